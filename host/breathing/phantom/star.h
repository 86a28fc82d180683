/* Star-shaped surfaces: each direction from a centre ends where a region ends. Private. */
#ifndef SKG_STAR_H
#define SKG_STAR_H

#include "phantom/rings.h"

/* A region of space: <= 0 inside, and outside about the distance to it in mm. */
typedef double (*skg_region)(const void *shape, const double point[3]);

/* Distance in mm from a point inside a region, along a direction of length 1, to where the region ends; at most
 * `far`. */
double skg_shape_exit(skg_region region, const void *shape, const double from[3], const double direction[3],
                      double far);

/* Adds the part of a region that is seen from `centre`, which lies inside it, as a closed surface of `rings` rings
 * from pole to pole; points are at most `far` mm from the centre. Radii are limited and smoothed along each ring. */
skg_status skg_shape_star(const char *name, skg_region region, const void *shape, const double centre[3],
                          double far, int64_t rings, skg_mesh_arrays *arrays);

/* Smooths the radii of a ring, downwards only, so that a surface stays inside its region: in each of the `passes` no
 * radius stays above the weighted mean (1, 2, 1) of its neighbours and itself. */
void skg_shape_smooth(double *radius, int64_t count, int passes);

/* Lowers the radii of a ring until none exceeds its neighbours' by more than a slope (radial over tangential)
 * allows. */
void skg_shape_limit(double *radius, int64_t count, double slope);

#endif
