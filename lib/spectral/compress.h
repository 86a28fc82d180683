/* Fewer planes and energies for a model, within a tolerance. Private. */
#ifndef SKG_COMPRESS_H
#define SKG_COMPRESS_H

#include "spectral/model.h"

/* Rough costs per pixel, in multiply-adds of the attenuation, of a hit that adds to a plane and of a plane that
 * is read. They choose between layouts of the same accuracy and estimate the costs of effects. */
#define SKG_COST_OF_CONTRIBUTION 50.0
#define SKG_COST_OF_PLANE 50.0

/* Rewrites a model that has a plane for each material and a node for each bin. The model stays as it is if fewer
 * nodes do not meet the tolerance.
 *
 * mu        [planes][nodes] 1/mm, the attenuation of a mm of a plane
 * options   tolerance > 0, the quantity, and further views */
skg_status skg_compress(const skg_scene *scene, const skg_view *view, const skg_plan_options *options,
                        const double *mu, skg_model *model);

#endif
