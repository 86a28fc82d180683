#include "shapes.h"

#include "bench.h"

#include <math.h>
#include <stdlib.h>

const char *shape_name(int kind) {
    return kind == SHAPE_BLOB ? "blob" : "sphere";
}

/* Bumps in a direction, relative to the radius: a smooth sum that stays within 1/6. */
static double bumps(double x, double y, double z) {
    return (sin(7 * x + 2 * y) + sin(5 * y - 3 * z + 1) + sin(6 * z + 4 * x * y + 2)) / 18;
}

static void put_vertex(int kind, double radius, double latitude, double longitude, float *out) {
    const double x = sin(latitude) * cos(longitude), y = sin(latitude) * sin(longitude), z = cos(latitude);
    const double r = kind == SHAPE_BLOB ? radius * (1 + bumps(x, y, z)) : radius;
    out[0] = (float)(r * x), out[1] = (float)(r * y), out[2] = (float)(r * z);
}

/* The number of segments of a quarter of ring k of 2n. */
static int64_t quarter(int64_t n, int64_t k) {
    return k < n ? k : 2 * n - k;
}

/* The number of vertices before ring k. Rings 0 and 2n are poles of one vertex. */
static int64_t ring_start(int64_t n, int64_t k) {
    if (k == 0) return 0;
    if (k <= n) return 1 + 2 * k * (k - 1);
    return 2 + 4 * n * n - 1 - 2 * (2 * n - k) * (2 * n - k + 1);
}

static int32_t on_ring(int64_t n, int64_t k, int64_t place) {
    const int64_t around = 4 * quarter(n, k);
    return (int32_t)(ring_start(n, k) + (around ? place % around : 0));
}

static int32_t *put_triangle(int32_t *out, int32_t a, int32_t b, int32_t c) {
    out[0] = a, out[1] = b, out[2] = c;
    return out + 3;
}

/* Triangles between ring k and ring k + 1. */
static int32_t *put_band(int64_t n, int64_t k, int32_t *out) {
    const int64_t up = quarter(n, k), low = quarter(n, k + 1);
    for (int64_t side = 0; side < 4; side++) {
        for (int64_t s = 0; s < (up > low ? up : low); s++) {
            const int64_t u = side * up + s, l = side * low + s;
            if (low > up) {
                out = put_triangle(out, on_ring(n, k, u), on_ring(n, k + 1, l), on_ring(n, k + 1, l + 1));
                if (s < up)
                    out = put_triangle(out, on_ring(n, k, u), on_ring(n, k + 1, l + 1), on_ring(n, k, u + 1));
            } else {
                out = put_triangle(out, on_ring(n, k, u), on_ring(n, k + 1, l), on_ring(n, k, u + 1));
                if (s < low)
                    out = put_triangle(out, on_ring(n, k, u + 1), on_ring(n, k + 1, l),
                                       on_ring(n, k + 1, l + 1));
            }
        }
    }
    return out;
}

void shape_make(int kind, double radius, int64_t triangles, bench_shape *shape) {
    int64_t n = (int64_t)lround(sqrt((double)triangles / 8));
    if (n < 1) n = 1;
    shape->vertices = 4 * n * n + 2;
    shape->triangles = 8 * n * n;
    shape->positions = bench_alloc((size_t)shape->vertices * 3, sizeof *shape->positions);
    shape->corners = bench_alloc((size_t)shape->triangles * 3, sizeof *shape->corners);
    float *vertex = shape->positions;
    for (int64_t k = 0; k <= 2 * n; k++) {
        const int64_t around = quarter(n, k) ? 4 * quarter(n, k) : 1;
        for (int64_t s = 0; s < around; s++, vertex += 3)
            put_vertex(kind, radius, BENCH_PI * (double)k / (double)(2 * n),
                       2 * BENCH_PI * (double)s / (double)around, vertex);
    }
    int32_t *out = shape->corners;
    for (int64_t k = 0; k < 2 * n; k++) out = put_band(n, k, out);
}

void shape_cut(bench_shape *shape) {
    shape->triangles -= 4; /* at the last pole */
}

void shape_free(bench_shape *shape) {
    free(shape->positions);
    free(shape->corners);
    *shape = (bench_shape){0};
}
