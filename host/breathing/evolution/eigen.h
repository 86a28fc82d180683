/* Eigenvalues, by LAPACK. Private. */
#ifndef SKG_EVOLUTION_EIGEN_H
#define SKG_EVOLUTION_EIGEN_H

#include "core/core.h"

/* Eigenvalues in rising order and eigenvectors (column k the k-th, matrix[n * row + k]) of a symmetric matrix, which they
 * replace. n <= SKG_SEARCH_MAX. */
skg_status skg_symmetric_eigen(int64_t n, double *matrix, double *values);

/* Whether the library has it. */
int skg_has_eigen(void);

#endif
