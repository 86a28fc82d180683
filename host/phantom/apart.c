/* Whether surfaces meet. The regions that shape the organs keep gaps where they are sampled; between the
 * samples a facet may still cut into a neighbour's. */
#include "phantom/shape.h"

#include "scene/vector.h"

#include <string.h>

static const double clearance = 0.2; /* mm, about; kept from the other surfaces */
enum { MOST_STEPS = 60 };

/* Triangles in cells of a grid, as rows of nine coordinates. */
typedef struct {
    int64_t count;
    double *corner; /* [count][9] */
    double low[3], cell;
    int64_t size[3];
    int64_t *first;
    int32_t *list;
} triangle_grid;

static void bounds_of(int64_t vertices, const double *p, double grow, double low[3], double high[3]) {
    for (int k = 0; k < 3; k++) low[k] = HUGE_VAL, high[k] = -HUGE_VAL;
    for (int64_t i = 0; i < vertices; i++)
        for (int k = 0; k < 3; k++)
            low[k] = fmin(low[k], p[3 * i + k] - grow), high[k] = fmax(high[k], p[3 * i + k] + grow);
}

static int apart(const double *low, const double *high, const double *others_low, const double *others_high) {
    for (int k = 0; k < 3; k++)
        if (low[k] > others_high[k] || others_low[k] > high[k]) return 1;
    return 0;
}

/* Adds the triangles of a mesh that reach into a box. */
static skg_status gather(const skg_mesh *mesh, const double low[3], const double high[3],
                         triangle_grid *grid) {
    int64_t vertices, triangles, found = grid->count;
    double *positions = NULL;
    int32_t *corners = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_mesh_size(mesh, &vertices, &triangles));
    SKG_TRY_CLEANUP(skg_alloc(3 * vertices, sizeof *positions, "thorax", &positions));
    SKG_TRY_CLEANUP(skg_alloc(3 * triangles, sizeof *corners, "thorax", &corners));
    SKG_TRY_CLEANUP(skg_mesh_read_positions(mesh, positions, 0));
    SKG_TRY_CLEANUP(skg_mesh_read_triangles(mesh, corners, 0));
    SKG_TRY_CLEANUP(skg_realloc(9 * (found + triangles), sizeof *grid->corner, "thorax", &grid->corner));
    for (int64_t t = 0; t < triangles; t++) {
        double *row = grid->corner + 9 * found, from[3], to[3];
        for (int c = 0; c < 3; c++)
            memcpy(row + 3 * c, positions + 3 * (int64_t)corners[3 * t + c], 3 * sizeof *row);
        bounds_of(3, row, 0, from, to);
        found += !apart(from, to, low, high);
    }
    grid->count = found;
cleanup:
    skg_free(&positions);
    skg_free(&corners);
    return status;
}

static void cells_of(const triangle_grid *grid, const double low[3], const double high[3], int64_t from[3],
                     int64_t to[3]) {
    for (int k = 0; k < 3; k++) {
        const double last = (double)(grid->size[k] - 1);
        from[k] = (int64_t)fmin(last, fmax(0, floor((low[k] - grid->low[k]) / grid->cell)));
        to[k] = (int64_t)fmin(last, fmax(0, floor((high[k] - grid->low[k]) / grid->cell)));
    }
}

/* Pass 0 counts the triangles of each cell, pass 1 lists them. */
static void enter_triangles(triangle_grid *grid, int pass) {
    for (int64_t t = 0; t < grid->count; t++) {
        double low[3], high[3];
        int64_t from[3], to[3];
        bounds_of(3, grid->corner + 9 * t, 0, low, high);
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

static skg_status fill_grid(const double low[3], const double high[3], triangle_grid *grid) {
    double volume = 1;
    int64_t cells = 1;
    for (int k = 0; k < 3; k++) volume *= high[k] - low[k];
    grid->cell = fmax(1, cbrt(volume / (1 + (double)grid->count)));
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

/* Whether a segment goes through a triangle: the ends on two sides of its plane, the crossing within it (by
 * the signs of the volumes over its edges). */
static int pierces(const double *p, const double *q, const double *triangle) {
    const double *a = triangle, *b = triangle + 3, *c = triangle + 6;
    double ab[3], ac[3], n[3], ap[3], aq[3], way[3], cross[3];
    skg_add_scaled(b, -1, a, ab);
    skg_add_scaled(c, -1, a, ac);
    skg_add_scaled(p, -1, a, ap);
    skg_add_scaled(q, -1, a, aq);
    skg_cross(ab, ac, n);
    const double from = skg_dot(n, ap), to = skg_dot(n, aq);
    if ((from > 0) == (to > 0)) return 0;
    skg_add_scaled(q, -1, p, way);
    skg_cross(way, ap, cross); /* weights of b and c: as Moeller and Trumbore, J. Graph. Tools 2 (1997) 21 */
    const double all = skg_dot(n, way), v = skg_dot(ac, cross) / all, w = -skg_dot(ab, cross) / all;
    return v >= 0 && w >= 0 && v + w <= 1;
}

static int meet(const double *a, const double *b) {
    for (int e = 0; e < 3; e++)
        if (pierces(a + 3 * e, a + 3 * ((e + 1) % 3), b) || pierces(b + 3 * e, b + 3 * ((e + 1) % 3), a))
            return 1;
    return 0;
}

static int meets_any(const triangle_grid *grid, const double *triangle) {
    double low[3], high[3], there_low[3], there_high[3];
    int64_t from[3], to[3];
    bounds_of(3, triangle, 0, low, high);
    cells_of(grid, low, high, from, to);
    for (int64_t z = from[2]; z <= to[2]; z++)
        for (int64_t y = from[1]; y <= to[1]; y++)
            for (int64_t x = from[0]; x <= to[0]; x++) {
                const int64_t cell = (z * grid->size[1] + y) * grid->size[0] + x;
                for (int64_t i = grid->first[cell]; i < grid->first[cell + 1]; i++) {
                    const double *other = grid->corner + 9 * (int64_t)grid->list[i];
                    bounds_of(3, other, 0, there_low, there_high);
                    if (!apart(low, high, there_low, there_high) && meet(triangle, other)) return 1;
                }
            }
    return 0;
}

/* Outward normals of the vertices, length 1. */
static void find_normals(const skg_mesh_arrays *a, double *normal) {
    for (int64_t t = 0; t < a->triangles; t++) {
        const int32_t *c = a->corners + 3 * t;
        double e[3], f[3], n[3];
        skg_add_scaled(a->positions + 3 * (int64_t)c[1], -1, a->positions + 3 * (int64_t)c[0], e);
        skg_add_scaled(a->positions + 3 * (int64_t)c[2], -1, a->positions + 3 * (int64_t)c[0], f);
        skg_cross(e, f, n);
        for (int k = 0; k < 3; k++)
            skg_add_scaled(normal + 3 * (int64_t)c[k], 1, n, normal + 3 * (int64_t)c[k]);
    }
    for (int64_t i = 0; i < a->vertices; i++) {
        const double size = skg_length(normal + 3 * i);
        skg_scale_vector(size > 0 ? 1 / size : 0, normal + 3 * i, normal + 3 * i);
    }
}

/* Whether a facet meets another surface's where it would be with the clearance added. */
static int any_meets(const triangle_grid *grid, const skg_mesh_arrays *a, const double *normal) {
    int any = 0;
#pragma omp parallel for schedule(dynamic, 256) reduction(| : any)
    for (int64_t t = 0; t < a->triangles; t++) {
        double grown[9];
        for (int c = 0; c < 3; c++) {
            const int64_t v = a->corners[3 * t + c];
            skg_add_scaled(a->positions + 3 * v, clearance, normal + 3 * v, grown + 3 * c);
        }
        any |= meets_any(grid, grown);
    }
    return any;
}

skg_status skg_shape_meets(const char *name, int64_t count, skg_mesh *const *others,
                           const skg_mesh_arrays *arrays, int *meets) {
    triangle_grid grid = {0};
    double low[3], high[3], *normal = NULL;
    skg_status status = SKG_OK;
    bounds_of(arrays->vertices, arrays->positions, 2 * clearance, low, high);
    for (int64_t i = 0; i < count; i++) {
        const double *bounds = others[i]->health.bounds;
        if (!apart(low, high, bounds, bounds + 3)) SKG_TRY_CLEANUP(gather(others[i], low, high, &grid));
    }
    if (grid.count > 0) {
        SKG_TRY_CLEANUP(fill_grid(low, high, &grid));
        SKG_TRY_CLEANUP(skg_alloc(3 * arrays->vertices, sizeof *normal, name, &normal));
        find_normals(arrays, normal);
    }
    *meets = grid.count > 0 && any_meets(&grid, arrays, normal);
cleanup:
    skg_free(&normal);
    skg_free(&grid.corner);
    skg_free(&grid.first);
    skg_free(&grid.list);
    return status;
}
