/* The parameters of a body that can be fitted: names, units and ranges. */
#include "body/parameters.h"

#include "core/core.h"
#include "core/text.h"

#include <skiagraph/body.h>

#include <stdio.h>
#include <string.h>

enum { ANATOMY = 1 << SKG_COUPLING_ANATOMICAL, PAPER = 1 << SKG_COUPLING_PAPER, BOTH = ANATOMY | PAPER };

/* Ranges: what is seen in people for tendon, domes and ribs, about the paper's values for tissues, and what keeps links
 * between neighbours for their reach. All are choices. */
const skg_parameter_kind skg_parameter_kinds[BODY_PARAMETERS] = {
    {"tendon-x", "tendon", "mm", -12, 12, -57, 57, BOTH, 1},
    {"tendon-y", "tendon", "mm", -12, 12, -57, 57, BOTH, 1},
    {"tendon-z", "tendon", "mm", -40, 5, -57, 57, BOTH, 1}, /* the tendon may go 100 mm in all */
    {"plane-azimuth", "plane", "degrees", 0, 180, -180, 360, PAPER, 0},
    {"plane-elevation", "plane", "degrees", 10, 90, -90, 90, PAPER, 0},
    {"plane-offset", "plane", "mm", 0, 0.6, -1000, 1000, PAPER, 0},
    {"diaphragm-alpha-min", "diaphragm", "", 0.5, 1, 0, 1, BOTH, 0},
    {"diaphragm-alpha-max", "diaphragm", "", 1, 1.5, 1, 100, BOTH, 0},
    {"diaphragm-beta", "diaphragm", "", 0, 0.5, 0, 100, BOTH, 0},
    {"liver-alpha-min", "liver", "", 0.5, 1, 0, 1, BOTH, 0},
    {"liver-alpha-max", "liver", "", 1, 1.5, 1, 100, BOTH, 0},
    {"liver-beta", "liver", "", 0, 0.5, 0, 100, BOTH, 0},
    {"diaphragm-ribs", "links", "mm", 1, 30, 1e-3, 1000, PAPER, 0},
    {"diaphragm-liver", "links", "mm", 1, 20, 1e-3, 1000, PAPER, 0},
    {"dome-left", "domes", "mm", -10, 15, -57, 57, ANATOMY, 1},
    {"dome-right", "domes", "mm", -10, 15, -57, 57, ANATOMY, 1},
    {"dome-back", "domes", "mm", -10, 15, -57, 57, ANATOMY, 1},
    {"muscle-length", "muscle", "", 0.5, 1, 0.1, 1, ANATOMY, 1},
    {"rib-angle", "ribs", "degrees", 5, 25, 0, 45, ANATOMY, 1},
    {"rib-fall", "ribs", "degrees", -1, 1, -5, 5, ANATOMY, 1},
    {"liver-follows", "follow", "", 0.6, 1.2, 0, 2, ANATOMY, 1},
    {"liver-held", "follow", "", 0, 0.6, 0, 1, ANATOMY, 1},
};

/* Names of parameters that have an effect with one of some couplings, and with_groups groups, separated by commas. */
static void list_names(unsigned couplings, int with_groups, char *text, size_t size) {
    size_t at = 0;
    for (int p = 0; p < BODY_PARAMETERS; p++)
        if (skg_parameter_kinds[p].couplings & couplings)
            at += (size_t)snprintf(text + at, size - at, "%s%s", at ? ", " : "", skg_parameter_kinds[p].name);
    if (with_groups)
        snprintf(text + at, size - at,
                 ", tendon, plane, diaphragm, liver, links, domes, muscle, ribs, follow");
}

/* Fails with the nearest name, and all of them. */
static skg_status refuse(const char *name, int with_groups) {
    const char *known[2 * BODY_PARAMETERS];
    char list[768];
    for (int p = 0; p < BODY_PARAMETERS; p++) {
        known[p] = skg_parameter_kinds[p].name;
        known[BODY_PARAMETERS + p] = skg_parameter_kinds[p].group;
    }
    const char *nearest = skg_nearest_name(name, known, with_groups ? 2 * BODY_PARAMETERS : BODY_PARAMETERS);
    list_names(BOTH, with_groups, list, sizeof list);
    return skg_fail(SKG_ERR_ARGUMENT, "there is no parameter \"%s\"%s%s%s Known are %s", name,
                    nearest ? "; did you mean " : "", nearest ? nearest : "", nearest ? "?" : ".", list);
}

skg_status skg_parameters_choose(const char *word, int32_t *chosen) {
    int found = 0;
    for (int p = 0; p < BODY_PARAMETERS; p++) {
        const skg_parameter_kind *kind = skg_parameter_kinds + p;
        if (strcmp(word, kind->group) == 0 && !chosen[p]) chosen[p] = BODY_BY_GROUP;
        if (strcmp(word, kind->name) == 0) chosen[p] = BODY_BY_NAME;
        found |= strcmp(word, kind->name) == 0 || strcmp(word, kind->group) == 0;
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

int skg_parameter_is_of(int parameter, int coupling) {
    return (skg_parameter_kinds[parameter].couplings >> coupling & 1) != 0;
}

skg_status skg_parameter_check_coupling(int parameter, int coupling) {
    char list[768];
    if (skg_parameter_is_of(parameter, coupling)) return SKG_OK;
    list_names(1U << coupling, 0, list, sizeof list);
    return skg_fail(
        SKG_ERR_ARGUMENT,
        "fit: %s has no effect on this body: with the coupling \"%s\" (key Breathing.Coupling) there are %s",
        skg_parameter_kinds[parameter].name, coupling == SKG_COUPLING_PAPER ? "Paper" : "Anatomical", list);
}
