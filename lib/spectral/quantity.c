/* Classifies quantities: ratios, counts, absolute values. */
#include "spectral/model.h"

int skg_quantity_has_noise(const skg_plan_options *options) {
    return options->noise || options->electronic_kev > 0 || options->quantum_step_kev > 0;
}

/* A blurred ratio is that of a blurred image to a blurred flat field, which is not the blur of a ratio where the beam differs over the
 * detector. With falloff alone it is taken ray by ray: docs/physics.md says what that costs. */
int skg_quantity_is_absolute(const skg_plan_options *options) {
    const int is_blurred = options->blur || options->depth_blur;
    const int is_uneven = options->heel || options->bowtie || options->grid || options->oblique;
    if (options->counter) return 1; /* neighbours share counts, and dead time is of their number */
    return skg_quantity_has_noise(options) || (skg_quantity_is_ratio(options) && is_blurred && is_uneven);
}

int skg_quantity_is_ratio(const skg_plan_options *options) {
    return options->quantity == SKG_QUANTITY_TRANSMISSION || options->quantity == SKG_QUANTITY_ATTENUATION;
}

int skg_quantity_counts(const skg_plan_options *options) {
    if (options->quantity == SKG_QUANTITY_PHOTONS || options->counter) return 1;
    return skg_quantity_is_ratio(options) && options->bands > 0 &&
           options->band_weight == SKG_BAND_WEIGHT_PHOTONS;
}
