/* Makes a plan: a recipe, a machine for it, and what is known before the first frame. */
#include "core/text.h"
#include "device/device.h"
#include "device/self_tests.h"
#include "frame/frames.h"
#include "frame/plans.h"
#include "plan/decisions.h"
#include "scene/scene.h"
#include "scene/volume.h"

#include <skiagraph/plan.h>

/* Finds overlaps while programs are loaded and nodes are searched. */
static skg_status find_overlaps(skg_plan *plan, skg_plan_overlaps *found) {
    skg_frame_prefetch(plan->recipe, &plan->machine);
    skg_prefetch_begin(plan->context);
    const skg_status status = skg_plan_overlaps_find(plan->recipe, found);
    skg_prefetch_wait(plan->context);
    return status;
}

/* Completes the recipe and what follows from it. */
static skg_status complete(skg_plan *plan, skg_plan_overlaps *found) {
    skg_machine *machine = &plan->machine;
    skg_outcome *outcome = &plan->outcome;
    skg_recipe *adapted = NULL;
    SKG_TRY(skg_recipe_complete(plan->recipe, plan->context));
    SKG_TRY(skg_machine_complete(plan->recipe, machine));
    SKG_TRY(skg_outcome_create(plan->recipe, outcome));
    SKG_TRY(skg_plan_overlaps_take(plan->recipe, plan->context, found, outcome));
    /* The scenes of a self-test are none of the caller's, who would look for their parts. */
    if (!plan->context->device->self_testing) skg_plan_warn_doubts(plan->recipe, plan->context);
    SKG_TRY(skg_frame_prepare(plan->recipe, machine, outcome));
    SKG_TRY(skg_samples_adapt(plan->recipe, machine, outcome, &adapted));
    skg_recipe_release(&plan->recipe);
    plan->recipe = adapted;
    SKG_TRY(skg_plan_precision_warn(plan->recipe, plan->context));
    return skg_effects_find(plan->recipe, plan->context, &machine->layers, outcome);
}

static skg_status make(skg_plan *plan, skg_scene *scene, const skg_view *view, skg_spectrum *spectrum,
                       const skg_plan_options *given) {
    skg_plan_options options;
    skg_plan_overlaps found = {0};
    skg_plan_options_init(&options);
    if (given) SKG_TRY(skg_struct_read(given, "skg_plan_options", &options, sizeof options));
    SKG_TRY(skg_recipe_create(plan->context, scene, view, spectrum, &options, &plan->recipe));
    SKG_TRY(skg_machine_assemble(plan->context, plan->recipe, &options, &plan->machine));
    skg_status status = find_overlaps(plan, &found);
    if (status == SKG_OK) status = complete(plan, &found);
    skg_buffer_forget(plan->context);
    skg_plan_overlaps_release(&found);
    return status;
}

/* Cells and what is linear between them are programs of their own, of which a plan needs those of its volumes. */
static uint64_t tests_of_volumes(const skg_scene *scene) {
    uint64_t tests = 0;
    for (int64_t p = 0; p < scene->count; p++)
        if (scene->parts[p].volume)
            tests |=
                UINT64_C(1) << (scene->parts[p].volume->linear ? SKG_SELF_TEST_LINEAR : SKG_SELF_TEST_VOLUME);
    return tests;
}

/* The self-tests of the kernels that a plan uses. */
static uint64_t tests_of(const skg_plan *plan, const skg_view *view) {
    const skg_recipe *recipe = plan->recipe;
    static const skg_self_test of_strategies[] = {[SKG_STRATEGY_AUTO] = SKG_SELF_TEST_CORE,
                                                  [SKG_STRATEGY_COPIES] = SKG_SELF_TEST_COPIES,
                                                  [SKG_STRATEGY_TILES] = SKG_SELF_TEST_TILES,
                                                  [SKG_STRATEGY_ATOMICS] = SKG_SELF_TEST_ATOMICS};
    uint64_t tests = UINT64_C(1) << of_strategies[recipe->strategy];
    if (recipe->options.precision == SKG_PRECISION_DOUBLE) tests |= UINT64_C(1) << SKG_SELF_TEST_DOUBLE;
    if (recipe->options.precision == SKG_PRECISION_HALF) tests |= UINT64_C(1) << SKG_SELF_TEST_HALF;
    if (view->projection != SKG_PROJECTION_POINT) tests |= UINT64_C(1) << SKG_SELF_TEST_PARALLEL;
    if (plan->outcome.side)
        tests |= UINT64_C(1) << (plan->outcome.side > 1 ? SKG_SELF_TEST_SIDE : SKG_SELF_TEST_PASSES);
    for (int e = 0; e < SKG_EFFECTS; e++)
        if (plan->outcome.effects[e].on) tests |= UINT64_C(1) << skg_effect_row_get(e)->self_test;
    const uint64_t of_cells = UINT64_C(1) << SKG_SELF_TEST_VOLUME;
    return tests & of_cells ? (tests & ~of_cells) | tests_of_volumes(recipe->scene) : tests;
}

/* Makes sure that the device has passed the self-tests of the kernels that the plan uses. */
static skg_status self_test(const skg_plan *plan, const skg_view *view) {
    const uint64_t tests = tests_of(plan, view);
    skg_device *device = plan->context->device;
    if (!device->self_testing) device->planes = plan->recipe->model.planes;
    for (int test = 0; test < SKG_SELF_TESTS; test++)
        if (tests >> test & 1) SKG_TRY(skg_self_test_need(plan->context, (skg_self_test)test));
    return SKG_OK;
}

static skg_status create(skg_context *context, skg_scene *scene, const skg_view *view, skg_spectrum *spectrum,
                         const skg_plan_options *options, skg_plan **plan) {
    SKG_PLAIN;
    SKG_TRY(skg_context_enter(context));
    SKG_NEEDS_OF("skg_plan_create", plan);
    *plan = NULL;
    SKG_NEEDS_OF("skg_plan_create", scene);
    SKG_NEEDS_OF("skg_plan_create", spectrum);
    if (scene->count == 0)
        return skg_fail(SKG_ERR_SCENE, "the scene has no parts; add one with skg_scene_part_add");
    SKG_TRY(skg_view_check(view));
    skg_plan *made = NULL;
    SKG_TRY(skg_alloc(1, sizeof *made, "plan", &made));
    skg_refs_init(&made->refs);
    made->context = context, skg_ref(&context->refs);
    skg_status status = make(made, scene, view, spectrum, options);
    if (status == SKG_OK) status = self_test(made, view);
    if (status != SKG_OK) skg_plan_release(&made);
    *plan = made;
    return status;
}

skg_status skg_plan_create(skg_context *context, skg_scene *scene, const skg_view *view,
                           skg_spectrum *spectrum, const skg_plan_options *options, skg_plan **plan) {
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, create(context, scene, view, spectrum, options, plan));
}
