/* Makes recipes: copies the options and decides. */
#include "beam/spectrum.h"
#include "device/device.h"
#include "geometry/optics.h"
#include "geometry/priority.h"
#include "plan/decisions.h"
#include "plan/rules.h"

#include <inttypes.h>

enum { VIEWS_MAX = 1024 };

static skg_status copy_views(skg_recipe *recipe) {
    skg_plan_options *options = &recipe->options;
    const skg_view *given = options->views;
    skg_view *ours = NULL;
    if (options->view_count < 0 || options->view_count > VIEWS_MAX || (options->view_count > 0 && !given))
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " further views; 0 to %d, with the views",
                        options->view_count, VIEWS_MAX);
    SKG_TRY(skg_copies_alloc(&recipe->copies, options->view_count, sizeof *ours, "views", &ours));
    for (int64_t v = 0; v < options->view_count; v++) {
        skg_view_init(&ours[v]);
        SKG_TRY(skg_struct_read_at(given, v, "skg_view", &ours[v], sizeof *ours));
        SKG_TRY(skg_view_check(&ours[v]));
    }
    options->views = ours;
    return SKG_OK;
}

/* Retains the caller's handles, copies its arrays and structs, and drops the pointers that are read while the plan is made.
 * *spot: the caller's. */
static skg_status copy_options(skg_recipe *recipe, const skg_plan_options *given, const skg_spot **spot) {
    static const skg_detector_blur there_is_one; /* what it is was read by then */
    skg_plan_options *options = &recipe->options;
    SKG_TRY(skg_struct_read(given, "skg_plan_options", options, sizeof *options));
    *spot = options->spot;
    recipe->is_blurred = options->blur != NULL || options->depth_blur != NULL;
    if (options->blur) SKG_TRY(skg_blur_take_pixels(options->blur, 0, recipe->blur_pixel_mm));
    options->spot = NULL;
    if (options->response) skg_response_retain(options->response);
    if (options->world) skg_material_retain(options->world);
    if (options->counter) skg_counter_retain(options->counter);
    SKG_TRY(skg_effects_copy(recipe));
    if (options->blur) options->blur = &there_is_one;
    return copy_views(recipe);
}

/* --- decisions */

/* Lists the parts whose meshes are not closed. */
static skg_status find_leaky(skg_recipe *recipe) {
    const skg_scene *scene = recipe->scene;
    SKG_TRY(skg_alloc(scene->count, sizeof *recipe->leaky, "leaky parts", &recipe->leaky));
    for (int64_t i = 0; i < scene->count; i++)
        if (!scene->parts[i].mesh->closed) recipe->leaky[recipe->leaky_count++] = i;
    return SKG_OK;
}

/* Half precision is offered only for what the buffers of Vidal and Villard (2016) could hold. */
static skg_status check_half(const skg_recipe *recipe) {
    if (recipe->options.precision != SKG_PRECISION_HALF) return SKG_OK;
    char names[512];
    if (recipe->view.projection != SKG_PROJECTION_POINT)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "precision half is for comparison: a point source or samples of one; take single");
    return skg_effects_refuse_half(recipe, sizeof names, names)
               ? skg_fail(SKG_ERR_UNSUPPORTED,
                          "precision half is for comparison, and not computed with %s; take single", names)
               : SKG_OK;
}

static skg_fine_request fine_request(const skg_recipe *recipe, int64_t accumulators) {
    return (skg_fine_request){
        .shifts = recipe->samples.shifts,
        .columns = recipe->view.columns,
        .rows = recipe->view.rows,
        .accumulators = accumulators,
        .triangles = skg_scene_triangles(recipe->scene),
        .precision = recipe->options.precision,
        .leaky = recipe->leaky_count > 0,
        .curved = recipe->view.radius > 0,
    };
}

/* Decides whether planes are mixed. This depends on the model and the view alone, so that frames of a renewed recipe have the
 * bits of a new one's. */
static skg_status choose_mix(skg_recipe *recipe) {
    const skg_model *model = &recipe->model;
    const skg_fine_request request = fine_request(recipe, 0);
    recipe->mixed = 0;
    if (recipe->options.precision == SKG_PRECISION_HALF) return SKG_OK; /* a plane per material */
    if (recipe->volume_count > 0) return SKG_OK;                        /* cells add to planes */
    return skg_mix_choose(recipe->scene->count, model->planes, model->contributions,
                          model->first_contribution, skg_max_mixed(&request, model->planes), &recipe->mixed);
}

int64_t skg_recipe_max_fine(const skg_recipe *recipe) {
    const skg_fine_request request = fine_request(recipe, 1);
    const char *why = NULL;
    return skg_fine_choose(&request, &why);
}

/* Decides whether one pass makes all rays of a pixel. Like the mix, this depends neither on the device nor on the past. */
static void choose_fine(skg_recipe *recipe) {
    const skg_fine_request request = fine_request(recipe, skg_recipe_accumulators(recipe));
    recipe->samples.fine = skg_fine_choose(&request, &recipe->fine_reason);
}

static skg_status choose_strategy(skg_recipe *recipe, const skg_device_info *device) {
    const skg_model *model = &recipe->model;
    skg_view view;
    skg_mix mix = {0};
    skg_samples_view(&recipe->samples, &recipe->view, &view);
    if (recipe->mixed)
        SKG_TRY(skg_mix_find(recipe->scene->count, model->planes, model->contributions,
                             model->first_contribution, recipe->mixed, &mix));
    const skg_strategy_request request = {
        .device = device,
        .scene = recipe->scene,
        .view = &view,
        .precision = recipe->options.precision,
        .wanted = recipe->options.strategy,
        .accumulators = skg_recipe_accumulators(recipe),
        .contributions = recipe->mixed ? mix.contributions : model->contributions,
        .first_contribution = recipe->mixed ? mix.first_contribution : model->first_contribution,
    };
    const skg_status status = skg_strategy_decide(&request, &recipe->strategy, &recipe->strategy_reason);
    skg_mix_release(&mix);
    /* Bands write only the few rows that a leaky part meets. Copies clear whole rectangles and are added up twice. */
    const int bands = request.wanted == SKG_STRATEGY_AUTO && recipe->strategy == SKG_STRATEGY_COPIES;
    recipe->leaky_strategy = bands ? SKG_STRATEGY_TILES : recipe->strategy;
    return status;
}

/* Chooses mixed sums, fine sums and the strategy, which depend on the planes. */
static skg_status choose_layout(skg_recipe *recipe, const skg_device_info *device) {
    SKG_TRY(choose_mix(recipe));
    choose_fine(recipe);
    return choose_strategy(recipe, device);
}

static skg_status make_model(skg_recipe *recipe) {
    recipe->owns_model = 1;
    return skg_model_begin(recipe->scene, &recipe->view, recipe->spectrum, &recipe->options, &recipe->model);
}

/* Fails if a view has no field, or if a sample of the source does not lie before the jaws. */
static skg_status check_field(const skg_recipe *recipe) {
    const skg_collimation *collimation = recipe->options.collimation;
    const int64_t passes = skg_samples_passes(&recipe->samples);
    skg_field field;
    if (!skg_collimation_limits(collimation)) return SKG_OK;
    for (int64_t v = 0; v < recipe->options.view_count; v++)
        SKG_TRY(skg_field_make(collimation, &recipe->options.views[v], &field));
    SKG_TRY(skg_field_make(collimation, &recipe->view, &field));
    for (int64_t p = 0; p < passes; p++) {
        skg_camera camera;
        int32_t window[4];
        SKG_TRY(skg_samples_camera(&recipe->samples, &recipe->view, p, &camera));
        SKG_TRY(skg_field_window(&field, &camera, window));
    }
    return SKG_OK;
}

static skg_status decide(skg_recipe *recipe, const skg_device_info *device, const skg_spot *spot) {
    const skg_plan_options *options = &recipe->options;
    const int parallel = recipe->view.projection != SKG_PROJECTION_POINT;
    SKG_TRY(skg_plan_options_check(options, device));
    SKG_TRY(skg_effects_check(options));
    SKG_TRY(skg_counting_check(recipe));
    SKG_TRY(skg_blur_check(recipe));
    if (options->falloff == SKG_FALLOFF_AUTO) recipe->options.falloff = recipe->exposure > 0;
    recipe->volume_count = skg_scene_volumes(recipe->scene);
    SKG_TRY(skg_plan_meshes_create(recipe->scene, &recipe->meshes));
    SKG_TRY(skg_plan_meshes_check(&recipe->meshes, recipe->scene));
    SKG_TRY(skg_samples_make(parallel ? NULL : spot, options->supersampling, &recipe->samples));
    if (spot) recipe->options.spot = &recipe->samples.spot;
    SKG_TRY(check_field(recipe));
    SKG_TRY(make_model(recipe));
    SKG_TRY(skg_decide_world(recipe, &recipe->view));
    SKG_TRY(skg_channel_names_create(options, recipe->model.channels, &recipe->channel_names));
    SKG_TRY(find_leaky(recipe));
    recipe->priority_possible =
        skg_priority_possible(recipe->scene, skg_priority_rules(options->clip, options->unite));
    SKG_TRY(check_half(recipe));
    SKG_TRY(skg_volumes_check(recipe));
    SKG_TRY(skg_curved_check(recipe));
    for (int64_t v = 0; v < options->view_count; v++)
        SKG_TRY(skg_curved_check_view(recipe, &options->views[v], SKG_ERR_SCENE));
    SKG_TRY(skg_scatter_check(recipe));
    return choose_layout(recipe, device);
}

/* Keeps the beam, in photons per pixel. */
static skg_status resolve(skg_recipe *recipe, const skg_context *context, skg_spectrum *spectrum) {
    if (!spectrum->absolute) {
        recipe->spectrum = spectrum, skg_ref(&spectrum->refs);
        return SKG_OK;
    }
    recipe->absolute = 1;
    if (recipe->view.projection == SKG_PROJECTION_POINT) {
        recipe->exposure = skg_view_exposure(&recipe->view);
    } else {
        skg_quality quality;
        skg_quality_init(&quality);
        SKG_TRY(skg_spectrum_quality_get(spectrum, &quality));
        skg_log(
            context, SKG_LOG_WARNING,
            "a parallel beam has no distance from a tube, so mAs does not say how many photons arrive (a point "
            "source would send %.4g to a mm2 at 1 m); the image is in units of that number per pixel",
            quality.photons);
    }
    return skg_spectrum_create_resolved(spectrum, &recipe->view, &recipe->spectrum);
}

skg_status skg_recipe_create(const skg_context *context, skg_scene *scene, const skg_view *view,
                             skg_spectrum *spectrum, const skg_plan_options *options, skg_recipe **recipe) {
    skg_recipe *made = NULL;
    const skg_spot *spot = NULL;
    skg_status status = SKG_OK;
    *recipe = NULL;
    SKG_TRY(skg_alloc(1, sizeof *made, "plan", &made));
    skg_refs_init(&made->refs);
    made->scene = scene, skg_ref(&scene->refs);
    made->structure = scene->structure;
    made->materials = scene->materials;
    skg_plan_options_init(&made->options);
    skg_view_init(&made->view);
    if (options) SKG_TRY_CLEANUP(copy_options(made, options, &spot));
    SKG_TRY_CLEANUP(skg_struct_read(view, "skg_view", &made->view, sizeof made->view));
    SKG_TRY_CLEANUP(resolve(made, context, spectrum));
    if (made->options.profile && !context->device->profiling) {
        status = skg_fail(SKG_ERR_UNSUPPORTED,
                          "profile is 1, but the context's queue keeps no times; make the queue with "
                          "CL_QUEUE_PROFILING_ENABLE, or take profile 0");
        goto cleanup;
    }
    SKG_TRY_CLEANUP(decide(made, &context->device->info, spot));
    *recipe = made;
    return SKG_OK;
cleanup:
    skg_recipe_release(&made);
    return status;
}

skg_status skg_recipe_complete(skg_recipe *recipe, const skg_context *context) {
    int changed = 0;
    SKG_TRY(skg_model_end(&recipe->model, &changed));
    return changed ? choose_layout(recipe, &context->device->info) : SKG_OK;
}

skg_status skg_recipe_renew(const skg_recipe *recipe, skg_recipe **renewed) {
    const skg_recipe *first = recipe;
    skg_recipe *made = NULL;
    int changed = 0;
    skg_status status = SKG_OK;
    *renewed = NULL;
    if (recipe->model.bound > 0)
        return skg_fail(SKG_STALE,
                        "a material has changed, and the plan's %d energies were chosen for the old ones; "
                        "make a new plan",
                        (int)recipe->model.nodes);
    while (first->origin) first = first->origin;
    SKG_TRY(skg_recipe_copy(first, &made));
    made->view = recipe->view;
    made->samples = recipe->samples;
    made->linear = recipe->linear;
    made->materials = recipe->scene->materials;
    made->model = (skg_model){0};
    SKG_TRY_CLEANUP(make_model(made));
    SKG_TRY_CLEANUP(skg_model_end(&made->model, &changed));
    SKG_TRY_CLEANUP(choose_mix(made));
    choose_fine(made);
    *renewed = made;
    return SKG_OK;
cleanup:
    skg_recipe_release(&made);
    return status;
}
