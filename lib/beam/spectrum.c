#include "beam/spectrum.h"

#include <inttypes.h>
#include <math.h>

/* The range over which cross sections stand: 1 keV to 20 MeV. */
static const double LOWEST_KEV = 1.0, HIGHEST_KEV = 20000.0;

skg_status skg_spectrum_mono(double energy_kev, double photons, skg_spectrum **spectrum) {
    if (!spectrum) return skg_fail(SKG_ERR_ARGUMENT, "skg_spectrum_mono: no place for the spectrum");
    *spectrum = NULL;
    if (!(energy_kev >= LOWEST_KEV && energy_kev <= HIGHEST_KEV))
        return skg_fail(SKG_ERR_BEAM, "a photon energy of %g keV lies outside %g to %g keV", energy_kev,
                        LOWEST_KEV, HIGHEST_KEV);
    if (!(isfinite(photons) && photons > 0))
        return skg_fail(SKG_ERR_BEAM, "%g photons per pixel make no beam; give a number above 0", photons);
    skg_spectrum *made = NULL;
    SKG_TRY(skg_alloc(1, sizeof *made, "spectrum", &made));
    skg_refs_init(&made->refs);
    made->count = 1;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(1, sizeof(double), "spectrum", &made->energy_kev));
    SKG_TRY_CLEANUP(skg_alloc(1, sizeof(double), "spectrum", &made->photons));
    made->energy_kev[0] = energy_kev;
    made->photons[0] = photons;
    *spectrum = made;
    return SKG_OK;
cleanup:
    skg_spectrum_release(&made);
    return status;
}

skg_status skg_spectrum_retain(skg_spectrum *spectrum) {
    if (!spectrum) return skg_fail(SKG_ERR_ARGUMENT, "skg_spectrum_retain: no spectrum");
    skg_ref(&spectrum->refs);
    return SKG_OK;
}

void skg_spectrum_release(skg_spectrum **spectrum) {
    if (!spectrum || !*spectrum) return;
    if (skg_unref(&(*spectrum)->refs)) {
        skg_free(&(*spectrum)->energy_kev);
        skg_free(&(*spectrum)->photons);
        skg_free(spectrum);
    }
    *spectrum = NULL;
}

skg_status skg_spectrum_size(const skg_spectrum *spectrum, int64_t *count) {
    if (!spectrum || !count) return skg_fail(SKG_ERR_ARGUMENT, "skg_spectrum_size: no spectrum or no result");
    *count = spectrum->count;
    return SKG_OK;
}

skg_status skg_spectrum_bin(const skg_spectrum *spectrum, int64_t index, double *energy_kev,
                            double *photons) {
    if (!spectrum || !energy_kev || !photons)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_spectrum_bin: no spectrum or no result");
    if (index < 0 || index >= spectrum->count)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_spectrum_bin: energy %" PRId64 " of %" PRId64, index,
                        spectrum->count);
    *energy_kev = spectrum->energy_kev[index];
    *photons = spectrum->photons[index];
    return SKG_OK;
}
