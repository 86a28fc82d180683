/* Describes many materials by few. */
#include "scatter/interactions.h"

#include "core/maths.h"
#include "spectral/compression.h"

#include <math.h>
#include <string.h>

enum { RANK = SKG_SCATTER_RANK };

/* The search uses one row of EVERY and improves ROUNDS times: three times as many of either change the error by a tenth at
 * most (measured with 12 tissues, steel, iodine, titanium and lead). */
enum { EVERY = 7, ROUNDS = 12 };

/* Two columns are multiples of each other within this: sums of some tens of terms with a rounding of 1e-16 each. */
static const double SAME = 1e-12;

/* A direction that is shorter than this, of 1, is left out: less than the rounding of floats. */
static const double NEGLIGIBLE = 1e-8;

/* In a row of zeros logarithms are taken of this. */
static const double LEAST = 1e-300;

static const int32_t ALL[RANK] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};

typedef struct {
    int64_t count, rows;
    const double *weight, *columns;
    double (*coefficients)[RANK], (*basis)[RANK];
    int64_t compositions, *list; /* [count] the first material of each composition; pivots come first */
    int32_t rank, most;
    int64_t *like; /* [count] the first material of the same composition */
    double *ratio; /* [count] to that material */
} reduction;

static double value_at(const reduction *r, int64_t material, int64_t row) {
    return r->columns[material * r->rows + row];
}

/* b / a where b is a multiple of a, and 0 otherwise. */
static double multiple(int64_t rows, const double *a, const double *b) {
    const double length = skg_dot_long(rows, a, a),
                 ratio = length > 0 ? skg_dot_long(rows, a, b) / length : 0;
    for (int64_t i = 0; i < rows; i++)
        if (!(fabs(b[i] - ratio * a[i]) <= SAME * b[i])) return 0;
    return ratio;
}

static void find_compositions(reduction *r) {
    for (int64_t m = 0; m < r->count; m++) {
        r->like[m] = m;
        r->ratio[m] = 1;
        for (int64_t n = 0; n < r->compositions && r->like[m] == m; n++) {
            const int64_t other = r->list[n];
            const double ratio = multiple(r->rows, r->columns + other * r->rows, r->columns + m * r->rows);
            if (ratio > 0) r->like[m] = other, r->ratio[m] = ratio;
        }
        if (r->like[m] == m) r->list[r->compositions++] = m;
    }
}

/* The direction of each composition's column. A row counts relative to the geometric mean of all. rest: [compositions][rows] */
static void find_directions(const reduction *r, double *rest) {
    const int64_t rows = r->rows;
    for (int64_t i = 0; i < rows; i++) {
        double mean = 0;
        for (int64_t n = 0; n < r->compositions; n++) mean += log(fmax(value_at(r, r->list[n], i), LEAST));
        mean = exp(mean / (double)r->compositions);
        for (int64_t n = 0; n < r->compositions; n++)
            rest[n * rows + i] = r->weight[i] * value_at(r, r->list[n], i) / mean;
    }
    for (int64_t n = 0; n < r->compositions; n++) {
        double *own = rest + n * rows;
        const double length = sqrt(skg_dot_long(rows, own, own));
        for (int64_t i = 0; i < rows; i++) own[i] /= length;
    }
}

/* Moves the compositions that differ most to the front of the list, by Gram and Schmidt with the largest remainder first. */
static void find_pivots(reduction *r, double *rest) {
    const int64_t rows = r->rows;
    for (r->rank = 0; r->rank < r->most; r->rank++) {
        const int32_t k = r->rank;
        int64_t most = k;
        double longest = 0;
        for (int64_t n = k; n < r->compositions; n++) {
            const double length = skg_dot_long(rows, rest + n * rows, rest + n * rows);
            if (length > longest) longest = length, most = n;
        }
        if (!(longest > NEGLIGIBLE * NEGLIGIBLE)) return;
        const int64_t pivot = r->list[most];
        r->list[most] = r->list[k], r->list[k] = pivot;
        double *unit = rest + k * rows, *taken = rest + most * rows;
        for (int64_t i = 0; i < rows; i++) {
            const double left = taken[i];
            taken[i] = unit[i], unit[i] = left / sqrt(longest);
        }
        for (int64_t n = k + 1; n < r->compositions; n++) {
            const double along = skg_dot_long(rows, rest + n * rows, unit);
            for (int64_t i = 0; i < rows; i++) rest[n * rows + i] -= along * unit[i];
        }
    }
}

/* Fits a row of the basis to all compositions. system: of as many rows */
static void fit_row(const reduction *r, skg_least_squares *system, int64_t row) {
    for (int64_t n = 0; n < r->compositions; n++) {
        const double value = value_at(r, r->list[n], row), relative = value > 0 ? 1 / value : 0;
        for (int k = 0; k < r->rank; k++)
            system->a[k * r->compositions + n] = relative * r->coefficients[r->list[n]][k];
        system->b[n] = value > 0 ? 1 : 0;
    }
    skg_least_squares_solve(system, r->rank, ALL, r->basis[row], NULL);
}

/* Fits the coefficients of a material to its rows, one of EVERY. system: of as many rows */
static void fit_material(const reduction *r, skg_least_squares *system, int64_t m) {
    for (int64_t i = 0; i < system->rows; i++) {
        const double value = value_at(r, m, i * EVERY),
                     relative = value > 0 ? r->weight[i * EVERY] / value : 0;
        for (int k = 0; k < r->rank; k++) system->a[k * system->rows + i] = relative * r->basis[i * EVERY][k];
        system->b[i] = relative * value;
    }
    skg_least_squares_solve(system, r->rank, ALL, r->coefficients[m], NULL);
}

static skg_status improve(const reduction *r) {
    skg_least_squares by_row = {0}, by_material = {0};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_least_squares_create(r->compositions, r->rank, &by_row));
    SKG_TRY_CLEANUP(skg_least_squares_create((r->rows + EVERY - 1) / EVERY, r->rank, &by_material));
    for (int round = 0; round < ROUNDS; round++) {
        for (int64_t n = r->rank; n < r->compositions; n++) fit_material(r, &by_material, r->list[n]);
        for (int64_t i = 0; i < r->rows; i += EVERY) fit_row(r, &by_row, i);
    }
    for (int64_t i = 0; i < r->rows; i++) fit_row(r, &by_row, i);
cleanup:
    skg_least_squares_release(&by_row);
    skg_least_squares_release(&by_material);
    return status;
}

/* The basis begins as the columns of the pivots, which is exact where there are no other compositions. */
static void begin(const reduction *r) {
    for (int64_t k = 0; k < r->rank; k++) {
        r->coefficients[r->list[k]][k] = 1;
        for (int64_t i = 0; i < r->rows; i++) r->basis[i][k] = value_at(r, r->list[k], i);
    }
}

static skg_status search(reduction *r) {
    double *rest = NULL;
    SKG_TRY(skg_alloc(r->compositions * r->rows, sizeof *rest, "scatter", &rest));
    find_directions(r, rest);
    find_pivots(r, rest);
    skg_free(&rest);
    begin(r);
    return improve(r);
}

skg_status skg_reduce(int32_t most, int64_t count, int64_t rows, const double *weight, const double *columns,
                      double (*coefficients)[SKG_SCATTER_RANK], double (*basis)[SKG_SCATTER_RANK]) {
    reduction r = {.most = most,
                   .count = count,
                   .rows = rows,
                   .weight = weight,
                   .columns = columns,
                   .coefficients = coefficients,
                   .basis = basis};
    skg_status status = SKG_OK;
    memset(coefficients, 0, (size_t)count * sizeof *coefficients);
    memset(basis, 0, (size_t)rows * sizeof *basis);
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *r.list, "scatter", &r.list));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *r.like, "scatter", &r.like));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *r.ratio, "scatter", &r.ratio));
    find_compositions(&r);
    if (r.compositions > most) {
        SKG_TRY_CLEANUP(search(&r));
    } else {
        r.rank = (int32_t)r.compositions;
        begin(&r);
    }
    for (int64_t m = 0; m < count; m++)
        for (int k = 0; k < RANK; k++) coefficients[m][k] = r.ratio[m] * coefficients[r.like[m]][k];
cleanup:
    skg_free(&r.list);
    skg_free(&r.like);
    skg_free(&r.ratio);
    return status;
}
