/* What a plan says of its precision. Private. */
#ifndef SKG_PLAN_PRECISION_H
#define SKG_PLAN_PRECISION_H

#include "plan/recipe.h"

/* The bound of the relative error that the precision makes. */
skg_status skg_plan_precision_bound(const skg_recipe *recipe, double *bound);

/* Warns of half precision, with its bound, and of parts that are too thin for single precision. */
skg_status skg_plan_precision_warn(const skg_recipe *recipe, const skg_context *context);

#endif
