/* Frames in which parts have another density or fill fraction than planned: air that thins a lung, contrast medium that
 * fills a duct. Private. */
#ifndef SKG_OVERRIDES_H
#define SKG_OVERRIDES_H

#include "plan/recipe.h"

/* What every part of such a frame contributes; both arrays are freed by the caller.
 *
 * contributions   part p has first[p] to first[p + 1] - 1
 * first           [parts + 1] */
skg_status skg_overrides_apply(const skg_recipe *recipe, const skg_frame *given,
                               skg_contribution **contributions, int64_t **first);

/* The matter of all parts in a frame: density over that of the material, and the share that is there. [parts] each */
skg_status skg_overrides_matter(const skg_recipe *recipe, const skg_frame *given, double *density,
                                double *fill);

#endif
