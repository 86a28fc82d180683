/* Nearest points on a triangle and on a surface. Private. */
#ifndef SKG_DISTANCE_NEAREST_H
#define SKG_DISTANCE_NEAREST_H

#include "core/core.h"

/* Weights of the corners a, b and c at the point of their triangle that is nearest to p. */
void skg_triangle_nearest(const double *a, const double *b, const double *c, const double *p,
                          double weights[3]);

/* Nearest points on a surface.
 *
 * The triangles are halved again and again along the longest axis of their centres, down to a few in each leaf, and a
 * search visits the nearer half first. Embree's point queries would do the same in single precision: bounds and query
 * are floats, so that a triangle 1e-5 mm farther may win at 200 mm from the origin, and its callback computes the
 * distance to a triangle itself, which leaves little of what a library is used for. */

typedef struct {
    int64_t triangles, nodes;
    double *bounds; /* per node: low, high */
    int64_t *first; /* per node: its first triangle of `order`; inner nodes have the left child at node + 1 */
    int64_t *count; /* per node: triangles of a leaf; minus the right child of an inner node */
    int64_t *order; /* triangles, leaf by leaf */
    double *corners; /* [triangles][3][3] mm, in that order */
} skg_tree;

/* Makes the tree of a surface. positions: rows of x, y, z in mm, all finite; corners: rows of three vertices. */
skg_status skg_tree_create(const char *name, const double *positions, int64_t triangles,
                           const int32_t *corners, skg_tree *tree);
void skg_tree_free(skg_tree *tree);

/* The square of the distance from a point to the surface, mm2. within: the square of a distance that is known to reach
 * the surface, or HUGE_VAL; if nothing is that near, the result is `within`. triangle: result, may be NULL: the number
 * of the nearest triangle, of several the least; -1 if nothing is that near. */
double skg_tree_nearest(const skg_tree *tree, const double point[3], double within, int64_t *triangle);

#endif
