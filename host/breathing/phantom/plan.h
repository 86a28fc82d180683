/* The measures of the generated thorax that the makers of its parts share. Private. */
#ifndef SKG_PHANTOM_PLAN_H
#define SKG_PHANTOM_PLAN_H

#include "phantom/dome.h"
#include "phantom/ribs.h"
#include "phantom/vessels.h"

typedef struct {
    int simple;                 /* 1: the simple thorax */
    double resolution;          /* lengths of edges go with 1/resolution */
    double gap;                 /* mm that organs keep to each other */
    skg_rib rib[RIBS];          /* rib[k] is number k + 1 */
    skg_dome diaphragm;         /* its middle surface */
    skg_vessel vessel[VESSELS]; /* of the thorax that is not simple */
} skg_thorax_plan;

skg_status skg_thorax_plan_fill(int simple, double resolution, skg_thorax_plan *plan);

#endif
