/* Values of a CTSimU scenario that is written, and the names of its files. Private. */
#ifndef SKG_SETUP_SCENARIO_JSON_H
#define SKG_SETUP_SCENARIO_JSON_H

#include "core/core.h"

#include <jansson.h>

extern const char skg_scenario_ending[]; /* .ctsimu.json */

/* {"value": number, "unit": unit}; unit NULL: none. */
json_t *skg_scenario_number(double value, const char *unit);

/* A vector by the names of its components, "xyz" or "uvw". */
json_t *skg_scenario_vector(const double *vector, const char *names, const char *unit);

/* The name of a file beside the scenario at `path`: "box-part-1.stl" of "box.ctsimu.json"; whole: with its folder. */
skg_status skg_scenario_name(const char *path, const char *ending, int whole, char *name, size_t size);

#endif
