/* The shape of the heart. */
#include "phantom/anatomy.h"

#include "phantom/shapes.h"

#include <math.h>

static const skg_ellipsoid simple_heart = {{20, -78, 40}, {66, 45, 45}, {0.76, -0.25, -0.60}};

/* Left ventricle with the apex, right ventricle, right atrium (the right border), left atrium. Places are typical of a
 * frontal image: the right border lies 40 mm to the right of the midline, the apex 85 mm to the left. */
static const skg_ellipsoid chamber[] = {{{42, -80, 28}, {54, 44, 40}, {0.72, -0.38, -0.50}},
                                        {{16, -97, 23}, {49, 28, 34}, {1, -0.10, -0.28}},
                                        {{-17, -76, 39}, {32, 26, 28}, {0.15, 0.1, 1}},
                                        {{4, -51, 49}, {36, 20, 24}, {1, 0, 0}},
                                        {{26, -84, 58}, {24, 22, 24}, {0.2, -0.2, 1}}};
enum { CHAMBERS = sizeof chamber / sizeof *chamber };

double skg_heart_inside(const skg_thorax_plan *plan, const double p[3], double larger) {
    static const double rounding = 5; /* mm over which one chamber goes over into the next */
    double sum = 0;
    if (plan->simple) return skg_ellipsoid_inside(&simple_heart, p, larger);
    for (int c = 0; c < CHAMBERS; c++)
        sum += exp(-fmax(skg_ellipsoid_inside(chamber + c, p, 0), -60) / rounding);
    return -rounding * log(sum + 1e-30) - larger;
}
