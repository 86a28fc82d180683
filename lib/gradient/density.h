/* Derivatives by the densities of parts. Private. */
#ifndef SKG_GRADIENT_DENSITY_H
#define SKG_GRADIENT_DENSITY_H

#include "gradient/forces.h"
#include "gradient/work.h"

/* Lists what stands around the parts of a pass, or less. Arrays are staged. drawn: the pass's parts, or a copy in which parts of the
 * material around them are drawn, too. */
skg_status skg_gradient_find_surroundings(skg_job *job, const skg_pass *pass, skg_surroundings *around,
                                          skg_geometry_part **drawn);

/* Adds the densities of a pass that take no path lengths, and marks the others in gradient->needs_lengths. sums: [parts] of the
 * gather of the pass with what stands around its parts */
void skg_gradient_add_densities(skg_job *job, const skg_frame_work *work, const skg_pass *pass,
                                const skg_surroundings *surroundings, const skg_gathered *gathered,
                                const skg_force_sums *sums);

/* Whether any density takes path lengths. */
int skg_gradient_needs_lengths(const skg_gradient_work *gradient, int64_t parts);

/* Reads the derivatives by the mm of the planes, which skg_gradient_memory.weights holds. */
skg_status skg_gradient_keep_planes(skg_job *job, const skg_pass *pass);

/* Adds the share of a part's density in a pass, from its path lengths; of a volume's, from what its cells add to a plane of the model.
 * Waits for them. Along a direction: keeps how fast they change planes and exponents (direction_rates.h). */
skg_status skg_gradient_add_density(skg_job *job, const skg_pass *pass, int64_t part, int32_t plane);

#endif
