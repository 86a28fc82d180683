/* Signed lengths, each pixel against each triangle, in long double. */
#include "kernels/picture.h"

#include "core/maths.h"

#include <math.h>
#include <stdlib.h>

typedef long double real;

static void subtract(const real *a, const real *b, real *c) {
    for (int k = 0; k < 3; k++) c[k] = a[k] - b[k];
}

static real triple(const real *a, const real *b, const real *c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* The signed path parameter (0 at the source, 1 at the pixel) at which the line meets the triangle, clamped;
 * 0 where it misses. */
static real crossing(const real *source, const real *direction, real corner[3][3], real least) {
    real a[3], b[3], c[3];
    subtract(corner[0], source, a);
    subtract(corner[1], source, b);
    subtract(corner[2], source, c);
    const real u = triple(direction, b, c), v = triple(direction, c, a), w = triple(direction, a, b);
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return 0;
    const real sum = u + v + w;
    if (sum == 0) return 0;
    const real t = triple(a, b, c) / sum;
    return (sum > 0 ? 1 : -1) * (t < least ? least : t > 1 ? 1 : t);
}

static void place(const body *b, int64_t vertex, real *world) {
    for (int r = 0; r < 3; r++) {
        world[r] = (real)b->pose[4 * r + 3];
        for (int c = 0; c < 3; c++)
            world[r] += (real)b->pose[4 * r + c] * (real)b->shape->positions[3 * vertex + c];
    }
}

/* A pixel's ray: where the path parameter is 0 and where it goes to 1; the least parameter that counts. */
typedef struct {
    real source[3], direction[3], length, least;
} ray;

static ray ray_of(const skg_view *view, int64_t p) {
    const real column = (real)(p % view->columns) - (real)(view->columns - 1) / 2;
    const real row = (real)(p / view->columns) - (real)(view->rows - 1) / 2;
    ray r = {.length = 0};
    real behind = 0;
    for (int k = 0; k < 3; k++) {
        const real source = (real)view->source[k], centre = (real)view->centre[k];
        const real pixel = centre + column * (real)view->column_step[k] + row * (real)view->row_step[k];
        r.direction[k] = view->projection == SKG_PROJECTION_POINT      ? pixel - source
                         : view->projection == SKG_PROJECTION_PARALLEL ? centre - source
                                                                       : source;
        r.source[k] = pixel - r.direction[k];
        r.length += r.direction[k] * r.direction[k];
        behind += (r.source[k] - source) * r.direction[k];
    }
    r.least = view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY ? -1e9L
              : view->projection == SKG_PROJECTION_PARALLEL             ? -behind / r.length
                                                                        : 0;
    r.length = sqrtl(r.length);
    return r;
}

double *referee(const skg_view *view, int bodies, const body *of) {
    double *image = calloc((size_t)(view->rows * view->columns), sizeof *image);
    for (int n = 0; n < bodies; n++) {
        const body *b = &of[n];
        const double *m = b->pose;
        const double volume = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
                              m[2] * (m[4] * m[9] - m[5] * m[8]);
        const real weight = (real)(volume < 0 ? -b->weight : b->weight);
        for (int64_t t = 0; t < b->shape->triangles; t++) {
            real corner[3][3];
            for (int k = 0; k < 3; k++) place(b, b->shape->corners[3 * t + k], corner[k]);
            for (int64_t p = 0; p < view->rows * view->columns; p++) {
                const ray r = ray_of(view, p);
                image[p] += (double)(weight * r.length * crossing(r.source, r.direction, corner, r.least));
            }
        }
    }
    return image;
}
