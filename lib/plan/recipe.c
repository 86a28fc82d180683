/* Questions that a recipe answers about itself, and its references. */
#include "plan/recipe.h"
#include "geometry/optics.h"

#include <float.h>
#include <math.h>

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

/* The count of references is the one member that changes. */
skg_recipe *skg_recipe_retain(const skg_recipe *recipe) {
    skg_recipe *retained = (skg_recipe *)(uintptr_t)recipe;
    skg_ref(&retained->refs);
    return retained;
}

static void release_own(skg_recipe *recipe) {
    skg_plan_meshes_release(&recipe->meshes);
    skg_free(&recipe->channel_names);
    skg_free(&recipe->leaky);
    skg_copies_release(&recipe->copies);
    skg_response_release(&recipe->options.response);
    skg_counter_release(&recipe->options.counter);
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
