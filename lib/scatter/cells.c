#include "scatter/cells.h"

#include "core/parallel.h"

#include <math.h>

/* Units of a coefficient: sums of 2^22 hits fit in 63 bits. */
static const double UNIT = 0x1p40;

typedef struct {
    int64_t count;
    const skg_solid *solids;
    const int32_t *sign;
    int64_t (*amounts)[SKG_SCATTER_RANK]; /* [count] */
    const skg_columns *grid;
    const skg_column_rows *rows;
    skg_cells *cells;
} filling;

static void add(int64_t *sum, const int64_t *amount, int64_t factor) {
    for (int k = 0; k < SKG_SCATTER_RANK; k++) sum[k] += factor * amount[k];
}

/* Adds one column's hits. sums: [z + 1] what each cell has of its own hits alone, and what begins in it for all behind. */
static void add_column(const filling *f, const skg_columns *grid, int64_t column,
                       int64_t (*own)[SKG_SCATTER_RANK], int64_t (*behind)[SKG_SCATTER_RANK]) {
    const int64_t cells = f->cells->count[2];
    const double per_mm = (double)cells / f->cells->size[2];
    for (int64_t h = grid->first[column]; h < grid->first[column + 1]; h++) {
        const skg_column_hit *hit = &grid->hits[h];
        const int64_t *amount = f->amounts[hit->part];
        const int64_t sign = hit->sign * f->sign[hit->part];
        const double place = (hit->depth - f->cells->low[2]) * per_mm;
        const int64_t cell = place < 0 ? 0 : place < (double)cells ? (int64_t)place : cells - 1;
        const double rest = fmin(fmax((double)(cell + 1) - place, 0), 1);
        for (int k = 0; k < SKG_SCATTER_RANK; k++) own[cell][k] += sign * llrint((double)amount[k] * rest);
        add(behind[cell + 1], amount, sign);
    }
}

/* The cells of one row along x, all through z. */
static skg_status fill_row(void *user, int64_t row) {
    const filling *f = user;
    const int64_t side = f->cells->count[0], depth = f->cells->count[2];
    const double each = 1 / (UNIT * SKG_CELL_COLUMNS * SKG_CELL_COLUMNS);
    skg_columns grid = *f->grid;
    int64_t(*own)[SKG_SCATTER_RANK] = NULL, (*behind)[SKG_SCATTER_RANK] = NULL;
    skg_status status = SKG_OK;
    grid.first_row = row * SKG_CELL_COLUMNS;
    grid.rows = SKG_CELL_COLUMNS;
    SKG_TRY_CLEANUP(skg_columns_gather(&grid, f->count, f->solids, f->rows));
    SKG_TRY_CLEANUP(skg_alloc(side * depth, sizeof *own, "cells", &own));
    SKG_TRY_CLEANUP(skg_alloc(side * (depth + 1), sizeof *behind, "cells", &behind));
    for (int64_t c = 0; c < grid.rows * grid.side; c++) {
        const int64_t x = c % grid.side / SKG_CELL_COLUMNS;
        add_column(f, &grid, c, own + x * depth, behind + x * (depth + 1));
    }
    for (int64_t x = 0; x < side; x++) {
        int64_t sum[SKG_SCATTER_RANK] = {0};
        for (int64_t z = 0; z < depth; z++) {
            float *mixture = f->cells->mixtures[(z * f->cells->count[1] + row) * side + x];
            add(sum, behind[x * (depth + 1) + z], 1);
            for (int k = 0; k < SKG_SCATTER_RANK; k++)
                mixture[k] = (float)((double)(sum[k] + own[x * depth + z][k]) * each);
        }
    }
cleanup:
    skg_columns_free(&grid);
    skg_free(&own);
    skg_free(&behind);
    return status;
}

static void count_cells(const skg_columns *grid, double voxel_mm, skg_cells *cells) {
    for (int k = 0; k < 3; k++) {
        cells->low[k] = grid->low[k];
        cells->size[k] = grid->high[k] - grid->low[k];
        cells->count[k] = voxel_mm > 0 ? (int64_t)fmin(ceil(cells->size[k] / voxel_mm - 1e-6), SKG_CELLS_MAX)
                                       : SKG_CELLS_DEFAULT;
        if (cells->count[k] < 1) cells->count[k] = 1;
    }
    /* The columns are as many along x and y. */
    if (cells->count[0] < cells->count[1]) cells->count[0] = cells->count[1];
    cells->count[1] = cells->count[0];
}

static skg_status fill(filling *f, const double (*coefficients)[SKG_SCATTER_RANK]) {
    skg_cells *cells = f->cells;
    const int64_t total = cells->count[0] * cells->count[1] * cells->count[2];
    SKG_TRY(skg_alloc(f->count, sizeof *f->amounts, "cells", &f->amounts));
    for (int64_t i = 0; i < f->count; i++)
        for (int k = 0; k < SKG_SCATTER_RANK; k++) f->amounts[i][k] = llrint(coefficients[i][k] * UNIT);
    SKG_TRY(skg_alloc(total, sizeof *cells->mixtures, "cells", &cells->mixtures));
    SKG_TRY(skg_parallel(cells->count[1], fill_row, f));
    for (int64_t c = 0; c < total; c++)
        for (int k = 0; k < SKG_SCATTER_RANK; k++)
            cells->mean[k] += (double)cells->mixtures[c][k] / (double)total;
    return SKG_OK;
}

skg_status skg_cells_make(int64_t count, const skg_solid *solids, const int32_t *sign,
                          const double (*coefficients)[SKG_SCATTER_RANK], double voxel_mm, skg_cells *cells) {
    skg_columns grid = {.side = 1};
    skg_column_rows *rows = NULL;
    *cells = (skg_cells){0};
    skg_columns_bound(&grid, count, solids);
    if (!(grid.high[0] > grid.low[0] && grid.high[1] > grid.low[1] && grid.high[2] > grid.low[2]))
        return SKG_OK;
    count_cells(&grid, voxel_mm, cells);
    grid.side = grid.rows = cells->count[0] * SKG_CELL_COLUMNS;
    for (int k = 0; k < 2; k++) grid.step[k] = cells->size[k] / (double)grid.side;
    SKG_TRY(skg_columns_span(&grid, count, solids, &rows));
    filling f = {.count = count, .solids = solids, .sign = sign, .grid = &grid, .rows = rows, .cells = cells};
    const skg_status status = fill(&f, coefficients);
    skg_free(&rows);
    skg_free(&f.amounts);
    return status;
}

void skg_cells_free(skg_cells *cells) {
    skg_free(&cells->mixtures);
}
