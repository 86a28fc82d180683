/* The effects that are shades, and K escape. Private. */
#ifndef SKG_SHADE_EFFECTS_H
#define SKG_SHADE_EFFECTS_H

#include "plan/outcome.h"

/* Says which of them are on, and why. */
void skg_effects_find_shades(const skg_recipe *recipe, skg_outcome *outcome);

#endif
