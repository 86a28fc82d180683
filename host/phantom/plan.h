/* The measures of the generated thorax that the makers of its parts share. Private. */
#ifndef SKG_PHANTOM_PLAN_H
#define SKG_PHANTOM_PLAN_H

#include "phantom/dome.h"
#include "phantom/ellipsoid.h"
#include "phantom/ribs.h"

typedef struct {
    double resolution;  /* 1: about 42,000 triangles; lengths of edges go with 1/resolution */
    double gap;         /* mm that organs keep to each other */
    skg_rib rib[RIBS];  /* rib[k] is number k + 1 */
    skg_dome diaphragm; /* its middle surface */
} skg_thorax_plan;

skg_status skg_thorax_plan_fill(double resolution, skg_thorax_plan *plan);

extern const skg_ellipsoid skg_heart;

#endif
