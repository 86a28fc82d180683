/* Least squares with weights that are not negative (Lawson and Hanson 1974). */
#include "spectral/compression.h"

#include "core/maths.h"

#include <math.h>
#include <string.h>

/* A diagonal below this share of the length of its column is rounding: some 50 times the epsilon of a double. */
static const double DEPENDENT = 1e-14;

skg_status skg_least_squares_create(int64_t rows, int32_t columns, skg_least_squares *system) {
    *system = (skg_least_squares){.rows = rows, .columns = columns};
    SKG_TRY(skg_alloc(rows * columns, sizeof *system->a, "least squares", &system->a));
    SKG_TRY(skg_alloc(rows, sizeof *system->b, "least squares", &system->b));
    SKG_TRY(skg_alloc(rows * (columns + 1), sizeof *system->work, "least squares", &system->work));
    SKG_TRY(skg_alloc(columns, sizeof *system->x, "least squares", &system->x));
    SKG_TRY(skg_alloc(columns, sizeof *system->gradient, "least squares", &system->gradient));
    return skg_alloc(columns, sizeof *system->list, "least squares", &system->list);
}

void skg_least_squares_release(skg_least_squares *system) {
    skg_free(&system->a);
    skg_free(&system->b);
    skg_free(&system->work);
    skg_free(&system->x);
    skg_free(&system->gradient);
    skg_free(&system->list);
}

/* Takes the reflection at v off SOME columns, which are `rows` apart: as many as keep an adder busy. */
enum { SOME = 4 };
static void reflect_some(const double *v, int64_t length, double square, int64_t rows, double *columns) {
    const double *const each[SOME] = {columns, columns + rows, columns + 2 * rows, columns + 3 * rows};
    double share[SOME];
    skg_dot_four(length, v, each, share);
    for (int32_t c = 0; c < SOME; c++) {
        double *column = columns + c * rows;
        const double factor = 2 * share[c] / square;
        for (int64_t i = 0; i < length; i++) column[i] -= factor * v[i];
    }
}

/* Makes the first `count` of `all` columns of q ([all][rows]) upper triangular by Householder reflections. */
static void reflect(double *q, int64_t rows, int32_t count, int32_t all) {
    for (int32_t k = 0; k < count && k + 1 < rows; k++) {
        double *v = q + k * rows;
        const double length = sqrt(skg_dot_long(rows - k, v + k, v + k));
        if (!(length > 0)) continue;
        const double diagonal = v[k] > 0 ? -length : length;
        v[k] -= diagonal;
        const double square = skg_dot_long(rows - k, v + k, v + k);
        int32_t j = k + 1;
        for (; j + SOME <= all; j += SOME) reflect_some(v + k, rows - k, square, rows, q + j * rows + k);
        for (; j < all; j++) {
            double *column = q + j * rows;
            const double share = 2 * skg_dot_long(rows - k, v + k, column + k) / square;
            for (int64_t i = k; i < rows; i++) column[i] -= share * v[i];
        }
        v[k] = diagonal;
        memset(v + k + 1, 0, (size_t)(rows - k - 1) * sizeof *v);
    }
}

skg_status skg_least_squares_reduce(const skg_least_squares *system, skg_least_squares *reduced) {
    const int64_t rows = system->rows, columns = system->columns;
    const int64_t kept = rows < columns + 1 ? rows : columns + 1;
    memcpy(system->work, system->a, (size_t)(rows * columns) * sizeof *system->work);
    memcpy(system->work + rows * columns, system->b, (size_t)rows * sizeof *system->work);
    reflect(system->work, rows, system->columns + 1, system->columns + 1);
    SKG_TRY(skg_least_squares_create(kept, system->columns, reduced));
    for (int64_t j = 0; j < columns; j++)
        memcpy(reduced->a + j * kept, system->work + j * rows, (size_t)kept * sizeof *reduced->a);
    memcpy(reduced->b, system->work + columns * rows, (size_t)kept * sizeof *reduced->b);
    return SKG_OK;
}

/* The diagonal of (R^T R)^-1, which are the squared lengths of the rows of R^-1. The inverse is made column by
 * column. */
static void find_spread(const double *r, int64_t rows, int32_t count, const int32_t *in,
                        const skg_least_squares *system, double *inverse, double *spread) {
    memset(spread, 0, (size_t)count * sizeof *spread);
    for (int32_t j = 0; j < count; j++) {
        if (fabs(r[j * rows + j]) <=
            DEPENDENT * sqrt(skg_dot_long(rows, system->a + in[j] * rows, system->a + in[j] * rows))) {
            spread[j] = HUGE_VAL;
            continue;
        }
        for (int32_t i = j; i >= 0; i--) {
            double sum = i == j ? 1 : 0;
            for (int32_t k = i + 1; k <= j; k++) sum -= r[k * rows + i] * inverse[k];
            inverse[i] = spread[i] < HUGE_VAL ? sum / r[i * rows + i] : 0;
            spread[i] += inverse[i] * inverse[i];
        }
    }
}

double skg_least_squares_solve(const skg_least_squares *system, int32_t count, const int32_t *in, double *x,
                               double *spread) {
    const int64_t rows = system->rows;
    double *r = system->work, *right = r + count * rows;
    for (int32_t j = 0; j < count; j++)
        memcpy(r + j * rows, system->a + in[j] * rows, (size_t)rows * sizeof *r);
    memcpy(right, system->b, (size_t)rows * sizeof *right);
    reflect(r, rows, count, count + 1);
    for (int32_t i = count - 1; i >= 0; i--) {
        const double *column = system->a + in[i] * rows;
        double sum = i < rows ? right[i] : 0;
        x[i] = 0;
        if (i >= rows || fabs(r[i * rows + i]) <= DEPENDENT * sqrt(skg_dot_long(rows, column, column)))
            continue;
        for (int32_t k = i + 1; k < count; k++) sum -= r[k * rows + i] * x[k];
        x[i] = sum / r[i * rows + i];
    }
    if (spread) find_spread(r, rows, count, in, system, system->gradient, spread);
    const int64_t solved = count < rows ? count : rows;
    return skg_dot_long(rows - solved, right + solved, right + solved);
}

/* Sets system->gradient to A^T (b - A x) for the `count` columns. */
static void find_gradient(const skg_least_squares *system, int32_t count, const int32_t *in,
                          const double *x) {
    const int64_t rows = system->rows;
    double *rest = system->work;
    memcpy(rest, system->b, (size_t)rows * sizeof *rest);
    for (int32_t j = 0; j < count; j++)
        if (x[j] > 0)
            for (int64_t i = 0; i < rows; i++) rest[i] -= x[j] * system->a[in[j] * rows + i];
    int32_t j = 0;
    for (; j + SOME <= count; j += SOME) {
        const double *const some[SOME] = {system->a + in[j] * rows, system->a + in[j + 1] * rows,
                                          system->a + in[j + 2] * rows, system->a + in[j + 3] * rows};
        skg_dot_four(rows, rest, some, system->gradient + j);
    }
    for (; j < count; j++) system->gradient[j] = skg_dot_long(rows, rest, system->a + in[j] * rows);
}

/* Solves with the columns whose x is positive. A column whose x would become negative stops at 0 and leaves. */
static double settle(const skg_least_squares *system, int32_t count, const int32_t *in, double *x) {
    int32_t *list = system->list;
    for (;;) {
        int32_t positive = 0, next = 0;
        double step = 1;
        for (int32_t j = 0; j < count; j++)
            if (x[j] > 0) list[positive++] = in[j];
        const double rest = skg_least_squares_solve(system, positive, list, system->x, NULL);
        for (int32_t j = 0; j < count; j++) {
            if (!(x[j] > 0)) continue;
            const double to = system->x[next++];
            if (to <= 0) step = fmin(step, x[j] / (x[j] - to));
        }
        next = 0;
        for (int32_t j = 0; j < count; j++) {
            if (!(x[j] > 0)) continue;
            const double to = system->x[next++];
            const int leaves = to <= 0 && x[j] / (x[j] - to) <= step;
            x[j] = leaves ? 0 : x[j] + step * (to - x[j]);
        }
        if (step >= 1) return rest;
    }
}

double skg_nnls(const skg_least_squares *system, int32_t count, const int32_t *in, double least, double *x) {
    double rest = settle(system, count, in, x);
    const int32_t most = 3 * count; /* the limit of Lawson and Hanson; a few more than `count` are usual */
    for (int32_t step = 0; step < most && rest > least; step++) {
        int32_t best = -1;
        double steepest = 0;
        find_gradient(system, count, in, x);
        for (int32_t j = 0; j < count; j++) {
            const double *column = system->a + in[j] * system->rows;
            if (x[j] > 0 || !(system->gradient[j] > 0)) continue;
            const double slope = system->gradient[j] / sqrt(skg_dot_long(system->rows, column, column));
            if (slope > steepest) best = j, steepest = slope;
        }
        if (best < 0) return rest;
        x[best] = 1e-300; /* positive, so that the column takes part, and too small to count */
        const double now = settle(system, count, in, x);
        if (!(now < rest) || !(x[best] > 0)) return rest < now ? rest : now; /* no progress but rounding */
        rest = now;
    }
    return rest;
}
