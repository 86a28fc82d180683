/* The effects of a plan: which are on, and why. Private. */
#ifndef SKG_EFFECTS_H
#define SKG_EFFECTS_H

#include "plan/outcome.h"
#include "stage/layers.h"

/* Fills the effects of an outcome whose overlaps and samples are known. layers: and their blurs. */
skg_status skg_effects_find(const skg_recipe *recipe, const skg_context *context, const skg_layers *layers,
                            skg_outcome *outcome);

#endif
