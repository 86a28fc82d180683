/* Ellipsoids. */
#include "phantom/shapes.h"

#include "core/maths.h"

double skg_ellipsoid_inside(const skg_ellipsoid *e, const double point[3], double larger) {
    double p[3], x[3], y[3], z[3], up[3] = {0, 0, 1};
    skg_add_scaled(point, -1, e->centre, p);
    skg_scale_vector(1 / skg_length(e->turned), e->turned, x);
    skg_cross(up, x, y);
    skg_scale_vector(1 / skg_length(y), y, y);
    skg_cross(x, y, z);
    double u = skg_dot(p, x) / (e->axis[0] + larger), v = skg_dot(p, y) / (e->axis[1] + larger);
    double w = skg_dot(p, z) / (e->axis[2] + larger);
    return (sqrt(u * u + v * v + w * w) - 1) * (fmin(e->axis[0], fmin(e->axis[1], e->axis[2])) + larger);
}
