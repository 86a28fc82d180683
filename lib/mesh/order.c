/* An order of the triangles in which neighbours in memory are neighbours in space. */
#include "mesh/mesh.h"

#include <math.h>
#include <string.h>

/* 10 bits for each axis make a code of 30 bits, which three passes over digits of 10 bits sort. */
enum { AXIS_BITS = 10, DIGIT_BITS = 10 };

static void centroid(const skg_mesh *mesh, int64_t triangle, float centre[3]) {
    const int32_t *corner = mesh->corners + 3 * triangle;
    for (int k = 0; k < 3; k++)
        centre[k] = (mesh->offsets[3 * (int64_t)corner[0] + k] + mesh->offsets[3 * (int64_t)corner[1] + k] +
                     mesh->offsets[3 * (int64_t)corner[2] + k]) /
                    3;
}

/* The bits abcdefghij as a00b00c00...: the gaps are for the bits of the two other axes (a Morton code). */
static uint32_t spread(uint32_t x) {
    x = (x | x << 16) & 0x030000FFu;
    x = (x | x << 8) & 0x0300F00Fu;
    x = (x | x << 4) & 0x030C30C3u;
    return (x | x << 2) & 0x09249249u;
}

/* Each item is code << 32 | triangle. */
static void fill_codes(const skg_mesh *mesh, uint64_t *item) {
    float extent = 0;
    for (int k = 0; k < 3; k++) extent = fmaxf(extent, mesh->highest[k] - mesh->lowest[k]);
    /* The half cell keeps the highest point in the top cell after rounding. A mesh without extent gets 0. */
    float scale = extent > 0 && isfinite(extent) ? ((1 << AXIS_BITS) - 0.5F) / extent : 0;
    for (int64_t t = 0; t < mesh->triangles; t++) {
        float centre[3];
        uint32_t code = 0;
        centroid(mesh, t, centre);
        for (int k = 0; k < 3; k++) {
            float cell = (centre[k] - mesh->lowest[k]) * scale;
            cell = fminf(fmaxf(cell, 0), (1 << AXIS_BITS) - 1);
            code |= spread((uint32_t)cell) << k;
        }
        item[t] = (uint64_t)code << 32 | (uint64_t)t;
    }
}

/* Sorts by code, the lowest digit first; equal codes keep their order. Returns the array that holds the result. */
static uint64_t *sort_codes(uint64_t *item, uint64_t *other, int64_t count) {
    for (int shift = 32; shift < 32 + 3 * AXIS_BITS; shift += DIGIT_BITS) {
        int64_t start[(1 << DIGIT_BITS) + 1] = {0};
        const uint64_t mask = (1 << DIGIT_BITS) - 1;
        for (int64_t i = 0; i < count; i++) start[(item[i] >> shift & mask) + 1]++;
        for (int d = 0; d < 1 << DIGIT_BITS; d++) start[d + 1] += start[d];
        for (int64_t i = 0; i < count; i++) other[start[item[i] >> shift & mask]++] = item[i];
        uint64_t *swap = item;
        item = other;
        other = swap;
    }
    return item;
}

/* The sum of the distances from each triangle to the next, mm. item NULL: in the caller's order. */
static double journey(const skg_mesh *mesh, const uint64_t *item) {
    float last[3], here[3];
    double sum = 0;
    centroid(mesh, item ? (int64_t)(item[0] & UINT32_MAX) : 0, last);
    for (int64_t i = 1; i < mesh->triangles; i++) {
        centroid(mesh, item ? (int64_t)(item[i] & UINT32_MAX) : i, here);
        sum += (double)(fabsf(here[0] - last[0]) + fabsf(here[1] - last[1]) + fabsf(here[2] - last[2]));
        memcpy(last, here, sizeof last);
    }
    return sum;
}

skg_status skg_mesh_sorted_corners(const skg_mesh *mesh, int32_t *corners, int32_t *sorted) {
    uint64_t *item = NULL, *other = NULL, *order;
    skg_status status = SKG_OK;
    *sorted = 0;
    memcpy(corners, mesh->corners, 3 * (size_t)mesh->triangles * sizeof *corners);
    if (mesh->triangles < SKG_MESH_SMALL || mesh->first_bad >= 0) return SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, sizeof *item, mesh->name, &item));
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, sizeof *other, mesh->name, &other));
    fill_codes(mesh, item);
    order = sort_codes(item, other, mesh->triangles);
    /* The strips of a modelling program serve as well as the curve, so an order up to twice as long is kept. */
    if (journey(mesh, NULL) > 2 * journey(mesh, order)) {
        *sorted = 1;
        for (int64_t i = 0; i < mesh->triangles; i++)
            memcpy(corners + 3 * i, mesh->corners + 3 * (order[i] & UINT32_MAX), 3 * sizeof *corners);
    }
cleanup:
    skg_free(&other);
    skg_free(&item);
    return status;
}
