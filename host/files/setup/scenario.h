/* Scenes that are written as CTSimU scenarios: the pieces of the file. Private. */
#ifndef SKG_SETUP_SCENARIO_H
#define SKG_SETUP_SCENARIO_H

#include "setup/types.h"

#include <jansson.h>

/* The stage of a scenario: its axes u, v, w as rows, w along the axis of rotation, and its centre. */
typedef struct {
    double axes[3][3], centre[3];
} skg_scenario_stage;

/* {"value": number, "unit": unit}; unit NULL: none. */
json_t *skg_scenario_number(double value, const char *unit);

/* A vector by the names of its components, "xyz" or "uvw". */
json_t *skg_scenario_vector(const double *vector, const char *names, const char *unit);

/* Adds samples and materials, and the material of the world. Each sample gets a mesh file beside the scenario, PATH's name with
 * -part-1.stl, from which its children are cut out, because samples of a scenario do not displace each other. */
skg_status skg_scenario_put_parts(const skg_setup *setup, const skg_scenario_stage *stage, const char *path,
                                  json_t *scenario);

/* The name of a file beside the scenario at `path`: "box-part-1.stl" of "box.ctsimu.json"; whole: with its folder. */
skg_status skg_scenario_name(const char *path, const char *ending, int whole, char *name, size_t size);

#endif
