/* Fewer planes and energies for a model, within a tolerance. Private. */
#ifndef SKG_COMPRESS_H
#define SKG_COMPRESS_H

#include "spectral/model.h"

/* Rough costs per pixel in multiply-adds of the attenuation: a plane written by a hit; a plane read. They
 * choose between layouts of the same accuracy, and tell what effects cost. */
#define SKG_COST_OF_CONTRIBUTION 50.0
#define SKG_COST_OF_PLANE 50.0

/* Rewrites a model that has a plane per material and a node per bin; leaves it as it is where that meets no
 * lower cost. mu: [planes][nodes] 1/mm, what a mm of a plane attenuates; it is left as it was. options:
 * tolerance > 0, quantity, further views. */
skg_status skg_compress(const skg_scene *scene, const skg_view *view, const skg_plan_options *options,
                        const double *mu, skg_model *model);

#endif
