/* Least squares with coefficients that are not negative (Lawson and Hanson 1974, chapter 23), in double and
 * in a fixed order: the same numbers whatever libraries are installed. Private. */
#ifndef SKG_NNLS_H
#define SKG_NNLS_H

#include "core/core.h"

/* Minimise |A x - b|. */
typedef struct {
    int64_t rows;
    int32_t columns, reserved;
    double *a;    /* [columns][rows] */
    double *b;    /* [rows] */
    double *work; /* [columns + 1][rows] */
    double *x, *gradient;
    int32_t *list;
} skg_least_squares;

/* Room for a system; a and b are the caller's to fill. */
skg_status skg_least_squares_create(int64_t rows, int32_t columns, skg_least_squares *system);
void skg_least_squares_release(skg_least_squares *system);

/* A system of at most columns + 1 rows with the same solutions and the same |A x - b|. */
skg_status skg_least_squares_reduce(const skg_least_squares *system, skg_least_squares *reduced);

/* Solves with `count` columns, in[count] their numbers; x: [count]. spread: [count], NULL where not wanted:
 * the diagonal of the inverse of A^T A, infinite where a column depends on those before it (its x is 0).
 * Returns |A x - b|^2. */
double skg_least_squares_solve(const skg_least_squares *system, int32_t count, const int32_t *in, double *x,
                               double *spread);

/* The same with x >= 0. Starts from the columns with x > 0 on entry, those that leave it may come back.
 * least: columns are added only while |A x - b|^2 exceeds it. */
double skg_nnls(const skg_least_squares *system, int32_t count, const int32_t *in, double least, double *x);

#endif
