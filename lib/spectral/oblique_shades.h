/* The shades of a scintillator that rays cross obliquely. Private. */
#ifndef SKG_OBLIQUE_SHADES_H
#define SKG_OBLIQUE_SHADES_H

#include "spectral/shade_list.h"

/* Appends them. The options ask for them, and their response is that of a layer. */
skg_status skg_oblique_shades(const skg_shading *shading, skg_shades *shades);

#endif
