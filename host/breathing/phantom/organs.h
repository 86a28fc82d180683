/* What makes the organs under the diaphragm. Private. */
#ifndef SKG_ORGANS_H
#define SKG_ORGANS_H

#include "phantom/makers.h"
#include "phantom/star.h"

/* <= 0 in the region of all organs of the belly: a gap under the diaphragm, within its rim, and clear of the spine; by
 * `wall` mm more than the gap. No distance. */
double skg_belly_inside(const skg_thorax_plan *plan, double wall, const double point[3]);

/* Adds a part as a star (skg_shape_star), drawn back from those before it with the same `inside`. standard_rings: at
 * resolution 1. */
skg_status skg_thorax_star(const skg_thorax_plan *plan, const char *label, double hounsfield, int64_t inside,
                           skg_region region, const void *shape, const double centre[3],
                           double standard_rings, skg_thorax *thorax);

#endif
