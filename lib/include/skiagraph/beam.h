/* Spectra: how many photons of which energy reach a pixel of the open beam.
 *
 * Spectra never change once made and may be shared by threads. */
#ifndef SKIAGRAPH_BEAM_H
#define SKIAGRAPH_BEAM_H

#include <skiagraph/error.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct skg_spectrum skg_spectrum;

/* One energy in keV (1 keV to 20 MeV) and a number of photons per pixel (finite, > 0). Errors: SKG_ERR_BEAM.
 */
SKG_API skg_status skg_spectrum_mono(double energy_kev, double photons, skg_spectrum **spectrum);

SKG_API skg_status skg_spectrum_retain(skg_spectrum *spectrum);
SKG_API void skg_spectrum_release(skg_spectrum **spectrum);

/* How many energies the spectrum has, and the one at 0 <= index < count: keV and photons per pixel. */
SKG_API skg_status skg_spectrum_size(const skg_spectrum *spectrum, int64_t *count);
SKG_API skg_status skg_spectrum_bin(const skg_spectrum *spectrum, int64_t index, double *energy_kev,
                                    double *photons);

#ifdef __cplusplus
}
#endif
#endif
