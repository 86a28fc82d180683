#include "plan/effects.h"
#include "beam/spectrum.h"
#include "core/names.h"
#include "geometry/priority.h"
#include "plan/costs.h"
#include "plan/decide.h"
#include "plan/shade_effects.h"
#include "spectral/quantity.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* What effects are found from, and where they go. */
typedef struct {
    const skg_recipe *recipe;
    const skg_context *context;
    const skg_layers *layers;
    skg_outcome *outcome;
} finding;

/* From this many energies on it is worth a warning that all are used: most beams need 8 to 24. */
enum { MANY_ENERGIES = 25 };

static void find_noise(const finding *f) {
    const skg_plan_options *options = &f->recipe->options;
    const int assumes = skg_response_assumes_efficiency(options->response);
    if (!options->noise) {
        skg_effect_set(f->outcome, SKG_EFFECT_NOISE, 0, "not asked for");
        return;
    }
    if (skg_quantity_counts(options))
        skg_effect_set(f->outcome, SKG_EFFECT_NOISE, 1,
                       "asked for; photons are counted, so the variance is the mean%s",
                       assumes ? "; every photon is taken as recorded" : "");
    else
        skg_effect_set(
            f->outcome, SKG_EFFECT_NOISE, 1,
            "asked for; Swank factor %g%s; photon by photon if fewer than %g are detected in a pixel%s",
            options->swank, options->response ? " times that of the response" : "", SKG_FEW_PHOTONS,
            assumes ? "; every photon is taken as recorded" : "");
    if (assumes)
        skg_log(
            f->context, SKG_LOG_WARNING,
            "noise with an energy response that gives no efficiency: every photon that arrives is taken as "
            "recorded, so the noise is the least possible; give the efficiency as a third column, or Meaning "
            "\"absorbed\" if photons leave either all of their energy or nothing");
}

static void find_layers(const finding *f) {
    const skg_plan_options *options = &f->recipe->options;
    const skg_dqe *dqe = options->dqe;
    if (options->depth_blur)
        skg_effect_set(f->outcome, SKG_EFFECT_DEPTHS, 1,
                       "%d depths of the scintillator, each with a blur of its own; the deepest has %s",
                       (int)options->depth_blur->count,
                       skg_blur_kind(f->layers->blurs[f->layers->count - 1]));
    else
        skg_effect_set(f->outcome, SKG_EFFECT_DEPTHS, 0,
                       "not asked for: the blur is the same for all energies");
    if (dqe && options->noise)
        skg_effect_set(f->outcome, SKG_EFFECT_DQE, 1,
                       "noise power by a DQE of %g at 0 to %g at %g per mm; noise is blurred by %s",
                       dqe->dqe[0], dqe->dqe[dqe->count - 1], dqe->per_mm[dqe->count - 1],
                       skg_blur_kind(f->layers->blurs[f->layers->count - 1]));
    else
        skg_effect_set(f->outcome, SKG_EFFECT_DQE, 0, "%s",
                       dqe ? "there is no noise" : "not asked for: noise is blurred as the signal is");
}

static void find_detector(const finding *f) {
    const skg_plan_options *options = &f->recipe->options;
    find_noise(f);
    find_layers(f);
    if (f->recipe->is_blurred && !options->depth_blur)
        skg_effect_set(f->outcome, SKG_EFFECT_BLUR, 1, "%s of the detector is given",
                       skg_blur_kind(f->layers->blurs[0]));
    else
        skg_effect_set(f->outcome, SKG_EFFECT_BLUR, 0, "no line or point spread function is given");
    if (options->electronic_kev > 0)
        skg_effect_set(f->outcome, SKG_EFFECT_ELECTRONIC, 1, "standard deviation of %g keV per pixel",
                       options->electronic_kev);
    else
        skg_effect_set(f->outcome, SKG_EFFECT_ELECTRONIC, 0, "not asked for");
    if (options->quantum_step_kev > 0)
        skg_effect_set(f->outcome, SKG_EFFECT_QUANTISATION, 1, "steps of %g keV per pixel",
                       options->quantum_step_kev);
    else
        skg_effect_set(f->outcome, SKG_EFFECT_QUANTISATION, 0, "no step is given");
}

static void set_priority(const finding *f, int64_t competing) {
    if (!f->recipe->priority_possible)
        skg_effect_set(f->outcome, SKG_EFFECT_PRIORITY, 0,
                       "no two parts of one parent differ in priority, and none is clipped");
    else if (competing == 0)
        skg_effect_set(f->outcome, SKG_EFFECT_PRIORITY, 0,
                       "parts of different priority keep apart in the plan's view");
    else
        skg_effect_set(f->outcome, SKG_EFFECT_PRIORITY, 1,
                       "hits of %" PRId64 " parts are listed: they may compete%s", competing,
                       f->recipe->options.clip ? ", or leave their parents" : "");
}

/* Effects that follow from where the parts lie. */
static skg_status find_places(const finding *f) {
    const skg_recipe *recipe = f->recipe;
    const skg_scene *scene = recipe->scene;
    skg_camera camera;
    skg_extent *extents = NULL;
    skg_priority priority = {0};
    int64_t near = 0;
    skg_status status = SKG_OK;
    SKG_TRY(skg_camera_make(&recipe->view, NULL, 0, 0, &camera));
    SKG_TRY(skg_alloc(scene->count, sizeof *extents, "effects", &extents));
    for (int64_t i = 0; i < scene->count; i++) {
        skg_extent_find(&camera, scene->parts[i].mesh, scene->parts[i].pose, skg_recipe_last_bit(recipe),
                        &extents[i]);
        near += extents[i].near_source && extents[i].on_detector;
    }
    if (near)
        skg_effect_set(f->outcome, SKG_EFFECT_SOURCE_PLANE, 1, "%" PRId64 " %s the plane where rays start",
                       near, skg_plural(near, "part reaches", "parts reach"));
    else
        skg_effect_set(f->outcome, SKG_EFFECT_SOURCE_PLANE, 0, "no part reaches the plane where rays start");
    if (recipe->priority_possible)
        SKG_TRY_CLEANUP(skg_priority_find(scene, recipe->options.clip, &camera, extents, &priority));
    set_priority(f, priority.count);
    skg_costs_estimate(recipe, f->layers, extents, &priority, f->outcome);
cleanup:
    skg_priority_release(&priority);
    skg_free(&extents);
    return status;
}

static void find_samples(const finding *f) {
    const skg_samples *samples = &f->recipe->samples;
    const double error = f->outcome->report.sample_error;
    static const char *const shapes[] = {"point", "line",   "rectangle",    "cube",
                                         "disc",  "sphere", "Gaussian spot"};
    const char *shape = shapes[samples->spot.shape];
    if (samples->spot.shape == SKG_SPOT_POINT)
        skg_effect_set(f->outcome, SKG_EFFECT_SOURCE, 0, "%s",
                       f->recipe->view.projection == SKG_PROJECTION_POINT ? "the source is a point: one pass"
                                                                          : "the beam is parallel: one pass");
    else if (error > 0)
        skg_effect_set(
            f->outcome, SKG_EFFECT_SOURCE, 1,
            "%s: %" PRId64
            " samples; the last doubling changed 99.9 %% of the pixels by less than %.2g of the flat "
            "field",
            shape, samples->spot_count, error);
    else
        skg_effect_set(f->outcome, SKG_EFFECT_SOURCE, 1, "%s: %" PRId64 " samples, as asked for", shape,
                       samples->spot_count);
    if (samples->shifts > 1)
        skg_effect_set(f->outcome, SKG_EFFECT_SUPERSAMPLING, 1, "%" PRId64 " x %" PRId64 " rays a pixel, %s",
                       samples->shifts, samples->shifts, f->recipe->fine_reason);
    else
        skg_effect_set(f->outcome, SKG_EFFECT_SUPERSAMPLING, 0, "one ray a pixel, at its centre");
}

static void find_beam(const finding *f) {
    const skg_plan_options *options = &f->recipe->options;
    skg_attenuation attenuation;
    const char *world = "";
    if (options->world && skg_material_name_get(options->world, &world) == SKG_OK)
        skg_effect_set(f->outcome, SKG_EFFECT_WORLD, 1, "the parts stand in %s", world);
    else
        skg_effect_set(f->outcome, SKG_EFFECT_WORLD, 0, "the parts stand in vacuum");
    const int counts = skg_quantity_counts(options);
    if (options->response)
        skg_effect_set(f->outcome, SKG_EFFECT_RESPONSE, 1,
                       counts ? "photons are counted by the share of them that the detector records"
                              : "photons count by what the detector records of their energy");
    else if (counts)
        skg_effect_set(f->outcome, SKG_EFFECT_RESPONSE, 0, "the detector is ideal: it counts all photons");
    else
        skg_effect_set(f->outcome, SKG_EFFECT_RESPONSE, 0,
                       "the detector is ideal: all photons, all their energy");
    skg_decide_attenuation(f->recipe, &attenuation);
    if (attenuation.falloff && f->recipe->view.projection != SKG_PROJECTION_POINT)
        skg_effect_set(f->outcome, SKG_EFFECT_FALLOFF, 0,
                       "the beam is parallel: its intensity is the same everywhere");
    else if (attenuation.falloff)
        skg_effect_set(
            f->outcome, SKG_EFFECT_FALLOFF, 1,
            "inverse square and obliquity, from the foot of the source's perpendicular on the detector's "
            "plane on");
    else
        skg_effect_set(f->outcome, SKG_EFFECT_FALLOFF, 0,
                       options->falloff ? "ratios to the flat field do not show it"
                                        : "photons are counted per pixel");
}

static void find_compression(const finding *f) {
    const skg_plan_options *options = &f->recipe->options;
    const skg_model *model = &f->recipe->model;
    const int effect = SKG_EFFECT_COMPRESSION;
    char logarithm[96] = "";
    if (model->verified > 0 && options->quantity == SKG_QUANTITY_ATTENUATION)
        snprintf(logarithm, sizeof logarithm, "; of -ln(I/I0) %.2g, at transmissions down to %.2g",
                 model->log_error, model->least);
    if (model->verified > 0)
        skg_effect_set(f->outcome, effect, 1,
                       "%" PRId32 " of %" PRId32 " energies and %" PRId32 " %s for %" PRId32
                       " %s; error of transmissions%s at most %.2g%s, verified on %" PRId64 " points",
                       model->nodes, model->bins, model->planes, skg_plural(model->planes, "plane", "planes"),
                       model->materials, skg_plural(model->materials, "material", "materials"),
                       model->variances ? " and variances" : "", model->bound, logarithm, model->verified);
    else if (model->bins == 1)
        skg_effect_set(f->outcome, effect, 0, "the beam has one energy");
    else if (options->precision == SKG_PRECISION_HALF)
        skg_effect_set(f->outcome, effect, 0,
                       "half precision keeps every energy and a plane per material, as the paper");
    else if (options->tolerance > 0)
        skg_effect_set(f->outcome, effect, 0, "no fewer energies meet a tolerance of %g: every one is used",
                       options->tolerance);
    else
        skg_effect_set(f->outcome, effect, 0, "tolerance 0: every energy is used");
    if (model->verified == 0 && options->tolerance > 0 && options->precision != SKG_PRECISION_HALF &&
        model->materials > 0 && model->bins >= MANY_ENERGIES)
        skg_log(f->context, SKG_LOG_WARNING,
                "compression does not pay: no fewer energies meet a tolerance of %g, so all %" PRId32
                " are used; filter the beam as its tube does, or allow a larger tolerance",
                options->tolerance, model->bins);
}

static void find_energies(const finding *f) {
    const skg_model *model = &f->recipe->model;
    if (model->bins > 1)
        skg_effect_set(f->outcome, SKG_EFFECT_ENERGIES, 1,
                       "%" PRId32 " %s, %" PRId32 " %s for %" PRId32 " %s", model->nodes,
                       skg_plural(model->nodes, "energy", "energies"), model->planes,
                       skg_plural(model->planes, "plane", "planes"), model->materials,
                       skg_plural(model->materials, "material", "materials that differ"));
    else
        skg_effect_set(f->outcome, SKG_EFFECT_ENERGIES, 0,
                       "the beam has one energy: one exponential per pixel, one plane");
}

static void find_nesting(const finding *f) {
    const skg_scene *scene = f->recipe->scene;
    int64_t nested = 0;
    for (int64_t i = 0; i < scene->count; i++) nested += scene->parts[i].inside >= 0;
    if (nested)
        skg_effect_set(f->outcome, SKG_EFFECT_NESTING, 1,
                       "%" PRId64 " %s a parent: differences of mu, no pass", nested,
                       skg_plural(nested, "part displaces", "parts displace"));
    else
        skg_effect_set(f->outcome, SKG_EFFECT_NESTING, 0, "no part names a parent");
}

static void find_leaky(const finding *f) {
    static const char *const repairs[] = {
        [SKG_REPAIR_NONE] = "not asked for: bad pixels are left out",
        [SKG_REPAIR_NEIGHBOURS] = "bad pixels of a part get the mean of its nearest valid ones",
        [SKG_REPAIR_EXACT] =
            "rays of bad pixels are traced again on the host, through meshes with their holes capped",
    };
    const int64_t count = f->recipe->leaky_count;
    const int32_t repair = f->recipe->options.repair;
    if (count == 0) {
        skg_effect_set(f->outcome, SKG_EFFECT_LEAKY, 0, "every mesh is closed: signed hits cancel exactly");
        skg_effect_set(f->outcome, SKG_EFFECT_REPAIR, 0, "every mesh is closed");
        return;
    }
    skg_effect_set(f->outcome, SKG_EFFECT_LEAKY, 1,
                   "%" PRId64 " %s not closed: each has a plane and a count of its own", count,
                   skg_plural(count, "part is", "parts are"));
    skg_effect_set(f->outcome, SKG_EFFECT_REPAIR, repair != SKG_REPAIR_NONE, "%s", repairs[repair]);
}

static void find_overlaps(const finding *f) {
    const int64_t count = f->outcome->overlap_count, side = f->outcome->overlap_side;
    char grid[128] = "";
    if (side > 0 && side < SKG_OVERLAP_SIDE)
        snprintf(grid, sizeof grid,
                 "; looked for along %" PRId64 " x %" PRId64
                 " columns instead of %d x %d, which would meet more than 10^7 surfaces",
                 side, side, (int)SKG_OVERLAP_SIDE, (int)SKG_OVERLAP_SIDE);
    if (!f->recipe->options.overlaps)
        skg_effect_set(f->outcome, SKG_EFFECT_OVERLAPS, 0, "not asked for");
    else
        skg_effect_set(f->outcome, SKG_EFFECT_OVERLAPS, 1, "%" PRId64 " %s%s", count,
                       skg_plural(count, "pair of parts overlaps, or a part leaves its parent",
                                  "pairs of parts overlap or leave their parent"),
                       grid);
}

skg_status skg_effects_find(const skg_recipe *recipe, const skg_context *context, const skg_layers *layers,
                            skg_outcome *outcome) {
    const finding f = {recipe, context, layers, outcome};
    find_energies(&f);
    find_samples(&f);
    find_beam(&f);
    skg_effects_find_shades(recipe, outcome);
    find_compression(&f);
    find_nesting(&f);
    find_leaky(&f);
    find_overlaps(&f);
    find_detector(&f);
    return find_places(&f);
}
