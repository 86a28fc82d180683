/* The texts by which pages learn of a scene and its images. */
#include "live/plans.h"

#include "core/maths.h"
#include "core/text.h"

#include <math.h>
#include <string.h>

void skg_live_facts_init_sized(void *facts, int32_t size) {
    const skg_live_facts defaults = {0};
    skg_struct_init(facts, size, &defaults, sizeof defaults);
}

static json_t *effects_json(const skg_plan *plan) {
    json_t *effects = json_array();
    int64_t count = 0;
    if (skg_plan_effect_count(plan, &count) != SKG_OK) return effects;
    for (int64_t i = 0; i < count; i++) {
        skg_effect effect;
        skg_effect_init(&effect);
        if (skg_plan_effect_get(plan, i, &effect) != SKG_OK) continue;
        json_t *object = json_object();
        json_object_set_new(object, "name", skg_live_text(effect.name));
        json_object_set_new(object, "on", json_boolean(effect.on));
        json_object_set_new(object, "reason", skg_live_text(effect.reason));
        json_object_set_new(object, "cost", skg_live_number(effect.cost));
        json_array_append_new(effects, object);
    }
    return effects;
}

static json_t *plan_json(const skg_plan *plan) {
    static const char *const precisions[] = {"single", "double", "half"};
    skg_plan_report report;
    json_t *object = json_object();
    skg_plan_report_init(&report);
    if (skg_plan_report_get(plan, &report) != SKG_OK) return object;
    json_object_set_new(object, "precision", json_string(precisions[report.precision]));
    json_object_set_new(object, "triangles", json_integer(report.triangles));
    json_object_set_new(object, "planes", json_integer(report.planes));
    json_object_set_new(object, "nodes", json_integer(report.nodes));
    json_object_set_new(object, "bins", json_integer(report.bins));
    json_object_set_new(object, "samples", json_integer(report.samples));
    json_object_set_new(object, "bound", skg_live_number(report.bound));
    json_object_set_new(object, "device_mib", skg_live_number((double)report.device_bytes / (1 << 20)));
    json_object_set_new(object, "effects", effects_json(plan));
    return object;
}

/* The open beam at the detector; empty if it has no such figures. */
static json_t *beam_json(skg_live_plans *plans, const skg_live_subject *subject) {
    json_t *object = json_object();
    if (memcmp(&plans->beam_view, subject->shown, sizeof plans->beam_view) != 0) {
        plans->beam_view = *subject->shown;
        skg_quality_init(&plans->beam);
        plans->has_beam =
            skg_flat_field_quality_get(subject->spectrum, subject->shown, &plans->beam) == SKG_OK;
    }
    if (!plans->has_beam) return object;
    json_object_set_new(object, "mean_kev", skg_live_number(plans->beam.mean_kev));
    json_object_set_new(object, "photons", skg_live_number(plans->beam.photons));
    json_object_set_new(object, "air_kerma_ugy", skg_live_number(plans->beam.air_kerma_ugy));
    return object;
}

/* The focal spot in mm; null in a parallel beam, which has none. */
static json_t *spot_json(const skg_live_subject *subject) {
    const skg_spot *spot = subject->options->spot;
    if (subject->view->projection != SKG_PROJECTION_POINT) return json_null();
    json_t *object = json_object();
    json_object_set_new(object, "shape", json_integer(spot ? spot->shape : SKG_SPOT_POINT));
    json_object_set_new(object, "extent", spot ? skg_live_numbers(spot->extent, 2) : json_null());
    return object;
}

/* The jaws in mm, as the scene file counts them; null if they are open. */
static json_t *jaws_json(const skg_collimation *jaws) {
    if (!jaws || jaws->kind == SKG_COLLIMATION_OPEN) return json_null();
    const double edges[] = {jaws->low[0], jaws->high[0], -jaws->high[1], -jaws->low[1]};
    json_t *object = json_object();
    if (jaws->kind == SKG_COLLIMATION_DETECTOR) {
        json_object_set_new(object, "margin", skg_live_number(jaws->margin_mm));
        return object;
    }
    json_object_set_new(object, "edges", skg_live_numbers(edges, 4)); /* left, right, bottom, top */
    json_object_set_new(object, "distance", skg_live_number(jaws->distance_mm));
    return object;
}

/* Of each projection, in degrees; empty without a scan. */
static json_t *angles_json(const skg_scan *scan, int64_t projections) {
    json_t *angles = json_array();
    double angle;
    for (int64_t k = 0; k < projections && skg_scan_angle_get(scan, k, &angle) == SKG_OK; k++)
        json_array_append_new(angles, skg_live_number(angle * 180 / SKG_PI));
    return angles;
}

static json_t *warnings_json(const skg_live_facts *facts) {
    json_t *list = json_array();
    for (int64_t i = 0; i < facts->warning_count; i++)
        json_array_append_new(list, skg_live_text(facts->warnings[i]));
    return list;
}

/* Adds the facts that the transport knows of the scene. */
static void put_facts(const skg_live_facts *facts, json_t *inner) {
    json_object_set_new(inner, "document", skg_live_parsed(facts->document));
    json_object_set_new(inner, "warnings", warnings_json(facts));
    json_object_set_new(inner, "path", skg_live_text(facts->path));
    json_object_set_new(inner, "geometry", json_integer(facts->geometry));
    json_object_set_new(inner, "load_ms", skg_live_number(facts->load_ms));
    json_object_set_new(inner, "dose", skg_live_parsed(facts->dose));
    json_object_set_new(inner, "fixed", skg_live_parsed(facts->fixed));
    json_object_set_new(inner, "without", skg_live_parsed(facts->without));
}

static skg_status put_scene(skg_live_plans *plans, const skg_live_subject *subject, json_t *inner) {
    int64_t parts = 0, projections = 0;
    double period = (double)NAN;
    skg_device_info device;
    skg_device_info_init(&device);
    SKG_TRY(skg_context_device_get(subject->context, &device));
    SKG_TRY(skg_scene_part_count(subject->scene, &parts));
    if (subject->scan) SKG_TRY(skg_scan_projection_count(subject->scan, &projections));
    if (subject->motion) SKG_TRY(skg_motion_period_get(subject->motion, &period));
    json_object_set_new(inner, "device", skg_live_text(device.name));
    json_object_set_new(inner, "parts", json_integer(parts));
    json_object_set_new(inner, "projections", json_integer(projections));
    json_object_set_new(inner, "period", skg_live_number(period));
    json_object_set_new(inner, "plan_ms", skg_live_number(plans->plan_ms));
    json_object_set_new(inner, "channel", skg_live_text(plans->channel.name));
    json_object_set_new(inner, "unit", skg_live_text(plans->channel.unit));
    json_object_set_new(inner, "plan", plan_json(plans->whole));
    json_object_set_new(inner, "beam", beam_json(plans, subject));
    json_object_set_new(inner, "spot", spot_json(subject));
    json_object_set_new(inner, "jaws", jaws_json(subject->options->collimation));
    json_object_set_new(inner, "angles", angles_json(subject->scan, projections));
    return SKG_OK;
}

skg_status skg_live_scene_write(skg_live_plans *plans, const skg_live_subject *theirs,
                                const skg_live_message *wish, const skg_live_facts *its,
                                skg_live_letter **letter) {
    SKG_PLAIN;
    skg_live_subject subject;
    skg_live_facts facts;
    SKG_NEEDS(plans);
    SKG_NEEDS(wish);
    SKG_NEEDS(letter);
    *letter = NULL;
    SKG_TRY(skg_live_subject_read(theirs, &subject));
    skg_live_facts_init(&facts);
    SKG_TRY(skg_struct_read(its, "skg_live_facts", &facts, sizeof facts));
    json_t *object = json_object(), *inner = json_object();
    json_object_set_new(object, "scene", inner);
    put_facts(&facts, inner);
    json_object_set_new(inner, "state", skg_live_state(wish));
    const skg_status status = put_scene(plans, &subject, inner);
    if (status == SKG_OK) return skg_live_text_letter(object, letter);
    json_decref(object);
    return status;
}

static json_t *stages_json(const skg_plan *plan) {
    json_t *stages = json_object();
    int64_t count = 0;
    if (skg_plan_stage_count(plan, &count) != SKG_OK) return stages;
    for (int64_t i = 0; i < count; i++) {
        skg_stage stage;
        skg_stage_init(&stage);
        if (skg_plan_stage_get(plan, i, &stage) == SKG_OK)
            json_object_set_new(stages, stage.name, skg_live_number(stage.ns * 1e-6));
    }
    return stages;
}

static json_t *scatter_json(const skg_plan *plan) {
    skg_scatter_report report;
    skg_scatter_report_init(&report);
    if (skg_plan_scatter_report_get(plan, &report) != SKG_OK) return json_null();
    json_t *object = json_object();
    json_object_set_new(object, "mean", skg_live_number(report.mean));
    json_object_set_new(object, "sigma", skg_live_number(report.sigma));
    json_object_set_new(object, "histories", json_integer(report.histories));
    json_object_set_new(object, "seconds", skg_live_number(report.seconds));
    return object;
}

/* Adds the facts of an image besides number, wish, ms and phase. */
static void put_shot(skg_live_plans *plans, const skg_live_subject *subject, const skg_live_message *wish,
                     json_t *object) {
    const int has_scatter = subject->options->scatter && !(plans->header.notes & SKG_LIVE_DRAFT);
    json_t *seen = json_object();
    json_object_set_new(object, "state", skg_live_state(wish));
    json_object_set_new(object, "stages", stages_json(plans->shown_plan));
    json_object_set_new(object, "beam", beam_json(plans, subject));
    json_object_set_new(object, "scatter", has_scatter ? scatter_json(plans->shown_plan) : json_null());
    if (skg_live_box_find(plans, subject) == SKG_OK &&
        skg_live_view_json(subject->shown, subject->options->collimation, plans->box, seen) == SKG_OK)
        json_object_set(object, "view", seen);
    json_decref(seen);
}

skg_status skg_live_shot_write(skg_live_plans *plans, const skg_live_subject *theirs,
                               const skg_live_message *wish, int64_t number, int32_t brief,
                               skg_live_letter **letter) {
    SKG_PLAIN;
    skg_live_subject subject;
    SKG_NEEDS(plans);
    SKG_NEEDS(wish);
    SKG_NEEDS(letter);
    *letter = NULL;
    SKG_TRY(skg_live_subject_read(theirs, &subject));
    if (!plans->is_shown) return skg_fail(SKG_ERR_ARGUMENT, "live: there is no image to tell of");
    json_t *object = json_object();
    json_object_set_new(object, "shot", json_integer(number));
    json_object_set_new(object, "wish", json_integer(wish->asked.number));
    json_object_set_new(object, "ms", skg_live_number(plans->ms));
    json_object_set_new(object, "phase", skg_live_number(wish->asked.phase));
    if (!brief) put_shot(plans, &subject, wish, object);
    return skg_live_text_letter(object, letter);
}
