/* Integrals over the sphere of the distributions of angles. Private. */
#ifndef SKG_SCATTER_SHAPES_H
#define SKG_SCATTER_SHAPES_H

#include "scatter/physics.h"

/* Klein and Nishina's cross section of a free electron per solid angle, in r_e^2. cosine: of the angle of scattering */
double skg_klein_nishina(double kev, double cosine);

/* Thomson's, likewise. */
double skg_thomson(double cosine);

/* The weights of the momenta's points in the integral over the sphere at an energy: the sum of weight[i] * table[i]
 * is the integral of cross_section * table, where the table is linear between its points.
 *
 * compton, rayleigh   [momenta]
 * returns             the number of points up to the momentum transfer of a photon that is turned back; the weights of the
 *                     others are not set */
int64_t skg_shape_weights(const skg_scatter_physics *grid, double kev, double *compton, double *rayleigh);

#endif
