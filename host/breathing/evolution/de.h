/* Differential evolution. Private. */
#ifndef SKG_EVOLUTION_DE_H
#define SKG_EVOLUTION_DE_H

#include "evolution/state.h"

int64_t skg_de_population(int64_t dimensions);
void skg_de_begin(skg_search *search);
void skg_de_ask(skg_search *search);
void skg_de_tell(skg_search *search, const double *values);

#endif
