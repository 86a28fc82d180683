/* Smooth curves through given points. Private. */
#ifndef SKG_CURVE_H
#define SKG_CURVE_H

#include "core/core.h"

/* Cubic through knots (x rising) whose slope at a knot is that between its neighbours; constant outside. Row k of
 * knots: x, value. */
double skg_shape_curve(const double (*knots)[2], int count, double x);

/* Centripetal Catmull-Rom curve through 2 to 16 points, as `samples` points evenly in arc length. */
skg_status skg_shape_spline(const double (*points)[3], int count, int64_t samples, double (*curve)[3]);

#endif
