/* What a recipe's frames do behind the raster: how planes become images, and what the detector does. Private. */
#ifndef SKG_DECIDE_H
#define SKG_DECIDE_H

#include "plan/recipe.h"
#include "stage/detect.h"

/* The shape of the attenuation of images: everything but its tables. */
void skg_decide_attenuation(const skg_recipe *recipe, skg_attenuation *shape);

/* The stage `detect`. *wanted: 0 if there is nothing left for it to do. factors: [channels]. SKG_ERR_BEAM if a ratio is
 * asked for and a channel records nothing of the flat field. */
skg_status skg_decide_detection(const skg_recipe *recipe, skg_detection *detection, double *factors,
                                int32_t *wanted);

/* Whether logarithms are taken of finished means, behind noise and blur. */
int skg_decide_late_logarithm(const skg_recipe *recipe);

#endif
