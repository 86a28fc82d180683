/* Makes a plan: a recipe, a machine for it, and what is known before the first frame. */
#include "device/device.h"
#include "frame/adapt.h"
#include "frame/assemble.h"
#include "frame/frame.h"
#include "frame/plan.h"
#include "plan/effects.h"
#include "plan/overlaps.h"

/* Finds overlaps while programs are loaded, and warns of them. */
static skg_status find_overlaps(skg_plan *plan) {
    skg_mesh_nesting *nestings = NULL;
    skg_frame_expect(plan->recipe, &plan->machine);
    skg_programs_load(plan->context);
    skg_status status = skg_plan_overlaps_find(plan->recipe, &plan->outcome, &nestings);
    skg_programs_wait(plan->context);
    if (status == SKG_OK)
        status = skg_plan_overlaps_warn(plan->recipe, plan->context, &plan->outcome, nestings);
    skg_free(&nestings);
    return status;
}

static skg_status make(skg_plan *plan, skg_scene *scene, const skg_view *view, skg_spectrum *spectrum,
                       const skg_plan_options *given) {
    skg_machine *machine = &plan->machine;
    skg_outcome *outcome = &plan->outcome;
    skg_plan_options options;
    skg_recipe *adapted = NULL;
    skg_plan_options_init(&options);
    if (given) SKG_TRY(skg_struct_read(given, "skg_plan_options", &options, sizeof options));
    SKG_TRY(skg_recipe_create(plan->context, scene, view, spectrum, &options, &plan->recipe));
    SKG_TRY(skg_machine_assemble(plan->context, plan->recipe, &options, machine));
    SKG_TRY(skg_outcome_create(plan->recipe, outcome));
    SKG_TRY(find_overlaps(plan));
    SKG_TRY(skg_frame_prepare(plan->recipe, machine, outcome));
    SKG_TRY(skg_samples_adapt(plan->recipe, machine, outcome, &adapted));
    skg_recipe_release(&plan->recipe);
    plan->recipe = adapted;
    return skg_effects_find(plan->recipe, plan->context, &machine->layers, outcome);
}

skg_status skg_plan_make(skg_context *context, skg_scene *scene, const skg_view *view, skg_spectrum *spectrum,
                         const skg_plan_options *options, skg_plan **plan) {
    *plan = NULL;
    if (scene->count == 0)
        return skg_fail(SKG_ERR_SCENE, "the scene has no parts; add one with skg_scene_add");
    SKG_TRY(skg_view_check(view));
    skg_plan *made = NULL;
    SKG_TRY(skg_alloc(1, sizeof *made, "plan", &made));
    skg_refs_init(&made->refs);
    made->context = context, skg_ref(&context->refs);
    const skg_status status = make(made, scene, view, spectrum, options);
    if (status != SKG_OK) skg_plan_release(&made);
    *plan = made;
    return status;
}
