/* Spectra: energies and photons, made, checked and asked. */
#include "beam/spectrum.h"
#include "core/text.h"
#include "material/material.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

skg_status skg_spectrum_make(int64_t count, skg_spectrum **spectrum) {
    skg_spectrum *made = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof *made, "spectrum", &made));
    skg_refs_init(&made->refs);
    made->count = count;
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof(double), "spectrum", &made->energy_kev));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof(double), "spectrum", &made->photons));
    *spectrum = made;
    return SKG_OK;
cleanup:
    skg_spectrum_release(&made);
    return status;
}

static skg_status check_energy(double energy_kev) {
    if (energy_kev >= SKG_LOWEST_KEV && energy_kev <= SKG_HIGHEST_KEV) return SKG_OK;
    return skg_fail(SKG_ERR_BEAM, "a photon energy of %g keV lies outside %g to %g keV", energy_kev,
                    SKG_LOWEST_KEV, SKG_HIGHEST_KEV);
}

/* Refuses photons whose energies add up to more than a double holds. */
static skg_status check_sum(int64_t count, const double *energies_kev, const double *photons, double factor) {
    double kev = 0;
    for (int64_t i = 0; i < count; i++) kev += energies_kev[i] * photons[i] * factor;
    if (isfinite(kev)) return SKG_OK;
    return skg_fail(SKG_ERR_BEAM,
                    "the energy of all photons is more than a double holds; give fewer photons");
}

skg_status skg_spectrum_create_mono(double energy_kev, double photons, skg_spectrum **spectrum) {
    SKG_PLAIN;
    SKG_NEEDS(spectrum);
    *spectrum = NULL;
    SKG_TRY(check_energy(energy_kev));
    if (!(isfinite(photons) && photons > 0))
        return skg_fail(SKG_ERR_BEAM, "%g photons per pixel make no beam; give a number above 0", photons);
    SKG_TRY(check_sum(1, &energy_kev, &photons, 1));
    SKG_TRY(skg_spectrum_make(1, spectrum));
    (*spectrum)->energy_kev[0] = energy_kev;
    (*spectrum)->photons[0] = photons;
    return SKG_OK;
}

typedef struct {
    double energy_kev, photons;
} bin;

static int by_energy(const void *a, const void *b) {
    double x = ((const bin *)a)->energy_kev, y = ((const bin *)b)->energy_kev;
    return (x > y) - (x < y);
}

/* Sorts the bins, adds up those of equal energy and removes those without photons. Returns the new count. */
static int64_t merge(int64_t count, bin *bins) {
    int64_t used = 0;
    qsort(bins, (size_t)count, sizeof *bins, by_energy);
    for (int64_t i = 0; i < count; i++) {
        if (!(bins[i].photons > 0)) continue;
        if (used > 0 && !(bins[i].energy_kev > bins[used - 1].energy_kev))
            bins[used - 1].photons += bins[i].photons;
        else
            bins[used++] = bins[i];
    }
    return used;
}

skg_status skg_spectrum_create_bins(int64_t count, const double *energies_kev, const double *photons,
                                    skg_spectrum **spectrum) {
    SKG_PLAIN;
    SKG_NEEDS(spectrum);
    *spectrum = NULL;
    if (count < 1 || !energies_kev || !photons)
        return skg_fail(SKG_ERR_BEAM, "a spectrum has at least one energy");
    for (int64_t i = 0; i < count; i++) {
        SKG_TRY(check_energy(energies_kev[i]));
        if (!(isfinite(photons[i]) && photons[i] >= 0))
            return skg_fail(SKG_ERR_BEAM, "%g photons of %g keV: give a number of at least 0", photons[i],
                            energies_kev[i]);
    }
    SKG_TRY(check_sum(count, energies_kev, photons, 1));
    bin *bins = NULL;
    SKG_TRY(skg_alloc(count, sizeof *bins, "spectrum", &bins));
    for (int64_t i = 0; i < count; i++) bins[i] = (bin){energies_kev[i], photons[i]};
    int64_t used = merge(count, bins);
    skg_status status = used > 0 ? skg_spectrum_make(used, spectrum)
                                 : skg_fail(SKG_ERR_BEAM, "a spectrum without photons makes no beam");
    for (int64_t i = 0; status == SKG_OK && i < used; i++) {
        (*spectrum)->energy_kev[i] = bins[i].energy_kev;
        (*spectrum)->photons[i] = bins[i].photons;
    }
    skg_free(&bins);
    return status;
}

skg_status skg_spectrum_create_scaled(const skg_spectrum *spectrum, double factor, skg_spectrum **scaled) {
    SKG_PLAIN;
    SKG_NEEDS(scaled);
    *scaled = NULL;
    SKG_NEEDS(spectrum);
    if (!(isfinite(factor) && factor > 0))
        return skg_fail(SKG_ERR_BEAM, "a spectrum times %g makes no beam; give a factor above 0", factor);
    SKG_TRY(check_sum(spectrum->count, spectrum->energy_kev, spectrum->photons, factor));
    SKG_TRY(skg_spectrum_make(spectrum->count, scaled));
    (*scaled)->absolute = spectrum->absolute;
    (*scaled)->unloaded = spectrum->unloaded;
    for (int64_t i = 0; i < spectrum->count; i++) {
        (*scaled)->energy_kev[i] = spectrum->energy_kev[i];
        (*scaled)->photons[i] = spectrum->photons[i] * factor;
    }
    return SKG_OK;
}

skg_status skg_spectrum_create_counts(const skg_spectrum *spectrum, double factor, skg_spectrum **counts) {
    SKG_TRY(skg_spectrum_create_scaled(spectrum, factor, counts));
    (*counts)->absolute = 0;
    return SKG_OK;
}

skg_status skg_spectrum_create_absolute(const skg_spectrum *spectrum, skg_spectrum **absolute) {
    SKG_TRY(skg_spectrum_create_scaled(spectrum, 1, absolute));
    (*absolute)->absolute = 1;
    (*absolute)->unloaded = 0;
    return SKG_OK;
}

skg_status skg_spectrum_absolute_get(const skg_spectrum *spectrum, int32_t *absolute) {
    SKG_NEEDS(spectrum);
    SKG_NEEDS(absolute);
    *absolute = spectrum->absolute;
    return SKG_OK;
}

double skg_microsteradians(double pixel_mm2, double distance_mm) {
    return pixel_mm2 * pow(1000 / distance_mm, 2);
}

skg_status skg_spectrum_retain(skg_spectrum *spectrum) {
    SKG_NEEDS(spectrum);
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

skg_status skg_spectrum_bin_count(const skg_spectrum *spectrum, int64_t *count) {
    SKG_NEEDS(spectrum);
    SKG_NEEDS(count);
    *count = spectrum->count;
    return SKG_OK;
}

skg_status skg_spectrum_bin_get(const skg_spectrum *spectrum, int64_t index, double *energy_kev,
                                double *photons) {
    SKG_NEEDS(spectrum);
    SKG_NEEDS(energy_kev);
    SKG_NEEDS(photons);
    if (index < 0 || index >= spectrum->count)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_spectrum_bin_get: energy %" PRId64 " of %" PRId64, index,
                        spectrum->count);
    *energy_kev = spectrum->energy_kev[index];
    *photons = spectrum->photons[index];
    return SKG_OK;
}
