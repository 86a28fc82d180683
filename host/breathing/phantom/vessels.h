/* The great vessels and the oesophagus. Private. */
#ifndef SKG_VESSELS_H
#define SKG_VESSELS_H

#include "core/core.h"

enum { VESSELS = 8, VESSEL_POINTS = 33 };

/* A vessel's middle line, evenly in arc length, the radii of its ends, and bounds of the whole, mm. */
typedef struct {
    const char *label;
    double hounsfield, rings; /* rings at resolution 1 */
    double line[VESSEL_POINTS][3], radius[2], low[3], high[3];
} skg_vessel;

skg_status skg_vessels_fill(skg_vessel vessels[VESSELS]);

/* Distance in mm to the vessels' walls; < 0 inside. At most 30. */
double skg_vessel_distance(const skg_vessel vessels[VESSELS], const double point[3]);

#endif
