/* CMA-ES. Private. */
#ifndef SKG_EVOLUTION_CMA_H
#define SKG_EVOLUTION_CMA_H

#include "evolution/state.h"

/* Length of skg_search.own. */
int64_t skg_cma_numbers(int64_t dimensions);

/* Points of a generation after so many restarts. */
int64_t skg_cma_population(int64_t dimensions, int64_t restarts);

void skg_cma_begin(skg_search *search);
skg_status skg_cma_ask(skg_search *search);
skg_status skg_cma_tell(skg_search *search, const double *values);

#endif
