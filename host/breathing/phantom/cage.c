/* The rib cage as a surface, on which ribs and wall lie. */
#include "phantom/anatomy.h"

#include "core/maths.h"
#include "phantom/shapes.h"

/* Rows of z and half width, z and y of the front, z and y of the back of the cage, in mm. */
static const double half_width[][2] = {{-300, 122}, {-200, 126}, {-158, 128}, {-119, 131}, {-84, 133},
                                       {-43, 136},  {-6, 134},   {30, 128},   {59, 121},   {95, 109},
                                       {125, 94},   {141, 78},   {157, 66},   {175, 54},   {200, 44}};
static const double front[][2] = {{-300, -132}, {-180, -136}, {-100, -142}, {-51, -144},
                                  {-9, -142},   {18, -134},   {50, -123},   {84, -109},
                                  {110, -97},   {137, -82},   {160, -72},   {200, -60}};
static const double back[][2] = {{-300, 28}, {-180, 31}, {-107, 36}, {-50, 42}, {0, 45},
                                 {47, 45},   {95, 38},   {143, 23},  {171, 6},  {200, -8}};
#define CURVE(knots, x) skg_shape_curve(knots, (int)(sizeof(knots) / sizeof *(knots)), x)

/* Exponent of the superellipses that are the cage's sections: 2 is an ellipse, more is squarer (a choice). */
static const double roundness = 2.3;

const double skg_spine_body[SPINE_BODIES][2] = {{170, 15},  {150, 16}, {129.5, 16.5}, {108, 17},   {86, 17.5},
                                                {63.5, 18}, {40, 19},  {15, 20},      {-11.5, 21}, {-39, 22},
                                                {-68, 23},  {-99, 24}, {-132, 25},    {-167, 26}};

double skg_spine_depth(double z) {
    static const double knots[][2] = {{-300, -24}, {-167, -26}, {-107, -23}, {-72, -13}, {-35, -5},
                                      {-6, 0},     {20, 6},     {47, 9},     {71, 3},    {95, 1},
                                      {119, -8},   {143, -15},  {171, -27},  {200, -36}};
    return CURVE(knots, z);
}

/* The spine with rib heads and processes. It begins 17 mm in front of the middle of the bodies, is round over 16 mm
 * of depth, then 23 mm wide on each side, and widens to the back from 8 mm in front of the middle (mm, by its
 * surface). */
double skg_spine_inside(const double p[3], double gap) {
    double y = p[1] - skg_spine_depth(p[2]), start = -17 - gap;
    if (y < start) return -1;
    double widening = y > -8 ? 0.45 * (y + 8) : 0, width = (23 + gap) * sqrt(fmin(1, (y - start) / 16));
    return width + widening - fabs(p[0]);
}

/* Half axes and centre of the section at z. */
static void section(double z, double inset, double *a, double *b, double *centre) {
    double yf = CURVE(front, z) + inset, yb = CURVE(back, z) - inset;
    *a = CURVE(half_width, z) - inset, *b = 0.5 * (yb - yf), *centre = 0.5 * (yb + yf);
}

double skg_cage_inside(const double p[3], double inset) {
    double a, b, centre;
    section(p[2], inset, &a, &b, &centre);
    double r = pow(pow(fabs(p[0]) / a, roundness) + pow(fabs(p[1] - centre) / b, roundness), 1 / roundness);
    return (r - 1) * fmin(a, b);
}

void skg_cage_project(double p[3]) {
    double a, b, centre;
    section(p[2], 0, &a, &b, &centre);
    double r = pow(pow(fabs(p[0]) / a, roundness) + pow(fabs(p[1] - centre) / b, roundness), 1 / roundness);
    p[0] /= r, p[1] = centre + (p[1] - centre) / r;
}

double skg_cage_front(double x, double z) {
    double a, b, centre;
    section(z, 0, &a, &b, &centre);
    return centre - b * pow(fmax(0, 1 - pow(fabs(x) / a, roundness)), 1 / roundness);
}

double skg_cage_back(double x, double z) {
    double a, b, centre;
    section(z, 0, &a, &b, &centre);
    return centre + b * pow(1 - pow(x / a, roundness), 1 / roundness);
}
