/* Meshes as a segmentation has them: smoothed, or with few vertices. */
#include "register/subject.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Cells whose vertices become one, mm; rounds in which each vertex goes halfway to the mean of its neighbours. */
static const double cell_mm = 4;
enum { ROUNDS = 10 };

typedef struct {
    double key[3];
    int64_t vertex;
} keyed;

static int by_key(const void *a, const void *b) {
    const keyed *x = a, *y = b;
    for (int k = 0; k < 3; k++)
        if (x->key[k] != y->key[k]) return x->key[k] < y->key[k] ? -1 : 1;
    return (x->vertex > y->vertex) - (x->vertex < y->vertex);
}

/* Vertices in the same cell are one; cell: 0: at the same position. one: [count] its number. Returns how many there are. */
static int64_t unite(int64_t count, const double *positions, double cell, int64_t *one) {
    keyed *sorted = bench_alloc((size_t)count, sizeof *sorted);
    int64_t groups = 0;
    for (int64_t v = 0; v < count; v++) {
        sorted[v].vertex = v;
        for (int k = 0; k < 3; k++)
            sorted[v].key[k] = cell > 0 ? floor(positions[3 * v + k] / cell) : positions[3 * v + k];
    }
    qsort(sorted, (size_t)count, sizeof *sorted, by_key);
    for (int64_t v = 0; v < count; v++) {
        groups += v == 0 || memcmp(sorted[v].key, sorted[v - 1].key, sizeof sorted[v].key) != 0;
        one[sorted[v].vertex] = groups - 1;
    }
    free(sorted);
    return groups;
}

/* Every vertex goes to the mean of its group. */
static void gather(int64_t count, int64_t groups, const int64_t *one, double *positions) {
    double *sums = bench_alloc((size_t)(4 * groups), sizeof *sums);
    memset(sums, 0, (size_t)(4 * groups) * sizeof *sums);
    for (int64_t v = 0; v < count; v++) {
        sums[4 * one[v] + 3]++;
        for (int k = 0; k < 3; k++) sums[4 * one[v] + k] += positions[3 * v + k];
    }
    for (int64_t v = 0; v < count; v++)
        for (int k = 0; k < 3; k++) positions[3 * v + k] = sums[4 * one[v] + k] / sums[4 * one[v] + 3];
    free(sums);
}

/* Every vertex goes halfway to the mean of the others of its triangles. */
static void smooth(int64_t count, int64_t groups, const int64_t *one, int64_t triangles,
                   const int32_t *corners, double *positions) {
    double *sums = bench_alloc((size_t)(4 * groups), sizeof *sums);
    memset(sums, 0, (size_t)(4 * groups) * sizeof *sums);
    for (int64_t t = 0; t < 3 * triangles; t++) {
        const int64_t from = corners[t], to = corners[t % 3 == 2 ? t - 2 : t + 1];
        /* closed: the edge occurs the other way round as well */
        sums[4 * one[from] + 3]++;
        for (int k = 0; k < 3; k++) sums[4 * one[from] + k] += positions[3 * to + k];
    }
    for (int64_t v = 0; v < count; v++) {
        const double *sum = sums + 4 * one[v];
        for (int k = 0; k < 3 && sum[3] > 0; k++)
            positions[3 * v + k] += 0.5 * (sum[k] / sum[3] - positions[3 * v + k]);
    }
    free(sums);
}

void subject_segment(const subject *s, int way) {
    int64_t before = 0, after = 0;
    double square = 0;
    for (int64_t p = 0; p < s->part_count; p++) {
        skg_part part;
        int64_t count, triangles;
        skg_part_init(&part);
        bench_try(skg_scene_part_get(s->scene, s->parts[p], &part), "body");
        bench_try(skg_mesh_count(part.mesh, &count, &triangles), part.label);
        double *given = bench_alloc((size_t)(3 * count), sizeof *given),
               *moved = bench_alloc((size_t)(3 * count), sizeof *moved);
        int32_t *corners = bench_alloc((size_t)(3 * triangles), sizeof *corners);
        int64_t *one = bench_alloc((size_t)count, sizeof *one);
        bench_try(skg_mesh_positions_get(part.mesh, given, 0), part.label);
        bench_try(skg_mesh_triangles_get(part.mesh, corners, 0), part.label);
        memcpy(moved, given, (size_t)(3 * count) * sizeof *moved);
        const int64_t welded = unite(count, given, 0, one);
        before += welded;
        if (way == SUBJECT_DECIMATED) {
            const int64_t groups = unite(count, given, cell_mm, one);
            gather(count, groups, one, moved);
            after += groups;
        } else {
            for (int round = 0; round < ROUNDS; round++)
                smooth(count, welded, one, triangles, corners, moved);
            after += welded;
        }
        for (int64_t k = 0; k < 3 * count; k++)
            square += (moved[k] - given[k]) * (moved[k] - given[k]) / (double)s->vertices;
        bench_try(skg_mesh_positions_set(part.mesh, moved, 0), part.label);
        free(given);
        free(moved);
        free(corners);
        free(one);
    }
    printf("the body's meshes: %lld vertices of %lld, %.2g mm (root mean square) from where they were\n",
           (long long)after, (long long)before, sqrt(square));
}
