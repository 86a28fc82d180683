/* A table of angles of scattering from which photons are sent on. Private. */
#ifndef SKG_SCATTER_ANGLES_H
#define SKG_SCATTER_ANGLES_H

#include "scatter/physics.h"

enum { SKG_ANGLE_ROWS = 48 };

/* Fills table [SKG_ANGLE_ROWS][SKG_SCATTER_ANGLES + 1], rising cosines between which scattering is equally likely, for energies
 * even in ln E. The distribution is the mean of that of `mixture` and those of all materials, so that no material's own
 * is far above it; weights of photons make good for the difference. mixture: coefficients, with all 0 not counted. */
skg_status skg_angles_make(const skg_scatter_physics *physics, const double mixture[SKG_SCATTER_RANK],
                           float *table);

#endif
