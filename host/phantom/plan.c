#include "phantom/plan.h"

#include <math.h>

const skg_ellipsoid skg_heart = {{20, -78, 40}, {66, 45, 45}, {0.76, -0.25, -0.60}};

skg_status skg_thorax_plan_fill(double resolution, skg_thorax_plan *plan) {
    plan->resolution = resolution;
    /* The larger the facets, the deeper they cut into a convex neighbour; 1.2 mm is a choice. */
    plan->gap = fmax(1.2, 1.5 / resolution);
    for (int k = 0; k < RIBS; k++) SKG_TRY(skg_rib_fill(k, plan->rib + k));
    skg_dome_fill(&plan->diaphragm);
    return SKG_OK;
}
