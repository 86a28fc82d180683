/* The self-tests that a plan needs. */
#include "device/self_tests.h"
#include "frame/plans.h"
#include "plan/decisions.h"
#include "scene/scene.h"
#include "scene/volume.h"

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

skg_status skg_plan_self_test(const skg_plan *plan, const skg_view *view) {
    const uint64_t tests = tests_of(plan, view);
    skg_device *device = plan->context->device;
    if (!device->self_testing) device->planes = plan->recipe->model.planes;
    for (int test = 0; test < SKG_SELF_TESTS; test++)
        if (tests >> test & 1) SKG_TRY(skg_self_test_need(plan->context, (skg_self_test)test));
    return SKG_OK;
}
