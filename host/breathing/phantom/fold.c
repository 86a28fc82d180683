/* Finds where a surface passes through itself, and smooths it until it does not. */
#include "phantom/contacts.h"

#include "core/maths.h"

#include <string.h>

enum { PASSES_MAX = 60 }; /* so that smoothing ends also where a fold stays */

/* A triangle of a surface. */
typedef struct {
    const int32_t *corners;
    int64_t triangle;
} surface;

/* Test of skg_grid_any: whether two facets of one surface meet. Facets with a common edge do not; those with a common
 * corner meet if the edge opposite to it passes through the other. */
static int folded(const void *data, const double *a, const double *b, int64_t number) {
    const surface *s = data;
    const int32_t *own = s->corners + 3 * s->triangle, *others = s->corners + 3 * number;
    int common = 0, i = 0, j = 0;
    if (number == s->triangle) return 0;
    for (int k = 0; k < 9; k++)
        if (own[k / 3] == others[k % 3]) common++, i = k / 3, j = k % 3;
    if (common == 0) return skg_triangles_meet(a, b);
    return common == 1 && (skg_triangle_pierced(a + 3 * ((i + 1) % 3), a + 3 * ((i + 2) % 3), b) ||
                           skg_triangle_pierced(b + 3 * ((j + 1) % 3), b + 3 * ((j + 2) % 3), a));
}

static int is_folded(const skg_triangle_grid *grid, const int32_t *corners, int64_t t) {
    return skg_grid_any(grid, grid->corner + 9 * t, folded, &(surface){corners, t});
}

static int has_moved(const int32_t *corners, int64_t t, const char *moved) {
    return !moved || moved[corners[3 * t]] || moved[corners[3 * t + 1]] || moved[corners[3 * t + 2]];
}

skg_status skg_shape_folds(const skg_mesh_arrays *a, const char *moved, int64_t *count, char *fold) {
    skg_triangle_grid grid = {0};
    double low[3], high[3];
    int64_t found = 0;
    skg_status status = SKG_OK;
    skg_grid_bounds(a->vertices, a->positions, 0, low, high);
    SKG_TRY_CLEANUP(skg_grid_add(a, low, high, &grid));
    SKG_TRY_CLEANUP(skg_grid_sort(low, high, &grid));
#pragma omp parallel for schedule(dynamic, 256) reduction(+ : found)
    for (int64_t t = 0; t < a->triangles; t++) {
        fold[t] = (char)(has_moved(a->corners, t, moved) && is_folded(&grid, a->corners, t));
        found += fold[t];
    }
    *count = found;
cleanup:
    skg_grid_free(&grid);
    return status;
}

/* Moves the corners of facets that are folded, or were in an earlier pass, halfway to the mean of their neighbours.
 * The neighbours of facets that are still folded move too, so that wide folds of small facets need no more passes
 * than narrow ones. moves: per vertex, 1 or 0; bit 2 marks the corners of folded facets meanwhile. */
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
    for (int pass = 0; pass < PASSES_MAX; pass++) {
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
