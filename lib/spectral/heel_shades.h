/* The shades of the heel effect. Private. */
#ifndef SKG_HEEL_SHADES_H
#define SKG_HEEL_SHADES_H

#include "spectral/shade_list.h"

/* Appends them. The options ask for them. */
skg_status skg_heel_shades(const skg_shading *shading, skg_shades *shades);

/* The normal of the anode's face, towards the beam. */
void skg_heel_axis(const skg_shades *shades, const skg_camera *camera, double axis[3]);

#endif
