/* Random numbers for the host. Private. */
#ifndef SKG_RANDOM_H
#define SKG_RANDOM_H

#include <stdint.h>

/* A random number from 0 to below 1: splitmix64 of Steele, Lea and Flood (2014). */
static inline double skg_draw(uint64_t *state) {
    uint64_t z = *state += 0x9E3779B97F4A7C15u;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

#endif
