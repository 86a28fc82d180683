/* Vectors of three doubles. Private. */
#ifndef SKG_VECTOR_H
#define SKG_VECTOR_H

#include <math.h>

static inline double skg_dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void skg_cross(const double *a, const double *b, double *product) {
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    product[0] = x, product[1] = y, product[2] = z;
}

static inline double skg_length(const double *a) {
    return sqrt(skg_dot(a, a));
}

/* result = a + factor b */
static inline void skg_add_scaled(const double *a, double factor, const double *b, double *result) {
    for (int k = 0; k < 3; k++) result[k] = a[k] + factor * b[k];
}

static inline void skg_scale_vector(double factor, const double *a, double *result) {
    for (int k = 0; k < 3; k++) result[k] = factor * a[k];
}

static inline int skg_all_finite(const double *numbers, int count) {
    for (int k = 0; k < count; k++)
        if (!isfinite(numbers[k])) return 0;
    return 1;
}

#endif
