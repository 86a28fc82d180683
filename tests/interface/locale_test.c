/* A caller's decimal comma changes no file, no name and no sentence, and is as it was after the calls. */
#include "everything.h"
#include "suite.h"
#include "support/run.h"

#include <string.h>

START_TEST(decimal_comma) {
    static everything point, comma;
    skg_spectrum *beam = NULL;
    char number[16];
    run_open();
    do_everything(&point);
    if (!everything_comma()) {
        run_close();
        skip_test("no locale with a decimal comma can be made here");
    }
    do_everything(&comma);
    ck_skg_fails(skg_spectrum_create_mono(-0.5, 1, &beam), SKG_ERR_BEAM, "-0.5 keV");
    run_close();
    snprintf(number, sizeof number, "%g", 0.5);
    ck_assert_str_eq(number, "0,5");
    ck_assert_str_eq(comma.material, "HU -741.5");
    ck_assert_ptr_nonnull(strstr(comma.channel, "55.5"));
    ck_assert_int_eq(memcmp(&comma, &point, sizeof point), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, decimal_comma);
}

SKG_SUITE_MAIN("locale", add_tests)
