/* Grey values of energies, their noise, bad pixels and bits. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PIXELS = 40000 };

static const double joules_per_kev = 1.602176634e-16;

static void read_floats(const skg_readout *readout, int64_t count, const float *energies, float *grey) {
    ck_skg(skg_readout_image(readout, count, SKG_TYPE_FLOAT32, energies, 1, 0, grey));
}

static skg_readout floats(void) {
    skg_readout readout;
    skg_readout_init(&readout);
    readout.bits = 0;
    readout.dark = 100;
    readout.full = 1100;
    readout.full_kev = 50;
    return readout;
}

START_TEST(test_line_factor_and_curve) {
    const float energies[4] = {0, 10, 50, 60};
    float grey[4];
    skg_readout readout = floats();
    read_floats(&readout, 4, energies, grey);
    /* The numbers are exact in float. */
    const float line[4] = {100, 300, 1100, 1300};
    ck_assert_int_eq(memcmp(grey, line, sizeof line), 0);
    readout.per_joule = 2 / joules_per_kev;
    read_floats(&readout, 4, energies, grey);
    for (int i = 0; i < 4; i++)
        ck_assert_double_eq_tol((double)grey[i], 100 + 2 * (double)energies[i],
                                1e-4); /* 1000 times float's epsilon */
    const double curve[6] = {0, 7, 20 * joules_per_kev, 27, 40 * joules_per_kev, 107};
    readout.curve = curve;
    readout.curve_count = 3;
    read_floats(&readout, 4, energies, grey);
    const double expected[4] = {7, 17, 147, 187};
    for (int i = 0; i < 4; i++) ck_assert_double_eq_tol((double)grey[i], expected[i], 1e-4); /* as above */
}
END_TEST

START_TEST(test_bits_round_and_clip) {
    const float energies[4] = {0.0312f, 49.99f, 1000, -1000};
    uint16_t grey[4];
    skg_readout readout = floats();
    readout.bits = 10;
    ck_skg(skg_readout_image(&readout, 4, SKG_TYPE_FLOAT32, energies, 1, 0, grey));
    ck_assert_uint_eq(grey[0], 101); /* 100.624 */
    ck_assert_uint_eq(grey[1], 1023);
    ck_assert_uint_eq(grey[2], 1023);
    ck_assert_uint_eq(grey[3], 0);
    ck_skg(skg_readout_image(&readout, 1, SKG_TYPE_FLOAT32, energies + 2, 0.01, 0, grey));
    ck_assert_uint_eq(grey[0], 300);
    const double doubles[1] = {10};
    ck_skg(skg_readout_image(&readout, 1, SKG_TYPE_FLOAT64, doubles, 1, 0, grey));
    ck_assert_uint_eq(grey[0], 300);
    ck_skg(skg_readout_image(&readout, 1, SKG_TYPE_FLOAT64, NULL, 1, 0, grey));
    ck_assert_uint_eq(grey[0], 100);
}
END_TEST

static void find_moments(const skg_readout *readout, double kev, int64_t index, double *mean, double *sigma) {
    float *energies = malloc(PIXELS * sizeof *energies), *grey = malloc(PIXELS * sizeof *grey);
    double sum = 0, squares = 0;
    ck_assert(energies && grey);
    for (int i = 0; i < PIXELS; i++) energies[i] = (float)kev;
    ck_skg(skg_readout_image(readout, PIXELS, SKG_TYPE_FLOAT32, energies, 1, index, grey));
    for (int i = 0; i < PIXELS; i++) sum += (double)grey[i];
    *mean = sum / PIXELS;
    for (int i = 0; i < PIXELS; i++) squares += pow((double)grey[i] - *mean, 2);
    *sigma = sqrt(squares / PIXELS);
    free(energies);
    free(grey);
}

/* The standard deviation of a sample of n has the relative error 1/sqrt(2n), 0.35 % of 40,000; the mean that of sigma/sqrt(n).
 * Bars are five of them. */
static void check_moments(const skg_readout *readout, double kev, double mean, double sigma) {
    double its_mean = 0, its_sigma = 0;
    find_moments(readout, kev, 3, &its_mean, &its_sigma);
    ck_assert_double_eq_tol(its_sigma, sigma, 5 * sigma / sqrt(2 * PIXELS));  /* as said */
    ck_assert_double_eq_tol(its_mean, mean, 5 * sigma / sqrt(PIXELS) + 1e-3); /* and the rounding to float */
}

START_TEST(test_noise_follows_its_ratio) {
    skg_readout readout = floats();
    readout.snr = 55;
    check_moments(&readout, 50, 1100, 20);
    check_moments(&readout, 12.5, 350, 10); /* a quarter of the variance */
    readout.frames = 16;
    check_moments(&readout, 50, 1100, 5);
    const double noise[4] = {100, 10, 1100, 110};
    readout.noise = noise;
    readout.noise_count = 2;
    readout.frames = 1;
    check_moments(&readout, 50, 1100, 10);
    check_moments(&readout, 25, 600, 10); /* a ratio of 60 */
}
END_TEST

START_TEST(test_noise_depends_on_seed_and_index_alone) {
    const float energies[2] = {50, 50};
    float grey[2], again[2], other[2], seeded[2];
    skg_readout readout = floats();
    readout.snr = 55;
    ck_skg(skg_readout_image(&readout, 2, SKG_TYPE_FLOAT32, energies, 1, 7, grey));
    ck_skg(skg_readout_image(&readout, 2, SKG_TYPE_FLOAT32, energies, 1, 7, again));
    ck_skg(skg_readout_image(&readout, 2, SKG_TYPE_FLOAT32, energies, 1, 8, other));
    readout.seed = 1;
    ck_skg(skg_readout_image(&readout, 2, SKG_TYPE_FLOAT32, energies, 1, 7, seeded));
    ck_assert_int_eq(memcmp(grey, again, sizeof grey), 0);
    ck_assert_int_ne(memcmp(grey, other, sizeof grey), 0);
    ck_assert_int_ne(memcmp(grey, seeded, sizeof grey), 0);
    ck_assert_int_ne(memcmp(&grey[0], &grey[1], sizeof grey[0]), 0);
}
END_TEST

START_TEST(test_bad_pixels_have_their_value) {
    const float energies[3] = {50, 50, 50}, bad[3] = {-1, 0, 777};
    uint16_t grey[3];
    skg_readout readout = floats();
    readout.bits = 16;
    readout.bad_pixels = bad;
    ck_skg(skg_readout_image(&readout, 3, SKG_TYPE_FLOAT32, energies, 1, 0, grey));
    ck_assert_uint_eq(grey[0], 1100);
    ck_assert_uint_eq(grey[1], 0);
    ck_assert_uint_eq(grey[2], 777);
}
END_TEST

/* Gain on what is beyond the dark value and on its noise; offset on all; then the level of saturation. */
START_TEST(test_pixels_differ) {
    const float energies[4] = {0, 25, 50, 50}, gain[4] = {2, 2, 1, 0}, offset[4] = {5, 5, -30, 0};
    float grey[4];
    skg_readout readout = floats();
    readout.gain = gain, readout.offset = offset;
    read_floats(&readout, 4, energies, grey);
    const float expected[4] = {105, 1105, 1070, 100};
    ck_assert_int_eq(memcmp(grey, expected, sizeof expected), 0); /* exact in float */
    readout.saturation = 1080;
    read_floats(&readout, 4, energies, grey);
    ck_assert(grey[1] >= 1080 && grey[1] <= 1080);
    ck_assert(grey[2] >= 1070 && grey[2] <= 1070);
    /* Noise is amplified with the signal: a flat field divides both out. */
    static float twice[PIXELS];
    for (int i = 0; i < PIXELS; i++) twice[i] = 2;
    readout = floats();
    readout.snr = 55, readout.gain = twice;
    check_moments(&readout, 50, 2100, 40);
}
END_TEST

/* Light from frame 0 to before frame `until`: what is shown in frame n, by the sum over all frames before. */
static double shown_of(const double terms[4], int until, int n) {
    double shown = n < until ? 1 : 0;
    for (int k = 0; k < 2; k++) {
        const double share = terms[2 * k], stays = exp(-1 / terms[2 * k + 1]);
        if (n < until) shown -= share;
        for (int m = 0; m < n && m < until; m++) shown += share * (1 - stays) * pow(stays, n - 1 - m);
    }
    return shown;
}

START_TEST(test_signals_come_later) {
    enum { FRAMES = 60, UNTIL = 40 };
    const double terms[4] = {0.05, 1.5, 0.01, 12}, light[2] = {30, 0};
    double frame[2], sum = 0;
    float single[2];
    skg_lag *lag = NULL;
    ck_skg(skg_lag_create(2, 2, terms, &lag));
    for (int n = 0; n < FRAMES; n++) {
        ck_skg(skg_lag_apply(lag, SKG_TYPE_FLOAT64, n < UNTIL ? light : NULL, 2, frame));
        ck_assert_double_eq_tol(frame[0], 60 * shown_of(terms, UNTIL, n),
                                1e-12 * 60); /* rounding of sums of 60 */
        ck_assert_double_eq(frame[1], 0);
        sum += frame[0];
    }
    /* The rest is the signal that is still held. */
    ck_assert_double_eq_tol(sum, 60 * UNTIL, 60 * (0.01 / (1 - exp(-1.0 / 12))) * exp(-19.0 / 12));
    /* After a long exposure the first frame shows the sum of the shares; a steady one is shown as it is. */
    for (int n = 0; n < 400; n++) ck_skg(skg_lag_apply(lag, SKG_TYPE_FLOAT64, light, 1, frame));
    ck_assert_double_eq_tol(frame[0], 30, 1e-12 * 30); /* exp(-400 / 12), and rounding */
    ck_skg(skg_lag_apply(lag, SKG_TYPE_FLOAT32, NULL, 1, single));
    ck_assert_double_eq_tol((double)single[0], 30 * 0.06, 1e-6); /* of floats */
    ck_skg(skg_lag_clear(lag));
    ck_skg(skg_lag_apply(lag, SKG_TYPE_FLOAT32, NULL, 1, single));
    ck_assert_double_eq((double)single[0], 0);
    ck_skg_fails(skg_lag_apply(lag, SKG_TYPE_UINT16, NULL, 1, single), SKG_ERR_ARGUMENT, "type");
    skg_lag_release(&lag);
    const double many[4] = {0.6, 1, 0.4, 1}, still[2] = {0.1, 0};
    ck_skg_fails(skg_lag_create(2, 2, many, &lag), SKG_ERR_ARGUMENT, "add up to 1");
    ck_skg_fails(skg_lag_create(2, 1, still, &lag), SKG_ERR_ARGUMENT, "0 frames");
    ck_skg_fails(skg_lag_create(2, 9, many, &lag), SKG_ERR_ARGUMENT, "9 terms");
    ck_assert_ptr_null(lag);
}
END_TEST

/* A long exposure changes the sensitivity by c (1 - exp(-n/t)), it goes as it came, and a dark pixel keeps its own. */
START_TEST(test_ghosts_fade) {
    enum { EXPOSED = 50, DARK = 30 };
    const double terms[4] = {-0.04, 20, 0.01, 3}, open[2] = {80, 0}, half[2] = {40, 40};
    double frame[2];
    skg_lag *lag = NULL;
    ck_skg(skg_lag_create(2, 0, NULL, &lag));
    ck_skg(skg_lag_ghosting_set(lag, 80, 2, terms));
    for (int n = 0; n < EXPOSED; n++) {
        ck_skg(skg_lag_apply(lag, SKG_TYPE_FLOAT64, open, 1, frame));
        const double sensitivity = 1 - 0.04 * (1 - exp(-n / 20.0)) + 0.01 * (1 - exp(-n / 3.0));
        ck_assert_double_eq_tol(frame[0], 80 * sensitivity, 1e-12 * 80); /* rounding of some 50 sums of 1 */
        ck_assert_double_eq(frame[1], 0);
    }
    for (int n = 0; n < DARK; n++) ck_skg(skg_lag_apply(lag, SKG_TYPE_FLOAT64, NULL, 1, frame));
    ck_skg(skg_lag_apply(lag, SKG_TYPE_FLOAT64, half, 1, frame));
    const double left = 1 - 0.04 * (1 - exp(-EXPOSED / 20.0)) * exp(-DARK / 20.0) +
                        0.01 * (1 - exp(-EXPOSED / 3.0)) * exp(-DARK / 3.0);
    ck_assert_double_eq_tol(frame[0], 40 * left, 1e-12 * 40); /* as above */
    ck_assert_double_eq(frame[1], 40);
    ck_skg(skg_lag_clear(lag));
    ck_skg(skg_lag_apply(lag, SKG_TYPE_FLOAT64, half, 1, frame));
    ck_assert_double_eq(frame[0], 40);
    const double dead[4] = {-0.6, 5, -0.4, 5}, wild[2] = {-1.5, 5}, still[2] = {0.1, 0};
    ck_skg_fails(skg_lag_ghosting_set(lag, 80, 2, dead), SKG_ERR_ARGUMENT, "add up to -1");
    ck_skg_fails(skg_lag_ghosting_set(lag, 80, 1, wild), SKG_ERR_ARGUMENT, "sensitivity -1.5");
    ck_skg_fails(skg_lag_ghosting_set(lag, 80, 1, still), SKG_ERR_ARGUMENT, "0 frames");
    ck_skg_fails(skg_lag_ghosting_set(lag, 0, 1, terms), SKG_ERR_ARGUMENT, "open beam is 0");
    ck_skg_fails(skg_lag_ghosting_set(lag, 80, 0, NULL), SKG_ERR_ARGUMENT, "0 terms");
    skg_lag_release(&lag);
}
END_TEST

START_TEST(test_wrong_fields_are_refused) {
    const double falling[4] = {1, 1, 0, 2};
    float grey[1];
    skg_readout readout = floats();
    readout.bits = 17;
    ck_skg_fails(skg_readout_image(&readout, 1, SKG_TYPE_FLOAT32, NULL, 1, 0, grey), SKG_ERR_ARGUMENT,
                 "17 bits");
    readout = floats();
    readout.full_kev = 0;
    ck_skg_fails(skg_readout_image(&readout, 1, SKG_TYPE_FLOAT32, NULL, 1, 0, grey), SKG_ERR_ARGUMENT,
                 "full_kev");
    readout = floats();
    readout.frames = 0;
    ck_skg_fails(skg_readout_image(&readout, 1, SKG_TYPE_FLOAT32, NULL, 1, 0, grey), SKG_ERR_ARGUMENT,
                 "0 frames");
    readout = floats();
    readout.curve = falling;
    readout.curve_count = 2;
    ck_skg_fails(skg_readout_image(&readout, 1, SKG_TYPE_FLOAT32, NULL, 1, 0, grey), SKG_ERR_ARGUMENT,
                 "curve");
    readout.curve_count = 1;
    ck_skg_fails(skg_readout_image(&readout, 1, SKG_TYPE_FLOAT32, NULL, 1, 0, grey), SKG_ERR_ARGUMENT,
                 "1 points");
    const float maps[2] = {1, NAN}, negative[1] = {-1};
    readout = floats();
    readout.offset = maps;
    ck_skg_fails(skg_readout_image(&readout, 2, SKG_TYPE_FLOAT32, NULL, 1, 0, grey), SKG_ERR_ARGUMENT,
                 "offset of pixel 1");
    readout = floats();
    readout.gain = negative;
    ck_skg_fails(skg_readout_image(&readout, 1, SKG_TYPE_FLOAT32, NULL, 1, 0, grey), SKG_ERR_ARGUMENT,
                 "gain of pixel 0");
    readout = floats();
    readout.saturation = -1;
    ck_skg_fails(skg_readout_image(&readout, 1, SKG_TYPE_FLOAT32, NULL, 1, 0, grey), SKG_ERR_ARGUMENT,
                 "saturation");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, test_line_factor_and_curve);
    tcase_add_test(tests, test_bits_round_and_clip);
    tcase_add_test(tests, test_noise_follows_its_ratio);
    tcase_add_test(tests, test_noise_depends_on_seed_and_index_alone);
    tcase_add_test(tests, test_bad_pixels_have_their_value);
    tcase_add_test(tests, test_pixels_differ);
    tcase_add_test(tests, test_signals_come_later);
    tcase_add_test(tests, test_ghosts_fade);
    tcase_add_test(tests, test_wrong_fields_are_refused);
}

SKG_SUITE_MAIN("readout", add_tests)
