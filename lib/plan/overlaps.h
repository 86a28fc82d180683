/* The check for parts that overlap or leave their parent. Private. */
#ifndef SKG_PLAN_OVERLAPS_H
#define SKG_PLAN_OVERLAPS_H

#include "plan/outcome.h"

/* Finds overlaps and inverted components, if the options ask for it. nestings: result: [meshes], to be freed by skg_free; NULL
 * if the options do not ask. */
skg_status skg_plan_overlaps_find(const skg_recipe *recipe, skg_outcome *outcome,
                                  skg_mesh_nesting **nestings);

/* Warns of what was found, except for overlaps that priorities or clipping settle. */
skg_status skg_plan_overlaps_warn(const skg_recipe *recipe, const skg_context *context,
                                  const skg_outcome *outcome, const skg_mesh_nesting *nestings);

#endif
