/* What the precision of path lengths does to intensities. Private. */
#ifndef SKG_ROUNDING_H
#define SKG_ROUNDING_H

#include "spectral/model.h"

/* Bounds the relative error of intensities that the rounding of lengths and exponents makes.
 *
 * is_double   precision of the lengths: 1 double, 0 single
 * bound       relative where more than 1e-6 of the flat field arrives, else in units of 1e-6 of the flat field
 * method      rays to 64 x 64 points of the detector; each part that a ray meets may be wrong by the bar of
 *             docs/numerics.md, a share of the longest path through the part */
skg_status skg_rounding_bound(const skg_scene *scene, const skg_view *view, const skg_model *model,
                              int is_double, double *bound);

#endif
