/* Faces that contain rays: seen edge-on, they are hit by no ray, but the mean length over a pixel changes when they move. Private.
 *
 * With di dj = h / (t^3 det) db, where db is the area in barycentric coordinates and det the determinant of the camera, the
 * integral over a pixel of the derivative of a hit, (t / h) b_k n . dv_k, stays finite when h = n . (v - source) goes to 0:
 * n . dv_k / det times the integral of b_k / t^2 db over the part of the face that the pixel sees. kernels/gradient.cl finds the
 * faces. */
#ifndef SKG_STEEP_H
#define SKG_STEEP_H

#include "geometry/optics.h"

/* A part's d loss / d t of the ray of a pixel; 0 outside of the detector. */
typedef double (*skg_steep_weight)(const void *user, int64_t column, int64_t row);

/* Adds, for each corner of a face, h of which is `seen` (skg_camera_see), the sum over pixels of weight times the integral of b_k / t^2 db, over det; with a parallel beam that
 * of b_k. */
void skg_steep_add(const skg_camera *camera, double seen[3][3], skg_steep_weight weight, const void *user,
                   double moments[3]);

/* Adds to every pixel of [camera->rows][camera->columns] its own weight times the same integrals, times slopes[k] at corner k. */
void skg_steep_spread(const skg_camera *camera, double seen[3][3], skg_steep_weight weight, const void *user,
                      const double slopes[3], double *values);

#endif
