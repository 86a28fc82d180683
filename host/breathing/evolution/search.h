/* Minimizing a function of up to 64 numbers between 0 and 1 by a population. Private.
 *
 *     while (...) {
 *         skg_search_ask(search);                      points of a generation
 *         values[i] = f(search->points + n * i)        in any order, by any threads
 *         skg_search_tell(search, values);
 *     }
 *
 * Everything random is drawn by skg_draw_key, so that the same seed gives the same search. All state but the points stands
 * in `counters` and `numbers`: a search that was saved between tell and ask continues with the same bits. */
#ifndef SKG_EVOLUTION_SEARCH_H
#define SKG_EVOLUTION_SEARCH_H

#include "evolution/methods.h"

/* Begins a search at a point. seed: at least 0. */
skg_status skg_search_create(int method, int64_t dimensions, const double *start, int64_t seed,
                             skg_search *search);
void skg_search_free(skg_search *search);

/* Sets counters[SEARCH_POPULATION] points. */
skg_status skg_search_ask(skg_search *search);

/* Takes their values, which may be HUGE_VAL but not NaN. */
skg_status skg_search_tell(skg_search *search, const double *values);

#endif
