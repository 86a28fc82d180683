/* What pages are told of a scene and its frames. */
#include "live/describe.h"

#include "common/encode.h"
#include "common/say.h"
#include "core/maths.h"
#include "live/page.h"
#include "live/slice.h"
#include "session/explain.h"

#include <math.h>
#include <string.h>

static json_t *effects_json(const skg_plan *plan) {
    json_t *effects = json_array();
    int64_t count = 0;
    if (skg_plan_effect_count(plan, &count) != SKG_OK) return effects;
    for (int64_t i = 0; i < count; i++) {
        skg_effect effect;
        skg_effect_init(&effect);
        if (skg_plan_effect_get(plan, i, &effect) != SKG_OK) continue;
        json_t *object = json_object();
        json_object_set_new(object, "name", cli_json_text(effect.name));
        json_object_set_new(object, "on", json_boolean(effect.on));
        json_object_set_new(object, "reason", cli_json_text(effect.reason));
        json_object_set_new(object, "cost", cli_json_number(effect.cost));
        json_array_append_new(effects, object);
    }
    return effects;
}

static json_t *plan_json(const live_scene *scene) {
    static const char *const precisions[] = {"single", "double", "half"};
    skg_plan_report report;
    json_t *object = json_object();
    skg_plan_report_init(&report);
    if (skg_plan_report_get(scene->plan, &report) != SKG_OK) return object;
    json_object_set_new(object, "precision", json_string(precisions[report.precision]));
    json_object_set_new(object, "triangles", json_integer(report.triangles));
    json_object_set_new(object, "planes", json_integer(report.planes));
    json_object_set_new(object, "nodes", json_integer(report.nodes));
    json_object_set_new(object, "bins", json_integer(report.bins));
    json_object_set_new(object, "samples", json_integer(report.samples));
    json_object_set_new(object, "bound", cli_json_number(report.bound));
    json_object_set_new(object, "device_mib", cli_json_number((double)report.device_bytes / (1 << 20)));
    json_object_set_new(object, "effects", effects_json(scene->plan));
    return object;
}

/* The open beam at the detector; empty if it has no such figures. */
static json_t *beam_json(live_scene *scene, const skg_view *view) {
    json_t *object = json_object();
    if (memcmp(&scene->beam_view, view, sizeof *view) != 0) {
        cli_session session = scene->session;
        session.view = scene->beam_view = *view;
        scene->has_beam = cli_flat_field_quality(&session, &scene->beam) == SKG_OK;
    }
    if (!scene->has_beam) return object;
    json_object_set_new(object, "mean_kev", cli_json_number(scene->beam.mean_kev));
    json_object_set_new(object, "photons", cli_json_number(scene->beam.photons));
    json_object_set_new(object, "air_kerma_ugy", cli_json_number(scene->beam.air_kerma_ugy));
    return object;
}

/* The focal spot in mm; null in a parallel beam, which has none. */
static json_t *spot_json(const live_scene *scene) {
    const skg_spot *spot = scene->session.options.spot;
    if (scene->session.view.projection != SKG_PROJECTION_POINT) return json_null();
    json_t *object = json_object();
    json_object_set_new(object, "shape", json_integer(spot ? spot->shape : SKG_SPOT_POINT));
    json_object_set_new(object, "extent", spot ? cli_json_numbers(spot->extent, 2) : json_null());
    return object;
}

/* The jaws in mm, as the scene file counts them; null if they are open. */
static json_t *jaws_json(const live_scene *scene) {
    const skg_collimation *jaws = scene->session.options.collimation;
    if (!jaws || jaws->kind == SKG_COLLIMATION_OPEN) return json_null();
    const double edges[] = {jaws->low[0], jaws->high[0], -jaws->high[1], -jaws->low[1]};
    json_t *object = json_object();
    if (jaws->kind == SKG_COLLIMATION_DETECTOR) {
        json_object_set_new(object, "margin", cli_json_number(jaws->margin_mm));
        return object;
    }
    json_object_set_new(object, "edges", cli_json_numbers(edges, 4)); /* left, right, bottom, top */
    json_object_set_new(object, "distance", cli_json_number(jaws->distance_mm));
    return object;
}

/* Of each projection, in degrees; empty without a scan. */
static json_t *angles_json(const live_scene *scene) {
    json_t *angles = json_array();
    skg_scan *scan = NULL;
    double angle;
    if (scene->projections < 1 || skg_setup_scan_get(scene->setup, &scan) != SKG_OK) return angles;
    for (int64_t k = 0; k < scene->projections && skg_scan_angle_get(scan, k, &angle) == SKG_OK; k++)
        json_array_append_new(angles, cli_json_number(angle * 180 / SKG_PI));
    return angles;
}

/* Of the radiograph of --fixed; null: there is none. */
static json_t *fixed_json(const register_image *fixed) {
    if (!fixed) return json_null();
    json_t *object = json_object();
    json_object_set_new(object, "path", cli_json_text(fixed->path));
    json_object_set_new(object, "projection",
                        fixed->projection < 0 ? json_null() : json_integer(fixed->projection));
    return object;
}

static json_t *reason_json(const char *reason) {
    return reason ? json_string(reason) : json_null();
}

/* Why switches of a slice change nothing; null: they do. */
static json_t *without_json(const live_scene *scene) {
    json_t *object = json_object();
    json_object_set_new(object, "spectrum", reason_json(live_slice_without_spectrum(scene)));
    json_object_set_new(object, "motion", reason_json(live_slice_without_motion(scene)));
    return object;
}

json_t *live_describe_scene(const live_base *base, live_scene *scene, const live_wish *wish,
                            int64_t geometry) {
    json_t *object = json_object(), *inner = json_object();
    char sentence[LIVE_SENTENCE];
    skg_view view;
    const char *text = NULL;
    if (!live_scene_view(base, scene, wish, &view, sentence)) view = scene->session.view;
    json_t *document = skg_setup_text_get(scene->setup, &text) == SKG_OK ? json_loads(text, 0, NULL) : NULL;
    json_object_set_new(inner, "document", document ? document : json_null());
    json_object_set_new(inner, "warnings", json_deep_copy(base->warnings));
    json_object_set_new(inner, "path", cli_json_text(base->path));
    json_object_set_new(inner, "device", cli_json_text(base->device.name));
    json_object_set_new(inner, "state", live_wish_json(wish));
    json_object_set_new(inner, "geometry", json_integer(geometry));
    json_object_set_new(inner, "parts", json_integer(scene->parts));
    json_object_set_new(inner, "projections", json_integer(scene->projections));
    json_object_set_new(inner, "period", scene->motion ? cli_json_number(scene->period) : json_null());
    json_object_set_new(inner, "load_ms", cli_json_number(scene->load_ms));
    json_object_set_new(inner, "plan_ms", cli_json_number(scene->plan_ms));
    json_object_set_new(inner, "channel", cli_json_text(scene->channel.name));
    json_object_set_new(inner, "unit", cli_json_text(scene->channel.unit));
    json_object_set_new(inner, "plan", plan_json(scene));
    json_object_set_new(inner, "beam", beam_json(scene, &view));
    json_object_set_new(inner, "dose", scene->dose ? json_incref(scene->dose) : json_null());
    json_object_set_new(inner, "spot", spot_json(scene));
    json_object_set_new(inner, "jaws", jaws_json(scene));
    json_object_set_new(inner, "angles", angles_json(scene));
    json_object_set_new(inner, "fixed", fixed_json(base->fixed));
    json_object_set_new(inner, "without", without_json(scene));
    json_object_set_new(object, "scene", inner);
    return object;
}

static json_t *stages_json(const skg_plan *plan) {
    json_t *stages = json_object();
    int64_t count = 0;
    if (skg_plan_stage_count(plan, &count) != SKG_OK) return stages;
    for (int64_t i = 0; i < count; i++) {
        skg_stage stage;
        skg_stage_init(&stage);
        if (skg_plan_stage_get(plan, i, &stage) == SKG_OK)
            json_object_set_new(stages, stage.name, cli_json_number(stage.ns * 1e-6));
    }
    return stages;
}

static json_t *scatter_json(const live_scene *scene) {
    skg_scatter_report report;
    skg_scatter_report_init(&report);
    if (!scene->session.options.scatter || skg_plan_scatter_report_get(scene->shown_plan, &report) != SKG_OK)
        return json_null();
    json_t *object = json_object();
    json_object_set_new(object, "mean", cli_json_number(report.mean));
    json_object_set_new(object, "sigma", cli_json_number(report.sigma));
    json_object_set_new(object, "histories", json_integer(report.histories));
    json_object_set_new(object, "seconds", cli_json_number(report.seconds));
    return object;
}

json_t *live_describe_phase(const live_wish *wish, int64_t number, double ms) {
    json_t *object = json_object();
    json_object_set_new(object, "shot", json_integer(number));
    json_object_set_new(object, "wish", json_integer(wish->number));
    json_object_set_new(object, "ms", cli_json_number(ms));
    json_object_set_new(object, "phase", cli_json_number(wish->phase));
    return object;
}

json_t *live_describe_shot(live_scene *scene, const live_wish *wish, const skg_view *view, int64_t number,
                           double ms) {
    json_t *object = live_describe_phase(wish, number, ms), *seen = json_object();
    const int is_draft = wish->dragging && scene->draft;
    json_object_set_new(object, "state", live_wish_json(wish));
    json_object_set_new(object, "stages", stages_json(scene->shown_plan));
    json_object_set_new(object, "beam", beam_json(scene, view));
    json_object_set_new(object, "scatter", is_draft ? json_null() : scatter_json(scene));
    if (live_page_view(scene, view, seen) == CLI_DONE)
        json_object_set_new(object, "view", seen);
    else
        json_decref(seen);
    return object;
}

/* Adds bytes to a sum by which scenes are told apart (FNV-1a). */
static uint64_t mix(uint64_t sum, const void *bytes, size_t size) {
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < size; i++) sum = (sum ^ byte[i]) * 1099511628211u;
    return sum;
}

int64_t live_geometry_of(const live_scene *scene) {
    uint64_t sum = 14695981039346656037u;
    for (int64_t i = 0; i < scene->parts; i++) {
        skg_part part;
        skg_mesh_health health;
        skg_part_init(&part);
        skg_mesh_health_init(&health);
        if (skg_scene_part_get(scene->session.scene, i, &part) != SKG_OK ||
            skg_mesh_health_get(part.mesh, &health) != SKG_OK)
            continue;
        sum = mix(sum, part.label, strlen(part.label));
        sum = mix(sum, part.pose, sizeof part.pose);
        sum = mix(sum, health.bounds, sizeof health.bounds);
        sum = mix(sum, &health.triangles, sizeof health.triangles);
    }
    return (int64_t)(sum >> 12); /* which a number of JavaScript holds exactly */
}
