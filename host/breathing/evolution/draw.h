/* Random numbers that depend on what they are for and on nothing else. Private. */
#ifndef SKG_EVOLUTION_DRAW_H
#define SKG_EVOLUTION_DRAW_H

#include <stdint.h>

/* Key of a random number. The same five values always give the same number, whatever was drawn before and by whichever
 * thread. */
typedef struct {
    int64_t seed, generation;
    int32_t individual, purpose;
} skg_draw_key;

/* A number from 0 to below 1, the index-th for this key: Philox4x32-10 (random.clh). */
double skg_draw_uniform(const skg_draw_key *key, int64_t index);

/* A normal deviate of mean 0 and variance 1 (Box and Muller). */
double skg_draw_normal(const skg_draw_key *key, int64_t index);

#endif
