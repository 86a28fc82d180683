/* A million tetrahedra in one mesh: no unbalanced pixel, no sum that wraps, the lengths right. */
#include "hard/balance.h"
#include "suite.h"
#include "support/verdict.h"

START_TEST(a_million_tetrahedra) {
    const double box[3] = {50, 50, 50};
    /* Small ones that fill a third of the box, and large ones that overlap twenty times. */
    const double size = _i ? 4 : 1;
    const skg_view view = run_view(128, 1.1);
    solid s = solid_tetrahedra(1000000, size, box, 12);
    uint64_t seed = 2;
    double *got = run_solid(&s, NULL, &view, (run_choice){0});
    caster *c = caster_create(&s, NULL);
    verdict v = {0};
    verdict_cast(&v, c, &view, got, window_of(&s, NULL, &view), 12, 0, &seed);
    /* A ray meets about a hundred small ones. Each is as exact as its own size and place allow, with corners
     * in pixels to 2^-18 (floats, 64 pixels from the part's own): 1 mm per pixel, sqrt(200) hits, over the 40
     * mm of all. */
    ck_assert_msg(verdict_rms(&v) <= 3e-6 && verdict_worst(&v) <= 1e-5, "rms %.3g, worst %.3g of Lmax",
                  verdict_rms(&v), verdict_worst(&v));
    for (int64_t p = 0; p < 128 * 128; p++) ck_assert(got[p] >= -1e-3 * v.longest && got[p] <= 2 * v.longest);
    verdict_free(&v);
    caster_free(c);
    free(got);
    ck_assert_int_eq(count_bad(&s, NULL, &view, 63.5, 0.05, (run_choice){0}), 0);
    solid_free(&s);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, a_million_tetrahedra, 0, 2);
}

SKG_SUITE_MAIN("million", add_tests)
