#include "geometry/columns.h"

#include "core/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns are off the corner of their cell by an irrational part of it (the square roots of 3 and 2 less 1), so that
 * faces along the axes and shared vertices are rarely met exactly. Where they are, the half-open rule below still
 * balances the hits. */
double skg_column_place(const skg_columns *grid, int axis, int64_t index) {
    return grid->low[axis] +
           ((double)index + (axis ? 0.4142135623730951 : 0.7320508075688772)) * grid->step[axis];
}

/* The x at which the edge from a to b crosses y. The end with the lower y comes first, so that both triangles at
 * an edge get the same bits. */
static double crossing(const double *a, const double *b, double y) {
    if (a[1] > b[1] || (a[1] == b[1] && a[0] > b[0])) {
        const double *swap = a;
        a = b, b = swap;
    }
    return a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
}

/* Adds the hits of one triangle by the scan-crossing rule of the kernels, in double. */
static void add_triangle(skg_columns *grid, int32_t part, const double *a, const double *b, const double *c) {
    const double *p[3] = {a, b, c};
    double lo = fmin(a[1], fmin(b[1], c[1])), hi = fmax(a[1], fmax(b[1], c[1]));
    double ab[3], ac[3], normal[3];
    skg_add_scaled(b, -1, a, ab);
    skg_add_scaled(c, -1, a, ac);
    skg_cross(ab, ac, normal);
    int64_t row = (int64_t)fmax(0, floor((lo - grid->low[1]) / grid->step[1]) - 1);
    for (; row < grid->side; row++) {
        double y = skg_column_place(grid, 1, row), x[2];
        int found = 0, downward[2];
        if (y < lo) continue;
        if (y >= hi) break;
        for (int e = 0; e < 3 && found < 2; e++) {
            const double *from = p[e], *to = p[(e + 1) % 3];
            if ((from[1] <= y) == (to[1] <= y)) continue;
            downward[found] = from[1] > to[1];
            x[found++] = crossing(from, to, y);
        }
        if (found < 2) continue;
        int first = x[0] <= x[1] ? 0 : 1;
        int64_t column = (int64_t)fmax(0, floor((x[first] - grid->low[0]) / grid->step[0]) - 1);
        for (; column < grid->side; column++) {
            double at = skg_column_place(grid, 0, column);
            if (at < x[first]) continue;
            if (at >= x[1 - first]) break;
            int64_t cell = row * grid->side + column;
            if (grid->hits) {
                double depth = normal[2] != 0
                                   ? a[2] - ((at - a[0]) * normal[0] + (y - a[1]) * normal[1]) / normal[2]
                                   : a[2];
                /* With a normal against +z the triangle is clockwise in x and y: the first crossing runs up, and
                 * the ray enters. */
                grid->hits[grid->first[cell]] = (skg_column_hit){depth, part, downward[first] ? -1 : 1};
            }
            grid->first[cell]++;
        }
    }
}

static void add_all(skg_columns *grid, int64_t count, const skg_solid *solids) {
    for (int64_t i = 0; i < count; i++)
        for (int64_t t = 0; t < solids[i].triangles; t++) {
            const int32_t *corner = solids[i].corners + 3 * t;
            const double *at = solids[i].positions;
            add_triangle(grid, (int32_t)i, at + 3 * (int64_t)corner[0], at + 3 * (int64_t)corner[1],
                         at + 3 * (int64_t)corner[2]);
        }
}

/* Counts the hits of each column, sums the counts, and fills: the hits of column c are those from grid->first[c] to
 * grid->first[c + 1] - 1. */
skg_status skg_columns_gather(skg_columns *grid, int64_t count, const skg_solid *solids) {
    const int64_t cells = grid->side * grid->side;
    SKG_TRY(skg_alloc(cells + 1, sizeof *grid->first, "overlap columns", &grid->first));
    add_all(grid, count, solids);
    int64_t sum = 0;
    for (int64_t c = 0; c <= cells; c++) {
        int64_t here = grid->first[c];
        grid->first[c] = sum;
        sum += here;
    }
    SKG_TRY(skg_alloc(sum, sizeof *grid->hits, "overlap hits", &grid->hits));
    add_all(grid, count, solids);
    memmove(grid->first + 1, grid->first, (size_t)cells * sizeof *grid->first);
    grid->first[0] = 0;
    return SKG_OK;
}

void skg_columns_bound(skg_columns *grid, int64_t count, const skg_solid *solids) {
    for (int k = 0; k < 3; k++) grid->low[k] = HUGE_VAL, grid->high[k] = -HUGE_VAL;
    for (int64_t i = 0; i < count; i++)
        for (int64_t v = 0; solids[i].triangles > 0 && v < 3 * solids[i].vertices; v++) {
            grid->low[v % 3] = fmin(grid->low[v % 3], solids[i].positions[v]);
            grid->high[v % 3] = fmax(grid->high[v % 3], solids[i].positions[v]);
        }
    for (int k = 0; k < 2; k++) grid->step[k] = (grid->high[k] - grid->low[k]) / (double)grid->side;
}

static int by_depth(const void *a, const void *b) {
    const skg_column_hit *left = a, *right = b;
    if (left->depth != right->depth) return left->depth < right->depth ? -1 : 1;
    /* At touching surfaces the ray leaves one part before it enters the other, so that they do not overlap. */
    if (left->sign != right->sign) return left->sign < right->sign ? -1 : 1;
    return left->part < right->part ? -1 : left->part > right->part;
}

void skg_columns_sort(skg_columns *grid, int64_t cell) {
    const int64_t first = grid->first[cell], count = grid->first[cell + 1] - first;
    qsort(grid->hits + first, (size_t)count, sizeof *grid->hits, by_depth);
}

void skg_columns_free(skg_columns *grid) {
    skg_free(&grid->first);
    skg_free(&grid->hits);
}
