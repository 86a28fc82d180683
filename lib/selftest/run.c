/* The table of self-tests, which the device calls through a hook. */
#include "selftest/selftest.h"

static skg_status run(skg_context *context, skg_self_test number, skg_verdict *verdict) {
    switch (number) {
    case SKG_SELF_TEST_PARALLEL:
        return skg_self_test_exact(context, verdict);
    case SKG_SELF_TEST_PICTURE:
        return skg_self_test_picture(context, verdict);
    case SKG_SELF_TEST_SCATTER:
        return skg_self_test_scatter(context, verdict);
    case SKG_SELF_TEST_GRADIENT:
    case SKG_SELF_TEST_CELLS:
        return skg_self_test_gradient(context, number, verdict);
    case SKG_SELF_TEST_DENSITIES:
        return skg_self_test_densities(context, verdict);
    case SKG_SELF_TEST_PULSES:
        return skg_self_test_pulses(context, verdict);
    default:
        return skg_self_test_image(context, number, verdict);
    }
}

const skg_self_test_hook skg_self_tests = {.run = run};
