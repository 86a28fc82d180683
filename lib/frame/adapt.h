/* Adaptive sampling of an extended source. Private. */
#ifndef SKG_ADAPT_H
#define SKG_ADAPT_H

#include "plan/results.h"
#include "stage/machine.h"

/* If the number of source samples is not given: doubles it until two doublings in a row change less than the tolerance at
 * the recipe's view (docs/numerics.md), and returns a recipe with that number; else returns the recipe that was given,
 * retained. Warns if more samples would be needed than are allowed. Reports the samples and the last change. */
skg_status skg_samples_adapt(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome,
                             skg_recipe **adapted);

#endif
