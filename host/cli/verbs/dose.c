/* The verb `dose`: what an exposure gives to people and things. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/progress.h"
#include "common/say.h"
#include "session/explain.h"
#include "session/session.h"

#include <skiagraph/scanning.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { PLACES_MAX = 4096 };

typedef struct {
    cli_session session;
    skg_plan *plan;
    skg_dose *dose;
    skg_dose_options options;
    double *places; /* [options.point_count][3] */
    skg_dose_report report;
    int64_t projections; /* of the scan; 1: there is none */
} work;

/* --- flags */

static int read_places(const cli_arguments *arguments, work *w) {
    const char *value;
    w->places = calloc(3 * PLACES_MAX, sizeof *w->places);
    if (!w->places) return cli_error(CLI_DEVICE, "out of host memory for the places");
    for (int i = 0; (value = cli_nth_value(arguments, "--at", i)); i++) {
        double *place = w->places + 3 * (int64_t)i;
        char rest = 0;
        if (i == PLACES_MAX) return cli_error(CLI_USAGE, "--at: more than %d places", PLACES_MAX);
        if (sscanf(value, "%lf,%lf,%lf%c", place, place + 1, place + 2, &rest) != 3)
            return cli_error(CLI_USAGE, "--at %s: give three numbers in mm, X,Y,Z", value);
        w->options.point_count = i + 1;
    }
    w->options.points = w->places;
    return CLI_DONE;
}

static int read_flags(const cli_arguments *arguments, work *w) {
    skg_dose_options_init(&w->options);
    int exit_status = read_places(arguments, w);
    if (exit_status == CLI_DONE)
        exit_status = cli_integer(arguments, "--histories", 0, (int64_t)1 << 40, &w->options.histories);
    if (exit_status == CLI_DONE)
        exit_status = cli_integer(arguments, "--seed", 0, INT64_MAX, &w->options.seed);
    return exit_status;
}

/* --- JSON */

static json_t *places_json(const work *w) {
    json_t *list = json_array();
    int64_t count = 0;
    skg_dose_point_count(w->dose, &count);
    for (int64_t i = 0; i < count; i++) {
        skg_dose_point point;
        skg_dose_point_init(&point);
        if (skg_dose_point_get(w->dose, i, &point) != SKG_OK) break;
        json_t *one = json_object();
        json_object_set_new(one, "at", cli_json_numbers(point.at, 3));
        json_object_set_new(one, "air_kerma_uGy", cli_json_number(point.air_kerma_ugy));
        json_object_set_new(one, "backscatter", cli_json_number(point.backscatter));
        json_array_append_new(list, one);
    }
    return list;
}

static json_t *parts_json(const work *w) {
    json_t *list = json_array();
    int64_t count = 0;
    skg_scene_part_count(w->session.scene, &count);
    for (int64_t i = 0; i < count; i++) {
        skg_dose_part part;
        const char *label = "";
        skg_dose_part_init(&part);
        if (skg_dose_part_get(w->dose, i, &part) != SKG_OK) break;
        skg_scene_part_label_get(w->session.scene, i, &label);
        json_t *one = json_object();
        json_object_set_new(one, "label", cli_json_text(label));
        json_object_set_new(one, "dose_uGy", cli_json_number(part.dose_ugy));
        json_object_set_new(one, "sigma", cli_json_number(part.sigma_ugy));
        json_object_set_new(one, "energy_keV", cli_json_number(part.energy_kev));
        json_array_append_new(list, one);
    }
    return list;
}

static json_t *dose_json(const work *w) {
    const skg_dose_report *r = &w->report;
    json_t *object = json_object();
    json_object_set_new(object, "kerma", places_json(w));
    json_object_set_new(object, "kap_uGy_cm2", cli_json_number(r->kap_ugy_cm2));
    json_object_set_new(object, "detector_air_kerma_uGy", cli_json_number(r->detector_air_kerma_ugy));
    json_object_set_new(object, "exposure_index", cli_json_number(r->exposure_index));
    json_object_set_new(object, "parts", parts_json(w));
    json_object_set_new(object, "hvl1_mm_al", cli_json_number(r->hvl1_mm_al));
    json_object_set_new(object, "hvl2_mm_al", cli_json_number(r->hvl2_mm_al));
    if (w->projections > 1) json_object_set_new(object, "projections", json_integer(w->projections));
    if (!r->has_darkest) return object;
    json_t *darkest = json_object();
    json_object_set_new(darkest, "row", json_integer(r->darkest_row));
    json_object_set_new(darkest, "column", json_integer(r->darkest_column));
    json_object_set_new(darkest, "signal", cli_json_number(r->darkest_signal));
    json_object_set_new(darkest, "snr", cli_json_number(r->darkest_snr));
    json_object_set_new(object, "darkest", darkest);
    return object;
}

/* --- text */

static void print_places(const work *w) {
    int64_t count = 0;
    skg_dose_point_count(w->dose, &count);
    for (int64_t i = 0; i < count; i++) {
        skg_dose_point p;
        skg_dose_point_init(&p);
        if (skg_dose_point_get(w->dose, i, &p) != SKG_OK) return;
        printf("%-10s at (%.6g, %.6g, %.6g) mm %.4g uGy free in air", i ? "" : "air kerma", p.at[0], p.at[1],
               p.at[2], p.air_kerma_ugy);
        if (!p.in_field)
            printf(", outside the field");
        else if (isfinite(p.backscatter))
            printf("; with backscatter %.4g uGy, a factor of %.4g +- %.2g", p.backscatter * p.air_kerma_ugy,
                   p.backscatter, p.backscatter_sigma);
        else if (w->report.followed)
            printf("; parts stand before it, so that there is no backscatter factor");
        printf("\n");
    }
}

static void print_detector(const work *w) {
    const skg_dose_report *r = &w->report;
    const char *unit = "";
    skg_quantity_get(w->session.options.quantity, NULL, &unit);
    printf("detector   air kerma %.4g uGy behind the parts, %s scatter", r->detector_air_kerma_ugy,
           r->scattered ? "with" : "without");
    if (isfinite(r->exposure_index))
        printf("; exposure index %.4g (median of the middle tenth)", r->exposure_index);
    printf("\n");
    if (r->has_darkest)
        printf("           least signal %.4g %s in row %" PRId64 ", column %" PRId64
               "; signal over noise %.3g\n",
               r->darkest_signal, unit, r->darkest_row, r->darkest_column, r->darkest_snr);
}

static void print_number(double value, int width) {
    if (isfinite(value))
        printf(" %*.4g", width, value);
    else
        printf(" %*s", width, "-");
}

static void print_parts(const work *w) {
    int64_t count = 0;
    skg_scene_part_count(w->session.scene, &count);
    printf("%-28s %11s %9s %12s %11s\n", "part", "dose uGy", "+-", "energy keV", "mass g");
    for (int64_t i = 0; i < count; i++) {
        skg_dose_part part;
        const char *label = "";
        skg_dose_part_init(&part);
        if (skg_dose_part_get(w->dose, i, &part) != SKG_OK) return;
        skg_scene_part_label_get(w->session.scene, i, &label);
        cli_print("%-28s", label);
        print_number(part.dose_ugy, 11);
        print_number(part.sigma_ugy, 9);
        print_number(part.energy_kev, 12);
        print_number(part.mass_g, 11);
        printf("\n");
    }
}

static void print_dose(const work *w) {
    const skg_dose_report *r = &w->report;
    if (w->projections > 1)
        printf("scan       %" PRId64 " projections together; parts stand as in the scene\n", w->projections);
    printf("beam       half-value layers %.4g and %.4g mm Al; kerma-area product %.4g uGy cm2\n",
           r->hvl1_mm_al, r->hvl2_mm_al, r->kap_ugy_cm2);
    print_places(w);
    print_detector(w);
    if (r->followed) {
        print_parts(w);
        printf(
            "%" PRId64
            " photons; %.3g %% of the field's energy leaves the parts, and the balance is right to %.2g %%\n",
            r->histories, 100 * r->escaped_kev / r->incident_kev,
            100 * r->balance_sigma_kev / r->incident_kev);
    }
}

/* --- the verb */

static int compute(work *w) {
    double plan_ms;
    const int exit_status = cli_make_plan(&w->session, &w->plan, &plan_ms);
    if (exit_status != CLI_DONE) return exit_status;
    skg_scan *scan = NULL;
    skg_status status = skg_setup_projection_count_get(w->session.setup, &w->projections);
    if (status == SKG_OK && w->projections > 1) status = skg_setup_scan_get(w->session.setup, &scan);
    if (status != SKG_OK) return cli_fail(status);
    w->options.progress = cli_progress();
    cli_progress_follow(scan ? "projections" : "photons");
    status = scan ? skg_scan_dose_create(w->plan, scan, &w->options, &w->dose)
                  : skg_dose_create(w->plan, &w->options, &w->dose);
    cli_progress_end();
    skg_dose_report_init(&w->report);
    if (status == SKG_OK) status = skg_dose_report_get(w->dose, &w->report);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

int cli_dose(const cli_arguments *arguments) {
    work w = {.plan = NULL};
    int exit_status = read_flags(arguments, &w);
    if (exit_status == CLI_DONE) exit_status = cli_open_session(arguments, 0, &w.session);
    if (exit_status == CLI_DONE) exit_status = compute(&w);
    if (exit_status == CLI_DONE && cli_given(arguments, "--json"))
        exit_status = cli_json_print(dose_json(&w));
    else if (exit_status == CLI_DONE && !cli_is_quiet())
        print_dose(&w);
    free(w.places);
    skg_dose_release(&w.dose);
    skg_plan_release(&w.plan);
    cli_close_session(&w.session);
    return exit_status;
}
