/* The primary transmission of an anti-scatter grid. */
#include "beam/grid.h"
#include "core/text.h"

#include <math.h>

void skg_grid_init_sized(void *grid, int32_t size) {
    const skg_grid defaults = {0};
    skg_struct_init(grid, size, &defaults, sizeof defaults);
}

static double period(const skg_grid *grid) {
    return 10 / grid->lines_per_cm;
}

double skg_grid_height(const skg_grid *grid) {
    return grid->ratio * (period(grid) - grid->strip_mm);
}

skg_status skg_grid_check(const skg_grid *grid) {
    if (!(grid->ratio > 0 && grid->ratio <= 100))
        return skg_fail(
            SKG_ERR_SCENE,
            "a grid ratio of %g; give the height of the strips over the width of the interspaces, "
            "above 0 to 100",
            grid->ratio);
    if (!(grid->lines_per_cm > 0 && isfinite(grid->lines_per_cm)))
        return skg_fail(SKG_ERR_SCENE, "a grid of %g strips per cm; give more than 0", grid->lines_per_cm);
    if (!(grid->strip_mm > 0 && grid->strip_mm < period(grid)))
        return skg_fail(SKG_ERR_SCENE,
                        "strips of a grid are %g mm thick, but one follows another every %g mm; give a "
                        "thickness between 0 and that",
                        grid->strip_mm, period(grid));
    if (!(grid->focus_mm >= 0 && isfinite(grid->focus_mm)))
        return skg_fail(SKG_ERR_SCENE,
                        "a grid's focus at %g mm; give its distance from the grid, or 0 for parallel strips",
                        grid->focus_mm);
    return SKG_OK;
}

skg_status skg_grid_attenuation(const skg_grid *grid, double energy_kev, double *strip, double *interspace) {
    skg_material *lead = NULL;
    *interspace = 0;
    if (!grid->strip) SKG_TRY(skg_material_create_element(82, &lead));
    skg_status status = skg_material_attenuation_get(lead ? lead : grid->strip, energy_kev, strip);
    skg_material_release(&lead);
    if (status == SKG_OK && grid->interspace)
        status = skg_material_attenuation_get(grid->interspace, energy_kev, interspace);
    *strip /= 10, *interspace /= 10;
    return status;
}

/* (exp(-a) - exp(-b)) / (b - a), the mean of exp(-x) between a and b. */
static double mean_between(double a, double b) {
    const double d = b - a;
    return exp(-a) * (fabs(d) < 1e-9 ? 1 - d / 2 : -expm1(-d) / d); /* rounding is 1e-16 / 1e-9 */
}

/* Across the strips, a ray covers whole periods and a rest b. Over the places where the rest may begin, the width of strips
 * in it is a trapezium: it is least where the rest lies in an interspace as far as it can, and greatest where it lies in a
 * strip as far as it can. */
double skg_grid_pass(const skg_grid *grid, double strip, double interspace, double oblique, double tilt) {
    const double p = period(grid), d = grid->strip_mm, gap = p - d, height = skg_grid_height(grid);
    const double path = height * oblique, across = height * fabs(tilt), whole = floor(across / p);
    const double b = across - whole * p, more = strip - interspace;
    if (!(across > 1e-12 * p)) /* along the strips */
        return (gap * exp(-interspace * path) + d * exp(-strip * path)) / p;
    const double per_width = path / across; /* of the ray's path */
    const double least = (whole * d + fmax(0, b - gap)) * per_width;
    const double most = (whole * d + fmin(b, d)) * per_width;
    const double slope = fmin(fmin(b, p - b), fmin(d, gap)); /* of the trapezium, in widths */
    const double low = interspace * path + more * least, high = interspace * path + more * most;
    return (fabs(gap - b) * exp(-low) + fabs(d - b) * exp(-high) + 2 * slope * mean_between(low, high)) / p;
}

skg_status skg_grid_transmission_get(const skg_grid *grid, double energy_kev, double oblique, double tilt,
                                     double *transmission) {
    SKG_PLAIN;
    skg_grid ours;
    double strip = 0, interspace = 0;
    SKG_NEEDS(grid);
    SKG_NEEDS(transmission);
    skg_grid_init(&ours);
    SKG_TRY(skg_struct_read(grid, "skg_grid", &ours, sizeof ours));
    SKG_TRY(skg_grid_check(&ours));
    if (!(oblique >= 1 && isfinite(tilt)))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "a path of %g heights of the grid, tilted by %g; give at least 1, and a finite tilt",
                        oblique, tilt);
    SKG_TRY(skg_grid_attenuation(&ours, energy_kev, &strip, &interspace));
    *transmission = skg_grid_pass(&ours, strip, interspace, oblique, tilt);
    return SKG_OK;
}
