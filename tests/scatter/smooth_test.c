/* Smoothing by cosines: known functions with known noise. */
#include "scatter/smoothing.h"
#include "scatter/tracing.h"

#include "suite.h"
#include "support/random.h"

#include <float.h>
#include <math.h>

static const double PI = 3.14159265358979323846;

enum { BATCHES = 32, SEEDS = 40 };

/* Standard normal, by Box and Muller. */
static double normal(uint64_t *state) {
    const double u = draw(state, 0x1p-53, 1), v = draw(state, 0, 1);
    return sqrt(-2 * log(u)) * cos(2 * PI * v);
}

typedef struct {
    int64_t columns, rows;
    int cosines;   /* along each side of the truth; 0: nothing at all */
    double spread; /* of a batch's value in a place */
    double wave;   /* spread of a single cosine, (16, 3), as a lattice of points has them */
    double *truth, *values;
} subject;

/* A mean of 1, and cosines of which none is lost in the noise. */
static void make(subject *s, uint64_t seed) {
    const int64_t places = s->rows * s->columns;
    s->truth = calloc((size_t)places, sizeof *s->truth);
    s->values = calloc((size_t)(places * BATCHES), sizeof *s->values);
    for (int64_t p = 0; p < places; p++) {
        const double x = ((double)(p % s->columns) + 0.5) / (double)s->columns;
        const double y = ((double)(p / s->columns) + 0.5) / (double)s->rows;
        for (int n = 0; n < s->cosines; n++)
            for (int m = 0; m < s->cosines; m++)
                s->truth[p] += cos(PI * m * x) * cos(PI * n * y) / (1 + m + n);
    }
    for (int64_t b = 0; b < BATCHES; b++) {
        const double wave = s->wave > 0 ? s->wave * normal(&seed) : 0;
        for (int64_t p = 0; p < places; p++) {
            const double x = ((double)(p % s->columns) + 0.5) / (double)s->columns;
            const double y = ((double)(p / s->columns) + 0.5) / (double)s->rows;
            s->values[b * places + p] = s->truth[p] + (s->spread > 0 ? s->spread * normal(&seed) : 0) +
                                        wave * cos(16 * PI * x) * cos(3 * PI * y);
        }
    }
}

static void drop(subject *s) {
    free(s->truth);
    free(s->values);
}

static void fit(const subject *s, skg_cosines *c) {
    const skg_arrivals arrivals = {BATCHES, s->columns, s->rows, s->values};
    ck_skg(skg_cosines_fit(&arrivals, c));
}

/* A place holds this share of a cosine's value at its middle. */
static double share(int64_t k, int64_t count) {
    const double x = PI * (double)k / (2 * (double)count);
    return k ? sin(x) / x : 1;
}

/* The mean square error of the smooth function at the middles of the places; the truth is in means over them. */
static double square_error(const subject *s, const skg_cosines *c) {
    const int64_t places = s->rows * s->columns;
    double sum = 0;
    for (int64_t p = 0; p < places; p++) {
        const double x = ((double)(p % s->columns) + 0.5) / (double)s->columns;
        const double y = ((double)(p / s->columns) + 0.5) / (double)s->rows;
        double off = 0;
        for (int64_t k = 0; k < places; k++) {
            const int64_t m = k % s->columns, n = k / s->columns;
            const double wave = cos(PI * (double)m * x) * cos(PI * (double)n * y);
            off += c->value[k] * sqrt((m ? 2.0 : 1.0) * (n ? 2.0 : 1.0) / (double)places) * wave;
            if (m < s->cosines && n < s->cosines)
                off -= wave / (double)(1 + m + n) / (share(m, s->columns) * share(n, s->rows));
        }
        sum += off * off;
    }
    return sum / (double)places;
}

START_TEST(errors_are_those_that_are_stated) {
    double square = 0, mean = 0;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        subject s = {.columns = 24, .rows = 20, .cosines = 8, .spread = 0.5};
        skg_cosines c;
        make(&s, seed);
        fit(&s, &c);
        ck_assert_int_ge(c.kept[0], s.cosines);
        ck_assert_int_ge(c.kept[1], s.cosines);
        const double ratio = square_error(&s, &c) / (c.sigma * c.sigma);
        square += ratio / SEEDS;
        mean += c.mean / SEEDS;
        skg_cosines_free(&c);
        drop(&s);
    }
    /* The mean square of 64 normal errors has a spread of sqrt(2 / 64), its mean over 40 draws .028, its root half of that. Twice
     * this is added to the 5 % that the smoothing may be off. */
    ck_assert_double_eq_tol(sqrt(square), 1, 0.05 + 2 * 0.014);
    /* The mean is the first coefficient's: .5 over the root of 480 places, 32 batches and 40 draws; four times that. */
    ck_assert_double_eq_tol(mean, 1, 4 * 0.5 / sqrt(480.0 * BATCHES * SEEDS));
}
END_TEST

/* Of noise alone little is kept: of 1024 coefficients as much as four of them hold, where one is there. */
START_TEST(noise_alone_is_left_out) {
    const double one = 0.25 / (BATCHES * 1024.0); /* the mean square that one coefficient's noise makes */
    int64_t most = 0;
    double found = 0, stated = 0;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        subject s = {.columns = 32, .rows = 32, .cosines = 1, .spread = 0.5};
        skg_cosines c;
        make(&s, seed);
        fit(&s, &c);
        found += square_error(&s, &c) / SEEDS, stated += c.sigma * c.sigma / SEEDS;
        if (c.kept[0] > most) most = c.kept[0];
        skg_cosines_free(&c);
        drop(&s);
    }
    ck_assert_int_le(most, 16);
    ck_assert_double_le(found, 4 * one);
    /* More may be stated, by what the choice itself is unsure of. */
    ck_assert_double_ge(stated, found);
    ck_assert_double_le(stated, 2 * found);
}
END_TEST

/* Little is kept of one cosine that is much noisier than the others, and it is no reason to keep those of lower order: its noise would
 * be taken for signal once in twenty times. */
START_TEST(a_noisy_cosine_is_left_out) {
    double with = 0, without = 0, kept = 0;
    for (uint64_t seed = 1; seed <= 5 * SEEDS; seed++)
        for (int i = 0; i < 2; i++) {
            subject s = {.columns = 24, .rows = 20, .cosines = 8, .spread = 0.5, .wave = i * 0.5};
            skg_cosines c;
            make(&s, seed);
            fit(&s, &c);
            *(i ? &with : &without) += square_error(&s, &c) / (5 * SEEDS);
            if (i) kept += c.value[3 * s.columns + 16] * c.value[3 * s.columns + 16] / (5 * SEEDS);
            skg_cosines_free(&c);
            drop(&s);
        }
    /* Noise that is kept is a square of .25 / 32 times a quarter of 480 places. */
    ck_assert_double_le(kept, 0.01 * 0.25 / 32 * 120);
    ck_assert_double_le(with, 1.05 * without);
}
END_TEST

/* Where a detector is noisier, more is stated. */
START_TEST(errors_follow_the_noise_over_the_detector) {
    enum { COLUMNS = 24, ROWS = 20 };
    double left = 0, right = 0, image[ROWS * COLUMNS];
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        subject s = {.columns = COLUMNS, .rows = ROWS, .cosines = 3, .spread = 0.5};
        skg_cosines c;
        make(&s, seed);
        for (int64_t i = 0; i < BATCHES * ROWS * COLUMNS; i++) { /* twice the noise on the right */
            const int64_t p = i % (ROWS * COLUMNS);
            if (p % COLUMNS >= COLUMNS / 2) s.values[i] += s.values[i] - s.truth[p];
        }
        fit(&s, &c);
        ck_skg(skg_cosines_show(&c, 1, ROWS, COLUMNS, image));
        for (int p = 0; p < ROWS * COLUMNS; p++)
            *(p % COLUMNS < COLUMNS / 4        ? &left
              : p % COLUMNS >= 3 * COLUMNS / 4 ? &right
                                               : &(double){0}) += image[p] - c.bias;
        skg_cosines_free(&c);
        drop(&s);
    }
    /* Four times the variance; a few cosines see a quarter of the detector each way. */
    ck_assert_double_ge(right / left, 2.5);
    ck_assert_double_le(right / left, 4.5);
}
END_TEST

START_TEST(without_noise_the_function_comes_back) {
    subject s = {.columns = 16, .rows = 12, .cosines = 5};
    skg_cosines c;
    double image[12 * 16], coarse[4 * 5], sum = 0;
    make(&s, 0);
    fit(&s, &c);
    /* Of the sum of a few values of about 1. */
    ck_assert_double_le(square_error(&s, &c), 64 * DBL_EPSILON);
    ck_assert_double_le(c.sigma, 64 * sqrt(DBL_EPSILON)); /* the root of a difference of such squares */
    ck_skg(skg_cosines_show(&c, 0, 12, 16, image));
    for (int p = 0; p < 12 * 16; p++) sum += image[p];
    ck_assert_double_eq_tol(sum / (12 * 16), 1, 64 * DBL_EPSILON);
    /* On coarser pixels there is as much. */
    ck_skg(skg_cosines_show(&c, 0, 4, 5, coarse));
    sum = 0;
    for (int p = 0; p < 4 * 5; p++) sum += coarse[p];
    ck_assert_double_eq_tol(sum / (12 * 16), 1, 64 * DBL_EPSILON);
    skg_cosines_free(&c);
    drop(&s);
}
END_TEST

/* A place holds the mean over it: the function itself is shown. */
START_TEST(places_are_means_over_their_pixels) {
    enum { FINE = 256 };
    double values[BATCHES * 8] = {0}, image[FINE];
    const skg_arrivals arrivals = {BATCHES, 8, 1, values};
    skg_cosines c;
    for (int64_t b = 0; b < BATCHES; b++)
        for (int i = 0; i < 8; i++) /* the integral of 1 + cos(3 pi x) over the place, times 8 */
            values[b * 8 + i] = 1 + 8 * (sin(3 * PI * (i + 1) / 8) - sin(3 * PI * i / 8)) / (3 * PI);
    ck_skg(skg_cosines_fit(&arrivals, &c));
    ck_assert_int_eq(c.rows, 1);
    ck_assert_int_eq(c.kept[1], 1);
    ck_skg(skg_cosines_show(&c, 0, 1, FINE, image));
    for (int i = 0; i < FINE; i++)
        ck_assert_double_eq_tol(image[i] * FINE / 8, 1 + cos(3 * PI * (i + 0.5) / FINE), 64 * DBL_EPSILON);
    skg_cosines_free(&c);
}
END_TEST

START_TEST(nothing_stays_nothing) {
    subject s = {.columns = 7, .rows = 3};
    skg_cosines c;
    double image[21];
    make(&s, 0);
    fit(&s, &c);
    ck_assert_double_eq(c.mean, 0);
    ck_assert_double_eq(c.sigma, 0);
    ck_assert_double_eq(c.bias, 0);
    for (int squares = 0; squares < 2; squares++) {
        ck_skg(skg_cosines_show(&c, squares, 3, 7, image));
        for (int p = 0; p < 21; p++) ck_assert_double_eq(image[p], 0);
    }
    skg_cosines_free(&c);
    drop(&s);
}
END_TEST

/* Rounds of an error that falls with a power of the histories, from 100 % after 1,024 of a batch on. */
static skg_rounds follow(double power, double tolerance, double *error) {
    const skg_scatter asked = {.size = sizeof asked, .tolerance = tolerance};
    skg_rounds rounds = skg_rounds_begin(&asked, 512, tolerance);
    do *error = pow(1024.0 / (double)rounds.end, power);
    while (skg_rounds_next(&rounds, *error));
    return rounds;
}

/* Noise comes down to what was asked for; what falls so slowly that the lattice's points would not do is given up at 4 million photons,
 * and a number of histories is one round. */
START_TEST(rounds_end_where_the_error_falls_too_slowly) {
    double error = 0;
    skg_rounds rounds = follow(0.5, 0.02, &error);
    ck_assert(!rounds.gave_up && error <= 0.02);
    rounds = follow(0.3, 0.02, &error);
    ck_assert_int_eq(rounds.gave_up, 1);
    ck_assert_int_eq(rounds.end, 1 << 17);
    rounds = follow(0, 0.02, &error);
    ck_assert_int_eq(rounds.gave_up, 1);
    const skg_scatter fixed = {.size = sizeof fixed, .histories = 1000};
    rounds = skg_rounds_begin(&fixed, 512, 0);
    ck_assert_int_eq(rounds.end * SKG_SCATTER_BATCHES, 1024); /* 32 for each batch */
    ck_assert(!skg_rounds_next(&rounds, 1) && !rounds.gave_up);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, rounds_end_where_the_error_falls_too_slowly);
    tcase_add_test(tests, errors_are_those_that_are_stated);
    tcase_add_test(tests, noise_alone_is_left_out);
    tcase_add_test(tests, a_noisy_cosine_is_left_out);
    tcase_add_test(tests, errors_follow_the_noise_over_the_detector);
    tcase_add_test(tests, without_noise_the_function_comes_back);
    tcase_add_test(tests, places_are_means_over_their_pixels);
    tcase_add_test(tests, nothing_stays_nothing);
}

SKG_SUITE_MAIN("scatter/smooth", add_tests)
