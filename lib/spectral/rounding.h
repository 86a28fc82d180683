/* What the precision of path lengths does to intensities. Private. */
#ifndef SKG_ROUNDING_H
#define SKG_ROUNDING_H

#include "spectral/model.h"

typedef struct {
    /* Of the relative error of intensities: relative where more than 1e-6 of the flat field arrives, else in units of 1e-6 of
     * the flat field. */
    double bound;
    /* Parts whose lengths may be wrong by more than 1 % of the longest, and the one with the largest share. */
    int64_t thin_count, thin;
    double thin_error, thin_longest; /* mm */
} skg_rounding;

/* Bounds the error that the rounding of lengths and exponents makes.
 *
 * options   its precision; with half precision images are rounded as well
 * method    rays to 64 x 64 points of the detector; each part that a ray meets may be wrong by the bar of docs/numerics.md:
 *           a share of the longest path through the part, or of its extent along the rays if that is more; with half
 *           precision half a last place of a distance in metres for each surface that is met */
skg_status skg_rounding_find(const skg_scene *scene, const skg_view *view, const skg_model *model,
                             const skg_plan_options *options, skg_rounding *rounding);

/* The same for parts alone that may be thin, judged by their volumes: thin_count and what follows, but not the bound. Costs
 * nothing where no part may be. */
skg_status skg_rounding_find_thin(const skg_scene *scene, const skg_view *view, const skg_model *model,
                                  const skg_plan_options *options, skg_rounding *rounding);

#endif
