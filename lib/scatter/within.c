/* Volumes of cells among the parts: what they hold in each cell of the object, and along lines. */
#include "scatter/voxels.h"

#include "core/maths.h"
#include "core/threads.h"

#include <math.h>

/* Samples along a side of a cell: one for each of the volume's cells, within these bounds. */
enum { SAMPLES_MIN = 4, SAMPLES_MAX = 16 };

typedef struct {
    const skg_cell_volume *of;
    const skg_cells *cells;
    int64_t (*within)[SKG_SCATTER_RANK]; /* [z][y][x] */
    int64_t samples[3];                  /* along the sides of a cell */
} filling;

/* Adds what the volume holds at a place of the world. Returns 0 outside. */
static int add_at(const skg_cell_volume *of, const double place[3], double sum[SKG_SCATTER_RANK]) {
    const skg_volume *volume = of->volume;
    double at[3], amount = 0;
    int64_t cell = 0;
    skg_pose_point(of->to_cells, place, at);
    for (int k = 2; k >= 0; k--) {
        if (!(at[k] >= 0 && at[k] < (double)volume->size[k])) return 0;
        cell = cell * volume->size[k] + (int64_t)at[k];
    }
    const int32_t curve = skg_volume_cell(volume, cell, &amount);
    for (int k = 0; k < SKG_SCATTER_RANK; k++) sum[k] += amount * of->coefficients[curve][k];
    return 1;
}

static void fill_cell(const filling *f, const int64_t cell[3], int64_t *within) {
    const skg_cells *cells = f->cells;
    double sum[SKG_SCATTER_RANK] = {0}, place[3];
    int64_t sample[3], count = 0;
    for (sample[2] = 0; sample[2] < f->samples[2]; sample[2]++)
        for (sample[1] = 0; sample[1] < f->samples[1]; sample[1]++)
            for (sample[0] = 0; sample[0] < f->samples[0]; sample[0]++) {
                for (int k = 0; k < 3; k++)
                    place[k] = cells->low[k] +
                               cells->size[k] / (double)cells->count[k] *
                                   ((double)cell[k] + ((double)sample[k] + 0.5) / (double)f->samples[k]);
                count += add_at(f->of, place, sum);
            }
    for (int k = 0; k < SKG_SCATTER_RANK && count; k++)
        within[k] = llrint(sum[k] / (double)count * SKG_CELL_UNIT);
}

static skg_status fill_plane(void *user, int64_t z) {
    const filling *f = user;
    const int64_t *count = f->cells->count;
    for (int64_t y = 0; y < count[1]; y++)
        for (int64_t x = 0; x < count[0]; x++)
            fill_cell(f, (const int64_t[3]){x, y, z}, f->within[(z * count[1] + y) * count[0] + x]);
    return SKG_OK;
}

static skg_status fill_volume(const skg_cell_volume *of, const skg_cells *cells,
                              int64_t (*within)[SKG_SCATTER_RANK]) {
    filling f = {.of = of, .cells = cells, .within = within};
    for (int k = 0; k < 3; k++) { /* so many of the volume's cells along a side */
        double most = 0;
        for (int r = 0; r < 3; r++)
            most = fmax(most, fabs(of->to_cells[4 * r + k]) * cells->size[k] / (double)cells->count[k]);
        f.samples[k] = (int64_t)fmin(fmax(ceil(most - 1e-6), SAMPLES_MIN), SAMPLES_MAX);
    }
    return skg_parallel(cells->count[2], fill_plane, &f);
}

skg_status skg_cells_within(const skg_cell_parts *parts, skg_cells *cells) {
    const int64_t total = skg_cells_count(cells);
    cells->volume_count = parts->volume_count;
    SKG_TRY(skg_alloc(parts->volume_count * total, sizeof *cells->within, "cells", &cells->within));
    for (int64_t v = 0; v < parts->volume_count; v++)
        SKG_TRY(fill_volume(&parts->volumes[v], cells, cells->within + v * total));
    return SKG_OK;
}

int64_t skg_cell_curves(const skg_cell_parts *parts) {
    int64_t most = 0;
    for (int64_t v = 0; v < parts->volume_count; v++) {
        const int64_t curves = parts->volumes[v].volume->curve_count;
        most = curves > most ? curves : most;
    }
    return most;
}

void skg_volume_between(const skg_cell_volume *of, int lines, const double from[3], const double to[3],
                        double *amounts, double sums[SKG_SCATTER_RANK]) {
    double ends[2][3];
    skg_pose_point(of->to_cells, from, ends[0]);
    skg_pose_point(of->to_cells, to, ends[1]);
    for (int64_t c = 0; c < of->volume->curve_count; c++) amounts[c] = 0;
    skg_volume_trace(of->volume, ends[0], ends[1], amounts);
    for (int64_t c = 0; c < of->volume->curve_count; c++)
        for (int k = 0; k < SKG_SCATTER_RANK; k++)
            sums[k] += amounts[c] * (lines ? of->lines : of->coefficients)[c][k];
}
