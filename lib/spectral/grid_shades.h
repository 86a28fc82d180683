/* The shades of an anti-scatter grid. Private. */
#ifndef SKG_GRID_SHADES_H
#define SKG_GRID_SHADES_H

#include "spectral/shade_list.h"

/* Appends them. The options have a checked grid. */
skg_status skg_grid_shades(const skg_shading *shading, skg_shades *shades);

/* Sets tilt so that the tilt of the ray to pixel (i, j) against the strips is tilt[0] + tilt[1] i + tilt[2] j. */
void skg_grid_tilt(const skg_shades *shades, const skg_camera *camera, double tilt[3]);

/* The unit vector across the strips, in the plane of the detector. 0 if there is none. */
int skg_grid_across(const skg_shades *shades, const skg_camera *camera, double across[3]);

#endif
