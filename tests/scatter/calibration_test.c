/* The error that is stated against the error that is found, over many seeds. */
#include "subject.h"
#include "suite.h"

#include <math.h>

/* 40 x 30 pixels in blocks of 5 x 5. */
enum {
    SEEDS = 40,
    COLUMNS = 40,
    ROWS = 30,
    PIXELS = COLUMNS * ROWS,
    SIDE = 5,
    ACROSS = COLUMNS / SIDE,
    BLOCKS = PIXELS / (SIDE * SIDE)
};

/* The mean square of a block's pixels, of errors over what is stated, lies between these in 95 of 100 cases if 40 seeds have
 * independent normal errors and a block's pixels have the same: quantiles of chi square with 40 degrees over 40. */
static const double LOWEST = 0.611, HIGHEST = 1.484;

static pictures take(int64_t histories, int64_t seed) {
    subject s;
    subject_open(&s);
    subject_fill(&s);
    s.scatter.histories = histories, s.scatter.seed = seed;
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    subject_close(&s);
    return p;
}

/* Adds the squares of errors over what is stated. */
static void add(const pictures *p, const float *truth, double *blocks, double *all) {
    for (int i = 0; i < PIXELS; i++) {
        const double off = (double)(p->scatter[i] - truth[i]) / (double)p->sigma[i];
        blocks[i / COLUMNS / SIDE * ACROSS + i % COLUMNS / SIDE] += off * off / (SIDE * SIDE * SEEDS);
        *all += off * off / (PIXELS * SEEDS);
    }
}

START_TEST(errors_are_as_large_as_stated) {
    double blocks[BLOCKS] = {0}, all = 0;
    int within = 0;
    pictures truth = take(1 << 20, SEEDS);
    for (int64_t seed = 0; seed < SEEDS; seed++) {
        pictures p = take(1 << 14, seed);
        add(&p, truth.scatter, blocks, &all);
        pictures_free(&p);
    }
    for (int b = 0; b < BLOCKS; b++) within += blocks[b] > LOWEST && blocks[b] < HIGHEST;
    printf("error over what is stated: %.3f; blocks as expected: %d of %d\n", sqrt(all), within, BLOCKS);
    fflush(stdout); /* before an assertion ends the process */
    /* Some 30 cosines are kept: the root mean square of 40 x 30 normal errors is known to 1 / sqrt(2 x 1200), .02. Twice this is
     * added to 5 %. */
    ck_assert_double_eq_tol(sqrt(all), 1, 0.05 + 2 * 0.02);
    /* 95 % of the blocks, less twice the spread of their number, sqrt(48 x .95 x .05): neighbours go together, which widens it. */
    ck_assert_int_ge(within, (int)(0.95 * BLOCKS) - 4);
    pictures_free(&truth);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, errors_are_as_large_as_stated);
}

SKG_SUITE_MAIN("scatter/calibration", add_tests)
