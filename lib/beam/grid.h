/* The primary transmission of an anti-scatter grid. Private. */
#ifndef SKG_GRID_H
#define SKG_GRID_H

#include "core/core.h"

#include <skiagraph/options.h>

/* Fails with SKG_ERR_SCENE unless the dimensions make a grid. */
skg_status skg_grid_check(const skg_grid *grid);

/* Height of the strips of a checked grid, mm. */
double skg_grid_height(const skg_grid *grid);

/* Attenuation of strips and interspaces in 1/mm. */
skg_status skg_grid_attenuation(const skg_grid *grid, double energy_kev, double *strip, double *interspace);

/* The share of the photons that pass a checked grid (skg_grid_transmission_get), with these attenuations. */
double skg_grid_pass(const skg_grid *grid, double strip, double interspace, double oblique, double tilt);

#endif
