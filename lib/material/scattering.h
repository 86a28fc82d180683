/* How strongly the atoms of a material scatter by momentum transfer. Private.
 *
 * The momentum transfer is x = sin(theta/2) / wavelength = E sin(theta/2) / (h c), in 1/Angstrom; theta is the angle
 * between the photon's directions before and after. Atoms are free, unless a material has a table of its molecules' form factors: the
 * structure of molecules and crystals changes F^2 below about 0.3/Angstrom. */
#ifndef SKG_MATERIAL_SCATTERING_H
#define SKG_MATERIAL_SCATTERING_H

#include "material/material.h"

/* h c in keV Angstrom, and the electron's rest energy in keV and classical radius in cm (CODATA 2018). */
#define SKG_HC_KEV_ANGSTROM 12.398419843320026
#define SKG_ELECTRON_KEV 510.99895
#define SKG_ELECTRON_RADIUS_CM 2.8179403262e-13
/* Avogadro's number (SI 2019), 1/mol. */
#define SKG_AVOGADRO 6.02214076e23

/* F^2 and S of one atom, in the order of materials/rows.h, at a momentum transfer >= 0 in 1/Angstrom. Below the first row of the
 * table F = Z - c x^2 and S = c x^2; above the last one F falls like x^-4, as that of 1s electrons does, and S stays Z. */
void skg_atom_scattering(int32_t z, double x, double factors[SKG_SCATTERINGS]);

/* Sums over the atoms of 1 g of a material, in 1/g: of F^2 and of S at momentum transfer x (1/Angstrom). F^2 is that of its molecules
 * where it has a table of them.
 *
 * errors   SKG_ERR_MATERIAL for a material without composition (mu at all energies, or a table); the message says what to
 *          use instead */
skg_status skg_scattering_factors(const skg_material *material, double x, double *coherent,
                                  double *incoherent);

/* Likewise for free atoms. */
skg_status skg_scattering_free(const skg_material *material, double x, double *coherent, double *incoherent);

/* SKG_ERR_MATERIAL as above unless the material has a composition. */
skg_status skg_scattering_check(const skg_material *material);

#endif
