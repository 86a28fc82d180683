/* Closed meshes with any number of triangles. */
#include "shapes.h"

#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

void shape_part(bench_shape *shape) {
    const int64_t vertices = 3 * shape->triangles;
    float *positions = bench_alloc((size_t)vertices * 3, sizeof *positions);
    for (int64_t v = 0; v < vertices; v++) {
        memcpy(positions + 3 * v, shape->positions + 3 * (int64_t)shape->corners[v], 3 * sizeof *positions);
        shape->corners[v] = (int32_t)v;
    }
    free(shape->positions);
    shape->positions = positions;
    shape->vertices = vertices;
}

/* The numbers below `count` in random order (Fisher and Yates; the generator is that of Knuth's MMIX). */
static int32_t *random_order(int64_t count, uint64_t state) {
    int32_t *order = bench_alloc((size_t)count, sizeof *order);
    for (int64_t i = 0; i < count; i++) order[i] = (int32_t)i;
    for (int64_t i = count - 1; i > 0; i--) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        const int64_t other = (int64_t)((state >> 32) % (uint64_t)(i + 1));
        const int32_t swap = order[i];
        order[i] = order[other];
        order[other] = swap;
    }
    return order;
}

void shape_shuffle(bench_shape *shape) {
    int32_t *vertex = random_order(shape->vertices, 1), *triangle = random_order(shape->triangles, 4);
    float *positions = bench_alloc((size_t)shape->vertices * 3, sizeof *positions);
    int32_t *corners = bench_alloc((size_t)shape->triangles * 3, sizeof *corners);
    for (int64_t v = 0; v < shape->vertices; v++)
        memcpy(positions + 3 * (int64_t)vertex[v], shape->positions + 3 * v, 3 * sizeof *positions);
    for (int64_t t = 0; t < shape->triangles; t++)
        for (int k = 0; k < 3; k++) corners[3 * (int64_t)triangle[t] + k] = vertex[shape->corners[3 * t + k]];
    free(shape->positions);
    free(shape->corners);
    shape->positions = positions, shape->corners = corners;
    free(vertex);
    free(triangle);
}

void shape_free(bench_shape *shape) {
    free(shape->positions);
    free(shape->corners);
    *shape = (bench_shape){0};
}
