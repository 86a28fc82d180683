/* Least squares with coefficients that are not negative (C. L. Lawson, R. J. Hanson, Solving Least Squares
 * Problems, 1974, chapter 23). Double precision and a fixed order give the same bits on every machine, which a
 * linear algebra library would not. Private. */
#ifndef SKG_NNLS_H
#define SKG_NNLS_H

#include "core/core.h"

/* The problem of minimising |A x - b|. */
typedef struct {
    int64_t rows;
    int32_t columns, reserved;
    double *a;    /* [columns][rows] */
    double *b;    /* [rows] */
    double *work; /* [columns + 1][rows] */
    double *x, *gradient;
    int32_t *list;
} skg_least_squares;

/* Allocates a system. The caller fills a and b. */
skg_status skg_least_squares_create(int64_t rows, int32_t columns, skg_least_squares *system);
void skg_least_squares_release(skg_least_squares *system);

/* A system of at most columns + 1 rows with the same solutions and the same |A x - b|. */
skg_status skg_least_squares_reduce(const skg_least_squares *system, skg_least_squares *reduced);

/* Solves with some of the columns and returns |A x - b|^2.
 *
 * in       [count] the numbers of the columns
 * x        [count] the solution
 * spread   [count] the diagonal of the inverse of A^T A, or NULL if it is not wanted; infinite for a column that
 *          depends on those before it, whose x is 0 */
double skg_least_squares_solve(const skg_least_squares *system, int32_t count, const int32_t *in, double *x,
                               double *spread);

/* The same with x >= 0. It starts from the columns with x > 0 on entry; columns that leave may come back.
 *
 * least   columns are added only while |A x - b|^2 exceeds this */
double skg_nnls(const skg_least_squares *system, int32_t count, const int32_t *in, double least, double *x);

#endif
