/* K fluorescence that leaves a layer. Private. */
#ifndef SKG_ESCAPE_H
#define SKG_ESCAPE_H

#include "core/core.h"

#include <skiagraph/material.h>

typedef struct skg_escape skg_escape;

/* Prepares a layer of a material whose composition is known; it is borrowed. The caller frees the result.
 *
 * method    A photoelectric absorption leaves a vacancy in the K shell of an element with the share 1 - 1/J of the element's
 *           cross section (J: jump of the cross section at the edge), and the vacancy emits a photon with the fluorescence
 *           yield, in any direction. Of a photon of depth z the share (E2(mu z) + E2(mu (t - z))) / 2 leaves the layer, with
 *           the exponential integral E2; the others are absorbed, and may again leave a vacancy, in an element with a lower
 *           edge. Depth is divided into cells that are finest at the surfaces. */
skg_status skg_escape_create(const skg_material *material, double mm, skg_escape **escape);
void skg_escape_release(skg_escape **escape);

/* The energy that leaves with fluorescence, per photon that interacts: sums over lines of probability times energy and of
 * probability times its square.
 *
 * per_mm    attenuation of the photons, 1/mm
 * oblique   their path through the layer divided by its thickness */
void skg_escape_moments(const skg_escape *escape, double energy_kev, double per_mm, double oblique,
                        double *energy, double *square);

/* Energy and its square that leave the layer for photons that interact at each of some depths, mm. energy, square: [depths] */
void skg_escape_left(const skg_escape *escape, double energy_kev, int depths, const double *depth_mm,
                     double *energy, double *square);

#endif
