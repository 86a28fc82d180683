/* The report of a finished job: times, counts, warnings. */
#include "core/text.h"
#include "plan/results.h"

#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

static void add_stage(skg_outcome *outcome, const char *name, double ns) {
    int64_t i = 0;
    while (i < outcome->stage_count && strcmp(outcome->stages[i].name, name) != 0) i++;
    if (i == SKG_STAGES_MAX) return;
    if (i == outcome->stage_count) outcome->stages[outcome->stage_count++] = (skg_stage_time){.name = name};
    outcome->stages[i].ns += ns;
}

static skg_status add_stages(const skg_stage_log *log, skg_outcome *outcome) {
    if (!log->on) return SKG_OK;
    outcome->stage_count = 0;
    for (int64_t i = 0; i < log->count; i++) {
        double ns = 0;
        SKG_TRY(skg_stage_log_time(log, i, &ns));
        add_stage(outcome, log->names[i], ns);
    }
    return SKG_OK;
}

/* Names the first bad frame; the images of the others are valid. */
static skg_status report_bad_vertex(const skg_recipe *recipe, const skg_geometry *geometry,
                                    const skg_results *results) {
    int64_t part = 0, of_mesh = 0, frame = 0;
    char place[32] = "";
    while (frame < results->frames && results->bad_vertex[frame] == INT32_MAX) frame++;
    if (frame == results->frames) return SKG_OK;
    skg_geometry_find(geometry, results->bad_vertex[frame], &part, &of_mesh);
    if (results->frames > 1) snprintf(place, sizeof place, "frame %" PRId64 ": ", frame);
    return skg_fail(SKG_ERR_MESH,
                    "%spart %s: vertex %" PRId64 " cannot be projected: it is not finite in this pose", place,
                    recipe->scene->parts[part].label, of_mesh);
}

static void report_negative(const skg_context *context, int32_t pixels, skg_outcome *outcome) {
    outcome->report.negative_pixels = pixels;
    if (pixels > 0)
        skg_log(context, SKG_LOG_WARNING,
                "%" PRId32
                " %s a negative exponent: more is subtracted than is there, by a part that leaves its "
                "parent or by an inverted component of a mesh; see the warnings of the plan",
                pixels, skg_plural(pixels, "pixel has", "pixels have"));
}

/* Whether a number of bad pixels is worth a warning: the first one is, then one of more digits than any before. */
static int is_news(skg_outcome *outcome, int64_t index, int32_t bad) {
    int32_t digits = 0;
    for (int64_t least = 1; least <= bad; least *= 10) digits++;
    if (digits <= outcome->warned_bad[index]) return 0;
    outcome->warned_bad[index] = digits;
    return 1;
}

/* bad: verdict on the leaky part `index`, as skg_raster_bad_pixels leaves it. */
static void report_bad(const skg_recipe *recipe, const skg_context *context, int64_t index,
                       const int32_t *bad, skg_outcome *outcome) {
    static const char *const done[] = {
        [SKG_REPAIR_NONE] = "it is left out there",
        [SKG_REPAIR_NEIGHBOURS] = "it has the mean of its nearest valid pixels there",
        [SKG_REPAIR_EXACT] = "these rays were traced again through the mesh with its holes capped",
    };
    const int64_t all = recipe->view.columns * recipe->view.rows;
    const int curved =
        recipe->view.radius > 0; /* places are those of the raster, whose rows are the columns */
    const int64_t columns = curved ? recipe->view.rows : recipe->view.columns;
    const int hopeless = recipe->options.repair == SKG_REPAIR_NEIGHBOURS && bad[0] == all;
    const int32_t repair = hopeless ? SKG_REPAIR_NONE : recipe->options.repair;
    outcome->report.bad_pixels += bad[0];
    if (repair != SKG_REPAIR_NONE) outcome->report.repaired_pixels += bad[0];
    if (!is_news(outcome, index, bad[0])) return;
    char places[32 * SKG_FIRST_BAD] = "";
    size_t length = 0;
    for (int32_t k = 0; k < bad[0] && k < SKG_FIRST_BAD; k++)
        length += (size_t)snprintf(places + length, sizeof places - length, "%s(%" PRId64 ", %" PRId64 ")",
                                   k ? ", " : "", curved ? bad[1 + k] / columns : bad[1 + k] % columns,
                                   curved ? bad[1 + k] % columns : bad[1 + k] / columns);
    skg_log(context, SKG_LOG_WARNING,
            "part %s is leaky: at %" PRId32
            " %s its rays do not leave it as often as they enter it; %s; first at (column, row) %s; close "
            "its mesh",
            recipe->scene->parts[recipe->leaky[index]].label, bad[0], skg_plural(bad[0], "pixel", "pixels"),
            done[repair], places);
}

/* The status carries the sentence for each frame, the log once for each plan. */
static skg_status report_infinite(const skg_recipe *recipe, const skg_context *context, int32_t values,
                                  skg_outcome *outcome) {
    const int half = recipe->options.precision == SKG_PRECISION_HALF;
    outcome->report.infinite_pixels = values;
    if (values == 0) return SKG_OK;
    (void)skg_fail(SKG_RANGE, "%" PRId32 " %s not finite: more than %s holds; take %s", values,
                   skg_plural(values, "pixel is", "pixels are"),
                   half ? "precision half (65,504; energies are in MeV)" : "the precision",
                   half ? "precision single, or fewer photons" : "fewer photons");
    if (!outcome->warned_infinite) skg_log(context, SKG_LOG_WARNING, "%s", skg_last_error());
    outcome->warned_infinite = 1;
    return SKG_RANGE;
}

/* The scale is made for the layers that columns through each mesh show (mesh/layers.c). */
static skg_status report_wrapped(const skg_context *context, int32_t rays, skg_outcome *outcome) {
    if (rays == 0) return SKG_OK;
    (void)skg_fail(
        SKG_RANGE,
        "at %" PRId32 " %s a mesh lies over itself more often than its columns show, and sums of "
        "lengths leave their integers: these pixels are wrong; unite what overlaps in the mesh, or take "
        "precision double",
        rays, skg_plural(rays, "ray", "rays"));
    if (!outcome->warned_wrapped) skg_log(context, SKG_LOG_WARNING, "%s", skg_last_error());
    outcome->warned_wrapped = 1;
    return SKG_RANGE;
}

static skg_status report_outside(const skg_recipe *recipe, int32_t pixels, skg_outcome *outcome) {
    outcome->report.outside_pixels = pixels;
    if (pixels == 0) return SKG_OK;
    return skg_fail(
        SKG_RANGE,
        "at %" PRId32 " %s the lengths leave the range that the error bound of %.2g was verified "
        "for; the image is valid, the bound is not stated there; plan for this view and these poses, or with "
        "tolerance 0",
        pixels, skg_plural(pixels, "pixel", "pixels"), recipe->model.bound);
}

/* A mesh from the caller's memory that leaves the bounds that were given with it. */
static skg_status report_left_bounds(const skg_recipe *recipe, const skg_results *results) {
    const skg_plan_meshes *meshes = &recipe->meshes;
    int64_t m = 0, part = 0;
    while (results->outside && m < meshes->count && results->outside[m] == INT32_MAX) m++;
    if (!results->outside || m == meshes->count) return SKG_OK;
    while (meshes->of_part[part] != m) part++;
    return skg_fail(
        SKG_RANGE,
        "part %s: vertex %" PRId32
        " lies outside of the bounds that skg_plan_positions_set_cl was given; such vertices were "
        "put on the bounds; give bounds that hold all positions",
        recipe->scene->parts[part].label, results->outside[m]);
}

skg_status skg_report_work(const skg_recipe *recipe, skg_context *context, const skg_geometry *geometry,
                           const skg_results *results, const skg_stage_log *log, skg_outcome *outcome) {
    skg_plan_report *report = &outcome->report;
    const skg_leaky_verdicts *leaky = &results->leaky;
    SKG_TRY(add_stages(log, outcome));
    SKG_TRY(report_bad_vertex(recipe, geometry, results));
    report_negative(context, results->negative[0], outcome);
    const double listings = (double)results->listed[0] + (double)results->listed[1] * (double)report->tiles;
    report->triangles_per_tile =
        recipe->strategy == SKG_STRATEGY_TILES ? listings / (double)report->tiles : (double)report->triangles;
    report->bad_pixels = report->repaired_pixels = 0;
    for (int64_t k = 0; k < leaky->count; k++) {
        const int32_t *bad = leaky->pixels + k * (1 + SKG_FIRST_BAD);
        if (bad[0] > 0) report_bad(recipe, context, leaky->indices[k], bad, outcome);
    }
    const skg_status outside = report_outside(recipe, results->negative[1], outcome);
    const skg_status infinite = report_infinite(recipe, context, results->negative[2], outcome);
    const skg_status wrapped = report_wrapped(context, results->negative[3], outcome);
    const skg_status left = report_left_bounds(recipe, results);
    return left != SKG_OK       ? left
           : wrapped != SKG_OK  ? wrapped
           : infinite != SKG_OK ? infinite
                                : outside; /* the sentence is the last one's */
}
