#include "fit/parameters.h"

#include "body/link.h"
#include "body/near.h"
#include "body/rules.h"
#include "core/maths.h"
#include "core/vector.h"

#include <string.h>

/* Ranges: what is seen in people for the tendon, about the paper's values for tissues, and what keeps links between
 * neighbours for their reach. All are choices. */
const skg_fit_kind skg_fit_kinds[FIT_PARAMETERS] = {
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

static const double degree = SKG_PI / 180;

/* The middle of the diaphragm's bounds, at their top: from there the offset counts downward along the normal. */
static void origin_of(const double *bounds, double origin[3]) {
    for (int k = 0; k < 2; k++) origin[k] = 0.5 * (bounds[k] + bounds[3 + k]);
    origin[2] = bounds[5];
}

void skg_fit_plane(const double *bounds, const double *values, double plane[4]) {
    const double azimuth = values[FIT_AZIMUTH] * degree, elevation = values[FIT_ELEVATION] * degree;
    double origin[3];
    origin_of(bounds, origin);
    plane[0] = cos(elevation) * cos(azimuth);
    plane[1] = cos(elevation) * sin(azimuth);
    plane[2] = sin(elevation);
    plane[3] = values[FIT_OFFSET] - skg_dot(plane, origin);
}

static void get_plane(const skg_body *body, double *values) {
    const skg_body_organ *diaphragm = body->organ + skg_find_organ(body, "diaphragm");
    const double *plane = body->options.tendon_plane, length = skg_length(plane);
    double origin[3];
    origin_of(diaphragm->bounds, origin);
    values[FIT_AZIMUTH] = atan2(plane[1], plane[0]) / degree;
    values[FIT_ELEVATION] = asin(fmin(fmax(plane[2] / length, -1), 1)) / degree;
    values[FIT_OFFSET] = (plane[3] + skg_dot(plane, origin)) / length;
}

static void get_tissue(const skg_body *body, const char *word, double *values) {
    const int32_t organ = skg_find_organ(body, word);
    const skg_tissue tissue = organ < 0 ? skg_tissue_of(word) : body->organ[organ].tissue;
    values[0] = tissue.alpha_min, values[1] = tissue.alpha_max, values[2] = tissue.beta;
}

void skg_fit_values_get(const skg_body *body, double *values) {
    memcpy(values + FIT_TENDON, body->options.tendon_mm, 3 * sizeof *values);
    get_plane(body, values);
    get_tissue(body, "diaphragm", values + FIT_DIAPHRAGM);
    get_tissue(body, "liver", values + FIT_LIVER);
    values[FIT_RIBS] = skg_diaphragm_ribs_reach(&body->options);
    values[FIT_REACH] = skg_diaphragm_liver_reach(&body->options);
}

/* Whether one of several neighbouring parameters is chosen. */
static int any(const int32_t *chosen, int first, int count) {
    int one = 0;
    for (int k = first; k < first + count; k++) one |= chosen[k];
    return one;
}

static void set_tissue(skg_body *body, const char *word, const double *values) {
    const int32_t organ = skg_find_organ(body, word);
    if (organ >= 0) body->organ[organ].tissue = (skg_tissue){values[0], values[1], values[2]};
}

skg_status skg_fit_values_set(skg_body *body, const int32_t *chosen, const double *values) {
    const skg_body_organ *diaphragm = body->organ + skg_find_organ(body, "diaphragm");
    skg_body_options *options = &body->options;
    if (any(chosen, FIT_TENDON, 3)) memcpy(options->tendon_mm, values + FIT_TENDON, 3 * sizeof *values);
    if (any(chosen, FIT_AZIMUTH, 3)) skg_fit_plane(diaphragm->bounds, values, options->tendon_plane);
    if (any(chosen, FIT_DIAPHRAGM, 3)) set_tissue(body, "diaphragm", values + FIT_DIAPHRAGM);
    if (any(chosen, FIT_LIVER, 3)) set_tissue(body, "liver", values + FIT_LIVER);
    if (chosen[FIT_RIBS]) options->diaphragm_ribs_mm = values[FIT_RIBS];
    if (chosen[FIT_REACH]) options->diaphragm_liver_mm = values[FIT_REACH];
    return any(chosen, FIT_AZIMUTH, FIT_PARAMETERS - FIT_AZIMUTH) ? skg_body_find_links_again(body) : SKG_OK;
}
