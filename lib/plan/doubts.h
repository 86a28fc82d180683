/* Warnings of a plan whose images are right and may not be what the caller meant. Private. */
#ifndef SKG_PLAN_DOUBTS_H
#define SKG_PLAN_DOUBTS_H

#include "plan/recipe.h"

/* Warns of bands that record nothing of the beam, and of a source inside a part, where the plan was made. */
void skg_plan_warn_doubts(const skg_recipe *recipe, const skg_context *context);

#endif
