/* Eigenvalues, by LAPACK.. */
#include "evolution/eigen.h"

#include "evolution/methods.h"

#include <lapacke.h>

#include <string.h>

int skg_has_eigen(void) {
    return 1;
}

skg_status skg_symmetric_eigen(int64_t n, double *matrix, double *values) {
    /* The matrix is symmetric and finite, so that LAPACK can only fail to converge. The vectors come as rows of its column
     * order. */
    double work[SKG_SEARCH_MAX * 34];
    const lapack_int size = (lapack_int)n;
    const lapack_int status =
        LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'U', size, matrix, size, values, work, 34 * size);
    if (status != 0) return skg_fail(SKG_ERR_INTERNAL, "LAPACK's dsyev ended with %d", (int)status);
    for (int64_t i = 0; i < n; i++)
        for (int64_t k = 0; k < i; k++) {
            const double swapped = matrix[n * i + k];
            matrix[n * i + k] = matrix[n * k + i], matrix[n * k + i] = swapped;
        }
    return SKG_OK;
}
