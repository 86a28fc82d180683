#include "plan/recipe.h"
#include "geometry/optics.h"
#include "plan/decisions.h"

#include <float.h>
#include <inttypes.h>
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

/* The photons of an absolute beam are found from a distance, which a parallel beam has not. */
static skg_status check_distance(const skg_recipe *recipe, const skg_view *view) {
    const int has_distance = view->projection == SKG_PROJECTION_POINT,
              had_distance = recipe->view.projection == SKG_PROJECTION_POINT;
    if (!recipe->absolute || has_distance == had_distance) return SKG_OK;
    return skg_fail(
        SKG_STALE, "the plan is for a %s and an absolute beam, the view has a %s; make a plan for it",
        had_distance ? "point source" : "parallel beam", has_distance ? "point source" : "parallel beam");
}

skg_status skg_recipe_check_world(const skg_recipe *recipe, const skg_view *view) {
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

skg_status skg_recipe_check_view(const skg_recipe *recipe, const skg_view *view) {
    SKG_TRY(skg_recipe_check_world(recipe, view));
    if (view->columns == recipe->view.columns && view->rows == recipe->view.rows)
        return check_distance(recipe, view);
    return skg_fail(SKG_STALE,
                    "the plan is for %" PRId64 " x %" PRId64 " pixels, the view has %" PRId64 " x %" PRId64
                    "; make a plan for it",
                    recipe->view.columns, recipe->view.rows, view->columns, view->rows);
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
