/* A bow-tie filter: one shade, whose amount is the path through the filter. */
#include "spectral/shading.h"

#include "core/maths.h"

#include <math.h>

typedef struct {
    const skg_shades *shades;
    double low, high; /* tangents of the angles in the fan */
    double longest;   /* path over that in the plane of the fan */
} extent;

static skg_status see(void *user, const skg_camera *camera, const double ray[3], double column, double row) {
    extent *e = user;
    double central[3], across[3];
    (void)column, (void)row;
    if (!skg_shade_axes(camera, e->shades->fan_toward, central, across))
        return skg_fail(SKG_ERR_SCENE,
                        "the bow-tie's direction points along the ray to the detector's centre; give the "
                        "direction in which its angles grow");
    const double x = skg_dot(ray, across), y = skg_dot(ray, central);
    if (!(y > 0))
        return skg_fail(SKG_ERR_SCENE, "the detector reaches 90 degrees from its centre; a bow-tie does not");
    e->low = fmin(e->low, x / y), e->high = fmax(e->high, x / y);
    e->longest = fmax(e->longest, skg_length(ray) / hypot(x, y));
    return SKG_OK;
}

static skg_status check_reach(const skg_bowtie *bowtie, const extent *e, skg_status status) {
    const double degree = 180 / SKG_PI, low = atan(e->low) * degree, high = atan(e->high) * degree;
    /* Angles are printed with some digits: a hundred-thousandth of a degree is 1e-7 of any length. */
    const double rounding = 1e-5, last = bowtie->angle_deg[bowtie->count - 1];
    if (low >= bowtie->angle_deg[0] - rounding && high <= last + rounding) return SKG_OK;
    return skg_fail(
        status,
        "the bow-tie's profile goes from %g to %g degrees, but rays leave the source from %.4g to "
        "%.4g degrees; add rows to the profile, or make the detector smaller",
        bowtie->angle_deg[0], last, low, high);
}

skg_status skg_bowtie_covers(const skg_shades *shades, const skg_view *view,
                             const skg_plan_options *options) {
    extent e = {.shades = shades, .low = HUGE_VAL, .high = -HUGE_VAL, .longest = 1};
    if (shades->bowtie == 0) return SKG_OK;
    SKG_TRY(skg_shade_rays_of(view, options, see, &e));
    return check_reach(options->bowtie, &e, SKG_STALE);
}

skg_status skg_bowtie_shade(const skg_shading *shading, skg_shades *shades) {
    const skg_bowtie *bowtie = shading->options->bowtie;
    const skg_spectrum *spectrum = shading->spectrum;
    const double *rows = shading->view->column_step;
    extent e = {.shades = shades, .low = HUGE_VAL, .high = -HUGE_VAL, .longest = 1};
    double *table = NULL, *losses = NULL, low = HUGE_VAL, high = 0;
    skg_status status = SKG_OK;
    SKG_TRY(skg_shade_direction(shading->view, skg_length(bowtie->direction) > 0 ? bowtie->direction : rows,
                                "bow-tie", "the direction in which its angles grow", shades->fan_toward));
    SKG_TRY(skg_shade_rays(shading, see, &e));
    SKG_TRY(check_reach(bowtie, &e, SKG_ERR_SCENE));
    shades->rows = bowtie->count;
    shades->fan_angle[0] = atan(e.low), shades->fan_angle[1] = atan(e.high);
    SKG_TRY(skg_shades_append_table(2 * bowtie->count, shades, &table));
    for (int64_t k = 0; k < bowtie->count; k++) {
        table[k] = tan(bowtie->angle_deg[k] * (SKG_PI / 180));
        table[bowtie->count + k] = bowtie->path_mm[k];
        low = fmin(low, bowtie->path_mm[k]), high = fmax(high, bowtie->path_mm[k]);
    }
    SKG_TRY(skg_alloc(spectrum->count, sizeof *losses, "bow-tie", &losses));
    for (int64_t b = 0; b < spectrum->count; b++) {
        SKG_TRY_CLEANUP(skg_material_attenuation_get(bowtie->material, spectrum->energy_kev[b], &losses[b]));
        losses[b] /= 10;
    }
    SKG_TRY_CLEANUP(skg_shades_append(spectrum->count, losses, low, high * e.longest, shades));
    shades->bowtie = 1;
cleanup:
    skg_free(&losses);
    return status;
}
