/* The motion of a surface from that of some of its vertices, smooth in between. */
#include "body/shares.h"

#include "core/maths.h"

/* The function f that is 1 at the given vertices and elsewhere solves f = t div grad f falls off about as exp(-d / sqrt t)
 * with the distance d (S. R. S. Varadhan, Comm. Pure Appl. Math. 20 (1967) 431). Linear finite elements. */
static const double smooth_mm = 12; /* sqrt t */

/* The equations: a weight for each side of each triangle, and an area for each vertex. */
typedef struct {
    const skg_body_organ *organ;
    double *side;   /* [3 triangles] opposite corner c: half of its angle's cotangent */
    double *area;   /* mm2 over t */
    double *centre; /* per vertex: what its own value counts */
    const unsigned char *given;
    int64_t struts;
    const int32_t *ends; /* [2 struts] */
    double *through;     /* [struts] their weights */
} equations;

static int32_t node(const skg_body_organ *o, int64_t triangle, int corner) {
    return o->node_of[o->corner[3 * triangle + corner % 3]];
}

static void fill(equations *e) {
    const double least = 1e-3,
                 most = 1e3; /* of a weight: keeps slivers from separating or joining their corners */
    const skg_body_organ *o = e->organ;
    for (int64_t t = 0; t < o->triangles; t++)
        for (int c = 0; c < 3; c++) {
            const double *p = o->rest + 3 * (int64_t)node(o, t, c);
            const int32_t i = node(o, t, c + 1), j = node(o, t, c + 2);
            double a[3], b[3], n[3];
            skg_add_scaled(o->rest + 3 * (int64_t)i, -1, p, a);
            skg_add_scaled(o->rest + 3 * (int64_t)j, -1, p, b);
            skg_cross(a, b, n);
            const double weight = 0.5 * skg_dot(a, b) / skg_length(n);
            e->side[3 * t + c] =
                weight >= least ? fmin(weight, most) : least; /* also where there is no area */
            e->centre[i] += e->side[3 * t + c], e->centre[j] += e->side[3 * t + c];
            e->area[node(o, t, c)] += skg_length(n) / 6;
        }
    for (int64_t s = 0; s < e->struts; s++) { /* each face stands for half of the thickness */
        const int32_t i = e->ends[2 * s], j = e->ends[2 * s + 1];
        double d[3];
        skg_add_scaled(o->rest + 3 * (int64_t)i, -1, o->rest + 3 * (int64_t)j, d);
        e->through[s] = fmin(2 * e->area[i] / skg_dot(d, d), most);
        e->centre[i] += e->through[s], e->centre[j] += e->through[s];
    }
    for (int64_t i = 0; i < o->vertices; i++) {
        e->area[i] /= smooth_mm * smooth_mm;
        e->centre[i] += e->area[i];
    }
}

/* result = A x, with rows of given vertices left out. */
static void apply(const equations *e, const double *x, double *result) {
    const skg_body_organ *o = e->organ;
    for (int64_t i = 0; i < o->vertices; i++) result[i] = e->area[i] * x[i];
    for (int64_t t = 0; t < o->triangles; t++)
        for (int c = 0; c < 3; c++) {
            const int32_t i = node(o, t, c + 1), j = node(o, t, c + 2);
            const double flow = e->side[3 * t + c] * (x[i] - x[j]);
            result[i] += flow, result[j] -= flow;
        }
    for (int64_t s = 0; s < e->struts; s++) {
        const int32_t i = e->ends[2 * s], j = e->ends[2 * s + 1];
        const double flow = e->through[s] * (x[i] - x[j]);
        result[i] += flow, result[j] -= flow;
    }
    for (int64_t i = 0; i < o->vertices; i++)
        if (e->given[i]) result[i] = 0;
}

/* Conjugate gradients, preconditioned by the diagonal. work: four numbers for each vertex. */
static void solve(const equations *e, double *f, double *work) {
    const int64_t n = e->organ->vertices;
    const double enough = 1e-10; /* of the first residual; the distance needs f down to exp(-10) */
    double *r = work, *z = work + n, *d = work + 2 * n, *ad = work + 3 * n, rz, first;
    apply(e, f, ad);
    for (int64_t i = 0; i < n; i++) {
        r[i] = -ad[i];
        d[i] = z[i] = e->centre[i] > 0 ? r[i] / e->centre[i] : 0;
    }
    first = rz = skg_dot_long(n, r, z);
    for (int64_t step = 0; step < 4 * n && rz > enough * enough * first; step++) {
        apply(e, d, ad);
        const double way = rz / skg_dot_long(n, d, ad), before = rz;
        for (int64_t i = 0; i < n; i++) {
            f[i] += way * d[i], r[i] -= way * ad[i];
            z[i] = e->centre[i] > 0 ? r[i] / e->centre[i] : 0;
        }
        rz = skg_dot_long(n, r, z);
        for (int64_t i = 0; i < n; i++) d[i] = z[i] + rz / before * d[i];
    }
}

skg_status skg_surface_distance(const skg_body_organ *o, const unsigned char *given, int64_t strut_count,
                                const int32_t *struts, double *distance) {
    equations e = {.organ = o, .given = given, .struts = strut_count, .ends = struts};
    double *work = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(3 * o->triangles, sizeof *e.side, o->label, &e.side));
    SKG_TRY_CLEANUP(skg_alloc(o->vertices, sizeof *e.area, o->label, &e.area));
    SKG_TRY_CLEANUP(skg_alloc(o->vertices, sizeof *e.centre, o->label, &e.centre));
    SKG_TRY_CLEANUP(skg_alloc(strut_count, sizeof *e.through, o->label, &e.through));
    SKG_TRY_CLEANUP(skg_alloc(4 * o->vertices, sizeof *work, o->label, &work));
    fill(&e);
    for (int64_t i = 0; i < o->vertices; i++) distance[i] = given[i];
    solve(&e, distance, work);
    for (int64_t i = 0; i < o->vertices; i++) /* 1e-9: about what the solution is accurate to */
        distance[i] = -smooth_mm * log(fmin(fmax(distance[i], 1e-9), 1));
cleanup:
    skg_free(&e.side);
    skg_free(&e.area);
    skg_free(&e.centre);
    skg_free(&e.through);
    skg_free(&work);
    return status;
}
