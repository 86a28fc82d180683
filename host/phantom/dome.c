/* The diaphragm's middle surface: two domes over a rim that fits the cage and leaves out the spine. */
#include "phantom/thorax.h"

#include "core/vector.h"

const double skg_dome_centre[2] = {0, -68};

static const double pi = 3.14159265358979323846;
static const double rim_inset = 9; /* mm: half a rib, a gap, half the diaphragm */

static double rim_region(const void *unused, const double p[3]) {
    (void)unused;
    double most = -HUGE_VAL;
    for (int i = 0; i < 3; i++) { /* where the rim may be */
        const double q[3] = {p[0], p[1], -60 - 60 * i};
        most = fmax(most, fmax(skg_cage_inside(q, rim_inset), skg_spine_inside(q, 5)));
    }
    return most;
}

void skg_dome_rim(skg_thorax_plan *plan) {
    const double centre[3] = {skg_dome_centre[0], skg_dome_centre[1], 0};
    for (int i = 0; i < RIM_POINTS; i++) {
        double azimuth = 2 * pi * i / RIM_POINTS, direction[3] = {cos(azimuth), sin(azimuth), 0};
        plan->rim[i] = skg_shape_exit(rim_region, NULL, centre, direction, 300);
    }
    skg_shape_smooth(plan->rim, RIM_POINTS, 70);
}

double skg_dome_rim_radius(const skg_thorax_plan *plan, double azimuth) {
    double at = azimuth * RIM_POINTS / (2 * pi);
    at -= RIM_POINTS * floor(at / RIM_POINTS);
    int i = (int)at % RIM_POINTS, j = (i + 1) % RIM_POINTS;
    double w = at - floor(at);
    return (1 - w) * plan->rim[i] + w * plan->rim[j];
}

double skg_dome_rim_distance(const skg_thorax_plan *plan, double x, double y) {
    double dx = x - skg_dome_centre[0], dy = y - skg_dome_centre[1], azimuth = atan2(dy, dx), h = 0.03;
    double radius = skg_dome_rim_radius(plan, azimuth);
    double oblique =
        (skg_dome_rim_radius(plan, azimuth + h) - skg_dome_rim_radius(plan, azimuth - h)) / (2 * h * radius);
    return (radius - hypot(dx, dy)) / sqrt(1 + oblique * oblique);
}

/* The rim: xiphoid in front, costal margin at the sides, deepest behind (mm). */
double skg_dome_rim_height(double azimuth) {
    double ahead = 0.5 * (1 - sin(azimuth)); /* 1 in front, 0 behind */
    return -172 + 112 * ahead * ahead * ahead;
}

static double hump(double x, double y, double cx, double cy, double width, double depth) {
    double u = (x - cx) / width, v = (y - cy) / depth;
    return exp(-u * u - v * v);
}

double skg_dome_height(const skg_thorax_plan *plan, double x, double y) {
    double dx = x - skg_dome_centre[0], dy = y - skg_dome_centre[1], azimuth = atan2(dy, dx);
    double r = hypot(dx, dy) / skg_dome_rim_radius(plan, azimuth), square = fmin(r, 1.05) * fmin(r, 1.05);
    /* right dome, left dome 13 mm lower, the saddle under the heart between them */
    double top = -26 + 31 * hump(x, y, -60, -56, 50, 75) + 17 * hump(x, y, 66, -54, 46, 75);
    double rim = skg_dome_rim_height(azimuth);
    return rim + (top - rim) * (1 - square * square * square * square);
}

double skg_dome_steepness(const skg_thorax_plan *plan, double x, double y) {
    const double h = 0.5; /* mm */
    double gx = skg_dome_height(plan, x + h, y) - skg_dome_height(plan, x - h, y);
    double gy = skg_dome_height(plan, x, y + h) - skg_dome_height(plan, x, y - h);
    return sqrt(1 + gx * gx + gy * gy); /* over 2 h = 1 mm */
}

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
