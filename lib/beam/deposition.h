/* Energy that photons leave in a layer, with scattered photons followed until they leave it. Private. */
#ifndef SKG_DEPOSITION_H
#define SKG_DEPOSITION_H

#include "beam/escape.h"

typedef struct skg_deposition skg_deposition;

/* Solves the transport of photons in a layer of a material whose composition is known. Material and escape are borrowed; escape NULL:
 * no fluorescence leaves the layer. The caller frees the result.
 *
 * method    The mean and the mean square of what a photon of energy E leaves behind from depth z on in direction w obey an integral
 *           equation over its next interaction: absorption leaves E, less what fluorescence takes away; Compton scattering leaves
 *           E - E' and a photon of E' in its new direction; Rayleigh scattering a photon of E; pair production E - 1,022 keV and two
 *           photons of 511 keV. It is solved from low energies to high ones on cells of depth and Gauss points of direction. Angles
 *           are those of free atoms (Klein and Nishina, scattering functions, form factors). Electrons stay where they are set free. */
skg_status skg_deposition_create(const skg_material *material, double mm, const skg_escape *escape,
                                 skg_deposition **deposition);
void skg_deposition_release(skg_deposition **deposition);

/* Mean and mean square of the energy that a photon leaves which interacts, keV and keV2.
 *
 * per_mm    attenuation of the photons, 1/mm
 * oblique   their path through the layer divided by its thickness */
void skg_deposition_moments(const skg_deposition *deposition, double energy_kev, double per_mm,
                            double oblique, double *energy, double *square);

#endif
