/* CMA-ES: known minima, the same bits from a saved state, bounds, restarts, eigenvalues. */
#include "core/eigen.h"
#include "evolution/functions.h"

#include <float.h>

/* The bar is 1e-10 at 15 dimensions within 8000 evaluations. Quadratic functions take one model: a few generations after
 * there are points for its 136 terms. */
START_TEST(known_minima) {
    static const int64_t most[FUNCTIONS] = {1000, 8000, 1000};
    for (int64_t seed = 1; seed <= 5; seed++) {
        skg_search s;
        search_for(SKG_SEARCH_CMA, _i, 15, seed, 1e-10, most[_i], &s);
        ck_assert_double_le(*s.best_value, 1e-10); /* the bar */
        for (int k = 0; k < 15; k++) {
            /* The least eigenvalue is 1 in x, and x is ten times as wide as the box; Rosenbrock's is about 0.5. */
            ck_assert_double_eq_tol(s.best[k], _i == ROSENBROCK ? 0.6 : 0.63, 2e-6);
        }
        skg_search_free(&s);
    }
}
END_TEST

static void tell_values(skg_search *s, int function) {
    static double q[SKG_SEARCH_MAX * SKG_SEARCH_MAX], values[4096];
    const int n = (int)s->dimensions;
    make_rotation(n, q);
    ck_skg(skg_search_ask(s));
    for (int64_t i = 0; i < s->counters[SEARCH_POPULATION]; i++)
        values[i] = value_of(function, n, q, s->points + n * i);
    ck_skg(skg_search_tell(s, values));
}

/* With more dimensions than a model has, the distribution alone finds the minimum. */
START_TEST(many_dimensions) {
    skg_search s;
    search_for(SKG_SEARCH_CMA, SPHERE, 24, 1, 1e-10, 6000, &s);
    ck_assert_double_le(*s.best_value, 1e-10); /* as above */
    skg_search_free(&s);
}
END_TEST

START_TEST(a_saved_state_continues_with_the_same_bits) {
    const double start[6] = {0.5, 0.5, 0.5, 0.5, 0.5, 0.5};
    skg_search whole, part;
    ck_skg(skg_search_create(_i, 6, start, 7, &whole));
    ck_skg(skg_search_create(_i, 6, start, 7, &part));
    for (int g = 0; g < 40; g++) tell_values(&whole, ROSENBROCK);
    for (int g = 0; g < 15; g++) tell_values(&part, ROSENBROCK);
    skg_search resumed;
    ck_skg(skg_search_create(_i, 6, start, 7, &resumed));
    memcpy(resumed.counters, part.counters, sizeof part.counters);
    memcpy(resumed.numbers, part.numbers, (size_t)part.number_count * sizeof(double));
    skg_search_free(&part);
    for (int g = 15; g < 40; g++) tell_values(&resumed, ROSENBROCK);
    ck_assert_mem_eq(resumed.numbers, whole.numbers, (size_t)whole.number_count * sizeof(double));
    ck_assert_mem_eq(resumed.counters, whole.counters, sizeof whole.counters);
    skg_search_free(&whole);
    skg_search_free(&resumed);
}
END_TEST

/* The sphere about a point outside of the box: the least value lies on its faces. */
START_TEST(bounds_hold) {
    const double start[5] = {0.2, 0.9, 0.5, 0.5, 0.1}, centre[5] = {1.4, -0.3, 0.5, 0.25, 2};
    skg_search s;
    double values[512];
    ck_skg(skg_search_create(SKG_SEARCH_CMA, 5, start, 3, &s));
    while (s.counters[SEARCH_EVALUATIONS] < 3000) {
        ck_skg(skg_search_ask(&s));
        for (int64_t i = 0; i < s.counters[SEARCH_POPULATION]; i++) {
            values[i] = 0;
            for (int k = 0; k < 5; k++) {
                const double x = s.points[5 * i + k];
                ck_assert(x >= 0 && x <= 1);
                values[i] += (x - centre[k]) * (x - centre[k]);
            }
        }
        ck_skg(skg_search_tell(&s, values));
    }
    for (int k = 0; k < 5; k++) {
        const double expected = fmin(fmax(centre[k], 0), 1);
        ck_assert_double_eq_tol(s.best[k], expected, 1e-5); /* squares of it vanish beside 2: 1e-10 */
    }
    skg_search_free(&s);
}
END_TEST

/* A function that is flat everywhere: restarts, doubles its population, and ends nowhere else. */
START_TEST(flat_functions_restart) {
    const double start[4] = {0.5, 0.5, 0.5, 0.5};
    double values[512] = {0};
    skg_search s;
    ck_skg(skg_search_create(SKG_SEARCH_CMA, 4, start, 3, &s));
    const int64_t first = s.counters[SEARCH_POPULATION];
    int64_t most = first;
    for (int g = 0; g < 600; g++) {
        ck_skg(skg_search_ask(&s));
        ck_skg(skg_search_tell(&s, values));
        if (s.counters[SEARCH_POPULATION] > most) most = s.counters[SEARCH_POPULATION];
    }
    ck_assert_int_ge(s.counters[SEARCH_RESTARTS], 8);
    ck_assert_int_eq(most, 16 * first);
    ck_assert_mem_eq(s.best, start, sizeof start); /* the first point is the start */
    skg_search_free(&s);
}
END_TEST

/* Of 12 and of 64 dimensions, the most that a search has. */
START_TEST(eigenvectors) {
    static double a[SKG_EIGEN_MAX * SKG_EIGEN_MAX], v[SKG_EIGEN_MAX * SKG_EIGEN_MAX], values[SKG_EIGEN_MAX];
    const int n = _i == 0 ? 12 : SKG_EIGEN_MAX;
    ck_assert_int_eq(SKG_EIGEN_MAX, SKG_SEARCH_MAX);
    uint64_t state = 3;
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) a[n * i + j] = a[n * j + i] = draw(&state, -1, 1);
    memcpy(v, a, sizeof v);
    skg_eigen_rising(n, v, values);
    for (int k = 0; k < n; k++) {
        if (k > 0) ck_assert_double_le(values[k - 1], values[k]);
        for (int i = 0; i < n; i++) {
            double sum = 0;
            for (int j = 0; j < n; j++) sum += a[n * i + j] * v[n * j + k];
            /* A rotation rounds a few times, and most of the 12 sweeps are of zeros. */
            ck_assert_double_eq_tol(sum, values[k] * v[n * i + k], 64 * n * DBL_EPSILON);
        }
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, known_minima, 0, FUNCTIONS);
    tcase_add_test(tests, many_dimensions);
    tcase_add_loop_test(tests, a_saved_state_continues_with_the_same_bits, 0, 2);
    tcase_add_test(tests, bounds_hold);
    tcase_add_test(tests, flat_functions_restart);
    tcase_add_loop_test(tests, eigenvectors, 0, 2);
}

SKG_SUITE_MAIN("search", add_tests)
