/* The shades of the heel effect. */
#include "spectral/shading.h"

#include "core/maths.h"

#include <math.h>

/* The normal of the anode's face, towards the beam: sin(angle) along the central ray less cos(angle) towards the anode. */
static int face_of(const skg_shades *shades, const skg_camera *camera, double normal[3]) {
    double central[3], toward[3];
    if (!skg_shade_axes(camera, shades->heel_toward, central, toward)) return 0;
    skg_scale_vector(sin(shades->heel_angle), central, normal);
    skg_add_scaled(normal, -cos(shades->heel_angle), toward, normal);
    return 1;
}

void skg_heel_axis(const skg_shades *shades, const skg_camera *camera, double axis[3]) {
    for (int k = 0; k < 3; k++) axis[k] = 0;
    (void)face_of(shades, camera, axis);
}

typedef struct {
    const skg_shades *shades;
    double low, high; /* cosines between the normal of the anode and the rays */
} extent;

static skg_status see(void *user, const skg_camera *camera, const double ray[3], double column, double row) {
    extent *e = user;
    double normal[3];
    (void)column, (void)row;
    if (!face_of(e->shades, camera, normal))
        return skg_fail(SKG_ERR_SCENE,
                        "the heel's direction points along the central ray; give the direction "
                        "from the detector's centre to the side of the anode");
    const double q = skg_dot(normal, ray) / skg_length(ray);
    e->low = fmin(e->low, q), e->high = fmax(e->high, q);
    return SKG_OK;
}

skg_status skg_heel_covers(const skg_shades *shades, const skg_view *view, const skg_plan_options *options) {
    const skg_shade_extent *known = &shades->heel_extent;
    extent e = {shades, 1, -1};
    if (shades->heel == 0) return SKG_OK;
    SKG_TRY(skg_shade_rays_of(view, options, see, &e));
    if (e.low >= known->middle - known->half && e.high <= known->middle + known->half) return SKG_OK;
    return skg_fail(
        SKG_STALE,
        "rays of this view leave the anode at %.4g to %.4g degrees, the plan knows the heel effect from %.4g to %.4g; make a "
        "plan for it",
        asin(fmax(e.low, -1)) * (180 / SKG_PI), asin(fmin(e.high, 1)) * (180 / SKG_PI),
        asin(fmax(known->middle - known->half, -1)) * (180 / SKG_PI),
        asin(fmin(known->middle + known->half, 1)) * (180 / SKG_PI));
}

skg_status skg_heel_shades(const skg_shading *shading, skg_shades *shades) {
    const skg_heel *heel = shading->options->heel;
    const skg_heel_tube tube = {
        .anode = heel->anode, .kvp = heel->kvp, .angle_deg = heel->angle_deg, .bin_kev = heel->bin_kev};
    skg_directions directions = {0};
    extent e = {shades, 1, -1};
    skg_status status = SKG_OK;
    shades->heel_angle = heel->angle_deg * (SKG_PI / 180);
    SKG_TRY(skg_shade_direction(shading->view, heel->direction, "heel",
                                "the direction from the detector's centre to the side of the anode",
                                shades->heel_toward));
    SKG_TRY(skg_shade_rays(shading, see, &e));
    shades->heel_extent = skg_shade_extent_of(e.low, e.high);
    SKG_TRY_CLEANUP(skg_directions_create(shading->spectrum, SKG_FIT_POINTS, &directions));
    for (int s = 0; s < SKG_FIT_POINTS; s++) {
        const double q = shades->heel_extent.middle + shades->heel_extent.half * skg_fit_point(s);
        const double angle = asin(fmin(fmax(q, -1), 1));
        SKG_TRY_CLEANUP(skg_heel_losses(&tube, angle * (180 / SKG_PI), shading->spectrum,
                                        directions.losses + s * directions.bins));
    }
    SKG_TRY_CLEANUP(skg_shades_append_fitted(&directions, shades, &shades->heel_error));
    shades->heel = directions.count;
cleanup:
    skg_directions_release(&directions);
    return status;
}
