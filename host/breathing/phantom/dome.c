/* The domes of the diaphragm. */
#include "phantom/anatomy.h"

#include "core/maths.h"
#include "phantom/shapes.h"

const double skg_dome_centre[2] = {0, -68};
const double skg_dome_half_thickness = 1.5;

static const double rim_inset = 9; /* mm from the ribs' middle lines: half a rib, a gap, half the diaphragm */

static double rim_region(const void *unused, const double p[3]) {
    (void)unused;
    double most = -HUGE_VAL;
    for (int i = 0; i < 3; i++) { /* from the top to the bottom of the rim */
        const double q[3] = {p[0], p[1], -60 - 60 * i};
        most = fmax(most, fmax(skg_cage_inside(q, rim_inset), skg_spine_inside(q, 5)));
    }
    return most;
}

void skg_dome_fill(skg_dome *dome) {
    const double centre[3] = {skg_dome_centre[0], skg_dome_centre[1], 0};
    for (int i = 0; i < RIM_POINTS; i++) {
        double azimuth = 2 * SKG_PI * i / RIM_POINTS, direction[3] = {cos(azimuth), sin(azimuth), 0};
        dome->rim[i] = skg_shape_exit(rim_region, NULL, centre, direction, 300);
    }
    skg_shape_smooth(dome->rim, RIM_POINTS, 70);
}

double skg_dome_rim_radius(const skg_dome *dome, double azimuth) {
    double at = azimuth * RIM_POINTS / (2 * SKG_PI);
    at -= RIM_POINTS * floor(at / RIM_POINTS);
    int i = (int)at % RIM_POINTS, j = (i + 1) % RIM_POINTS;
    double w = at - floor(at);
    return (1 - w) * dome->rim[i] + w * dome->rim[j];
}

double skg_dome_rim_distance(const skg_dome *dome, double x, double y) {
    double dx = x - skg_dome_centre[0], dy = y - skg_dome_centre[1], azimuth = atan2(dy, dx),
           h = 0.03; /* rad; 2 points */
    double radius = skg_dome_rim_radius(dome, azimuth);
    double oblique =
        (skg_dome_rim_radius(dome, azimuth + h) - skg_dome_rim_radius(dome, azimuth - h)) / (2 * h * radius);
    return (radius - hypot(dx, dy)) / sqrt(1 + oblique * oblique);
}

double skg_dome_rim_height(double azimuth) {
    double ahead = 0.5 * (1 - sin(azimuth)); /* 1 in front, 0 behind */
    return -172 + 112 * ahead * ahead * ahead;
}

/* A Gaussian of height 1. */
static double hump(double x, double y, double cx, double cy, double width, double depth) {
    double u = (x - cx) / width, v = (y - cy) / depth;
    return exp(-u * u - v * v);
}

double skg_dome_height(const skg_dome *dome, double x, double y) {
    double dx = x - skg_dome_centre[0], dy = y - skg_dome_centre[1], azimuth = atan2(dy, dx);
    double r = hypot(dx, dy) / skg_dome_rim_radius(dome, azimuth), square = fmin(r, 1.05) * fmin(r, 1.05);
    /* A right dome, a left one that is 13 mm lower, and between them the saddle under the heart. */
    double top = -26 + 31 * hump(x, y, -60, -56, 50, 75) + 17 * hump(x, y, 66, -54, 46, 75);
    double rim = skg_dome_rim_height(azimuth);
    /* the eighth power keeps the dome flat and its wall steep; 1.05: the wall continues a little below the rim */
    return rim + (top - rim) * (1 - square * square * square * square);
}

double skg_dome_steepness(const skg_dome *dome, double x, double y) {
    const double h = 0.5; /* mm */
    double gx = skg_dome_height(dome, x + h, y) - skg_dome_height(dome, x - h, y);
    double gy = skg_dome_height(dome, x, y + h) - skg_dome_height(dome, x, y - h);
    return sqrt(1 + gx * gx + gy * gy); /* over 2 h = 1 mm */
}
