/* The table of effects, and what all of its rows do for a plan. Private. */
#ifndef SKG_EFFECTS_H
#define SKG_EFFECTS_H

#include "plan/outcome.h"

/* Row 0 <= index < SKG_EFFECTS. Static storage. */
const skg_effect_row *skg_effect_row_get(int64_t index);

/* Replaces what the options of effects point to by copies. After a failure the recipe can only be released. */
skg_status skg_effects_copy(skg_recipe *recipe);

/* Refuses options of effects that cannot be used. */
skg_status skg_effects_check(const skg_plan_options *options);

/* Whether any effect refuses half precision. */
int skg_effects_refuse_half(const skg_recipe *recipe);

/* Fills the effects of an outcome whose overlaps and samples are known. layers: and their blurs. */
skg_status skg_effects_find(const skg_recipe *recipe, const skg_context *context, const skg_layers *layers,
                            skg_outcome *outcome);

#endif
