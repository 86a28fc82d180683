/* The check for parts that overlap or leave their parent. Private. */
#ifndef SKG_PLAN_OVERLAPS_H
#define SKG_PLAN_OVERLAPS_H

#include "plan/outcome.h"

/* What the check has found. */
typedef struct {
    int64_t side; /* columns along each side of the grid */
    int64_t pair_count;
    skg_overlap_pair *pairs;
    skg_mesh_nesting *nestings; /* [meshes]; NULL: the options do not ask for the check */
} skg_plan_overlaps;

/* Finds overlaps and inverted components, if the options ask for it. Release what was found also after a failure. */
skg_status skg_plan_overlaps_find(const skg_recipe *recipe, skg_plan_overlaps *found);
void skg_plan_overlaps_release(skg_plan_overlaps *found);

/* Moves the pairs to the outcome, and warns of what was found, except for overlaps that priorities or clipping settle. */
skg_status skg_plan_overlaps_take(const skg_recipe *recipe, const skg_context *context,
                                  skg_plan_overlaps *found, skg_outcome *outcome);

#endif
