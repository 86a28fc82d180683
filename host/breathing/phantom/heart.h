/* The heart's shape. Private. */
#ifndef SKG_HEART_H
#define SKG_HEART_H

#include "phantom/plan.h"

/* <= 0 inside the heart enlarged by `larger` mm, outside about the distance in mm. */
double skg_heart_inside(const skg_thorax_plan *plan, const double point[3], double larger);

#endif
