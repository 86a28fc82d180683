/* What effects cost, estimated from counts of operations per pixel, in units of a frame without any effect. Private. */
#ifndef SKG_COSTS_H
#define SKG_COSTS_H

#include "geometry/extent.h"
#include "geometry/priority.h"
#include "plan/outcome.h"
#include "stage/layers.h"

/* Fills the costs of the outcome's effects. layers: and their blurs; extents: [parts] at the recipe's view. */
void skg_costs_estimate(const skg_recipe *recipe, const skg_layers *layers, const skg_extent *extents,
                        const skg_priority *priority, skg_outcome *outcome);

#endif
