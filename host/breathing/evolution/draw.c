/* Random numbers that depend on what they are for and on nothing else. */
#include "evolution/draw.h"

#include "core/maths.h"

#include <math.h>

/* Names of OpenCL C that random.clh uses. */
#define uint uint32_t

static uint32_t upper_half(uint32_t a, uint32_t b) {
    return (uint32_t)((uint64_t)a * b >> 32);
}

#include "random.clh"

SKG_DEFINE_PHILOX(philox, uint32_t, upper_half)

static void draw_words(const skg_draw_key *key, int64_t index, uint32_t words[4]) {
    words[0] = (uint32_t)key->generation;
    words[1] = (uint32_t)key->individual;
    words[2] = (uint32_t)index;
    words[3] = (uint32_t)key->purpose;
    philox(words, (uint32_t)key->seed, (uint32_t)(key->seed >> 32));
}

/* 53 bits of two words. */
static double fraction(uint32_t high, uint32_t low) {
    return (double)(((uint64_t)high << 32 | low) >> 11) * 0x1p-53;
}

double skg_draw_uniform(const skg_draw_key *key, int64_t index) {
    uint32_t words[4];
    draw_words(key, index, words);
    return fraction(words[0], words[1]);
}

double skg_draw_normal(const skg_draw_key *key, int64_t index) {
    uint32_t words[4];
    draw_words(key, index, words);
    const double radius = sqrt(-2 * log(1 - fraction(words[0], words[1])));
    return radius * cos(2 * SKG_PI * fraction(words[2], words[3]));
}
