/* How the error before smoothing falls with the number of histories. */
#include "subject.h"
#include "suite.h"
#include "sums.h"

#include <math.h>

/* The grid of 40 x 30 pixels. */
enum { PLACES = 32 * 24 };

/* The root mean square over the places of the standard error of one order (0: first, 1: second, 2: higher), over its mean. */
static double error_of(const int64_t *sums, int order) {
    double square = 0, mean = 0;
    for (int64_t p = 0; p < PLACES; p++) {
        double sum = 0, squares = 0;
        for (int64_t b = 0; b < SUMS_BATCHES; b++) {
            const int64_t *of = sums + b * SUMS_PLANES * PLACES + p;
            const double value = (double)of[order * PLACES] + (double)of[(order + 3) * PLACES];
            sum += value, squares += value * value;
        }
        square += (squares - sum * sum / SUMS_BATCHES) * SUMS_BATCHES / (SUMS_BATCHES - 1.0) / PLACES;
        mean += sum / PLACES;
    }
    return sqrt(square) / mean;
}

static void take(int64_t histories, double errors[3]) {
    static int64_t sums[SUMS_BATCHES * SUMS_PLANES * PLACES];
    subject s;
    subject_open(&s);
    subject_fill(&s);
    s.scatter.histories = histories;
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    ck_skg(sums_read(run_context, s.plan, sums));
    for (int order = 0; order < 3; order++) errors[order] = error_of(sums, order);
    pictures_free(&p);
    subject_close(&s);
}

/* Eight times the histories have an error that is smaller by the root of 8, or by more where the lattice of points helps. */
START_TEST(errors_fall_with_the_root_of_the_histories) {
    double few[3], many[3];
    take(1 << 14, few);
    take(1 << 17, many);
    for (int order = 0; order < 3; order++)
        printf("order %d: %.4f, then %.4f: 1 / %.2f\n", order + 1, few[order], many[order],
               few[order] / many[order]);
    fflush(stdout); /* before an assertion ends the process */
    for (int order = 0; order < 3;
         order++) /* heavy photons are rare, and the spread of 32 batches is known to 13 % */
        ck_assert_double_ge(few[order] / many[order], 0.85 * sqrt(8));
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, errors_fall_with_the_root_of_the_histories);
}

SKG_SUITE_MAIN("scatter/convergence", add_tests)
