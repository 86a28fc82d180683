/* Whether surfaces meet, each other or themselves. The regions that shape the organs keep gaps where they are
 * sampled; between the samples a facet may still cut into a neighbour's, and then draws back from it. */
#include "phantom/shape.h"

#include "core/vector.h"

#include <string.h>

static const double clearance = 0.2; /* mm, about; kept from the other surfaces */
static const double step = 0.25;     /* mm that what meets them draws back at once */
static const double slope = 0.5;     /* of what draws back, against what does not */
enum { MOST_STEPS = 60, MOST_PASSES = 60 };

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

/* Adds the triangles that reach into a box. */
static skg_status gather(const skg_mesh_arrays *a, const double low[3], const double high[3],
                         triangle_grid *grid) {
    int64_t found = grid->count;
    SKG_TRY(skg_realloc(9 * (found + a->triangles), sizeof *grid->corner, "thorax", &grid->corner));
    for (int64_t t = 0; t < a->triangles; t++) {
        double *row = grid->corner + 9 * found, from[3], to[3];
        for (int c = 0; c < 3; c++)
            memcpy(row + 3 * c, a->positions + 3 * (int64_t)a->corners[3 * t + c], 3 * sizeof *row);
        bounds_of(3, row, 0, from, to);
        found += !apart(from, to, low, high);
    }
    grid->count = found;
    return SKG_OK;
}

static skg_status gather_mesh(const skg_mesh *mesh, const double low[3], const double high[3],
                              triangle_grid *grid) {
    skg_mesh_arrays a = {0};
    skg_status status = SKG_OK;
    SKG_TRY(skg_mesh_count(mesh, &a.vertices, &a.triangles));
    SKG_TRY_CLEANUP(skg_alloc(3 * a.vertices, sizeof *a.positions, "thorax", &a.positions));
    SKG_TRY_CLEANUP(skg_alloc(3 * a.triangles, sizeof *a.corners, "thorax", &a.corners));
    SKG_TRY_CLEANUP(skg_mesh_positions_get(mesh, a.positions, 0));
    SKG_TRY_CLEANUP(skg_mesh_triangles_get(mesh, a.corners, 0));
    SKG_TRY_CLEANUP(gather(&a, low, high, grid));
cleanup:
    skg_mesh_arrays_free(&a);
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
    double volume = 1, extent = 0;
    int64_t cells = 1;
    for (int k = 0; k < 3; k++) volume *= high[k] - low[k];
    for (int64_t t = 0; t < grid->count; t++) {
        double from[3], to[3];
        bounds_of(3, grid->corner + 9 * t, 0, from, to);
        extent += fmax(to[0] - from[0], fmax(to[1] - from[1], to[2] - from[2])) / (double)grid->count;
    }
    grid->cell =
        fmax(extent, cbrt(volume / (1 + 8 * (double)grid->count))); /* surfaces leave most cells empty */
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
    const double level = 1e-9 * skg_length(n); /* mm3 of 1e-9 mm: rounding of points in the plane */
    if (fabs(from) <= level || fabs(to) <= level || (from > 0) == (to > 0)) return 0;
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

/* How far the vertices have drawn back from the surface as it was made. */
typedef struct {
    const skg_mesh_arrays *mesh;
    const double *normal; /* [vertices][3] as made */
    double *back;         /* [vertices] mm */
    char *meets;          /* [vertices] of a facet that meets another surface */
} retreat;

static void place_at(const retreat *r, int64_t v, double outwards, double place[3]) {
    skg_add_scaled(r->mesh->positions + 3 * v, outwards - r->back[v], r->normal + 3 * v, place);
}

/* Marks the vertices of facets that meet another surface where they would be with the clearance added. */
static int find_meeting(const triangle_grid *grid, const retreat *r) {
    const skg_mesh_arrays *a = r->mesh;
    int any = 0;
#pragma omp parallel for schedule(dynamic, 256) reduction(| : any)
    for (int64_t t = 0; t < a->triangles; t++) {
        double grown[9];
        for (int c = 0; c < 3; c++) place_at(r, a->corners[3 * t + c], clearance, grown + 3 * c);
        if (!meets_any(grid, grown)) continue;
        any = 1;
        for (int c = 0; c < 3; c++) {
#pragma omp atomic write
            r->meets[a->corners[3 * t + c]] = 1;
        }
    }
    return any;
}

/* Draws the marked vertices back by a step, and what is near them so far that the surface keeps a slope. */
static void draw_back(const retreat *r) {
    const skg_mesh_arrays *a = r->mesh;
    for (int64_t v = 0; v < a->vertices; v++) {
        if (r->meets[v]) r->back[v] += step;
        r->meets[v] = 0;
    }
    for (int changed = 1; changed;) {
        changed = 0;
        for (int64_t t = 0; t < a->triangles; t++)
            for (int c = 0; c < 3; c++) {
                const int64_t v = a->corners[3 * t + c], w = a->corners[3 * t + (c + 1) % 3];
                double edge[3];
                skg_add_scaled(a->positions + 3 * v, -1, a->positions + 3 * w, edge);
                const double least = r->back[v] - slope * skg_length(edge);
                if (r->back[w] < least - 1e-9) r->back[w] = least, changed = 1;
            }
    }
}

static skg_status retreat_from(const char *name, const triangle_grid *grid, skg_mesh_arrays *arrays) {
    double *normal = NULL, *back = NULL;
    char *meets = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(3 * arrays->vertices, sizeof *normal, name, &normal));
    SKG_TRY_CLEANUP(skg_alloc(arrays->vertices, sizeof *back, name, &back));
    SKG_TRY_CLEANUP(skg_alloc(arrays->vertices, 1, name, &meets));
    find_normals(arrays, normal);
    const retreat r = {arrays, normal, back, meets};
    for (int k = 0; k < MOST_STEPS && find_meeting(grid, &r); k++) draw_back(&r);
    for (int64_t v = 0; v < arrays->vertices; v++) place_at(&r, v, 0, arrays->positions + 3 * v);
cleanup:
    skg_free(&normal);
    skg_free(&back);
    skg_free(&meets);
    return status;
}

static void free_grid(triangle_grid *grid) {
    skg_free(&grid->corner);
    skg_free(&grid->first);
    skg_free(&grid->list);
}

skg_status skg_shape_retreat(const char *name, int64_t count, skg_mesh *const *others,
                             skg_mesh_arrays *arrays) {
    triangle_grid grid = {0};
    double low[3], high[3];
    skg_status status = SKG_OK;
    bounds_of(arrays->vertices, arrays->positions, 2 * clearance, low, high);
    for (int64_t i = 0; i < count; i++) {
        const double *bounds = others[i]->health.bounds;
        if (!apart(low, high, bounds, bounds + 3)) SKG_TRY_CLEANUP(gather_mesh(others[i], low, high, &grid));
    }
    if (grid.count == 0) goto cleanup;
    SKG_TRY_CLEANUP(fill_grid(low, high, &grid));
    SKG_TRY_CLEANUP(retreat_from(name, &grid, arrays));
cleanup:
    free_grid(&grid);
    return status;
}

/* Whether two facets of one surface meet: those with a common edge do not, those with a common corner by the
 * edges opposite to it. */
static int folded(const triangle_grid *grid, const int32_t *corners, int64_t t, int64_t u) {
    const double *a = grid->corner + 9 * t, *b = grid->corner + 9 * u;
    int common = 0, i = 0, j = 0;
    for (int k = 0; k < 9; k++)
        if (corners[3 * t + k / 3] == corners[3 * u + k % 3]) common++, i = k / 3, j = k % 3;
    if (common == 0) return meet(a, b);
    return common == 1 && (pierces(a + 3 * ((i + 1) % 3), a + 3 * ((i + 2) % 3), b) ||
                           pierces(b + 3 * ((j + 1) % 3), b + 3 * ((j + 2) % 3), a));
}

static int is_folded(const triangle_grid *grid, const int32_t *corners, int64_t t) {
    double low[3], high[3], there_low[3], there_high[3];
    int64_t from[3], to[3];
    bounds_of(3, grid->corner + 9 * t, 0, low, high);
    cells_of(grid, low, high, from, to);
    for (int64_t z = from[2]; z <= to[2]; z++)
        for (int64_t y = from[1]; y <= to[1]; y++)
            for (int64_t x = from[0]; x <= to[0]; x++) {
                const int64_t cell = (z * grid->size[1] + y) * grid->size[0] + x;
                for (int64_t i = grid->first[cell]; i < grid->first[cell + 1]; i++) {
                    const int64_t other = grid->list[i];
                    bounds_of(3, grid->corner + 9 * other, 0, there_low, there_high);
                    if (other != t && !apart(low, high, there_low, there_high) &&
                        folded(grid, corners, t, other))
                        return 1;
                }
            }
    return 0;
}

static int has_moved(const int32_t *corners, int64_t t, const char *moved) {
    return !moved || moved[corners[3 * t]] || moved[corners[3 * t + 1]] || moved[corners[3 * t + 2]];
}

skg_status skg_shape_folds(const skg_mesh_arrays *a, const char *moved, int64_t *count, char *fold) {
    triangle_grid grid = {0};
    double low[3], high[3];
    int64_t found = 0;
    skg_status status = SKG_OK;
    bounds_of(a->vertices, a->positions, 0, low, high);
    SKG_TRY_CLEANUP(gather(a, low, high, &grid));
    SKG_TRY_CLEANUP(fill_grid(low, high, &grid));
#pragma omp parallel for schedule(dynamic, 256) reduction(+ : found)
    for (int64_t t = 0; t < a->triangles; t++) {
        fold[t] = (char)(has_moved(a->corners, t, moved) && is_folded(&grid, a->corners, t));
        found += fold[t];
    }
    *count = found;
cleanup:
    free_grid(&grid);
    return status;
}

/* Moves the corners of folded facets, and of those that were, halfway to the mean of their neighbours; where
 * it folds still, also those neighbours, so that wide folds of small facets go as soon as narrow ones. */
static void smooth_folds(const skg_mesh_arrays *a, const char *fold, char *moves, double *sum) {
    memset(sum, 0, (size_t)(4 * a->vertices) * sizeof *sum);
    for (int64_t k = 0; k < 3 * a->triangles; k++)
        if (fold[k / 3]) moves[a->corners[k]] |= 2;
    for (int64_t k = 0; k < 3 * a->triangles; k++) {
        const int64_t here = a->corners[k], next = a->corners[k - k % 3 + (k + 1) % 3];
        if (moves[here] & 2) moves[next] |= 1;
        skg_add_scaled(sum + 4 * here, 1, a->positions + 3 * next, sum + 4 * here);
        sum[4 * here + 3]++;
    }
    for (int64_t i = 0; i < a->vertices; i++) {
        for (int k = 0; moves[i] && k < 3; k++)
            a->positions[3 * i + k] = 0.5 * (a->positions[3 * i + k] + sum[4 * i + k] / sum[4 * i + 3]);
        moves[i] = moves[i] != 0;
    }
}

skg_status skg_shape_unfold(const char *name, const skg_mesh_arrays *a) {
    char *fold = NULL, *moves = NULL;
    double *sum = NULL;
    int64_t folds = 1;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(a->triangles, sizeof *fold, name, &fold));
    SKG_TRY_CLEANUP(skg_alloc(a->vertices, sizeof *moves, name, &moves));
    SKG_TRY_CLEANUP(skg_alloc(4 * a->vertices, sizeof *sum, name, &sum));
    for (int pass = 0; pass < MOST_PASSES; pass++) {
        SKG_TRY_CLEANUP(skg_shape_folds(a, pass > 0 ? moves : NULL, &folds, fold));
        if (folds == 0) break;
        smooth_folds(a, fold, moves, sum);
    }
cleanup:
    skg_free(&fold);
    skg_free(&moves);
    skg_free(&sum);
    return status;
}
