#include "core/names.h"
#include "geometry/extent.h"
#include "plan/report.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

static void set(skg_plan *plan, int effect, int on, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static void set(skg_plan *plan, int effect, int on, const char *format, ...) {
    skg_effect_state *state = &plan->effects[effect];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(state->reason, sizeof state->reason, format, arguments);
    va_end(arguments);
    state->on = on;
}

static void tell_noise(skg_plan *plan) {
    const skg_plan_options *options = &plan->options;
    if (options->noise)
        set(plan, SKG_EFFECT_NOISE, 1,
            "asked for; Swank factor %g; photon by photon where fewer than %g are detected in a pixel",
            options->swank, SKG_FEW_PHOTONS);
    else
        set(plan, SKG_EFFECT_NOISE, 0, "not asked for");
    if (plan->blur)
        set(plan, SKG_EFFECT_BLUR, 1, "%s of the detector is given", skg_blur_kind(plan->blur));
    else
        set(plan, SKG_EFFECT_BLUR, 0, "no line or point spread function is given");
    if (options->electronic_kev > 0)
        set(plan, SKG_EFFECT_ELECTRONIC, 1, "standard deviation of %g keV per pixel",
            options->electronic_kev);
    else
        set(plan, SKG_EFFECT_ELECTRONIC, 0, "not asked for");
    if (options->quantum_step_kev > 0)
        set(plan, SKG_EFFECT_QUANTISATION, 1, "steps of %g keV per pixel", options->quantum_step_kev);
    else
        set(plan, SKG_EFFECT_QUANTISATION, 0, "no step is given");
}

static void report_priorities(skg_plan *plan, int64_t competing) {
    if (!plan->priority_possible)
        set(plan, SKG_EFFECT_PRIORITY, 0,
            "no two parts of one parent differ in priority, and none is clipped");
    else if (competing == 0)
        set(plan, SKG_EFFECT_PRIORITY, 0, "parts of different priority keep apart in the plan's view");
    else
        set(plan, SKG_EFFECT_PRIORITY, 1, "hits of %" PRId64 " parts are listed: they may compete%s",
            competing, plan->options.clip ? ", or leave their parents" : "");
}

/* Effects that follow from where the parts lie. */
static skg_status report_places(skg_plan *plan) {
    const skg_scene *scene = plan->scene;
    skg_camera camera;
    skg_extent *extents = NULL;
    skg_priority priority = {0};
    int64_t near = 0;
    skg_status status = SKG_OK;
    SKG_TRY(skg_camera_make(&plan->view, NULL, 0, 0, &camera));
    SKG_TRY(skg_alloc(scene->count, sizeof *extents, "effects", &extents));
    for (int64_t i = 0; i < scene->count; i++) {
        skg_extent_find(&camera, scene->parts[i].mesh, scene->parts[i].pose, &extents[i]);
        near += extents[i].near_source && extents[i].on_detector;
    }
    if (near)
        set(plan, SKG_EFFECT_SOURCE_PLANE, 1, "%" PRId64 " %s the plane where rays start", near,
            skg_plural(near, "part reaches", "parts reach"));
    else
        set(plan, SKG_EFFECT_SOURCE_PLANE, 0, "no part reaches the plane where rays start");
    if (plan->priority_possible)
        SKG_TRY_CLEANUP(skg_priority_find(scene, plan->options.clip, extents, &priority));
    report_priorities(plan, priority.count);
    skg_report_costs(plan, extents);
cleanup:
    skg_priority_release(&priority);
    skg_free(&extents);
    return status;
}

static void tell_samples(skg_plan *plan) {
    const skg_samples *samples = &plan->samples;
    static const char *const shapes[] = {"point", "line",   "rectangle",    "cube",
                                         "disc",  "sphere", "Gaussian spot"};
    const char *shape = shapes[samples->spot.shape];
    if (samples->spot.shape == SKG_SPOT_POINT)
        set(plan, SKG_EFFECT_SOURCE, 0, "%s",
            plan->view.projection == SKG_PROJECTION_POINT ? "the source is a point: one pass"
                                                          : "the beam is parallel: one pass");
    else if (plan->report.sample_error > 0)
        set(plan, SKG_EFFECT_SOURCE, 1,
            "%s: %" PRId64
            " samples; the last doubling changed 99.9 %% of the pixels by less than %.2g of the open "
            "beam",
            shape, samples->spot_count, plan->report.sample_error);
    else
        set(plan, SKG_EFFECT_SOURCE, 1, "%s: %" PRId64 " samples, as asked for", shape, samples->spot_count);
    if (samples->shifts > 1)
        set(plan, SKG_EFFECT_SUPERSAMPLING, 1, "%" PRId64 " x %" PRId64 " rays a pixel", samples->shifts,
            samples->shifts);
    else
        set(plan, SKG_EFFECT_SUPERSAMPLING, 0, "one ray a pixel, at its centre");
}

static void tell_detector(skg_plan *plan) {
    const skg_plan_options *options = &plan->options;
    const char *world = "";
    if (options->world && skg_material_name_get(options->world, &world) == SKG_OK)
        set(plan, SKG_EFFECT_WORLD, 1, "the parts stand in %s", world);
    else
        set(plan, SKG_EFFECT_WORLD, 0, "the parts stand in vacuum");
    if (options->response)
        set(plan, SKG_EFFECT_RESPONSE, 1, "photons count by what the detector records of their energy");
    else
        set(plan, SKG_EFFECT_RESPONSE, 0, "the detector is ideal: all photons, all their energy");
    if (plan->attenuation.falloff && plan->view.projection != SKG_PROJECTION_POINT)
        set(plan, SKG_EFFECT_FALLOFF, 0, "the beam is parallel: its intensity is the same everywhere");
    else if (plan->attenuation.falloff)
        set(plan, SKG_EFFECT_FALLOFF, 1,
            "inverse square and obliquity, from the pixel nearest the perpendicular on");
    else
        set(plan, SKG_EFFECT_FALLOFF, 0,
            options->falloff ? "ratios to the open beam do not show it" : "photons are counted per pixel");
}

static void tell_compression(skg_plan *plan) {
    const skg_model *model = &plan->model;
    const int effect = SKG_EFFECT_COMPRESSION;
    if (model->verified > 0)
        set(plan, effect, 1,
            "%" PRId32 " of %" PRId32 " energies and %" PRId32 " %s for %" PRId32
            " %s; error of transmissions%s at most %.2g, verified on %" PRId64 " points",
            model->nodes, model->bins, model->planes, skg_plural(model->planes, "plane", "planes"),
            model->materials, skg_plural(model->materials, "material", "materials"),
            model->variances ? " and variances" : "", model->bound, model->verified);
    else if (model->bins == 1)
        set(plan, effect, 0, "the beam has one energy");
    else if (plan->options.precision == SKG_PRECISION_HALF)
        set(plan, effect, 0, "half precision keeps every energy and a plane per material, as the paper");
    else if (plan->options.tolerance > 0)
        set(plan, effect, 0, "no fewer energies meet a tolerance of %g: every one is used",
            plan->options.tolerance);
    else
        set(plan, effect, 0, "tolerance 0: every energy is used");
}

skg_status skg_report_effects(skg_plan *plan) {
    const skg_scene *scene = plan->scene;
    int64_t nested = 0;
    for (int64_t i = 0; i < scene->count; i++) nested += scene->parts[i].inside >= 0;
    if (plan->model.bins > 1)
        set(plan, SKG_EFFECT_ENERGIES, 1, "%" PRId32 " %s, %" PRId32 " %s for %" PRId32 " %s",
            plan->model.nodes, skg_plural(plan->model.nodes, "energy", "energies"), plan->model.planes,
            skg_plural(plan->model.planes, "plane", "planes"), plan->model.materials,
            skg_plural(plan->model.materials, "material", "materials that differ"));
    else
        set(plan, SKG_EFFECT_ENERGIES, 0, "the beam has one energy: one exponential per pixel, one plane");
    tell_samples(plan);
    tell_detector(plan);
    tell_compression(plan);
    if (nested)
        set(plan, SKG_EFFECT_NESTING, 1, "%" PRId64 " %s a parent: differences of mu, no pass", nested,
            skg_plural(nested, "part displaces", "parts displace"));
    else
        set(plan, SKG_EFFECT_NESTING, 0, "no part names a parent");
    if (plan->open_count)
        set(plan, SKG_EFFECT_OPEN, 1, "%" PRId64 " %s not closed: each has a plane and a count of its own",
            plan->open_count, skg_plural(plan->open_count, "part is", "parts are"));
    else
        set(plan, SKG_EFFECT_OPEN, 0, "every mesh is closed: signed hits cancel exactly");
    static const char *const repairs[] = {
        [SKG_REPAIR_NONE] = "not asked for: bad pixels are left out",
        [SKG_REPAIR_NEIGHBOURS] = "bad pixels of a part get the mean of its nearest valid ones",
        [SKG_REPAIR_EXACT] =
            "rays of bad pixels are cast anew on the host, through meshes with their holes capped",
    };
    if (plan->open_count)
        set(plan, SKG_EFFECT_REPAIR, plan->options.repair != SKG_REPAIR_NONE, "%s",
            repairs[plan->options.repair]);
    else
        set(plan, SKG_EFFECT_REPAIR, 0, "every mesh is closed");
    if (!plan->options.overlaps)
        set(plan, SKG_EFFECT_OVERLAPS, 0, "not asked for");
    else
        set(plan, SKG_EFFECT_OVERLAPS, 1, "%" PRId64 " %s", plan->overlap_count,
            skg_plural(plan->overlap_count, "pair of parts overlaps, or a part leaves its parent",
                       "pairs of parts overlap or leave their parent"));
    tell_noise(plan);
    return report_places(plan);
}

void skg_effect_init(skg_effect *effect) {
    if (effect) *effect = (skg_effect){.size = (int32_t)sizeof *effect};
}

skg_status skg_plan_effect_count(const skg_plan *plan, int64_t *count) {
    if (!plan || !count) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_effect_count: no plan or no result");
    *count = SKG_EFFECTS;
    return SKG_OK;
}

skg_status skg_plan_effect_get(const skg_plan *plan, int64_t index, skg_effect *effect) {
    static const char *const names[] = {
#define SKG_EFFECT_TEXT(name, text) text,
        SKG_EFFECT_LIST(SKG_EFFECT_TEXT)
#undef SKG_EFFECT_TEXT
    };
    if (!plan) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_effect_get: no plan");
    if (index < 0 || index >= SKG_EFFECTS)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_effect_get: effect %" PRId64 " of %d", index,
                        SKG_EFFECTS);
    skg_effect ours = {.size = sizeof ours,
                       .on = plan->effects[index].on,
                       .name = names[index],
                       .cost = plan->effects[index].cost,
                       .reason = plan->effects[index].reason};
    return skg_struct_write(&ours, sizeof ours, "skg_effect", effect);
}
