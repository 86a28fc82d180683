#include "plan/recipe.h"
#include "beam/spectrum.h"
#include "device/device.h"
#include "geometry/exposure.h"
#include "geometry/priority.h"
#include "plan/choose.h"
#include "plan/options.h"
#include "spectral/quantity.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>

enum { MOST_VIEWS = 1024 };

int skg_recipe_averages(const skg_recipe *recipe) {
    return recipe->samples.spot.shape != SKG_SPOT_POINT || recipe->samples.shifts > 1;
}

/* Views whose exposures agree to this are alike: those of a turn around an object differ by the rounding of its sines. */
static const double SAME_EXPOSURE = 1e-12;

double skg_recipe_exposure(const skg_recipe *recipe, const skg_view *view) {
    if (!(recipe->exposure > 0)) return 1;
    const double ratio = skg_view_exposure(view) / recipe->exposure;
    return fabs(ratio - 1) < SAME_EXPOSURE ? 1 : ratio;
}

int64_t skg_recipe_accumulators(const skg_recipe *recipe) {
    return recipe->mixed ? recipe->mixed : recipe->model.planes;
}

int32_t skg_recipe_kernel_precision(const skg_recipe *recipe) {
    return recipe->options.precision == SKG_PRECISION_DOUBLE ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
}

double skg_recipe_last_bit(const skg_recipe *recipe) {
    return skg_recipe_kernel_precision(recipe) == SKG_PRECISION_DOUBLE ? DBL_EPSILON : (double)FLT_EPSILON;
}

/* The photons of an absolute beam are found from a distance, which a parallel beam has not. */
static skg_status check_distance(const skg_recipe *recipe, const skg_view *view) {
    const int has_distance = view->projection == SKG_PROJECTION_POINT,
              had_distance = recipe->view.projection == SKG_PROJECTION_POINT;
    if (!recipe->absolute || has_distance == had_distance) return SKG_OK;
    return skg_fail(
        SKG_STALE, "the plan is for a %s and an absolute beam, the view has a %s; make a plan for it",
        had_distance ? "point source" : "parallel beam", has_distance ? "point source" : "parallel beam");
}

skg_status skg_recipe_check_view(const skg_recipe *recipe, const skg_view *view) {
    if (view->columns == recipe->view.columns && view->rows == recipe->view.rows)
        return check_distance(recipe, view);
    return skg_fail(SKG_STALE,
                    "the plan is for %" PRId64 " x %" PRId64 " pixels, the view has %" PRId64 " x %" PRId64
                    "; make a plan for it",
                    recipe->view.columns, recipe->view.rows, view->columns, view->rows);
}

/* --- what is copied of the options */

static skg_status keep_views(skg_recipe *recipe) {
    skg_plan_options *options = &recipe->options;
    const skg_view *given = options->views;
    options->views = NULL;
    if (options->view_count < 0 || options->view_count > MOST_VIEWS || (options->view_count > 0 && !given))
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " further views; 0 to %d, with the views",
                        options->view_count, MOST_VIEWS);
    SKG_TRY(skg_alloc(options->view_count, sizeof *recipe->views, "views", &recipe->views));
    for (int64_t v = 0; v < options->view_count; v++) {
        skg_view_init(&recipe->views[v]);
        SKG_TRY(skg_struct_read_at(given, v, "skg_view", &recipe->views[v], sizeof *recipe->views));
        SKG_TRY(skg_view_check(&recipe->views[v]));
    }
    options->views = recipe->views;
    return SKG_OK;
}

static skg_status keep_bands(skg_recipe *recipe) {
    skg_plan_options *options = &recipe->options;
    const double *edges = options->band_kev;
    options->band_kev = NULL;
    if (options->bands < 0 || options->bands > SKG_CHANNELS_MAX || (options->bands > 0 && !edges))
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " bands of energy; 0 to %d, with their edges",
                        options->bands, SKG_CHANNELS_MAX);
    if (options->bands == 0) return SKG_OK;
    SKG_TRY(skg_alloc(options->bands + 1, sizeof *recipe->band_kev, "bands", &recipe->band_kev));
    for (int64_t c = 0; c <= options->bands; c++) recipe->band_kev[c] = edges[c];
    options->band_kev = recipe->band_kev;
    return SKG_OK;
}

/* Retains the caller's handles, copies its arrays, and drops the pointers that are not kept. Returns in *spot the
 * caller's, which is read later. */
static skg_status keep_options(skg_recipe *recipe, const skg_plan_options *given, const skg_spot **spot) {
    skg_plan_options *options = &recipe->options;
    SKG_TRY(skg_struct_read(given, "skg_plan_options", options, sizeof *options));
    *spot = options->spot;
    recipe->is_blurred = options->blur != NULL || options->depth_blur != NULL;
    options->spot = NULL;
    if (options->response) skg_response_retain(options->response);
    if (options->world) skg_material_retain(options->world);
    skg_status status = skg_keep(options, &recipe->kept);
    options->blur = NULL;
    if (status != SKG_OK) {
        options->band_kev = NULL, options->views = NULL;
        return status;
    }
    status = keep_views(recipe);
    if (status != SKG_OK) options->band_kev = NULL;
    return status == SKG_OK ? keep_bands(recipe) : status;
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
    const skg_plan_options *options = &recipe->options;
    if (options->precision != SKG_PRECISION_HALF) return SKG_OK;
    if (recipe->view.projection != SKG_PROJECTION_POINT || recipe->leaky_count > 0 || options->world ||
        recipe->priority_possible || recipe->is_blurred || options->heel || options->oblique ||
        options->bowtie || options->grid || skg_quantity_is_absolute(options))
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "precision half is for comparison: a point source or samples of one, closed meshes without "
            "priorities, vacuum around them, no noise, blur, heel effect, oblique scintillator, bow-tie or grid; "
            "take single");
    return SKG_OK;
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
    };
}

/* Decides whether planes are mixed. This depends on the model and the view alone, so that frames of a renewed recipe have the
 * bits of a new one's. */
static skg_status choose_mix(skg_recipe *recipe) {
    const skg_model *model = &recipe->model;
    const skg_fine_request request = fine_request(recipe, 0);
    recipe->mixed = 0;
    if (recipe->options.precision == SKG_PRECISION_HALF) return SKG_OK; /* a plane per material */
    return skg_mix_choose(recipe->scene->count, model->planes, model->contributions,
                          model->first_contribution, skg_most_mixed(&request, model->planes), &recipe->mixed);
}

int64_t skg_recipe_most_fine(const skg_recipe *recipe) {
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

/* What follows from the planes. */
static skg_status choose_layout(skg_recipe *recipe, const skg_device_info *device) {
    SKG_TRY(choose_mix(recipe));
    choose_fine(recipe);
    return choose_strategy(recipe, device);
}

static skg_status make_model(skg_recipe *recipe) {
    recipe->owns_model = 1;
    return skg_model_begin(recipe->scene, &recipe->view, recipe->spectrum, &recipe->options, &recipe->model);
}

static skg_status decide(skg_recipe *recipe, const skg_device_info *device, const skg_spot *spot) {
    const skg_plan_options *options = &recipe->options;
    const int parallel = recipe->view.projection != SKG_PROJECTION_POINT;
    SKG_TRY(skg_plan_options_check(options, device));
    if (options->falloff == SKG_FALLOFF_AUTO) recipe->options.falloff = recipe->exposure > 0;
    SKG_TRY(skg_plan_meshes_create(recipe->scene, &recipe->meshes));
    SKG_TRY(skg_plan_meshes_check(&recipe->meshes, recipe->scene));
    SKG_TRY(skg_samples_make(parallel ? NULL : spot, options->supersampling, &recipe->samples));
    if (spot) recipe->options.spot = &recipe->samples.spot;
    SKG_TRY(make_model(recipe));
    SKG_TRY(skg_channel_names_create(options, recipe->model.channels, &recipe->channel_names));
    SKG_TRY(find_leaky(recipe));
    recipe->priority_possible = skg_priority_possible(recipe->scene, options->clip);
    SKG_TRY(check_half(recipe));
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

/* --- life */

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
    if (options) SKG_TRY_CLEANUP(keep_options(made, options, &spot));
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

/* The count of references is the one member that changes. */
skg_recipe *skg_recipe_retain(const skg_recipe *recipe) {
    skg_recipe *retained = (skg_recipe *)(uintptr_t)recipe;
    skg_ref(&retained->refs);
    return retained;
}

static void release_own(skg_recipe *recipe) {
    skg_plan_meshes_release(&recipe->meshes);
    skg_free(&recipe->band_kev);
    skg_free(&recipe->views);
    skg_free(&recipe->channel_names);
    skg_free(&recipe->leaky);
    skg_kept_release(&recipe->kept);
    skg_response_release(&recipe->options.response);
    skg_material_release(&recipe->options.world);
    skg_spectrum_release(&recipe->spectrum);
    skg_scene_release(&recipe->scene);
}

void skg_recipe_release(skg_recipe **recipe) {
    if (!*recipe) return;
    skg_recipe *last = *recipe;
    *recipe = NULL;
    if (!skg_unref(&last->refs)) return;
    if (last->owns_model) skg_model_release(&last->model);
    if (last->origin)
        skg_recipe_release(&last->origin);
    else
        release_own(last);
    skg_free(&last);
}

skg_status skg_recipe_copy(const skg_recipe *recipe, skg_recipe **copy) {
    skg_recipe *made = NULL;
    *copy = NULL;
    SKG_TRY(skg_alloc(1, sizeof *made, "plan", &made));
    *made = *recipe;
    skg_refs_init(&made->refs);
    /* The recipe that owns the model keeps everything else alive, too: copies of copies do not form a chain. */
    made->origin = skg_recipe_retain(recipe->owns_model ? recipe : recipe->origin);
    made->owns_model = 0;
    *copy = made;
    return SKG_OK;
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
