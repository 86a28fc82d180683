/* The parameters of a fit: read from a body, and set in it. */
#include "fit/types.h"

#include "body/build.h"
#include "body/links.h"
#include "core/maths.h"

#include <string.h>

static const double degree = SKG_PI / 180;

/* The middle of the diaphragm's bounds, at their top: from there the offset counts downward along the normal. */
static void origin_of(const double *bounds, double origin[3]) {
    for (int k = 0; k < 2; k++) origin[k] = 0.5 * (bounds[k] + bounds[3 + k]);
    origin[2] = bounds[5];
}

void skg_fit_plane(const double *bounds, const double *values, double plane[4]) {
    const double azimuth = values[BODY_AZIMUTH] * degree, elevation = values[BODY_ELEVATION] * degree;
    double origin[3];
    origin_of(bounds, origin);
    plane[0] = cos(elevation) * cos(azimuth);
    plane[1] = cos(elevation) * sin(azimuth);
    plane[2] = sin(elevation);
    plane[3] = values[BODY_OFFSET] - skg_dot(plane, origin);
}

static void get_plane(const skg_body *body, double *values) {
    const skg_body_organ *diaphragm = body->organ + skg_find_organ(body, "diaphragm");
    const double *plane = body->options.tendon_plane, length = skg_length(plane);
    double origin[3];
    origin_of(diaphragm->bounds, origin);
    values[BODY_AZIMUTH] = atan2(plane[1], plane[0]) / degree;
    values[BODY_ELEVATION] = asin(fmin(fmax(plane[2] / length, -1), 1)) / degree;
    values[BODY_OFFSET] = (plane[3] + skg_dot(plane, origin)) / length;
}

static void get_tissue(const skg_body *body, const char *word, double *values) {
    const int32_t organ = skg_find_organ(body, word);
    const skg_tissue tissue = organ < 0 ? skg_tissue_of(word) : body->organ[organ].tissue;
    values[0] = tissue.alpha_min, values[1] = tissue.alpha_max, values[2] = tissue.beta;
}

static void get_anatomy(const skg_body_options *options, double *values) {
    values[BODY_DOMES] = options->dome_left_mm, values[BODY_DOMES + 1] = options->dome_right_mm;
    values[BODY_DOMES + 2] = options->dome_back_mm;
    values[BODY_MUSCLE] = options->muscle_length;
    values[BODY_RIB_ANGLE] = options->rib_angle_rad / degree;
    values[BODY_RIB_FALL] = options->rib_fall_rad / degree;
    values[BODY_FOLLOWS] = options->liver_follows, values[BODY_HELD] = options->liver_held;
}

static void set_anatomy(const int32_t *chosen, const double *values, skg_body_options *options) {
    const struct {
        int parameter;
        double *option, unit;
    } all[] = {
        {BODY_DOMES, &options->dome_left_mm, 1},           {BODY_DOMES + 1, &options->dome_right_mm, 1},
        {BODY_DOMES + 2, &options->dome_back_mm, 1},       {BODY_MUSCLE, &options->muscle_length, 1},
        {BODY_RIB_ANGLE, &options->rib_angle_rad, degree}, {BODY_RIB_FALL, &options->rib_fall_rad, degree},
        {BODY_FOLLOWS, &options->liver_follows, 1},        {BODY_HELD, &options->liver_held, 1}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (chosen[all[i].parameter]) *all[i].option = all[i].unit * values[all[i].parameter];
}

void skg_fit_values_get(const skg_body *body, double *values) {
    memcpy(values + BODY_TENDON, body->options.tendon_mm, 3 * sizeof *values);
    get_plane(body, values);
    get_tissue(body, "diaphragm", values + BODY_DIAPHRAGM);
    get_tissue(body, "liver", values + BODY_LIVER);
    get_anatomy(&body->options, values);
    values[BODY_RIBS] = skg_diaphragm_ribs_reach(&body->options);
    values[BODY_REACH] = skg_diaphragm_liver_reach(&body->options);
}

/* Whether one of several neighbouring parameters is chosen. */
static int any(const int32_t *chosen, int first, int count) {
    int one = 0;
    for (int k = first; k < first + count; k++) one |= chosen[k];
    return one;
}

static void set_tissue(skg_body *body, const char *word, const double *values) {
    const int32_t organ = skg_find_organ(body, word);
    if (organ < 0) return;
    body->organ[organ].tissue = (skg_tissue){values[0], values[1], values[2]};
    body->organ[organ].tissue_by_label = 0;
}

skg_status skg_fit_values_set(skg_body *body, const int32_t *chosen, const double *values) {
    const skg_body_organ *diaphragm = body->organ + skg_find_organ(body, "diaphragm");
    skg_body_options *options = &body->options;
    if (any(chosen, BODY_TENDON, 3)) memcpy(options->tendon_mm, values + BODY_TENDON, 3 * sizeof *values);
    if (any(chosen, BODY_AZIMUTH, 3)) skg_fit_plane(diaphragm->bounds, values, options->tendon_plane);
    if (any(chosen, BODY_DIAPHRAGM, 3)) set_tissue(body, "diaphragm", values + BODY_DIAPHRAGM);
    if (any(chosen, BODY_LIVER, 3)) set_tissue(body, "liver", values + BODY_LIVER);
    if (chosen[BODY_RIBS]) options->diaphragm_ribs_mm = values[BODY_RIBS];
    if (chosen[BODY_REACH]) options->diaphragm_liver_mm = values[BODY_REACH];
    set_anatomy(chosen, values, options);
    if (any(chosen, BODY_AZIMUTH, BODY_DOMES - BODY_AZIMUTH)) return skg_body_find_links_again(body);
    return body->diaphragm >= 0 ? skg_body_share_again(body) : SKG_OK;
}
