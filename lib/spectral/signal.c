/* Mean signal of a photon in a detector, and its variance. */
#include "spectral/model.h"

#include "core/core.h"

skg_status skg_signal_oblique_get(const skg_plan_options *options, double energy_kev, double oblique,
                                  double *signal) {
    const int counts = skg_quantity_counts(options);
    SKG_ASSERT(oblique >= 1);
    *signal = counts ? 1 : energy_kev;
    if (!options->response) return SKG_OK;
    return skg_response_get(options->response, energy_kev, oblique, counts ? NULL : signal,
                            counts ? signal : NULL);
}

skg_status skg_signal_get(const skg_plan_options *options, double energy_kev, double *signal) {
    return skg_signal_oblique_get(options, energy_kev, 1, signal);
}

/* A photon that arrives is recorded with the probability `efficiency` and then adds signal / efficiency on average; the
 * distribution of the pulse heights divides by the Swank factor. Counted photons all add 1, whatever the size of their
 * signals. */
skg_status skg_signal_variance_get(const skg_plan_options *options, double energy_kev, double signal,
                                   double *variance) {
    const skg_response *response = options->response;
    double efficiency = 1, swank = 1;
    *variance = signal;
    if (skg_quantity_counts(options)) return SKG_OK;
    if (response) {
        SKG_TRY(skg_response_get(response, energy_kev, 1, NULL, &efficiency));
        SKG_TRY(skg_response_swank_get(response, energy_kev, 1, &swank));
    }
    *variance = efficiency > 0 ? signal * signal / (efficiency * swank * options->swank) : 0;
    return SKG_OK;
}
