/* The check for parts that overlap or leave their parent. Private. */
#ifndef SKG_PLAN_OVERLAPS_H
#define SKG_PLAN_OVERLAPS_H

#include "plan/outcome.h"

/* Finds overlaps, if the options ask for it, and warns of those that neither priorities nor clipping settle. */
skg_status skg_plan_overlaps_find(const skg_recipe *recipe, skg_context *context, skg_outcome *outcome);

#endif
