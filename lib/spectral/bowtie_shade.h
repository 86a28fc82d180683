/* The shade of a bow-tie filter. Private. */
#ifndef SKG_BOWTIE_SHADE_H
#define SKG_BOWTIE_SHADE_H

#include "spectral/shade_list.h"

/* Appends it. The options have a checked bow-tie. */
skg_status skg_bowtie_shade(const skg_shading *shading, skg_shades *shades);

#endif
