/* A slow ray caster in long double: every ray against every triangle. */
#include "support/caster.h"

#include <math.h>
#include <stdlib.h>

typedef long double real;

/* A vertex in the ray's frame: across (u, v), along (from the pixel, towards where the ray goes), mm. The
 * code says on which sides it lies, so that most triangles are skipped quickly. */
typedef struct {
    real u, v, along;
    unsigned code;
} seen;

struct caster {
    const solid *of;
    real pose[12];
    real sign; /* -1: the pose mirrors */
    seen *vertices;
};

caster *caster_create(const solid *of, const double *pose) {
    caster *c = calloc(1, sizeof *c);
    c->of = of;
    for (int k = 0; k < 12; k++) c->pose[k] = pose ? (real)pose[k] : k % 5 == 0;
    const real *m = c->pose;
    c->sign = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
                          m[2] * (m[4] * m[9] - m[5] * m[8]) <
                      0
                  ? -1
                  : 1;
    c->vertices = calloc((size_t)of->vertices, sizeof *c->vertices);
    return c;
}

void caster_free(caster *c) {
    if (c) free(c->vertices);
    free(c);
}

static real dot(const real *a, const real *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const real *a, const real *b, real *c) {
    for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void normalise(real *a) {
    const real length = sqrtl(dot(a, a));
    for (int k = 0; k < 3; k++) a[k] /= length;
}

/* The ray to a pixel: axes[2] is its direction, axes[0] and axes[1] are across; `start` is where it begins,
 * measured from the pixel along it (negative). */
typedef struct {
    real pixel[3], axes[3][3], start;
} ray;

static ray ray_to(const skg_view *view, real column, real row) {
    ray r = {.start = 0};
    const real c = column - (real)(view->columns - 1) / 2, w = row - (real)(view->rows - 1) / 2;
    real way[3];
    for (int k = 0; k < 3; k++) {
        r.pixel[k] = (real)view->centre[k] + c * (real)view->column_step[k] + w * (real)view->row_step[k];
        way[k] = r.pixel[k] - (real)view->source[k];
        r.axes[2][k] = view->projection == SKG_PROJECTION_POINT ? way[k]
                       : view->projection == SKG_PROJECTION_PARALLEL
                           ? (real)view->centre[k] - (real)view->source[k]
                           : (real)view->source[k];
    }
    normalise(r.axes[2]);
    r.start =
        view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY ? -(real)HUGE_VAL : -dot(way, r.axes[2]);
    int least = 0; /* the axis most across the ray */
    for (int k = 1; k < 3; k++)
        if (fabsl(r.axes[2][k]) < fabsl(r.axes[2][least])) least = k;
    const real any[3] = {least == 0, least == 1, least == 2};
    cross(r.axes[2], any, r.axes[0]);
    normalise(r.axes[0]);
    cross(r.axes[2], r.axes[0], r.axes[1]);
    return r;
}

static void see(caster *c, const ray *r) {
    for (int64_t n = 0; n < c->of->vertices; n++) {
        const double *p = c->of->positions + 3 * n;
        const real at[3] = {(real)p[0], (real)p[1], (real)p[2]};
        real from[3];
        for (int k = 0; k < 3; k++) from[k] = dot(c->pose + 4 * k, at) + c->pose[4 * k + 3] - r->pixel[k];
        seen *v = &c->vertices[n];
        v->u = dot(r->axes[0], from);
        v->v = dot(r->axes[1], from);
        v->along = dot(r->axes[2], from);
        v->code = (v->u > 0 ? 1u : 0u) | (v->u < 0 ? 2u : 0u) | (v->v > 0 ? 4u : 0u) | (v->v < 0 ? 8u : 0u);
    }
}

static int sign_of(real x) {
    return (x > 0) - (x < 0);
}

/* The side of the edge a -> b that the origin, moved by (e, e^2), lies on: the sign of
 * (a.u - e)(b.v - e^2) - (a.v - e^2)(b.u - e). 0 only where a and b coincide as seen. */
static int side(const seen *a, const seen *b) {
    const real p = a->u * b->v, q = a->v * b->u;
    if (p != q) return p > q ? 1 : -1; /* rounding keeps order */
    const int exact = sign_of(fmal(a->u, b->v, -p) - fmal(a->v, b->u, -q));
    if (exact) return exact;
    return a->v != b->v ? sign_of(a->v - b->v) : sign_of(b->u - a->u);
}

/* Where on the ray the triangle's plane is met. Weights are the areas on the far side of each corner. */
static real meet(const seen *a, const seen *b, const seen *c) {
    const real wa = b->u * c->v - b->v * c->u, wb = c->u * a->v - c->v * a->u, wc = a->u * b->v - a->v * b->u;
    const real sum = wa + wb + wc;
    const real low = fminl(a->along, fminl(b->along, c->along)),
               high = fmaxl(a->along, fmaxl(b->along, c->along));
    const real met = sum != 0 ? (wa * a->along + wb * b->along + wc * c->along) / sum : low;
    return fminl(high, fmaxl(low, met));
}

real caster_length(caster *c, const skg_view *view, real column, real row) {
    const ray r = ray_to(view, column, row);
    if (r.start >= 0) return 0; /* behind the source's plane */
    see(c, &r);
    real length = 0;
    int balance = 0;
    for (int64_t t = 0; t < c->of->triangles; t++) {
        const int32_t *n = c->of->corners + 3 * t;
        const seen *v0 = &c->vertices[n[0]], *v1 = &c->vertices[n[1]], *v2 = &c->vertices[n[2]];
        if (v0->code & v1->code & v2->code) continue;
        const int s = side(v0, v1);
        if (s == 0 || side(v1, v2) != s || side(v2, v0) != s) continue;
        const real met = meet(v0, v1, v2);
        balance += s;
        length += (real)s * (met < r.start ? r.start : met > 0 ? 0 : met);
    }
    return balance ? (real)NAN : c->sign * length;
}

void caster_range(caster *c, const skg_view *view, int64_t column, int64_t row, double wobble, double *low,
                  double *high) {
    static const int steps[5][2] = {{0, 0}, {-1, -1}, {-1, 1}, {1, -1}, {1, 1}};
    *low = HUGE_VAL;
    *high = -HUGE_VAL;
    for (int k = 0; k < (wobble > 0 ? 5 : 1); k++) {
        const double length = (double)caster_length(c, view, (real)column + (real)steps[k][0] * (real)wobble,
                                                    (real)row + (real)steps[k][1] * (real)wobble);
        *low = fmin(*low, length);
        *high = fmax(*high, length);
        if (isnan(length)) *low = *high = length;
    }
}
