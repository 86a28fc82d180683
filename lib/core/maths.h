/* Constants and small formulas that every room uses. Private. */
#ifndef SKG_MATHS_H
#define SKG_MATHS_H

#include <stdint.h>

/* pi to the precision of a double. C11 does not define M_PI. An angle in degrees times SKG_PI / 180 is in radians. */
#define SKG_PI 3.14159265358979323846

/* The number of pieces of `size` that hold `count` items: the quotient rounded up. */
static inline int64_t skg_divide_up(int64_t count, int64_t size) {
    return (count + size - 1) / size;
}

/* The smallest multiple of `size` that is not below `count`. */
static inline int64_t skg_round_up(int64_t count, int64_t size) {
    return skg_divide_up(count, size) * size;
}

/* The slope of a monotone cubic at a sample: the harmonic mean of the slopes to the samples on both sides, 0 at a maximum or
 * minimum (F. N. Fritsch and J. Butland, SIAM Journal on Scientific and Statistical Computing 5 (1984) 300-304). */
static inline double skg_monotone_slope(double before, double after) {
    return before * after > 0 ? 2 * before * after / (before + after) : 0;
}

#endif
