/* Samples and materials of a CTSimU scenario that is written. Private. */
#ifndef SKG_SETUP_SCENARIO_PARTS_H
#define SKG_SETUP_SCENARIO_PARTS_H

#include "setup/types.h"

#include <jansson.h>

/* The stage of a scenario: its axes u, v, w as rows, w along the axis of rotation, and its centre. */
typedef struct {
    double axes[3][3], centre[3];
} skg_scenario_stage;

/* Adds samples and materials, and the material of the world. Each sample gets a mesh file beside the scenario, PATH's name with
 * -part-1.stl, from which its children are cut out, because samples of a scenario do not displace each other. */
skg_status skg_scenario_put_parts(const skg_setup *setup, const skg_scenario_stage *stage, const char *path,
                                  json_t *scenario);

#endif
