/* The great vessels and those of the lungs. */
#include "phantom/anatomy.h"

#include "core/maths.h"
#include "phantom/shapes.h"

#include <math.h>
#include <string.h>

enum { POINTS_MAX = 9 };

/* Points of the middle lines and radii of the ends, mm. The descending aorta is that of BodyParts3D; the others are
 * placed by the usual relations of the mediastinum, with typical radii. The aorta ends above the diaphragm. */
static const struct {
    const char *label;
    double hounsfield;
    int points;
    double point[POINTS_MAX][3], radius[2];
    double rings;
} table[VESSELS] = {
    {"aorta",
     45,
     9,
     {{-3, -74, 119},
      {6, -66, 122},
      {17, -55, 122},
      {28, -39, 116},
      {31, -24, 103},
      {27, -16, 84},
      {20, -14, 51},
      {18, -20, 15},
      {16, -32, -38}},
     {12.5, 9.5},
     20},
    {"ascending aorta", 45, 3, {{-2, -72, 76}, {-10, -77, 88}, {-9.5, -77, 102}}, {12.5, 12.5}, 6},
    {"vena cava superior", 45, 3, {{-22, -62, 142}, {-30, -68, 105}, {-31, -71, 76}}, {7, 8}, 8},
    {"brachiocephalic vein left", 45, 3, {{-10, -76, 143}, {12, -79, 144}, {30, -74, 150}}, {6, 5}, 6},
    {"pulmonary trunk", 45, 3, {{19, -86, 78}, {22, -80, 88}, {24, -71, 95}}, {12, 11}, 5},
    {"pulmonary artery left", 45, 3, {{26, -56, 95}, {36, -42, 92}, {47, -32, 84}}, {9, 7.5}, 6},
    {"pulmonary artery right", 45, 3, {{8, -60, 88}, {-14, -57, 85}, {-42, -46, 77}}, {8, 7.5}, 8},
    {"oesophagus",
     35,
     5,
     {{2, -39, 166}, {1, -28, 130}, {0, -23, 100}, {-3, -18, 60}, {-2, -27, 5}},
     {2.4, 5},
     14}};

skg_status skg_vessels_fill(skg_vessel vessels[VESSELS]) {
    for (int v = 0; v < VESSELS; v++) {
        SKG_TRY(skg_shape_spline(table[v].point, table[v].points, VESSEL_POINTS, vessels[v].line));
        vessels[v].label = table[v].label, vessels[v].hounsfield = table[v].hounsfield;
        vessels[v].rings = table[v].rings;
        memcpy(vessels[v].radius, table[v].radius, sizeof vessels[v].radius);
        const double most = fmax(table[v].radius[0], table[v].radius[1]);
        for (int k = 0; k < 3; k++) vessels[v].low[k] = HUGE_VAL, vessels[v].high[k] = -HUGE_VAL;
        for (int i = 0; i < VESSEL_POINTS; i++)
            for (int k = 0; k < 3; k++) {
                vessels[v].low[k] = fmin(vessels[v].low[k], vessels[v].line[i][k] - most);
                vessels[v].high[k] = fmax(vessels[v].high[k], vessels[v].line[i][k] + most);
            }
    }
    return SKG_OK;
}

double skg_vessel_distance(const skg_vessel vessels[VESSELS], const double p[3]) {
    double least = 30;
    for (int v = 0; v < VESSELS; v++) {
        const skg_vessel *vessel = vessels + v;
        int far = 0;
        for (int k = 0; k < 3; k++) far |= p[k] < vessel->low[k] - least || p[k] > vessel->high[k] + least;
        for (int i = 0; i < VESSEL_POINTS && !far; i++) {
            double d[3], t = (double)i / (VESSEL_POINTS - 1);
            skg_add_scaled(p, -1, vessel->line[i], d);
            least =
                fmin(least, skg_length(d) - vessel->radius[0] - t * (vessel->radius[1] - vessel->radius[0]));
        }
    }
    return least;
}
