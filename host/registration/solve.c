/* Cholesky's solution of normal equations. */
#include "registration/types.h"

int reg_solve(int64_t count, double *matrix, int64_t right, double *vectors) {
    for (int64_t i = 0; i < count; i++)
        for (int64_t j = 0; j <= i; j++) {
            double sum = matrix[i * count + j];
            for (int64_t k = 0; k < j; k++) sum -= matrix[i * count + k] * matrix[j * count + k];
            if (i == j && !(sum > 0)) return 0;
            matrix[i * count + j] = i == j ? sqrt(sum) : sum / matrix[j * count + j];
        }
    for (int64_t v = 0; v < right; v++) {
        double *x = vectors + v * count;
        for (int64_t i = 0; i < count; i++) {
            for (int64_t k = 0; k < i; k++) x[i] -= matrix[i * count + k] * x[k];
            x[i] /= matrix[i * count + i];
        }
        for (int64_t i = count; i-- > 0;) {
            for (int64_t k = i + 1; k < count; k++) x[i] -= matrix[k * count + i] * x[k];
            x[i] /= matrix[i * count + i];
        }
    }
    return 1;
}
