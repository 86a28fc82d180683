/* A plan after it was made: references, another view, and a scene that has changed. */
#include "frame/plans.h"

#include "core/text.h"
#include "frame/quiet.h"
#include "plan/decisions.h"

#include <string.h>

skg_status skg_plan_retain(skg_plan *plan) {
    SKG_NEEDS(plan);
    skg_ref(&plan->refs);
    return SKG_OK;
}

void skg_plan_release(skg_plan **plan) {
    if (!plan || !*plan) return;
    skg_plan *last = *plan;
    *plan = NULL;
    if (!skg_unref(&last->refs)) return;
    skg_machine_release(&last->machine);
    skg_outcome_release(&last->outcome);
    skg_scatterer_release(&last->scatterer);
    skg_recipe_release(&last->recipe);
    skg_context_release(&last->context);
    skg_free(&last);
}

/* From now on the plan has another recipe. */
static void replace(skg_plan *plan, skg_recipe *recipe) {
    skg_recipe_release(&plan->recipe);
    plan->recipe = recipe;
}

static skg_status move(skg_plan *plan, const skg_view *view) {
    SKG_PLAIN;
    SKG_NEEDS_OF("skg_plan_view_set", plan);
    SKG_TRY(skg_context_enter(plan->context));
    SKG_TRY(skg_view_check(view));
    skg_view moved;
    skg_recipe *recipe = NULL;
    skg_view_init(&moved);
    SKG_TRY(skg_struct_read(view, "skg_view", &moved, sizeof moved));
    if (memcmp(&moved, &plan->recipe->view, sizeof moved) == 0) return SKG_OK;
    SKG_TRY(skg_decide_view(plan->recipe, &moved));
    SKG_TRY(skg_recipe_copy(plan->recipe, &recipe));
    recipe->view = moved;
    replace(plan, recipe);
    return SKG_OK;
}

skg_status skg_plan_view_set(skg_plan *plan, const skg_view *view) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(begun, move(plan, view));
}

skg_status skg_plan_renew(skg_plan *plan) {
    const skg_scene *scene = plan->recipe->scene;
    skg_recipe *renewed = NULL;
    if (scene->structure != plan->recipe->structure)
        return skg_fail(
            SKG_STALE,
            "parts of the scene were added or put elsewhere since the plan was made; make a new plan");
    if (scene->materials == plan->recipe->materials) return SKG_OK;
    SKG_TRY(skg_recipe_renew(plan->recipe, &renewed));
    const skg_status status = skg_machine_renew(renewed, &plan->machine);
    if (status != SKG_OK) {
        skg_recipe_release(&renewed);
        return status;
    }
    skg_outcome_renew(renewed, &plan->outcome);
    replace(plan, renewed);
    return SKG_OK;
}

skg_call skg_plan_call_begin(const skg_plan *plan) {
    return skg_call_begin(plan ? plan->context : NULL);
}

int32_t skg_plan_warned_unseen_set(skg_plan *plan, int32_t warned) {
    const int32_t before = plan->outcome.warned_unseen;
    plan->outcome.warned_unseen = warned;
    return before;
}
