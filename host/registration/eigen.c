/* Eigenvalues and eigenvectors of small symmetric matrices. */
#include "registration/types.h"

void reg_eigen(int64_t count, double *matrix, double *values, double *vectors) {
    enum { SWEEPS = 60 };
    for (int64_t k = 0; k < count * count; k++) vectors[k] = k % (count + 1) == 0;
    for (int sweep = 0; sweep < SWEEPS; sweep++) { /* Jacobi's rotations, which end after some ten sweeps */
        double off = 0;
        for (int64_t p = 0; p < count; p++)
            for (int64_t q = p + 1; q < count; q++) {
                const double a = matrix[p * count + q];
                off += fabs(a);
                if (a == 0) continue;
                const double theta = (matrix[q * (count + 1)] - matrix[p * (count + 1)]) / (2 * a);
                const double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1)),
                             c = 1 / sqrt(t * t + 1), s = t * c;
                for (int64_t k = 0; k < count; k++) {
                    const double x = matrix[k * count + p], y = matrix[k * count + q];
                    matrix[k * count + p] = c * x - s * y, matrix[k * count + q] = s * x + c * y;
                }
                for (int64_t k = 0; k < count; k++) {
                    const double x = matrix[p * count + k], y = matrix[q * count + k];
                    matrix[p * count + k] = c * x - s * y, matrix[q * count + k] = s * x + c * y;
                    const double u = vectors[p * count + k], v = vectors[q * count + k];
                    vectors[p * count + k] = c * u - s * v, vectors[q * count + k] = s * u + c * v;
                }
                matrix[p * count + q] = matrix[q * count + p] = 0;
            }
        if (off == 0) break;
    }
    for (int64_t k = 0; k < count; k++) values[k] = matrix[k * (count + 1)];
    for (int64_t k = 0; k < count; k++) /* the smallest first */
        for (int64_t l = k + 1; l < count; l++) {
            if (!(values[l] < values[k])) continue;
            const double value = values[k];
            values[k] = values[l], values[l] = value;
            for (int64_t c = 0; c < count; c++) {
                const double v = vectors[k * count + c];
                vectors[k * count + c] = vectors[l * count + c], vectors[l * count + c] = v;
            }
        }
}
