/* Surfaces of organs: curves, tubes, stars and branching vessels, stitched from rings of points. Private. */
#ifndef SKG_PHANTOM_SHAPES_H
#define SKG_PHANTOM_SHAPES_H

#include "core/core.h"
#include "mesh/mesh.h"

/* Smooth curves through given points. */

/* Cubic through knots (x rising) whose slope at a knot is that between its neighbours; constant outside. Row k of
 * knots: x, value. */
double skg_shape_curve(const double (*knots)[2], int count, double x);

/* Centripetal Catmull-Rom curve through 2 to 16 points, as `samples` points evenly in arc length. */
skg_status skg_shape_spline(const double (*points)[3], int count, int64_t samples, double (*curve)[3]);

/* Closed surfaces stitched from rings of points. */

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

/* Tubes: elliptic rings along a line or a curve. */

/* One place along a tube: its centre and the half axes of its elliptic section, in mm. */
typedef struct {
    double centre[3];
    double height; /* half axis along z, as far as the tube's direction allows */
    double width;  /* half axis across both */
} skg_tube_ring;

/* Adds a tube through the rings, of `around` points each, closed by a pole `pole` mm beyond each end. */
skg_status skg_shape_tube(const char *name, int64_t rings, const skg_tube_ring *ring, double pole,
                          int64_t around, skg_mesh_arrays *arrays);

/* Adds a tube of one section along a curve, with rounded ends. side: 1, or -1 for its mirror image at x = 0. */
skg_status skg_shape_cord(const char *name, const double (*curve)[3], int64_t points, double height,
                          double width, double side, int64_t rings, int64_t around, skg_mesh_arrays *arrays);

/* Adds a tube of round section along a curve, with rounded ends, whose radius goes evenly from `first` to `last` mm.
 * Unlike a cord it may turn to any direction. side: as above. */
skg_status skg_shape_hose(const char *name, const double (*curve)[3], int64_t points, double first,
                          double last, double side, int64_t rings, int64_t around, skg_mesh_arrays *arrays);

/* Ellipsoids that shape organs. */

typedef struct {
    double centre[3], axis[3]; /* axis: half axes, mm */
    double turned[3];          /* direction of the first axis; the second is horizontal */
} skg_ellipsoid;

/* <= 0 inside the ellipsoid whose half axes are larger by `larger` mm, outside about the distance in mm. */
double skg_ellipsoid_inside(const skg_ellipsoid *ellipsoid, const double point[3], double larger);

/* Star-shaped surfaces: each direction from a centre ends where a region ends. */

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

/* The vessels of a lung: trunks from the hilum with two orders of branches. */

/* Whether a ball lies in the lung. */
typedef int (*skg_tree_room)(const void *shape, const double centre[3], double radius);

/* Adds the vessels of one lung, each a closed tube; where they join, a gap is left. side: 1 left, -1 right. */
skg_status skg_shape_tree(const char *name, skg_tree_room room, const void *shape, double side,
                          double resolution, skg_mesh_arrays *arrays);

#endif
