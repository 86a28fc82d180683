/* The effect of a curved detector, and what is not computed with one. */
#include "plan/decisions.h"
#include "plan/rules.h"
#include "scene/curve.h"

#include <skiagraph/collimation.h>

#include <math.h>

static int is_curved(const skg_recipe *recipe) {
    return recipe->view.radius > 0;
}

static int has_collimation(const skg_recipe *recipe) {
    return skg_collimation_limits(recipe->options.collimation);
}

static int has_grid(const skg_recipe *recipe) {
    return recipe->options.grid != NULL;
}

static int has_oblique(const skg_recipe *recipe) {
    return recipe->options.oblique != 0;
}

static int has_scatter(const skg_recipe *recipe) {
    return recipe->options.scatter != NULL;
}

static int traces_again(const skg_recipe *recipe) {
    return recipe->leaky_count > 0 && recipe->options.repair == SKG_REPAIR_EXACT;
}

/* Effects that are made for rays to a flat detector alone. */
static const struct {
    int (*is_on)(const skg_recipe *recipe);
    const char *what, *mend;
} refused[] = {
    {has_collimation, "jaws", "leave the collimation out"},
    {has_grid, "an anti-scatter grid", "leave the grid out"},
    {has_oblique, "a scintillator that rays cross obliquely", "leave oblique out"},
    {has_scatter, "scattered photons", "leave the scatter out"},
    {traces_again, "rays through leaky meshes that are traced again",
     "close the meshes, or take another repair"},
};

skg_status skg_curved_check(const skg_recipe *recipe) {
    for (size_t k = 0; is_curved(recipe) && k < sizeof refused / sizeof *refused; k++)
        if (refused[k].is_on(recipe))
            return skg_fail(SKG_ERR_UNSUPPORTED,
                            "a curved detector is not computed with %s; %s, or take a flat one",
                            refused[k].what, refused[k].mend);
    return SKG_OK;
}

skg_status skg_curved_check_view(const skg_recipe *recipe, const skg_view *view, skg_status status) {
    if ((view->radius > 0) == is_curved(recipe)) return SKG_OK;
    return skg_fail(status, "the plan is for a %s detector, the view has a %s one; make a plan for it",
                    is_curved(recipe) ? "curved" : "flat", is_curved(recipe) ? "flat" : "curved");
}

static skg_status refuse_gradient(const char *call, const skg_recipe *recipe, int by_view) {
    (void)by_view;
    if (!is_curved(recipe)) return SKG_OK;
    return skg_effect_no_gradient(call, "the image of a curved detector", "take a flat one");
}

static void find_curved(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_view *view = &f->recipe->view;
    if (!is_curved(f->recipe)) {
        skg_effect_set(state, 0, "the detector is flat");
        return;
    }
    skg_curvature curve;
    skg_curvature_find(view, NULL, &curve);
    skg_effect_set(state, 1, "columns stand on a cylinder of radius %.6g mm, %.4g degrees apart",
                   view->radius, curve.angle * 180 / acos(-1.0));
}

const skg_effect_row skg_effect_curved = {
    .name = "curved detector",
    .key = "Curved",
    .refuses_half = is_curved,
    .refuses_gradient = refuse_gradient,
    .find = find_curved,
};
