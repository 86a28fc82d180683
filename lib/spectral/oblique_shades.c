/* Rays that cross a scintillator obliquely: its layer is longer for them. */
#include "spectral/shading.h"

#include "core/maths.h"
#include "spectral/model.h"

#include <math.h>

typedef struct {
    double low, high; /* cosines between the rays and the normal of the detector */
} extent;

static skg_status see(void *user, const skg_camera *camera, const double ray[3], double column, double row) {
    extent *e = user;
    const double q = skg_camera_foot(camera) / skg_length(ray);
    (void)column, (void)row;
    e->low = fmin(e->low, q), e->high = fmax(e->high, q);
    return SKG_OK;
}

skg_status skg_oblique_covers(const skg_shades *shades, const skg_view *view,
                              const skg_plan_options *options) {
    const skg_shade_extent *known = &shades->oblique_extent;
    extent e = {1, 0};
    if (shades->oblique == 0) return SKG_OK;
    SKG_TRY(skg_shade_rays_of(view, options, see, &e));
    if (e.low >= known->middle - known->half && fmin(e.high, 1) <= known->middle + known->half + 1e-6)
        return SKG_OK;
    return skg_fail(
        SKG_STALE,
        "rays of this view cross the scintillator with cosines from %.4g to %.4g, the plan knows %.4g to %.4g; make a plan for it",
        e.low, e.high, known->middle - known->half, known->middle + known->half);
}

skg_status skg_oblique_shades(const skg_shading *shading, skg_shades *shades) {
    const skg_spectrum *spectrum = shading->spectrum;
    skg_directions directions = {0};
    extent e = {1, 0};
    skg_status status = SKG_OK;
    SKG_TRY(skg_shade_rays(shading, see, &e));
    /* No cosine is above 1, where what is recorded would not be smooth. */
    const skg_shade_extent wide = skg_shade_extent_of(e.low, e.high);
    const double low = wide.middle - wide.half, high = fmin(wide.middle + wide.half, 1);
    shades->oblique_extent = (skg_shade_extent){0.5 * (low + high), 0.5 * (high - low)};
    SKG_TRY_CLEANUP(skg_directions_create(spectrum, SKG_FIT_POINTS, &directions));
    for (int s = 0; s < SKG_FIT_POINTS; s++) {
        const double q = shades->oblique_extent.middle + shades->oblique_extent.half * skg_fit_point(s);
        for (int64_t b = 0; b < spectrum->count; b++) {
            double straight = 0, oblique = 0;
            SKG_TRY_CLEANUP(skg_signal_get(shading->options, spectrum->energy_kev[b], &straight));
            SKG_TRY_CLEANUP(
                skg_signal_oblique_get(shading->options, spectrum->energy_kev[b], 1 / fmin(q, 1), &oblique));
            directions.losses[s * directions.bins + b] = log(straight / oblique);
        }
    }
    SKG_TRY_CLEANUP(skg_shades_append_fitted(&directions, shades, &shades->oblique_error));
    shades->oblique = directions.count;
cleanup:
    skg_directions_release(&directions);
    return status;
}
