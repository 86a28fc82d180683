/* The ribs' middle lines. Private. */
#ifndef SKG_RIBS_H
#define SKG_RIBS_H

#include "core/core.h"

enum { RIBS = 12, RIB_POINTS = 96 };

/* One rib of the left side; the right one is its mirror image. */
typedef struct {
    double line[RIB_POINTS][3]; /* middle line from the head, evenly in arc length */
    double height, width;       /* half axes of its section, mm */
} skg_rib;

/* Fills rib number k + 1: from the head beside the spine backward to the angle, which is on the cage, and from there
 * along the cage. Where not simple, the neck runs to the side as much as backward. */
skg_status skg_rib_fill(int k, int simple, skg_rib *rib);

/* Distance in mm to the nearest point of a middle line, on the point's own side. */
double skg_rib_distance(const skg_rib ribs[RIBS], const double point[3]);

#endif
