/* The power of two by which lengths become integers. */
#include "geometry/bounds.h"

#include <math.h>
#include <string.h>

skg_status skg_scale_grid_create(int64_t columns, int64_t rows, skg_scale_grid *grid) {
    grid->columns = (columns + SKG_SCALE_CELL - 1) / SKG_SCALE_CELL;
    grid->rows = (rows + SKG_SCALE_CELL - 1) / SKG_SCALE_CELL;
    return skg_alloc((grid->columns + 1) * (grid->rows + 1), sizeof *grid->sums, "scale grid", &grid->sums);
}

skg_scale_grid skg_scale_grid_of(const skg_scale_grid *grid, int64_t columns, int64_t rows) {
    return (skg_scale_grid){.columns = (columns + SKG_SCALE_CELL - 1) / SKG_SCALE_CELL,
                            .rows = (rows + SKG_SCALE_CELL - 1) / SKG_SCALE_CELL,
                            .sums = grid->sums};
}

void skg_scale_grid_release(skg_scale_grid *grid) {
    skg_free(&grid->sums);
}

/* The cell of a pixel coordinate, clamped to -1 and count, which are both outside the detector. */
static int64_t cell_of(double pixel, int64_t count) {
    double cell = floor(pixel / SKG_SCALE_CELL);
    return cell < -1 ? -1 : cell > (double)count ? count : (int64_t)cell;
}

static double max_of(const skg_scale_part *part) {
    return part->weight * (part->high_depth - part->low_depth) * part->multiplicity;
}

/* Adds a part to its rectangle of cells, as differences at the four corners that largest_sum sums up. Returns 0
 * if the rectangle misses the detector. */
static int add_rectangle(const skg_scale_grid *grid, const skg_scale_part *part) {
    /* One pixel of margin, because the kernels decide with rounded coordinates what is covered. */
    int64_t c0 = cell_of(part->low_column - 1, grid->columns),
            c1 = cell_of(part->high_column + 1, grid->columns);
    int64_t r0 = cell_of(part->low_row - 1, grid->rows), r1 = cell_of(part->high_row + 1, grid->rows);
    if (c1 < 0 || r1 < 0 || c0 >= grid->columns || r0 >= grid->rows) return 0;
    if (c0 < 0) c0 = 0;
    if (r0 < 0) r0 = 0;
    if (c1 >= grid->columns) c1 = grid->columns - 1;
    if (r1 >= grid->rows) r1 = grid->rows - 1;
    const int64_t stride = grid->columns + 1;
    const double most = max_of(part);
    grid->sums[r0 * stride + c0] += most;
    grid->sums[r0 * stride + c1 + 1] -= most;
    grid->sums[(r1 + 1) * stride + c0] -= most;
    grid->sums[(r1 + 1) * stride + c1 + 1] += most;
    return 1;
}

static double largest_sum(const skg_scale_grid *grid) {
    const int64_t stride = grid->columns + 1;
    double largest = 0;
    for (int64_t r = 0; r < grid->rows; r++)
        for (int64_t c = 0; c < grid->columns; c++) {
            double *sum = &grid->sums[r * stride + c];
            if (c) *sum += sum[-1];
            if (r) *sum += sum[-stride] - (c ? sum[-stride - 1] : 0);
            if (*sum > largest) largest = *sum;
        }
    return largest;
}

void skg_scale_find(const skg_scale_grid *grid, int64_t count, const skg_scale_part *parts,
                    int32_t bits_wanted, skg_scale *scale) {
    memset(grid->sums, 0, (size_t)((grid->columns + 1) * (grid->rows + 1)) * sizeof *grid->sums);
    double total = 0, weight = 0, low = HUGE_VAL, high = -HUGE_VAL;
    for (int64_t i = 0; i < count; i++) {
        if (!add_rectangle(grid, &parts[i])) continue;
        total += max_of(&parts[i]);
        weight = fmax(weight, parts[i].weight);
        low = fmin(low, parts[i].low_depth);
        high = fmax(high, parts[i].high_depth);
    }
    /* Sums of differences keep the rounding of larger sums: a few ulp of the total, which 1e-12 exceeds by far. */
    const double bound = total > 0 ? largest_sum(grid) + 1e-12 * total : 0;
    const double plausible = bound > 0 ? fmin(bound, weight * (high - low)) : 0;
    *scale = (skg_scale){.bound = bound, .plausible = plausible, .scale = 1, .bits = bits_wanted};
    if (!(bound > 0)) return;
    int exponent = 0;
    frexp(bound, &exponent); /* bound < 2^exponent */
    if (bits_wanted == 32 && ldexp(plausible, 30 - exponent) < 0x1p24) scale->bits = 64;
    /* 2^50, because the kernels round doubles to integers by adding 1.5 * 2^52. */
    scale->scale = ldexp(1, (scale->bits == 32 ? 30 : 50) - exponent);
}
