/* Eigenvalues and eigenvectors of small symmetric matrices. Private. */
#ifndef SKG_EIGEN_H
#define SKG_EIGEN_H

/* Eigenvalues in falling order and eigenvectors (row k the k-th) of a symmetric n x n matrix, by Jacobi rotations. The matrix
 * is overwritten. The same bits on every machine. Takes 72 n^3 multiplications at most. */
void skg_eigen(int n, double *matrix, double *values, double *vectors);

/* Finds eigenvalues and eigenvectors in rising order, with the vectors as columns (column k the k-th, matrix[n * row + k]) in place of the
 * matrix. n <= SKG_EIGEN_MAX. */
enum { SKG_EIGEN_MAX = 64 };
void skg_eigen_rising(int n, double *matrix, double *values);

#endif
