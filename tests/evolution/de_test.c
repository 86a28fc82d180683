/* Differential evolution, and the random numbers of both methods. */
#include "evolution/draw.h"
#include "evolution/functions.h"

START_TEST(known_minima) {
    for (int64_t seed = 1; seed <= 3; seed++) {
        skg_search s;
        search_for(SKG_SEARCH_DE, SPHERE, 6, seed, 1e-10, 20000, &s);
        ck_assert_double_le(*s.best_value, 1e-10); /* as of CMA-ES */
        skg_search_free(&s);
    }
}
END_TEST

/* Philox4x32-10 of a counter and a key of zeros, from its authors' list of known answers: 6627e8d5 e169c58d bc57ac4c
 * 9b00dbd8. */
START_TEST(numbers_are_philox) {
    const skg_draw_key key = {0};
    const uint64_t bits = (uint64_t)0x6627e8d5 << 32 | 0xe169c58d;
    ck_assert_double_eq(skg_draw_uniform(&key, 0), (double)(bits >> 11) * 0x1p-53);
}
END_TEST

START_TEST(numbers_are_spread) {
    enum { COUNT = 40000 };
    double mean = 0, square = 0, normal = 0, normal_square = 0;
    for (int i = 0; i < COUNT; i++) {
        const skg_draw_key key = {5, i % 100, i / 100, 1};
        const double u = skg_draw_uniform(&key, 3), z = skg_draw_normal(&key, 4);
        ck_assert(u >= 0 && u < 1);
        mean += u / COUNT, square += u * u / COUNT;
        normal += z / COUNT, normal_square += z * z / COUNT;
    }
    /* Five standard errors: of the mean sqrt(1/12), of the square sqrt(4/45), of a normal deviate 1, of its square sqrt 2. */
    const double error = 5 / sqrt(COUNT);
    ck_assert_double_eq_tol(mean, 0.5, error * sqrt(1.0 / 12));
    ck_assert_double_eq_tol(square, 1.0 / 3, error * sqrt(4.0 / 45));
    ck_assert_double_eq_tol(normal, 0, error);
    ck_assert_double_eq_tol(normal_square, 1, error * sqrt(2));
}
END_TEST

START_TEST(bad_arguments) {
    const double start[1] = {0.5};
    skg_search s;
    ck_skg_fails(skg_search_create(SKG_SEARCH_DE, 0, start, 1, &s), SKG_ERR_ARGUMENT, "1 to 64");
    ck_skg_fails(skg_search_create(SKG_SEARCH_DE, 65, start, 1, &s), SKG_ERR_ARGUMENT, "1 to 64");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, known_minima);
    tcase_add_test(tests, numbers_are_philox);
    tcase_add_test(tests, numbers_are_spread);
    tcase_add_test(tests, bad_arguments);
}

SKG_SUITE_MAIN("de", add_tests)
