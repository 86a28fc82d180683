/* A grid of triangles, by which those near each other are found. */
#include "phantom/contacts.h"

#include "core/maths.h"

#include <string.h>

void skg_grid_bounds(int64_t count, const double *p, double margin, double low[3], double high[3]) {
    for (int k = 0; k < 3; k++) low[k] = HUGE_VAL, high[k] = -HUGE_VAL;
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            low[k] = fmin(low[k], p[3 * i + k] - margin), high[k] = fmax(high[k], p[3 * i + k] + margin);
}

int skg_grid_apart(const double *low, const double *high, const double *others_low,
                   const double *others_high) {
    for (int k = 0; k < 3; k++)
        if (low[k] > others_high[k] || others_low[k] > high[k]) return 1;
    return 0;
}

skg_status skg_grid_add(const skg_mesh_arrays *a, const double low[3], const double high[3],
                        skg_triangle_grid *grid) {
    int64_t found = grid->count;
    SKG_TRY(skg_realloc(9 * (found + a->triangles), sizeof *grid->corner, "thorax", &grid->corner));
    for (int64_t t = 0; t < a->triangles; t++) {
        double *row = grid->corner + 9 * found, from[3], to[3];
        for (int c = 0; c < 3; c++)
            memcpy(row + 3 * c, a->positions + 3 * (int64_t)a->corners[3 * t + c], 3 * sizeof *row);
        skg_grid_bounds(3, row, 0, from, to);
        found += !skg_grid_apart(from, to, low, high);
    }
    grid->count = found;
    return SKG_OK;
}

skg_status skg_grid_add_mesh(const skg_mesh *mesh, const double low[3], const double high[3],
                             skg_triangle_grid *grid) {
    skg_mesh_arrays a = {0};
    skg_status status = SKG_OK;
    SKG_TRY(skg_mesh_count(mesh, &a.vertices, &a.triangles));
    SKG_TRY_CLEANUP(skg_alloc(3 * a.vertices, sizeof *a.positions, "thorax", &a.positions));
    SKG_TRY_CLEANUP(skg_alloc(3 * a.triangles, sizeof *a.corners, "thorax", &a.corners));
    SKG_TRY_CLEANUP(skg_mesh_positions_get(mesh, a.positions, 0));
    SKG_TRY_CLEANUP(skg_mesh_triangles_get(mesh, a.corners, 0));
    SKG_TRY_CLEANUP(skg_grid_add(&a, low, high, grid));
cleanup:
    skg_mesh_arrays_free(&a);
    return status;
}

static void cells_of(const skg_triangle_grid *grid, const double low[3], const double high[3],
                     int64_t from[3], int64_t to[3]) {
    for (int k = 0; k < 3; k++) {
        const double last = (double)(grid->size[k] - 1);
        from[k] = (int64_t)fmin(last, fmax(0, floor((low[k] - grid->low[k]) / grid->cell)));
        to[k] = (int64_t)fmin(last, fmax(0, floor((high[k] - grid->low[k]) / grid->cell)));
    }
}

/* Pass 0 counts the triangles of each cell, pass 1 lists them. */
static void enter_triangles(skg_triangle_grid *grid, int pass) {
    for (int64_t t = 0; t < grid->count; t++) {
        double low[3], high[3];
        int64_t from[3], to[3];
        skg_grid_bounds(3, grid->corner + 9 * t, 0, low, high);
        cells_of(grid, low, high, from, to);
        for (int64_t z = from[2]; z <= to[2]; z++)
            for (int64_t y = from[1]; y <= to[1]; y++)
                for (int64_t x = from[0]; x <= to[0]; x++) {
                    int64_t *at = grid->first + (z * grid->size[1] + y) * grid->size[0] + x;
                    if (pass == 0)
                        at[1]++;
                    else
                        grid->list[(*at)++] = (int32_t)t;
                }
    }
}

skg_status skg_grid_sort(const double low[3], const double high[3], skg_triangle_grid *grid) {
    double volume = 1, extent = 0;
    int64_t cells = 1;
    for (int k = 0; k < 3; k++) volume *= high[k] - low[k];
    for (int64_t t = 0; t < grid->count; t++) {
        double from[3], to[3];
        skg_grid_bounds(3, grid->corner + 9 * t, 0, from, to);
        extent += fmax(to[0] - from[0], fmax(to[1] - from[1], to[2] - from[2])) / (double)grid->count;
    }
    /* At least the mean size of a triangle. 8 cells a triangle are enough, since surfaces leave most cells empty. */
    grid->cell = fmax(extent, cbrt(volume / (1 + 8 * (double)grid->count)));
    for (int k = 0; k < 3; k++) {
        grid->low[k] = low[k];
        grid->size[k] = 1 + (int64_t)((high[k] - low[k]) / grid->cell);
        cells *= grid->size[k];
    }
    SKG_TRY(skg_alloc(cells + 1, sizeof *grid->first, "thorax", &grid->first));
    enter_triangles(grid, 0);
    for (int64_t c = 0; c < cells; c++) grid->first[c + 1] += grid->first[c];
    SKG_TRY(skg_alloc(grid->first[cells], sizeof *grid->list, "thorax", &grid->list));
    enter_triangles(grid, 1);
    for (int64_t c = cells; c > 0; c--) grid->first[c] = grid->first[c - 1];
    grid->first[0] = 0;
    return SKG_OK;
}

int skg_triangle_pierced(const double *p, const double *q, const double *triangle) {
    const double *a = triangle, *b = triangle + 3, *c = triangle + 6;
    double ab[3], ac[3], n[3], ap[3], aq[3], way[3], cross[3];
    skg_add_scaled(b, -1, a, ab);
    skg_add_scaled(c, -1, a, ac);
    skg_add_scaled(p, -1, a, ap);
    skg_add_scaled(q, -1, a, aq);
    skg_cross(ab, ac, n);
    const double from = skg_dot(n, ap), to = skg_dot(n, aq);
    const double level =
        1e-9 * skg_length(n); /* a point within 1e-9 mm of the plane lies in it, but for rounding */
    if (fabs(from) <= level || fabs(to) <= level || (from > 0) == (to > 0)) return 0;
    skg_add_scaled(q, -1, p, way);
    skg_cross(way, ap, cross);
    /* weights of b and c at the crossing, as Moeller and Trumbore compute them (J. Graph. Tools 2 (1997) 21) */
    const double all = skg_dot(n, way), v = skg_dot(ac, cross) / all, w = -skg_dot(ab, cross) / all;
    return v >= 0 && w >= 0 && v + w <= 1;
}

int skg_triangles_meet(const double *a, const double *b) {
    for (int e = 0; e < 3; e++)
        if (skg_triangle_pierced(a + 3 * e, a + 3 * ((e + 1) % 3), b) ||
            skg_triangle_pierced(b + 3 * e, b + 3 * ((e + 1) % 3), a))
            return 1;
    return 0;
}

int skg_grid_any(const skg_triangle_grid *grid, const double *triangle, skg_grid_test test,
                 const void *data) {
    double low[3], high[3], others_low[3], others_high[3];
    int64_t from[3], to[3];
    skg_grid_bounds(3, triangle, 0, low, high);
    cells_of(grid, low, high, from, to);
    for (int64_t z = from[2]; z <= to[2]; z++)
        for (int64_t y = from[1]; y <= to[1]; y++)
            for (int64_t x = from[0]; x <= to[0]; x++) {
                const int64_t cell = (z * grid->size[1] + y) * grid->size[0] + x;
                for (int64_t i = grid->first[cell]; i < grid->first[cell + 1]; i++) {
                    const double *other = grid->corner + 9 * (int64_t)grid->list[i];
                    skg_grid_bounds(3, other, 0, others_low, others_high);
                    if (!skg_grid_apart(low, high, others_low, others_high) &&
                        test(data, triangle, other, grid->list[i]))
                        return 1;
                }
            }
    return 0;
}

void skg_grid_free(skg_triangle_grid *grid) {
    skg_free(&grid->corner);
    skg_free(&grid->first);
    skg_free(&grid->list);
}
