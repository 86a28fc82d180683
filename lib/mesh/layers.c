/* How many components of a mesh may lie over each other at a point. The integer planes of sums are scaled so that as
 * many fit. */
#include "mesh/mesh.h"

#include <float.h>
#include <math.h>

/* Cells along each axis. More would separate components better and cost more: 33^3 counts are 140 KiB. */
enum { CELLS = 32, EDGES = CELLS + 1 };

/* Boxes counted per cell of the mesh's bounds: differences at the corners of each box, summed at the end. */
typedef struct {
    double low[3], step[3];
    int32_t *counts; /* [EDGES][EDGES][EDGES] */
} cell_grid;

static int64_t cell_of(const cell_grid *grid, int axis, double x) {
    if (!(grid->step[axis] > 0)) return 0;
    double cell = floor((x - grid->low[axis]) / grid->step[axis]);
    return cell < 0 ? 0 : cell > CELLS - 1 ? CELLS - 1 : (int64_t)cell;
}

static void add_box(cell_grid *grid, const float *box) {
    int64_t from[3], to[3];
    for (int k = 0; k < 3; k++) {
        from[k] = cell_of(grid, k, (double)box[k]);
        to[k] = cell_of(grid, k, (double)box[3 + k]) + 1;
    }
    for (int corner = 0; corner < 8; corner++) {
        int64_t at = 0, sign = 1;
        for (int k = 0; k < 3; k++) {
            int last = corner >> k & 1;
            at = at * EDGES + (last ? to[k] : from[k]);
            if (last) sign = -sign;
        }
        grid->counts[at] += (int32_t)sign;
    }
}

/* Sums the differences along each axis in turn, and returns the largest count. */
static int32_t largest(cell_grid *grid) {
    const int64_t strides[3] = {(int64_t)EDGES * EDGES, EDGES, 1}, all = (int64_t)EDGES * EDGES * EDGES;
    int32_t most = 1;
    for (int axis = 0; axis < 3; axis++)
        for (int64_t i = 0; i < all; i++) {
            if (i / strides[axis] % EDGES > 0) grid->counts[i] += grid->counts[i - strides[axis]];
            if (axis == 2 && grid->counts[i] > most) most = grid->counts[i];
        }
    return most;
}

/* The box of each component; components are numbered in the order of their root triangles. */
static skg_status find_boxes(const skg_mesh *mesh, const int32_t *root, float **boxes, int64_t *count) {
    int32_t *number = NULL;
    *count = 0;
    SKG_TRY(skg_alloc(mesh->triangles, sizeof *number, mesh->name, &number));
    for (int64_t t = 0; t < mesh->triangles; t++)
        if (root[t] == t) number[t] = (int32_t)(*count)++;
    skg_status status = skg_alloc(*count * 6, sizeof **boxes, mesh->name, boxes);
    for (int64_t i = 0; status == SKG_OK && i < *count * 6; i++) (*boxes)[i] = i % 6 < 3 ? FLT_MAX : -FLT_MAX;
    for (int64_t c = 0; status == SKG_OK && c < 3 * mesh->triangles; c++) {
        float *box = *boxes + 6 * (int64_t)number[root[c / 3]];
        const float *at = mesh->offsets + 3 * (int64_t)mesh->corners[c];
        for (int k = 0; k < 3; k++) {
            box[k] = fminf(box[k], at[k]);
            box[3 + k] = fmaxf(box[3 + k], at[k]);
        }
    }
    skg_free(&number);
    return status;
}

skg_status skg_mesh_count_layers(skg_mesh *mesh, const int32_t *root, int32_t multiplicity) {
    cell_grid grid = {0};
    float *boxes = NULL;
    int64_t count = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(find_boxes(mesh, root, &boxes, &count));
    mesh->layers = multiplicity;
    if (count < 2) goto cleanup;
    SKG_TRY_CLEANUP(skg_alloc((int64_t)EDGES * EDGES * EDGES, sizeof *grid.counts, mesh->name, &grid.counts));
    for (int k = 0; k < 3; k++) {
        grid.low[k] = (double)mesh->lowest[k];
        grid.step[k] = ((double)mesh->highest[k] - (double)mesh->lowest[k]) / CELLS;
    }
    for (int64_t i = 0; i < count; i++) add_box(&grid, boxes + 6 * i);
    mesh->layers = multiplicity * largest(&grid);
cleanup:
    skg_free(&boxes);
    skg_free(&grid.counts);
    return status;
}
