/* Closed surfaces stitched from rings of points. Private. */
#ifndef SKG_RINGS_H
#define SKG_RINGS_H

#include "core/core.h"
#include "mesh/mesh.h"

/* Where a point of a ring lies: azimuth 0 to below 1. */
typedef void (*skg_ring_place)(const void *shape, int64_t ring, double azimuth, double point[3]);

/* Adds a surface of sphere topology to the arrays: rings of counts[r] points evenly in azimuth. The first and the
 * last ring are the poles, of 1 point. Normals point outward when the azimuth runs counter-clockwise as seen from
 * the last ring. */
skg_status skg_shape_rings(const char *name, int64_t rings, const int64_t *counts, skg_ring_place place,
                           const void *shape, skg_mesh_arrays *arrays);

/* Number of points around a ring or along a curve: `standard` at resolution 1, at least `fewest`. */
int64_t skg_shape_count(double resolution, double standard, int64_t fewest);

/* Radius (0 to 1) of the ring at t (0 to 1) of a disc that bends most at its rim: the distance between rings falls
 * from 1.45 of the mean at the centre to 0.55 of it at the rim (a choice). */
static inline double skg_shape_towards_rim(double t) {
    return 1.45 * t - 0.45 * t * t;
}

#endif
