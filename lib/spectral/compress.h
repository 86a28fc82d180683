/* Fewer planes and energies for a model, within a tolerance. Private. */
#ifndef SKG_COMPRESS_H
#define SKG_COMPRESS_H

#include "spectral/model.h"

/* Rough costs per pixel, in multiply-adds of the attenuation, of a hit that adds to a plane and of a plane that
 * is read. They choose between layouts of the same accuracy and estimate the costs of effects. */
#define SKG_COST_OF_CONTRIBUTION 50.0
#define SKG_COST_OF_PLANE 50.0

/* Begins to compress a model that has a plane for each material and a node for each bin: its planes and contributions are
 * rewritten, and a search for nodes begins in a thread of its own (model->search).
 *
 * mu        [planes][nodes] 1/mm, the attenuation of a mm of a plane; taken over, and NULL afterwards
 * options   tolerance > 0, the quantity, and further views */
skg_status skg_compress_begin(const skg_scene *scene, const skg_view *view, const skg_plan_options *options,
                              double **mu, skg_model *model);

/* Waits for the search and rewrites the nodes. If fewer nodes do not meet the tolerance, the planes are again those from
 * before, and *restored is 1. */
skg_status skg_compress_end(skg_model *model, int *restored);

/* Waits for the search, which ends without a result. */
void skg_compress_drop(skg_model *model);

#endif
