/* The surface on which the ribs lie, the ribs' middle lines, and the spine. Sizes: aggregates of the surfaces
 * of BodyParts3D (one man, lying), to about 5 mm. */
#include "phantom/thorax.h"

#include "core/vector.h"

#include <string.h>

/* z, half width; z, y of the front; z, y of the back (mm) */
static const double half_width[][2] = {{-300, 122}, {-200, 126}, {-158, 128}, {-119, 131}, {-84, 133},
                                       {-43, 136},  {-6, 134},   {30, 128},   {59, 121},   {95, 109},
                                       {125, 94},   {141, 78},   {157, 66},   {175, 54},   {200, 44}};
static const double front[][2] = {{-300, -132}, {-180, -136}, {-100, -142}, {-51, -144},
                                  {-9, -142},   {18, -134},   {50, -123},   {84, -109},
                                  {110, -97},   {137, -82},   {160, -72},   {200, -60}};
static const double back[][2] = {{-300, 28}, {-180, 31}, {-107, 36}, {-50, 42}, {0, 45},
                                 {47, 45},   {95, 38},   {143, 23},  {171, 6},  {200, -8}};
#define CURVE(knots, x) skg_shape_curve(knots, (int)(sizeof(knots) / sizeof *(knots)), x)

static const double roundness = 2.3; /* exponent of the cage's sections */

const double skg_spine_body[SPINE_BODIES][2] = {{170, 15},  {150, 16}, {129.5, 16.5}, {108, 17},   {86, 17.5},
                                                {63.5, 18}, {40, 19},  {15, 20},      {-11.5, 21}, {-39, 22},
                                                {-68, 23},  {-99, 24}, {-132, 25},    {-167, 26}};

double skg_spine_depth(double z) {
    static const double knots[][2] = {{-300, -24}, {-167, -26}, {-107, -23}, {-72, -13}, {-35, -5},
                                      {-6, 0},     {20, 6},     {47, 9},     {71, 3},    {95, 1},
                                      {119, -8},   {143, -15},  {171, -27},  {200, -36}};
    return CURVE(knots, z);
}

/* |x| of the spine with rib heads and processes widens to the back; its front is round. */
double skg_spine_inside(const double p[3], double gap) {
    double y = p[1] - skg_spine_depth(p[2]), start = -17 - gap;
    if (y < start) return -1;
    double widening = y > -8 ? 0.45 * (y + 8) : 0, width = (23 + gap) * sqrt(fmin(1, (y - start) / 16));
    return width + widening - fabs(p[0]);
}

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

/* Left ribs: head, point at half the length, most lateral point, anterior end; section in mm2. (Rib 12 is
 * 6 mm lower than measured: on the cage it would touch rib 11.) */
static const struct {
    double point[4][3], section;
} rib_table[RIBS] = {{{{15, -19, 171}, {53, -33, 157}, {67, -48, 141}, {51, -77, 124}}, 60},
                     {{{16, -14, 157}, {84, -37, 132}, {95, -37, 125}, {42, -104, 84}}, 77},
                     {{{17, -5, 143}, {102, -26, 106}, {107, -32, 95}, {49, -114, 50}}, 74},
                     {{{16, -2, 119}, {112, -20, 78}, {120, -46, 59}, {66, -130, 18}}, 89},
                     {{{15, 10, 95}, {119, -18, 47}, {125, -47, 30}, {77, -140, -9}}, 101},
                     {{{16, 11, 71}, {123, -8, 19}, {133, -46, -6}, {91, -135, -51}}, 103},
                     {{{17, 18, 47}, {121, -1, -13}, {135, -55, -43}, {107, -121, -82}}, 107},
                     {{{17, 14, 20}, {111, 5, -42}, {129, -51, -84}, {112, -104, -117}}, 88},
                     {{{18, 8, -6}, {104, 20, -72}, {127, -47, -119}, {118, -78, -145}}, 85},
                     {{{19, 2, -35}, {94, 20, -104}, {126, -44, -158}, {117, -61, -181}}, 74},
                     {{{21, -5, -72}, {76, 21, -129}, {114, -40, -185}, {109, -43, -194}}, 59},
                     {{{20, -16, -107}, {46, 21, -150}, {66, 9, -194}, {64, 11, -200}}, 51}};

/* From the head beside the spine backward to the angle, which is on the cage, and along the cage. */
static skg_status rib_line(int k, skg_rib *rib) {
    const double ratio = 1.6, pi = 3.14159265358979323846; /* 12 to 14 mm high, 7 to 9 thick */
    rib->width = sqrt(rib_table[k].section / (pi * ratio)), rib->height = ratio * rib->width;
    double p[5][3];
    memcpy(p[0], rib_table[k].point[0], sizeof p[0]);
    p[0][0] += 9; /* clear of the body, whose half width is up to 20 */
    for (int i = 1; i < 4; i++) memcpy(p[i + 1], rib_table[k].point[i], sizeof p[i]);
    p[1][0] = fmax(0.45 * p[2][0], p[0][0] + 8);
    p[1][2] = p[0][2] - 0.2 * (p[0][2] - p[2][2]);
    double a, b, centre;
    section(p[1][2], 0, &a, &b, &centre);
    p[1][1] = centre + b * pow(1 - pow(p[1][0] / a, roundness), 1 / roundness);
    int points = 5;
    if (k >= 10)
        memcpy(p[3], p[4], sizeof p[3]), points = 4; /* the ends are so near that the rib would fold */
    for (int i = 2; i < points; i++) skg_cage_project(p[i]);
    SKG_TRY(skg_shape_spline((const double(*)[3])p, points, RIB_POINTS, rib->line));
    int behind = 1;
    for (int i = 0; i < RIB_POINTS; i++) {
        behind = behind && rib->line[i][0] < p[1][0];
        if (!behind) skg_cage_project(rib->line[i]);
    }
    return SKG_OK;
}

double skg_rib_distance(const skg_thorax_plan *plan, const double p[3]) {
    double least = HUGE_VAL;
    for (int k = 0; k < RIBS; k++)
        for (int i = 0; i < RIB_POINTS; i++) {
            const double *q = plan->rib[k].line[i];
            double x = fabs(p[0]) - q[0], y = p[1] - q[1], z = p[2] - q[2], d = x * x + y * y + z * z;
            if (d < least) least = d;
        }
    return sqrt(least);
}

skg_status skg_cage_plan(double resolution, skg_thorax_plan *plan) {
    plan->resolution = resolution;
    for (int k = 0; k < RIBS; k++) SKG_TRY(rib_line(k, plan->rib + k));
    skg_dome_rim(plan);
    return SKG_OK;
}
