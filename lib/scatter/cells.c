/* The object as cells: what every column through the parts meets, put into the cells that it crosses. */
#include "scatter/voxels.h"

#include "core/threads.h"

#include <math.h>
#include <string.h>

typedef skg_cell_amount amount;

typedef struct {
    const skg_cell_parts *parts;
    amount *amounts; /* [parts] */
    const skg_columns *grid;
    const skg_column_rows *rows;
    skg_cells *cells;
} filling;

/* One column of cells. own: [z] of the hits in each; behind: [z + 1] what begins before each, for all behind; known: [z + 1] what
 * begins before the place of each where its medium is known, likewise, or NULL. */
typedef struct {
    const skg_cells *cells;
    amount *own, *behind, *known;
} pile;

static void add(int64_t *sum, const int64_t *more, int64_t factor) {
    for (int k = 0; k < SKG_CELL_AMOUNTS; k++) sum[k] += factor * more[k];
}

/* From a depth on there is more. */
static void deposit(void *user, double depth, const int64_t *more, int64_t factor) {
    const pile *p = user;
    const int64_t cells = p->cells->count[2];
    const double place = (depth - p->cells->low[2]) * (double)cells / p->cells->size[2];
    const int64_t cell = place < 0 ? 0 : place < (double)cells ? (int64_t)place : cells - 1;
    const double rest = fmin(fmax((double)(cell + 1) - place, 0), 1);
    for (int k = 0; k < SKG_CELL_AMOUNTS; k++) p->own[cell][k] += factor * llrint((double)more[k] * rest);
    add(p->behind[cell + 1], more, factor);
    if (!p->known) return;
    const double next = floor(place - SKG_KNOWN[2]) + 1;
    add(p->known[next < 0 ? 0 : next < (double)cells ? (int64_t)next : cells], more, factor);
}

/* --- parts that compete */

/* The parts that a column is in, and how many times. */
typedef struct {
    int64_t count;
    int64_t *part, *times; /* [parts] */
} inside;

static int64_t find(const inside *in, int64_t part) {
    for (int64_t i = 0; i < in->count; i++)
        if (in->part[i] == part) return i;
    return -1;
}

static void pass(inside *in, int64_t part, int64_t sign) {
    const int64_t i = find(in, part);
    if (i < 0) {
        in->part[in->count] = part;
        in->times[in->count++] = sign;
    } else if ((in->times[i] += sign) == 0) {
        in->count--;
        in->part[i] = in->part[in->count];
        in->times[i] = in->times[in->count];
    }
}

/* Whether a part counts where the column is: neither it nor what it lies in is displaced by one of higher priority with the same
 * parent, or is clipped. */
static int counts(const skg_cell_parts *parts, const inside *in, int64_t part) {
    for (int64_t p = part; p >= 0; p = parts->solids[p].inside) {
        const int64_t parent = parts->solids[p].inside;
        if (find(in, p) < 0) {
            if (parts->clip) return 0;
            continue;
        }
        for (int64_t i = 0; i < in->count; i++)
            if (parts->solids[in->part[i]].inside == parent &&
                parts->priority[in->part[i]] > parts->priority[p])
                return 0;
    }
    return 1;
}

static void sum_up(const skg_cell_parts *parts, const amount *amounts, const inside *in, int64_t *sum) {
    for (int k = 0; k < SKG_CELL_AMOUNTS; k++) sum[k] = 0;
    for (int64_t i = 0; i < in->count; i++)
        if (counts(parts, in, in->part[i]))
            add(sum, amounts[in->part[i]], parts->unite ? in->times[i] > 0 : in->times[i]);
    /* Where several parts displace the same volume it is removed once; outside of its box there is nothing to remove. */
    for (int k = SKG_CELL_TIMES; k < SKG_CELL_AMOUNTS; k++)
        if (sum[k] < 0) sum[k] = 0;
}

static void settle_column(const skg_cell_parts *parts, const amount *amounts, skg_columns *grid,
                          int64_t column, int64_t *work, skg_cell_change *change, void *user) {
    inside in = {0, work, work + parts->count};
    amount before = {0};
    skg_columns_sort(grid, column);
    for (int64_t h = grid->first[column]; h < grid->first[column + 1]; h++) {
        const skg_column_hit *hit = &grid->hits[h];
        amount now, more;
        pass(&in, hit->part, hit->sign * parts->sign[hit->part]);
        sum_up(parts, amounts, &in, now);
        for (int k = 0; k < SKG_CELL_AMOUNTS; k++) more[k] = now[k] - before[k], before[k] = now[k];
        change(user, hit->depth, more, 1);
    }
}

void skg_cells_walk(const skg_cell_parts *parts, const skg_cell_amount *amounts, skg_columns *grid,
                    int64_t column, int64_t *work, skg_cell_change *change, void *user) {
    if (parts->priority) {
        settle_column(parts, amounts, grid, column, work, change, user);
        return;
    }
    for (int64_t h = grid->first[column]; h < grid->first[column + 1]; h++) {
        const skg_column_hit *hit = &grid->hits[h];
        change(user, hit->depth, amounts[hit->part], hit->sign * parts->sign[hit->part]);
    }
}

skg_status skg_cells_amounts(const skg_cell_parts *parts, skg_cell_amount **amounts) {
    SKG_TRY(skg_alloc(parts->count, sizeof **amounts, "cells", amounts));
    for (int64_t i = 0; i < parts->count; i++) {
        for (int k = 0; k < SKG_SCATTER_RANK; k++)
            (*amounts)[i][k] = llrint(parts->coefficients[i][k] * SKG_CELL_UNIT);
        for (int64_t v = 0; v < parts->volume_count; v++)
            (*amounts)[i][SKG_CELL_TIMES + v] = parts->volumes[v].times[i] * (int64_t)SKG_CELL_UNIT;
    }
    return SKG_OK;
}

/* --- all cells */

/* The mixture of a cell from what begins before it and in it. */
static void mix(const filling *f, int64_t cell, const int64_t *before, const int64_t *own, float *mixture) {
    const double *base = f->parts->base;
    const double each = 1 / (SKG_CELL_UNIT * SKG_CELL_COLUMNS * SKG_CELL_COLUMNS);
    for (int k = 0; k < SKG_SCATTER_RANK; k++) {
        double sum = (double)(before[k] + own[k]) * each + (base ? base[k] : 0);
        for (int64_t v = 0; v < f->cells->volume_count; v++)
            sum += (double)(before[SKG_CELL_TIMES + v] + own[SKG_CELL_TIMES + v]) * each *
                   ((double)f->cells->within[v * skg_cells_count(f->cells) + cell][k] / SKG_CELL_UNIT);
        mixture[k] = (float)sum;
    }
}

/* The cells of one row along x, all through z. */
static skg_status fill_row(void *user, int64_t row) {
    const filling *f = user;
    const int64_t side = f->cells->count[0], depth = f->cells->count[2];
    skg_columns grid = *f->grid;
    amount *own = NULL, *behind = NULL, *known = NULL;
    int64_t *inside_of = NULL;
    skg_status status = SKG_OK;
    grid.first_row = row * SKG_CELL_COLUMNS;
    grid.rows = SKG_CELL_COLUMNS;
    SKG_TRY_CLEANUP(skg_columns_gather(&grid, f->parts->count, f->parts->solids, f->rows));
    SKG_TRY_CLEANUP(skg_alloc(2 * f->parts->count, sizeof *inside_of, "cells", &inside_of));
    SKG_TRY_CLEANUP(skg_alloc(side * depth, sizeof *own, "cells", &own));
    SKG_TRY_CLEANUP(skg_alloc(side * (depth + 1), sizeof *behind, "cells", &behind));
    SKG_TRY_CLEANUP(skg_alloc(side * (depth + 1), sizeof *known, "cells", &known));
    for (int64_t c = 0; c < grid.rows * grid.side; c++) {
        const int64_t x = c % grid.side / SKG_CELL_COLUMNS;
        const int first = c < grid.side && c % SKG_CELL_COLUMNS == 0;
        pile p = {f->cells, own + x * depth, behind + x * (depth + 1),
                  first ? known + x * (depth + 1) : NULL};
        skg_cells_walk(f->parts, (const amount *)f->amounts, &grid, c, inside_of, deposit, &p);
    }
    for (int64_t x = 0; x < side; x++) {
        amount sum = {0}, *of = f->cells->known + row * side + x;
        for (int64_t z = 0; z < depth; z++) {
            const int64_t cell = (z * f->cells->count[1] + row) * side + x;
            if (z)
                memcpy(of[z * f->cells->count[1] * side], of[(z - 1) * f->cells->count[1] * side],
                       sizeof *of);
            add(of[z * f->cells->count[1] * side], known[x * (depth + 1) + z], 1);
            add(sum, behind[x * (depth + 1) + z], 1);
            mix(f, cell, sum, own[x * depth + z], f->cells->mixtures[cell]);
        }
    }
cleanup:
    skg_columns_free(&grid);
    skg_free(&inside_of);
    skg_free(&own);
    skg_free(&behind);
    skg_free(&known);
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

static skg_status fill(filling *f) {
    skg_cells *cells = f->cells;
    const int64_t total = skg_cells_count(cells);
    SKG_TRY(skg_cells_amounts(f->parts, &f->amounts));
    SKG_TRY(skg_alloc(total, sizeof *cells->mixtures, "cells", &cells->mixtures));
    SKG_TRY(skg_alloc(total, sizeof *cells->known, "cells", &cells->known));
    if (f->parts->volume_count > 0) SKG_TRY(skg_cells_within(f->parts, cells));
    SKG_TRY(skg_parallel(cells->count[1], fill_row, f));
    for (int64_t c = 0; c < total; c++)
        for (int k = 0; k < SKG_SCATTER_RANK; k++)
            cells->mean[k] += (double)cells->mixtures[c][k] / (double)total;
    return SKG_OK;
}

skg_status skg_cells_make(const skg_cell_parts *parts, double voxel_mm, skg_cells *cells) {
    skg_columns grid = {.side = 1};
    skg_column_rows *rows = NULL;
    *cells = (skg_cells){0};
    skg_columns_bound(&grid, parts->count, parts->solids);
    if (!(grid.high[0] > grid.low[0] && grid.high[1] > grid.low[1] && grid.high[2] > grid.low[2]))
        return SKG_OK;
    count_cells(&grid, voxel_mm, cells);
    grid.side = grid.rows = cells->count[0] * SKG_CELL_COLUMNS;
    for (int k = 0; k < 2; k++) grid.step[k] = cells->size[k] / (double)grid.side;
    SKG_TRY(skg_columns_span(&grid, parts->count, parts->solids, &rows));
    filling f = {.parts = parts, .grid = &grid, .rows = rows, .cells = cells};
    const skg_status status = fill(&f);
    skg_free(&rows);
    skg_free(&f.amounts);
    return status;
}

void skg_cells_free(skg_cells *cells) {
    skg_free(&cells->mixtures);
    skg_free(&cells->known);
    skg_free(&cells->within);
    skg_free(&cells->media);
    skg_free(&cells->tree);
    skg_free(&cells->faces);
}
