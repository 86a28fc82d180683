/* The result in words. */
#include "registration/types.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* How nearly two directions have to be parallel to share a name: 18 degrees. An assumption. */
static const double same = 0.95;

/* Below this agreement the body is called not to be where it shows. Of bench_register's real spines all wrong poses had less, and so had right
 * ones behind scatter, a spectrum and missing tissue at once; the generated spine, whose contrast is higher, had more at some wrong poses. */
static const double least_agreement = 0.6;

/* Residuals of less than this, a hundredth of the transmission, are called noise whatever their structure. An assumption. */
static const double least_residual = 0.01;

static const char axes[] = "xyz";

/* "the beam of view 2", "the body's long axis", "x", or three numbers. unit: of length 1. */
static void name_axis(const skg_registration *r, const double *unit, char *name, size_t size) {
    for (int64_t i = 0; i < r->image_count; i++) {
        double beam[3], middle[3];
        const skg_view *view = &r->state.views[i];
        skg_pose_point(r->state.motion, r->middle, middle);
        if (view->projection == SKG_PROJECTION_POINT)
            skg_add_scaled(middle, -1, view->source, beam);
        else if (view->projection == SKG_PROJECTION_PARALLEL)
            skg_add_scaled(view->centre, -1, view->source, beam);
        else
            memcpy(beam, view->source, sizeof beam);
        if (fabs(skg_dot(beam, unit)) > same * skg_length(beam)) {
            snprintf(name, size, "the beam of view %" PRId64, i + 1);
            return;
        }
    }
    double axis[3];
    for (int k = 0; k < 3; k++) axis[k] = skg_dot(r->state.motion + 4 * k, r->axis);
    if (fabs(skg_dot(axis, unit)) > same) {
        snprintf(name, size, "the body's long axis");
        return;
    }
    for (int k = 0; k < 3; k++)
        if (fabs(unit[k]) > same) {
            snprintf(name, size, "%c", axes[k]);
            return;
        }
    snprintf(name, size, "(%.2f, %.2f, %.2f)", unit[0], unit[1], unit[2]);
}

static void name_motion(const skg_registration *r, const char *what, const double *vector, char *name,
                        size_t size) {
    const double shift = skg_length(vector), turn = skg_length(vector + 3);
    const double *major = shift >= turn ? vector : vector + 3, length = fmax(shift, turn);
    double unit[3];
    char axis[64];
    skg_scale_vector(1 / length, major, unit);
    name_axis(r, unit, axis, sizeof axis);
    snprintf(name, size, "%s%s %s", what, shift >= turn ? "shift along" : "turn about", axis);
}

/* A geometry: the part of the vector that is largest names it. */
static void name_geometry(const skg_registration *r, const double *vector, char *name, size_t size) {
    const int64_t local = reg_local_count(r);
    const int source = (r->options.free & SKG_REGISTRATION_FREE_SOURCE) != 0, detector = local > 3;
    double most = -1;
    for (int64_t i = 0; i < r->image_count; i++) {
        const double *own = vector + reg_first(r, i);
        char what[64];
        double padded[6] = {0};
        if (source && skg_length(own) > most) {
            most = skg_length(own);
            memcpy(padded, own, 3 * sizeof *own);
            snprintf(what, sizeof what, "source of view %" PRId64 ": ", i + 1);
            name_motion(r, what, padded, name, size);
        }
        own += source ? 3 : 0;
        if (detector && fmax(skg_length(own), skg_length(own + 3)) > most) {
            most = fmax(skg_length(own), skg_length(own + 3));
            snprintf(what, sizeof what, "detector of view %" PRId64 ": ", i + 1);
            name_motion(r, what, own, name, size);
        }
    }
}

void reg_name_direction(const skg_registration *r, const double *vector, char *name, size_t size) {
    if (r->options.free == SKG_REGISTRATION_FREE_POSE)
        name_motion(r, "", vector, name, size);
    else
        name_geometry(r, vector, name, size);
}

/* A length with the digits that matter. */
static void put_length(double mm, char *text, size_t size) {
    if (mm < 1e4)
        snprintf(text, size, "%.2g mm", mm);
    else
        snprintf(text, size, "without limit");
}

void reg_say_verdict(skg_registration *r, const reg_rest *rest) {
    skg_registration_result *result = &r->result;
    const skg_registration_direction *open = &r->directions[0];
    char length[64];
    if (result->agreement < least_agreement) {
        result->verdict = SKG_REGISTRATION_VERDICT_FAILED;
        snprintf(
            r->verdict, sizeof r->verdict,
            "failed: the contrast of the parts and the radiographs correlate by %.2f only; start nearer, give restarts, or "
            "check views and quantity",
            result->agreement);
    } else if (!open->determined) {
        result->verdict = SKG_REGISTRATION_VERDICT_UNDETERMINED;
        put_length(open->sigma_structure_mm, length, sizeof length);
        snprintf(r->verdict, sizeof r->verdict,
                 "not determined: %s (standard deviation %s, and %.2g mm are asked for); a view from another "
                 "side determines it",
                 open->name, length, r->options.need_mm);
    } else if (r->apart > 0) {
        result->verdict = SKG_REGISTRATION_VERDICT_UNDETERMINED;
        snprintf(
            r->verdict, sizeof r->verdict,
            "not determined: two places %.2g mm apart agree almost equally, since the model lacks something; a better "
            "start, another view, or what is missing in the scene decides between them",
            r->apart);
    } else if (result->residual > 1.1 * result->noise && result->residual > least_residual) {
        result->verdict = SKG_REGISTRATION_VERDICT_STRUCTURE;
        snprintf(
            r->verdict, sizeof r->verdict,
            "agrees but for structure: a difference of %.2g rms, of which noise is %.2g; most of it in view %" PRId64
            " about row %" PRId64 ", column %" PRId64,
            result->residual, result->noise, rest->worst_image + 1, rest->worst_row, rest->worst_column);
    } else {
        result->verdict = SKG_REGISTRATION_VERDICT_AGREES;
        snprintf(r->verdict, sizeof r->verdict, "agrees: what is left is noise (%.2g rms)", result->residual);
    }
}
