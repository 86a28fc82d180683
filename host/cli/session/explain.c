/* Reports the decisions of a plan as text and as JSON. */
#include "session/explain.h"

#include "common/encode.h"
#include "common/progress.h"
#include "common/say.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* Reports the chosen strategy and the time with --verbose. The kernels are compiled, or taken from the cache, while the plan is made. */
static void tell_plan(const skg_plan *plan, double plan_ms) {
    skg_plan_report report;
    int64_t effects = 0;
    skg_plan_report_init(&report);
    if (skg_plan_report_get(plan, &report) != SKG_OK || skg_plan_effect_count(plan, &effects) != SKG_OK)
        return;
    cli_tell("planned and compiled in %.0f ms: strategy %s, precision %s, %" PRId64 " nodes, %" PRId64
             " planes",
             plan_ms, cli_flag_strategy.values[report.strategy].name,
             cli_flag_precision.values[report.precision].name, report.nodes, report.planes);
    for (int64_t i = 0; i < effects; i++) {
        skg_effect effect;
        skg_effect_init(&effect);
        if (skg_plan_effect_get(plan, i, &effect) == SKG_OK && effect.on)
            cli_tell("on: %s: %s", effect.name, effect.reason);
    }
}

int cli_make_plan(const cli_session *session, skg_plan **plan, double *plan_ms) {
    double start = cli_now_ms();
    cli_progress_begin("planning", 0);
    skg_status status = skg_plan_create(session->context, session->scene, &session->view, session->spectrum,
                                        &session->options, plan);
    cli_progress_end();
    *plan_ms = cli_now_ms() - start;
    if (status == SKG_OK) tell_plan(*plan, *plan_ms);
    if (status == SKG_OK) return CLI_DONE;
    int exit_status = cli_fail(status);
    /* Most of what is not supported is a scene's; a device may lack double precision. */
    return status == SKG_ERR_UNSUPPORTED && session->options.precision == SKG_PRECISION_DOUBLE ? CLI_DEVICE
                                                                                               : exit_status;
}

static json_t *flat_field_json(const cli_session *session) {
    skg_quality quality;
    skg_quality_init(&quality);
    if (skg_flat_field_quality_get(session->spectrum, &session->view, &quality) != SKG_OK) return json_null();
    return json_pack("{s:f, s:f, s:f}", "mean_energy_keV", quality.mean_kev, "photons_per_pixel",
                     quality.photons, "air_kerma_uGy", quality.air_kerma_ugy);
}

static json_t *effects_json(const skg_plan *plan) {
    json_t *list = json_array();
    int64_t count = 0;
    skg_plan_effect_count(plan, &count);
    for (int64_t i = 0; i < count; i++) {
        skg_effect effect;
        skg_effect_init(&effect);
        if (skg_plan_effect_get(plan, i, &effect) != SKG_OK) break;
        json_t *object = json_object();
        json_object_set_new(object, "name", cli_json_text(effect.name));
        json_object_set_new(object, "on", json_boolean(effect.on));
        json_object_set_new(object, "reason", cli_json_text(effect.reason));
        json_object_set_new(object, "cost", cli_json_number(effect.cost));
        json_array_append_new(list, object);
    }
    return list;
}

/* The energies at which attenuation is computed, each with the photons per pixel that it represents. */
static json_t *nodes_json(const skg_plan *plan, int64_t nodes) {
    json_t *list = json_array();
    for (int64_t i = 0; i < nodes; i++) {
        double node[2];
        if (skg_plan_node_get(plan, i, &node[0], &node[1], NULL) == SKG_OK)
            json_array_append_new(list, cli_json_numbers(node, 2));
    }
    return list;
}

/* Device time of each stage of the last frame. */
static json_t *stages_json(const skg_plan *plan) {
    json_t *object = json_object();
    int64_t count = 0;
    skg_plan_stage_count(plan, &count);
    for (int64_t i = 0; i < count; i++) {
        skg_stage stage;
        skg_stage_init(&stage);
        if (skg_plan_stage_get(plan, i, &stage) != SKG_OK) break;
        json_object_set_new(object, stage.name, cli_json_number(stage.ns));
    }
    return object;
}

static const char *label_of(const skg_scene *scene, int64_t id) {
    skg_part part;
    skg_part_init(&part);
    return skg_scene_part_get(scene, id, &part) == SKG_OK ? part.label : "?";
}

static json_t *overlaps_json(const skg_plan *plan, const skg_scene *scene) {
    json_t *list = json_array();
    int64_t count = 0;
    skg_plan_overlap_count(plan, &count);
    for (int64_t i = 0; i < count; i++) {
        skg_overlap overlap;
        skg_overlap_init(&overlap);
        if (skg_plan_overlap_get(plan, i, &overlap) != SKG_OK) break;
        json_t *object = json_object();
        json_object_set_new(object, "part", cli_json_text(label_of(scene, overlap.part)));
        json_object_set_new(object, "other", cli_json_text(label_of(scene, overlap.other)));
        json_object_set_new(object, "protrudes", json_boolean(overlap.protrudes));
        json_object_set_new(object, "volume_mm3", cli_json_number(overlap.volume));
        json_object_set_new(object, "longest_mm", cli_json_number(overlap.longest));
        json_object_set_new(object, "place_mm", cli_json_numbers(overlap.place, 3));
        json_array_append_new(list, object);
    }
    return list;
}

static json_t *tiles_json(const skg_plan_report *report) {
    json_t *object = json_object();
    json_object_set_new(object, "count", json_integer(report->tiles));
    json_object_set_new(object, "columns", json_integer(report->tile_columns));
    json_object_set_new(object, "rows", json_integer(report->tile_rows));
    json_object_set_new(object, "triangles_per_tile", cli_json_number(report->triangles_per_tile));
    return object;
}

/* The bound of the error by the precision; null if none is known. */
static json_t *precision_bound_json(const skg_plan *plan) {
    double bound = 0;
    if (skg_plan_precision_bound_get(plan, &bound) != SKG_OK) return json_null();
    return cli_json_number(bound);
}

json_t *cli_explain_json(const skg_plan *plan, const cli_session *session) {
    skg_plan_report report;
    json_t *object = json_object();
    skg_plan_report_init(&report);
    skg_plan_report_get(plan, &report);
    json_object_set_new(object, "effects", effects_json(plan));
    json_object_set_new(object, "nodes", nodes_json(plan, report.nodes));
    json_object_set_new(object, "planes", json_integer(report.planes));
    json_object_set_new(object, "accumulators", json_integer(report.accumulators));
    json_object_set_new(object, "plane_bits", json_integer(report.plane_bits));
    json_object_set_new(object, "strategy", cli_json_text(cli_flag_strategy.values[report.strategy].name));
    json_object_set_new(object, "tiles", tiles_json(&report));
    json_object_set_new(object, "bound", cli_json_number(report.bound));
    json_object_set_new(object, "bound_precision", precision_bound_json(plan));
    json_object_set_new(object, "verified", json_integer(report.verified));
    json_object_set_new(object, "precision", cli_json_text(cli_flag_precision.values[report.precision].name));
    json_object_set_new(object, "device", cli_json_text(session->device.name));
    json_object_set_new(object, "device_bytes", json_integer(report.device_bytes));
    json_object_set_new(object, "parts", json_integer(report.parts));
    json_object_set_new(object, "open_parts", json_integer(report.leaky_parts));
    json_object_set_new(object, "triangles", json_integer(report.triangles));
    json_object_set_new(object, "vertices", json_integer(report.vertices));
    json_object_set_new(object, "bad_pixels", json_integer(report.bad_pixels));
    json_object_set_new(object, "repaired_pixels", json_integer(report.repaired_pixels));
    json_object_set_new(object, "negative_pixels", json_integer(report.negative_pixels));
    json_object_set_new(object, "outside_pixels", json_integer(report.outside_pixels));
    json_object_set_new(object, "bins", json_integer(report.bins));
    json_object_set_new(object, "open_beam", flat_field_json(session));
    json_object_set_new(object, "samples", json_integer(report.samples));
    json_object_set_new(object, "sample_error", cli_json_number(report.sample_error));
    json_object_set_new(object, "stages_ns", stages_json(plan));
    json_object_set_new(object, "overlaps", overlaps_json(plan, session->scene));
    return object;
}

static void print_cost(const skg_effect *effect) {
    if (fabs(effect->cost) < 0.005)
        printf("%9s", effect->on ? "-" : "");
    else
        printf("%+9.2f", effect->cost);
}

static void print_effects(const skg_plan *plan) {
    int64_t count = 0;
    skg_plan_effect_count(plan, &count);
    printf("\neffects, with their estimated cost in frames of this scene without effects\n");
    for (int64_t i = 0; i < count; i++) {
        skg_effect effect;
        skg_effect_init(&effect);
        if (skg_plan_effect_get(plan, i, &effect) != SKG_OK) break;
        printf("  %-3s %-22s", effect.on ? "on" : "off", effect.name);
        print_cost(&effect);
        cli_print("  %s\n", effect.reason);
    }
}

static void print_stages(const skg_plan *plan) {
    int64_t count = 0;
    if (skg_plan_stage_count(plan, &count) != SKG_OK || count == 0) return;
    printf("\nmeasured on one frame, ms\n");
    for (int64_t i = 0; i < count; i++) {
        skg_stage stage;
        skg_stage_init(&stage);
        if (skg_plan_stage_get(plan, i, &stage) != SKG_OK) break;
        printf("  %-26s %.3f\n", stage.name, stage.ns * 1e-6);
    }
}

/* The nodes, if a spectrum was compressed. */
static void print_nodes(const skg_plan *plan, const skg_plan_report *report) {
    if (report->verified == 0) return;
    printf("\nenergies, keV: photons per pixel of the flat field; error at most %.2g, verified on %" PRId64
           " points\n",
           report->bound, report->verified);
    for (int64_t i = 0; i < report->nodes; i++) {
        double kev, photons;
        if (skg_plan_node_get(plan, i, &kev, &photons, NULL) != SKG_OK) break;
        printf("%s%8.6g: %-10.6g%s", i % 4 ? "" : "  ", kev, photons,
               i % 4 == 3 || i + 1 == report->nodes ? "\n" : "");
    }
}

/* The worst, which the plan has first. */
static void print_overlaps(const skg_plan *plan, const skg_scene *scene) {
    enum { SHOWN = 3 };
    int64_t count = 0;
    if (skg_plan_overlap_count(plan, &count) != SKG_OK || count == 0) return;
    printf("\noverlaps (path lengths add where parts overlap)\n");
    for (int64_t i = 0; i < count && i < SHOWN; i++) {
        skg_overlap overlap;
        skg_overlap_init(&overlap);
        if (skg_plan_overlap_get(plan, i, &overlap) != SKG_OK) break;
        cli_print("  %s %s %s: %.4g mm3, longest %.4g mm at (%.4g, %.4g, %.4g) mm\n",
                  label_of(scene, overlap.part), overlap.protrudes ? "leaves its parent" : "overlaps",
                  label_of(scene, overlap.other), overlap.volume, overlap.longest, overlap.place[0],
                  overlap.place[1], overlap.place[2]);
    }
    if (count > SHOWN) printf("  and %" PRId64 " more; --json lists all\n", count - SHOWN);
}

static void print_beam(const cli_session *session) {
    int64_t bins = 0;
    skg_quality quality;
    skg_quality_init(&quality);
    skg_spectrum_bin_count(session->spectrum, &bins);
    printf("beam       ");
    if (bins > 1) printf("%" PRId64 " energies, mean ", bins);
    if (skg_flat_field_quality_get(session->spectrum, &session->view, &quality) == SKG_OK)
        printf("%g keV, %g photons per pixel of the flat field, air kerma %.4g uGy\n", quality.mean_kev,
               quality.photons, quality.air_kerma_ugy);
    else
        printf("its quality is not known: %s\n", skg_last_error());
}

static void print_precision(const skg_plan *plan, const skg_plan_report *report) {
    double bound = 0;
    printf("precision  %s", cli_flag_precision.values[report->precision].name);
    if (skg_plan_precision_bound_get(plan, &bound) == SKG_OK)
        printf(": error of intensities at most %.2g", bound);
    if (report->verified > 0) printf(", and %.2g by fewer energies", report->bound);
    putchar('\n');
}

static void print_strategy(const skg_plan_report *report) {
    printf("strategy   %s: ", cli_flag_strategy.values[report->strategy].name);
    if (report->strategy != SKG_STRATEGY_TILES)
        printf("the whole detector, %" PRId64 " triangles\n", report->triangles);
    else
        printf("%" PRId64 " tile%s of %" PRId64 " x %" PRId64 " pixels, %.1f triangles in each\n",
               report->tiles, report->tiles == 1 ? "" : "s", report->tile_columns, report->tile_rows,
               report->triangles_per_tile);
}

static void print_scatter(const cli_session *session, const cli_prediction *prediction) {
    if (session->options.scatter)
        printf(
            "\nTransmitted photons, and those that parts and world scatter (Compton, Rayleigh) or emit (fluorescence, annihilation). Left out "
            "are the\norder of molecules (but for FormFactor), and what filters, jaws and the detector scatter.\n");
    else
        printf("\nDirectly transmitted photons only.%s\n",
               prediction->is_known && prediction->found.called_for
                   ? " \"Scatter\": 0.01 adds scattered ones."
                   : "");
    cli_print("scatter, %s\n", prediction->reason);
    cli_prediction_print_grid(prediction);
}

void cli_explain_print(const skg_plan *plan, const cli_session *session, const cli_prediction *prediction) {
    skg_plan_report report;
    skg_plan_report_init(&report);
    skg_plan_report_get(plan, &report);
    cli_print("scene      %s: %" PRId64 " %s (%" PRId64 " leaky), %" PRId64 " triangles, %" PRId64
              " vertices\n",
              session->path, report.parts, skg_plural(report.parts, "part", "parts"), report.leaky_parts,
              report.triangles, report.vertices);
    printf("detector   %" PRId64 " x %" PRId64 " pixels\n", session->view.columns, session->view.rows);
    print_beam(session);
    printf("device     %s, %.1f MiB used\n", session->device.name,
           (double)report.device_bytes / (1024.0 * 1024.0));
    print_precision(plan, &report);
    print_strategy(&report);
    const int64_t closed = report.parts - report.leaky_parts;
    printf("planes     %" PRId64 " for %" PRId64 " %s, from %" PRId64 " %s of %" PRId64 " bits\n",
           report.planes, closed, skg_plural(closed, "part", "parts"), report.accumulators,
           skg_plural(report.accumulators, "accumulator", "accumulators"), report.plane_bits);
    printf("pixels     %" PRId64 " where hits of a leaky mesh do not cancel, %" PRId64
           " of them repaired; %" PRId64 " with a negative exponent; %" PRId64
           " outside the verified range\n",
           report.bad_pixels, report.repaired_pixels, report.negative_pixels, report.outside_pixels);
    print_effects(plan);
    print_nodes(plan, &report);
    print_stages(plan);
    print_overlaps(plan, session->scene);
    print_scatter(session, prediction);
}
