/* Faces that contain rays: seen edge-on, they are hit by no ray, but the mean length over a pixel changes when they move. Private.
 *
 * With di dj = h / (t^3 det) db, where db is the area in barycentric coordinates and det the determinant of the camera, the
 * integral over a pixel of the derivative of a hit, (t / h) b_k n . dv_k, stays finite when h = n . (v - source) goes to 0:
 * n . dv_k / det times the integral of b_k / t^2 db over the part of the face that the pixel sees. kernels/gradient/gradient.cl finds the
 * faces. */
#ifndef SKG_STEEP_H
#define SKG_STEEP_H

#include "gradient/crossings.h"

/* d loss / d t of the part along a ray: weights[k] in front of planes.at[k].plane, as far as the plane before; `rest` behind all. */
typedef struct {
    skg_crossing_list planes;
    double *weights; /* [planes.capacity] */
    int64_t capacity;
    double rest;
} skg_steep_weights;

/* Fills the weights of a pixel. middle: column and row of the middle of what the pixel sees of the face. */
typedef skg_status (*skg_steep_weigh)(const void *user, int64_t column, int64_t row, const double middle[2],
                                      skg_steep_weights *weights);

/* Adds, for each corner of a face, h of which is `seen` (skg_camera_see), the sum over pixels of weight times the integral of b_k / t^2 db, over det; with a parallel beam that
 * of b_k. */
skg_status skg_steep_add(const skg_camera *camera, double seen[3][3], skg_steep_weigh weigh, const void *user,
                         double moments[3]);

/* Adds to every pixel of [camera->rows][camera->columns] its own weight times the same integrals, times slopes[k] at corner k. */
skg_status skg_steep_spread(const skg_camera *camera, double seen[3][3], skg_steep_weigh weigh,
                            const void *user, const double slopes[3], double *values);

#endif
