/* Random numbers for tests: the same on every machine. Method: splitmix64 (Steele, Lea, Flood 2014). */
#ifndef SKG_TESTS_RANDOM_H
#define SKG_TESTS_RANDOM_H

#include <stdint.h>

static inline uint64_t draw_bits(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* low <= value < high */
static inline double draw(uint64_t *state, double low, double high) {
    return low + (high - low) * (double)(draw_bits(state) >> 11) * 0x1p-53;
}

/* 0 <= value < count */
static inline int64_t draw_below(uint64_t *state, int64_t count) {
    return (int64_t)(draw_bits(state) % (uint64_t)count);
}

#endif
