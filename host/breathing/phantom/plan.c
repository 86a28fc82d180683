/* The measures of the generated thorax, from its options. */
#include "phantom/anatomy.h"

#include <math.h>

skg_status skg_thorax_plan_fill(int simple, double resolution, skg_thorax_plan *plan) {
    plan->simple = simple;
    plan->resolution = resolution;
    /* The larger the facets, the deeper they cut into a convex neighbour; 1.2 mm is a choice. */
    plan->gap = fmax(1.2, 1.5 / resolution);
    for (int k = 0; k < RIBS; k++) SKG_TRY(skg_rib_fill(k, simple, plan->rib + k));
    skg_dome_fill(&plan->diaphragm);
    return skg_vessels_fill(plan->vessel);
}
