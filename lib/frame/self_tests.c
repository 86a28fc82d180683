#include "device/self_tests.h"
#include "frame/plan.h"

/* The self-tests of the kernels that a plan uses. */
static uint32_t tests_of(const skg_plan *plan, const skg_view *view) {
    const skg_recipe *recipe = plan->recipe;
    const skg_effect_state *effects = plan->outcome.effects;
    static const struct {
        int effect;
        skg_self_test test;
    } of_effects[] = {{SKG_EFFECT_ENERGIES, SKG_SELF_TEST_ENERGIES},
                      {SKG_EFFECT_SOURCE_PLANE, SKG_SELF_TEST_SOURCE_PLANE},
                      {SKG_EFFECT_LEAKY, SKG_SELF_TEST_LEAKY},
                      {SKG_EFFECT_PRIORITY, SKG_SELF_TEST_PRIORITY},
                      {SKG_EFFECT_NOISE, SKG_SELF_TEST_NOISE},
                      {SKG_EFFECT_BLUR, SKG_SELF_TEST_BLUR},
                      {SKG_EFFECT_ELECTRONIC, SKG_SELF_TEST_DETECTOR},
                      {SKG_EFFECT_QUANTISATION, SKG_SELF_TEST_DETECTOR},
                      {SKG_EFFECT_HEEL, SKG_SELF_TEST_HEEL},
                      {SKG_EFFECT_BOWTIE, SKG_SELF_TEST_SHADES},
                      {SKG_EFFECT_GRID, SKG_SELF_TEST_SHADES},
                      {SKG_EFFECT_OBLIQUE, SKG_SELF_TEST_SHADES},
                      {SKG_EFFECT_SUPERSAMPLING, SKG_SELF_TEST_RAYS},
                      {SKG_EFFECT_DEPTHS, SKG_SELF_TEST_DEPTHS},
                      {SKG_EFFECT_DQE, SKG_SELF_TEST_APART}};
    static const skg_self_test of_strategies[] = {[SKG_STRATEGY_AUTO] = SKG_SELF_TEST_CORE,
                                                  [SKG_STRATEGY_COPIES] = SKG_SELF_TEST_COPIES,
                                                  [SKG_STRATEGY_TILES] = SKG_SELF_TEST_TILES,
                                                  [SKG_STRATEGY_ATOMICS] = SKG_SELF_TEST_ATOMICS};
    uint32_t tests = UINT32_C(1) << of_strategies[recipe->strategy];
    if (recipe->options.precision == SKG_PRECISION_DOUBLE) tests |= UINT32_C(1) << SKG_SELF_TEST_DOUBLE;
    if (recipe->options.precision == SKG_PRECISION_HALF) tests |= UINT32_C(1) << SKG_SELF_TEST_HALF;
    if (view->projection != SKG_PROJECTION_POINT) tests |= UINT32_C(1) << SKG_SELF_TEST_PARALLEL;
    if (plan->outcome.side)
        tests |= UINT32_C(1) << (plan->outcome.side > 1 ? SKG_SELF_TEST_SIDE : SKG_SELF_TEST_PASSES);
    for (size_t i = 0; i < sizeof of_effects / sizeof *of_effects; i++)
        if (effects[of_effects[i].effect].on) tests |= UINT32_C(1) << of_effects[i].test;
    return tests;
}

skg_status skg_plan_self_test(const skg_plan *plan, const skg_view *view) {
    const uint32_t tests = tests_of(plan, view);
    for (int test = 0; test < SKG_SELF_TESTS; test++)
        if (tests >> test & 1) SKG_TRY(skg_self_test_need(plan->context, (skg_self_test)test));
    return SKG_OK;
}
