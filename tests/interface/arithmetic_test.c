/* A caller's rounding mode changes no number, and is as it was after the calls. */
#include "everything.h"
#include "suite.h"
#include "support/run.h"

#include <fenv.h>
#include <string.h>

static int modes[] = {FE_UPWARD, FE_TOWARDZERO};

/* The device is opened under the caller's mode: its threads must not keep it. */
START_TEST(rounding) {
    static everything rounded, nearest;
    ck_assert_int_eq(fesetround(modes[_i]), 0);
    run_open();
    do_everything(&rounded);
    ck_assert_int_eq(fegetround(), modes[_i]);
    ck_assert_int_eq(fesetround(FE_TONEAREST), 0);
    do_everything(&nearest);
    run_close();
    ck_assert_int_eq(memcmp(&rounded, &nearest, sizeof nearest), 0);
    ck_assert(nearest.image[0][EVERYTHING_PIXELS / 2] > 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, rounding, 0, 2);
}

SKG_SUITE_MAIN("arithmetic", add_tests)
