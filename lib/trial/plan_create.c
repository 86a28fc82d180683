/* skg_plan_create: a plan whose kernels were tested on this device. */
#include "core/plain.h"
#include "frame/plan.h"
#include "plan/effects.h"
#include "trial/trial.h"

#include <skiagraph/plan.h>

/* The tests of what a plan uses. */
static uint64_t tests_of(const skg_plan *plan, const skg_view *view) {
    const skg_recipe *recipe = plan->recipe;
    static const skg_trial_number of_strategies[] = {[SKG_STRATEGY_AUTO] = SKG_TRIAL_CORE,
                                                     [SKG_STRATEGY_COPIES] = SKG_TRIAL_COPIES,
                                                     [SKG_STRATEGY_TILES] = SKG_TRIAL_TILES,
                                                     [SKG_STRATEGY_ATOMICS] = SKG_TRIAL_ATOMICS};
    uint64_t tests = UINT64_C(1) << of_strategies[recipe->strategy];
    if (recipe->options.precision == SKG_PRECISION_DOUBLE) tests |= UINT64_C(1) << SKG_TRIAL_DOUBLE;
    if (recipe->options.precision == SKG_PRECISION_HALF) tests |= UINT64_C(1) << SKG_TRIAL_HALF;
    if (view->projection != SKG_PROJECTION_POINT) tests |= UINT64_C(1) << SKG_TRIAL_PARALLEL;
    if (plan->outcome.side)
        tests |= UINT64_C(1) << (plan->outcome.side > 1 ? SKG_TRIAL_SIDE : SKG_TRIAL_PASSES);
    for (int e = 0; e < SKG_EFFECTS; e++) {
        const char *test = skg_effect_row_get(e)->self_test;
        if (plan->outcome.effects[e].on && test) tests |= UINT64_C(1) << skg_trial_find(test);
    }
    return tests;
}

static skg_status create(skg_context *context, skg_scene *scene, const skg_view *view, skg_spectrum *spectrum,
                         const skg_plan_options *options, skg_plan **plan) {
    SKG_PLAIN;
    SKG_TRY(skg_context_enter(context));
    SKG_NEEDS_OF("skg_plan_create", plan);
    *plan = NULL;
    SKG_NEEDS_OF("skg_plan_create", scene);
    SKG_NEEDS_OF("skg_plan_create", spectrum);
    SKG_TRY(skg_plan_make(context, scene, view, spectrum, options, plan));
    const uint64_t tests = tests_of(*plan, view);
    for (int test = 0; test < SKG_TRIALS; test++) {
        if (!(tests >> test & 1)) continue;
        const skg_status status = skg_trial_need(context, (skg_trial_number)test);
        if (status == SKG_OK) continue;
        skg_plan_release(plan);
        return status;
    }
    return SKG_OK;
}

skg_status skg_plan_create(skg_context *context, skg_scene *scene, const skg_view *view,
                           skg_spectrum *spectrum, const skg_plan_options *options, skg_plan **plan) {
    const skg_error_handler handler = skg_call_begin(context);
    return skg_call_end(handler, create(context, scene, view, spectrum, options, plan));
}
