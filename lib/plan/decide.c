/* Decisions that follow from a recipe: how intensities become what is shown, and which views it is for. */
#include "beam/counter.h"
#include "geometry/optics.h"
#include "plan/decisions.h"
#include "plan/rules.h"
#include "spectral/model.h"
#include "spectral/shading.h"

#include <inttypes.h>

/* Whether the weights of the model are those of a ratio already. */
static int has_ratio_weights(const skg_plan_options *options) {
    return skg_quantity_is_ratio(options) && !skg_quantity_is_absolute(options);
}

/* Whether -ln of the mean of several passes, or of noisy or blurred intensities, is wanted; else the attenuation is
 * computed with the intensities. */
static int is_late(const skg_recipe *recipe) {
    return skg_recipe_averages(recipe) || recipe->is_blurred || skg_quantity_is_absolute(&recipe->options) ||
           recipe->options.scatter;
}

int skg_decide_late_logarithm(const skg_recipe *recipe) {
    return recipe->options.quantity == SKG_QUANTITY_ATTENUATION && is_late(recipe) && !recipe->linear;
}

void skg_decide_attenuation(const skg_recipe *recipe, skg_attenuation *shape) {
    const skg_plan_options *options = &recipe->options;
    const skg_model *model = &recipe->model;
    const int is_ratio = has_ratio_weights(options);
    /* The attenuation of one energy is the exponent itself. */
    const int32_t shown = options->quantity != SKG_QUANTITY_ATTENUATION || is_late(recipe)
                              ? SKG_SHOW_INTENSITY
                          : model->nodes == 1 ? SKG_SHOW_EXPONENT
                                              : SKG_SHOW_LOGARITHM;
    /* In a ratio of one energy the world cancels. */
    const int has_world = model->world_plane >= 0 && !(is_ratio && model->nodes == 1);
    *shape = (skg_attenuation){.planes = skg_model_width(model),
                               .nodes = model->nodes,
                               .channels = skg_model_sums(model),
                               .layers = model->layers,
                               .shown = shown,
                               .world_plane = has_world ? (int32_t)model->world_plane : -1,
                               .world_weight = model->world_weight,
                               .shades = &model->shades,
                               .ratio = (has_world || model->shades.count > 0) && is_ratio,
                               .falloff = options->falloff && !is_ratio,
                               .collimated = skg_collimation_limits(options->collimation),
                               .noise = options->noise,
                               .apart = options->noise && (options->dqe || options->counter),
                               .energies = options->quantity == SKG_QUANTITY_ENERGY};
}

skg_status skg_decide_detection(const skg_recipe *recipe, skg_detection *detection, double *factors,
                                int32_t *wanted) {
    const skg_plan_options *options = &recipe->options;
    const skg_model *model = &recipe->model;
    const int ratio = skg_quantity_is_ratio(options), areas = options->quantity == SKG_QUANTITY_FLUENCE;
    *detection = (skg_detection){
        .electronic = options->electronic_kev,
        .step = options->quantum_step_kev,
        .channels = model->channels,
        .over_flat_field = ratio && (options->world || options->falloff || model->shades.count > 0 ||
                                     (options->counter && options->counter->counting.pile_up))};
    *wanted = skg_quantity_is_absolute(options) &&
              (ratio || areas || detection->electronic > 0 || detection->step > 0);
    if (*wanted && ratio) SKG_TRY(skg_counting_check_flat(recipe));
    for (int32_t c = 0; *wanted && c < model->channels; c++) {
        if (ratio && !(model->flat_field[c] > 0))
            return skg_fail(SKG_ERR_BEAM,
                            "channel %d records nothing of the flat field, so there is no ratio to it",
                            (int)c);
        factors[c] = ratio && !detection->over_flat_field ? 1 / model->flat_field[c] : 1;
    }
    return SKG_OK;
}

skg_status skg_decide_world(const skg_recipe *recipe, const skg_view *view) {
    const char *name = "";
    skg_attenuation shape;
    if (view->projection != SKG_PROJECTION_PARALLEL_FROM_INFINITY || !recipe->options.world) return SKG_OK;
    skg_decide_attenuation(recipe, &shape);
    if (shape.world_plane < 0) return SKG_OK;
    SKG_TRY(skg_material_name_get(recipe->options.world, &name));
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "a parallel beam from infinity never comes through a World of %s; give the place where it "
        "begins, or leave out the World, or take a ratio of one energy, in which it cancels",
        name);
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

skg_status skg_decide_view(const skg_recipe *recipe, const skg_view *view) {
    SKG_TRY(skg_decide_world(recipe, view));
    if (view->columns != recipe->view.columns || view->rows != recipe->view.rows)
        return skg_fail(SKG_STALE,
                        "the plan is for %" PRId64 " x %" PRId64 " pixels, the view has %" PRId64
                        " x %" PRId64 "; make a plan for it",
                        recipe->view.columns, recipe->view.rows, view->columns, view->rows);
    SKG_TRY(check_distance(recipe, view));
    SKG_TRY(skg_curved_check_view(recipe, view, SKG_STALE));
    SKG_TRY(skg_counting_check_pixels(recipe, view, SKG_STALE));
    SKG_TRY(skg_blur_check_pixels(recipe, view, SKG_STALE));
    SKG_TRY(skg_heel_covers(&recipe->model.shades, view, &recipe->options));
    SKG_TRY(skg_bowtie_covers(&recipe->model.shades, view, &recipe->options));
    SKG_TRY(skg_grid_covers(&recipe->model.shades, view, &recipe->options));
    return skg_oblique_covers(&recipe->model.shades, view, &recipe->options);
}
