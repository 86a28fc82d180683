/* The courses of the ribs. */
#include "phantom/anatomy.h"

#include "core/maths.h"
#include "phantom/shapes.h"

#include <string.h>

/* Left ribs: head, point at half the length, most lateral point, anterior end; area of the section in mm2. Aggregates
 * of the surfaces of BodyParts3D, but that rib 12 is 6 mm lower: on the cage it would touch rib 11. */
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

/* Rounds the corner where a line meets the cage, over about 10 mm: means of three neighbours, their middle twice. */
static void round_angle(double (*line)[3]) {
    for (int pass = 0; pass < 16; pass++) {
        double before[3];
        memcpy(before, line[0], sizeof before);
        for (int i = 1; i + 1 < RIB_POINTS; i++)
            for (int k = 0; k < 3; k++) {
                const double here = line[i][k];
                line[i][k] = 0.25 * before[k] + 0.5 * here + 0.25 * line[i + 1][k];
                before[k] = here;
            }
    }
}

skg_status skg_rib_fill(int k, int simple, skg_rib *rib) {
    const double ratio = 1.6; /* of height to thickness: ribs are 12 to 14 mm high and 7 to 9 mm thick */
    rib->width = sqrt(rib_table[k].section / (SKG_PI * ratio)), rib->height = ratio * rib->width;
    double p[5][3];
    memcpy(p[0], rib_table[k].point[0], sizeof p[0]);
    p[0][0] += 9; /* mm; clear of the vertebra's body, whose half width is up to 21 mm */
    for (int i = 1; i < 4; i++) memcpy(p[i + 1], rib_table[k].point[i], sizeof p[i]);
    /* The angle, where a rib turns forward, is no measured point: it is placed on the cage at 0.45 of the way to the
     * side and a fifth of the way down. */
    p[1][0] = fmax(0.45 * p[2][0], p[0][0] + 8);
    p[1][2] = p[0][2] - 0.2 * (p[0][2] - p[2][2]);
    p[1][1] = skg_cage_back(p[1][0], p[1][2]);
    if (!simple) /* or the neck would be seen end-on from the front */
        for (int pass = 0; pass < 4; pass++) {
            p[1][0] = fmin(p[0][0] + 1.1 * (p[1][1] - p[0][1]), fmax(0.8 * p[2][0], p[0][0] + 8));
            p[1][1] = skg_cage_back(p[1][0], p[1][2]);
        }
    int points = 5;
    /* The last two points of ribs 11 and 12 are so near each other that the rib would fold. */
    if (k >= 10) memcpy(p[3], p[4], sizeof p[3]), points = 4;
    for (int i = 2; i < points; i++) skg_cage_project(p[i]);
    if (!simple && k == 11) /* it has no angle */
        for (int i = 0; i < 3; i++) p[1][i] = 0.45 * p[0][i] + 0.55 * p[2][i] + (i == 1 ? 5 : 0);
    SKG_TRY(skg_shape_spline((const double(*)[3])p, points, RIB_POINTS, rib->line));
    int behind = 1;
    for (int i = 0; i < RIB_POINTS; i++) {
        behind = behind && rib->line[i][0] < (simple || k < 11 ? p[1][0] : p[2][0]);
        if (!behind) skg_cage_project(rib->line[i]);
    }
    if (!simple) round_angle(rib->line);
    return SKG_OK;
}

double skg_rib_distance(const skg_rib ribs[RIBS], const double p[3]) {
    double least = HUGE_VAL;
    for (int k = 0; k < RIBS; k++)
        for (int i = 0; i < RIB_POINTS; i++) {
            const double *q = ribs[k].line[i];
            double x = fabs(p[0]) - q[0], y = p[1] - q[1], z = p[2] - q[2], d = x * x + y * y + z * z;
            if (d < least) least = d;
        }
    return sqrt(least);
}
