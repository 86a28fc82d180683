/* What quantities are: ratios, counts, absolute. */
#include "spectral/model.h"

int skg_quantity_is_absolute(const skg_plan_options *options) {
    return options->noise || options->electronic_kev > 0 || options->quantum_step_kev > 0;
}

int skg_quantity_is_ratio(const skg_plan_options *options) {
    return options->quantity == SKG_QUANTITY_TRANSMISSION || options->quantity == SKG_QUANTITY_ATTENUATION;
}

int skg_quantity_counts(const skg_plan_options *options) {
    if (options->quantity == SKG_QUANTITY_PHOTONS) return 1;
    return skg_quantity_is_ratio(options) && options->bands > 0 &&
           options->band_weight == SKG_BAND_WEIGHT_PHOTONS;
}
