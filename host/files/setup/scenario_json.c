/* Values of a CTSimU scenario that is written, and the names of its files. */
#include "setup/scenario_json.h"

#include <stdio.h>
#include <string.h>

const char skg_scenario_ending[] = ".ctsimu.json";

json_t *skg_scenario_number(double value, const char *unit) {
    return unit ? json_pack("{s:f, s:s}", "value", value, "unit", unit) : json_pack("{s:f}", "value", value);
}

json_t *skg_scenario_vector(const double *vector, const char *names, const char *unit) {
    json_t *object = json_object();
    for (int k = 0; k < 3; k++) {
        const char name[2] = {names[k], '\0'};
        json_object_set_new(object, name, skg_scenario_number(vector[k], unit));
    }
    return object;
}

skg_status skg_scenario_name(const char *path, const char *ending, int whole, char *name, size_t size) {
    const char *slash = strrchr(path, '/'), *from = whole || !slash ? path : slash + 1;
    const int stem = (int)(strlen(from) - strlen(skg_scenario_ending));
    if ((size_t)snprintf(name, size, "%.*s%s", stem, from, ending) < size) return SKG_OK;
    return skg_fail(SKG_ERR_OUTPUT, "%s: its name is too long", path);
}
