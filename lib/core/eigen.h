/* Eigenvalues and eigenvectors of small symmetric matrices. Private. */
#ifndef SKG_EIGEN_H
#define SKG_EIGEN_H

/* Eigenvalues in falling order and eigenvectors (row k the k-th) of a symmetric n x n matrix, by Jacobi rotations. The matrix
 * is overwritten. For few dimensions, in every build and with the same bits everywhere: a search in up to 64
 * dimensions has LAPACK's (evolution/eigen.h), which is optional. */
void skg_eigen(int n, double *matrix, double *values, double *vectors);

#endif
