/* Closed surfaces of rings, and the curves that shape them. Private. */
#ifndef SKG_SHAPE_H
#define SKG_SHAPE_H

#include "core/core.h"
#include "mesh/mesh.h"

/* Where the point of a ring lies: azimuth 0 to below 1. */
typedef void (*skg_ring_place)(const void *shape, int64_t ring, double azimuth, double point[3]);

/* Adds a surface of sphere topology to the arrays: rings of counts[r] points evenly in azimuth, 1 for the
 * poles, which are the first and the last ring. Outward when the azimuth runs counter-clockwise as seen from
 * the last ring. */
skg_status skg_shape_rings(const char *name, int64_t rings, const int64_t *counts, skg_ring_place place,
                           const void *shape, skg_mesh_arrays *arrays);

/* Points around a ring or along a curve: at least `fewest`, `standard` at resolution 1. */
int64_t skg_shape_count(double resolution, double standard, int64_t fewest);

/* One place along a tube: centre, and the half axes of its elliptic section in mm. */
typedef struct {
    double centre[3];
    double height; /* along z, as far as the tube's direction allows */
    double width;  /* across both */
} skg_tube_ring;

/* A tube along the rings, `around` points each, closed by a pole so many mm beyond each end. */
skg_status skg_shape_tube(const char *name, int64_t rings, const skg_tube_ring *ring, double pole,
                          int64_t around, skg_mesh_arrays *arrays);

/* The same along a curve, one section, with rounded ends; side -1: mirrored to the right. */
skg_status skg_shape_cord(const char *name, const double (*curve)[3], int64_t points, double height,
                          double width, double side, int64_t rings, int64_t around, skg_mesh_arrays *arrays);

/* Whether a point is allowed: <= 0 where it is, mm-like outside. */
typedef double (*skg_region)(const void *shape, const double point[3]);

/* How far one can go from a point inside a region along a direction of length 1 before leaving it: mm, at
 * most `far`. */
double skg_shape_exit(skg_region region, const void *shape, const double from[3], const double direction[3],
                      double far);

/* The part of a region that is seen from a point inside, as a closed surface; `rings` from pole to pole. No
 * point is farther than its neighbours' mean by more than smoothing allows. */
skg_status skg_shape_star(const char *name, skg_region region, const void *shape, const double centre[3],
                          double far, int64_t rings, skg_mesh_arrays *arrays);

/* Draws the surface back, near where it meets those of meshes as they were made or comes nearer than some 0.2
 * mm, until it does not; at most 15 mm (apart.c). */
skg_status skg_shape_retreat(const char *name, int64_t count, skg_mesh *const *others,
                             skg_mesh_arrays *arrays);

/* Which facets of a closed surface meet others of it that are not their neighbours: how many, and 1 or 0 per
 * triangle. moved: per vertex, whether facets there are looked at; NULL: all (apart.c). */
skg_status skg_shape_folds(const skg_mesh_arrays *arrays, const char *moved, int64_t *count, char *fold);

/* Smooths a surface where it folds over itself, until it does not. */
skg_status skg_shape_unfold(const char *name, const skg_mesh_arrays *arrays);

/* Smooths the radii of a ring, downwards only: what was allowed stays allowed. `passes` times over, none
 * exceeds the mean of its neighbours' and its own. */
void skg_shape_smooth(double *radius, int64_t count, int passes);

/* Likewise: none exceeds its neighbours' by more than a slope (radial over tangential) gives. */
void skg_shape_limit(double *radius, int64_t count, double slope);

/* Cubic through knots (x rising), slopes from both neighbours; constant outside. Row k of knots: x, value. */
double skg_shape_curve(const double (*knots)[2], int count, double x);

/* Centripetal Catmull-Rom curve through points, as `samples` points evenly in arc length. */
skg_status skg_shape_spline(const double (*points)[3], int count, int64_t samples, double (*curve)[3]);

#endif
