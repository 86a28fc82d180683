/* Cells where parts compete: where one may displace others, what a face changes depends on what else is there. */
#include "scatter/media.h"

#include <math.h>

static int32_t lowest_priority(const skg_cell_parts *parts) {
    int32_t lowest = parts->priority[0];
    for (int64_t i = 1; i < parts->count; i++)
        if (parts->priority[i] < lowest) lowest = parts->priority[i];
    return lowest;
}

/* The cells that the box of a solid meets. */
static void find_range(const skg_cells *cells, const skg_solid *solid, int64_t first[3], int64_t last[3]) {
    for (int k = 0; k < 3; k++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int64_t v = 0; v < solid->vertices; v++) {
            low = fmin(low, solid->positions[3 * v + k]);
            high = fmax(high, solid->positions[3 * v + k]);
        }
        const double per_mm = (double)cells->count[k] / cells->size[k], end = (double)(cells->count[k] - 1);
        first[k] = (int64_t)fmin(fmax(floor((low - cells->low[k]) * per_mm), 0), end);
        last[k] = (int64_t)fmin(fmax(floor((high - cells->low[k]) * per_mm), 0), end);
    }
}

static void mark(const skg_cells *cells, const int64_t first[3], const int64_t last[3], uint8_t *settled) {
    for (int64_t z = first[2]; z <= last[2]; z++)
        for (int64_t y = first[1]; y <= last[1]; y++)
            for (int64_t x = first[0]; x <= last[0]; x++)
                settled[(z * cells->count[1] + y) * cells->count[0] + x] = 1;
}

/* Whether two parts displace the same volume. */
static int both_displace(const skg_cell_parts *parts, int64_t a, int64_t b) {
    int same = 0;
    for (int64_t v = 0; v < parts->volume_count; v++)
        same |= parts->volumes[v].times[a] < 0 && parts->volumes[v].times[b] < 0;
    return same;
}

/* Where two parts that displace a volume may overlap, its cells are away once. */
static void mark_pair(const skg_cells *cells, const skg_solid *a, const skg_solid *b, uint8_t *settled) {
    int64_t first[2][3], last[2][3];
    find_range(cells, a, first[0], last[0]);
    find_range(cells, b, first[1], last[1]);
    for (int k = 0; k < 3; k++) {
        if (first[1][k] > first[0][k]) first[0][k] = first[1][k];
        if (last[1][k] < last[0][k]) last[0][k] = last[1][k];
    }
    mark(cells, first[0], last[0], settled);
}

skg_status skg_cells_settled(const skg_cell_parts *parts, const skg_cells *cells, uint8_t **settled) {
    SKG_TRY(skg_alloc(skg_cells_count(cells), 1, "cells", settled));
    if (!parts->priority || parts->count == 0) return SKG_OK;
    const int32_t lowest = lowest_priority(parts);
    for (int64_t i = 0; i < parts->count; i++) {
        if (parts->clip || parts->unite || parts->priority[i] > lowest) {
            int64_t first[3], last[3];
            find_range(cells, &parts->solids[i], first, last);
            mark(cells, first, last, *settled);
        }
        for (int64_t j = 0; parts->volume_count > 0 && j < i; j++)
            if (both_displace(parts, i, j)) mark_pair(cells, &parts->solids[i], &parts->solids[j], *settled);
    }
    return SKG_OK;
}
