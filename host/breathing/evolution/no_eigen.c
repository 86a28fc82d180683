/* Without LAPACKE. */
#include "evolution/eigen.h"

int skg_has_eigen(void) {
    return 0;
}

skg_status skg_symmetric_eigen(int64_t n, double *matrix, double *values) {
    (void)n, (void)matrix, (void)values;
    return skg_fail(SKG_ERR_UNSUPPORTED, "this library was built without LAPACKE");
}
