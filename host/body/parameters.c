#include "body/parameters.h"

#include "core/core.h"
#include "core/names.h"

#include <stdio.h>
#include <string.h>

/* Ranges: what is seen in people for the tendon, about the paper's values for tissues, and what keeps links between
 * neighbours for their reach. All are choices. */
const skg_parameter_kind skg_parameter_kinds[BODY_PARAMETERS] = {
    {"tendon-x", "tendon", "mm", -12, 12, -57, 57},
    {"tendon-y", "tendon", "mm", -12, 12, -57, 57},
    {"tendon-z", "tendon", "mm", -40, 5, -57, 57}, /* the tendon may go 100 mm in all */
    {"plane-azimuth", "plane", "degrees", 0, 180, -180, 360},
    {"plane-elevation", "plane", "degrees", 10, 90, -90, 90},
    {"plane-offset", "plane", "mm", 0, 0.6, -1000, 1000},
    {"diaphragm-alpha-min", "diaphragm", "", 0.5, 1, 0, 1},
    {"diaphragm-alpha-max", "diaphragm", "", 1, 1.5, 1, 100},
    {"diaphragm-beta", "diaphragm", "", 0, 0.5, 0, 100},
    {"liver-alpha-min", "liver", "", 0.5, 1, 0, 1},
    {"liver-alpha-max", "liver", "", 1, 1.5, 1, 100},
    {"liver-beta", "liver", "", 0, 0.5, 0, 100},
    {"diaphragm-ribs", "links", "mm", 1, 30, 1e-3, 1000},
    {"diaphragm-liver", "links", "mm", 1, 20, 1e-3, 1000},
};

/* Names, and with_groups groups, separated by commas. */
static void list_names(int with_groups, char *text, size_t size) {
    size_t at = 0;
    for (int p = 0; p < BODY_PARAMETERS; p++)
        at += (size_t)snprintf(text + at, size - at, "%s%s", p ? ", " : "", skg_parameter_kinds[p].name);
    if (with_groups) snprintf(text + at, size - at, ", tendon, plane, diaphragm, liver, links");
}

/* Fails with the nearest name, and all of them. */
static skg_status refuse(const char *name, int with_groups) {
    const char *known[2 * BODY_PARAMETERS];
    char list[512];
    for (int p = 0; p < BODY_PARAMETERS; p++) {
        known[p] = skg_parameter_kinds[p].name;
        known[BODY_PARAMETERS + p] = skg_parameter_kinds[p].group;
    }
    const char *nearest = skg_nearest_name(name, known, with_groups ? 2 * BODY_PARAMETERS : BODY_PARAMETERS);
    list_names(with_groups, list, sizeof list);
    return skg_fail(SKG_ERR_ARGUMENT, "there is no parameter \"%s\"%s%s%s Known are %s", name,
                    nearest ? "; did you mean " : "", nearest ? nearest : "", nearest ? "?" : ".", list);
}

skg_status skg_parameters_choose(const char *word, int32_t *chosen) {
    int found = 0;
    for (int p = 0; p < BODY_PARAMETERS; p++) {
        const skg_parameter_kind *kind = skg_parameter_kinds + p;
        if (strcmp(word, kind->name) == 0 || strcmp(word, kind->group) == 0) chosen[p] = found = 1;
    }
    return found ? SKG_OK : refuse(word, 1);
}

skg_status skg_parameter_find(const char *name, int *parameter) {
    for (int p = 0; p < BODY_PARAMETERS; p++) {
        *parameter = p;
        if (strcmp(name, skg_parameter_kinds[p].name) == 0) return SKG_OK;
    }
    return refuse(name, 0);
}

skg_status skg_parameter_check_range(int parameter, double low, double high) {
    const skg_parameter_kind *kind = skg_parameter_kinds + parameter;
    if (low >= kind->least && high <= kind->greatest && low < high) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s from %g to %g; a range rises, and lies within %g to %g", kind->name,
                    low, high, kind->least, kind->greatest);
}
