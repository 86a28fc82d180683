#include "geometry/optics.h"
#include "plan/decisions.h"
#include "spectral/model.h"

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
                               .apart = options->noise && options->dqe,
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
        .over_flat_field = ratio && (options->world || options->falloff || model->shades.count > 0)};
    *wanted = skg_quantity_is_absolute(options) &&
              (ratio || areas || detection->electronic > 0 || detection->step > 0);
    for (int32_t c = 0; *wanted && c < model->channels; c++) {
        if (ratio && !(model->flat_field[c] > 0))
            return skg_fail(SKG_ERR_BEAM,
                            "channel %d records nothing of the flat field, so there is no ratio to it",
                            (int)c);
        factors[c] = ratio && !detection->over_flat_field ? 1 / model->flat_field[c] : 1;
    }
    return SKG_OK;
}
