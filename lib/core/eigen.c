/* Eigenvalues and eigenvectors of small symmetric matrices. */
#include "core/eigen.h"

#include <math.h>

/* One Jacobi rotation, which makes matrix[p][q] zero. */
static void clear_entry(int n, double *a, double *v, int p, int q) {
    if (a[n * p + q] == 0) return;
    double theta = (a[n * q + q] - a[n * p + p]) / (2 * a[n * p + q]);
    double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
    double c = 1 / sqrt(t * t + 1), s = t * c;
    for (int k = 0; k < n; k++) {
        double x = a[n * k + p], y = a[n * k + q];
        a[n * k + p] = c * x - s * y, a[n * k + q] = s * x + c * y;
    }
    for (int k = 0; k < n; k++) {
        double x = a[n * p + k], y = a[n * q + k];
        a[n * p + k] = c * x - s * y, a[n * q + k] = s * x + c * y;
        x = v[n * p + k], y = v[n * q + k];
        v[n * p + k] = c * x - s * y, v[n * q + k] = s * x + c * y;
    }
}

static void swap(double *a, double *b) {
    const double a_before = *a;
    *a = *b, *b = a_before;
}

void skg_eigen(int n, double *matrix, double *values, double *vectors) {
    for (int i = 0; i < n * n; i++) vectors[i] = i / n == i % n;
    for (int sweep = 0; sweep < 12;
         sweep++) /* converges quadratically; 6 sweeps are enough for n = 4, 10 for n = 64 */
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++) clear_entry(n, matrix, vectors, p, q);
    for (int i = 0; i < n; i++) values[i] = matrix[n * i + i];
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            if (values[j] > values[i]) {
                swap(values + i, values + j);
                for (int k = 0; k < n; k++) swap(vectors + n * i + k, vectors + n * j + k);
            }
}

void skg_eigen_rising(int n, double *matrix, double *values) {
    double vectors[SKG_EIGEN_MAX * SKG_EIGEN_MAX];
    skg_eigen(n, matrix, values, vectors);
    for (int i = 0; i < n / 2; i++) swap(values + i, values + n - 1 - i);
    for (int k = 0; k < n; k++)
        for (int row = 0; row < n; row++) matrix[n * row + k] = vectors[n * (n - 1 - k) + row];
}
