/* Counts of single photons in a counting detector, in closed form. */
#include "suite.h"
#include "support/named.h"

#include <skiagraph/counting.h>

#include <math.h>
#include <string.h>

enum { SIDE = SKG_COUNTING_SIDE, PIXELS = SIDE * SIDE, MIDDLE = PIXELS / 2 };

static skg_material *cdte;

/* 1 mm of CdTe, pixels of 0.1 mm, a threshold of 20 keV. */
static skg_counting plain(const double *thresholds, int64_t count) {
    skg_counting c;
    skg_counting_init(&c);
    c.material = cdte, c.thickness_mm = 1, c.pixel_mm[0] = c.pixel_mm[1] = 0.1;
    c.threshold_kev = thresholds, c.count = count;
    return c;
}

static skg_counter *make(const skg_counting *c) {
    skg_counter *counter = NULL;
    ck_skg(skg_counter_create(c, &counter));
    return counter;
}

/* The share of photons that a mm of CdTe absorbs or scatters by Compton's effect. */
static double interacting(double kev) {
    skg_coefficients k;
    skg_coefficients_init(&k);
    ck_skg(skg_material_coefficients_get(cdte, kev, &k));
    double density = 0;
    ck_skg(skg_material_density_get(cdte, &density));
    return -expm1(-(k.photo + k.compton) * density * 0.1);
}

/* Without clouds and fluorescence a photon below the least energy of Compton's effect that matters counts once if it is absorbed. */
START_TEST(without_sharing_a_photon_counts_once) {
    static const double thresholds[] = {5, 25};
    const skg_counting c = plain(thresholds, 2);
    skg_counter *counter = make(&c);
    double counts[2], spread[PIXELS], pairs[PIXELS];
    ck_skg(skg_counter_counts_get(counter, 26, counts));
    /* Of photons of 26 keV, 1.0 % are scattered, and leave at most 2.4 keV where they are. */
    ck_assert_double_eq_tol(counts[1], interacting(26), 0.011);
    ck_assert_double_ge(interacting(26), counts[1]);
    ck_skg(skg_counter_spread_get(counter, 26, 1, spread));
    /* Other photons are absorbed on the way. */
    ck_assert_double_eq_tol(spread[MIDDLE], counts[1], 5e-3);
    ck_skg(skg_counter_pairs_get(counter, 26, 1, 1, pairs));
    ck_assert_double_eq_tol(pairs[MIDDLE], counts[1], 1e-12); /* sums of the same numbers */
    ck_skg(skg_counter_pairs_get(counter, 26, 0, 1, pairs));
    ck_assert_double_eq_tol(pairs[MIDDLE], 0, 1e-12); /* a pulse is in one window */
    skg_counter_release(&counter);
}
END_TEST

/* Where the charge that a pixel of side 1 collects of a cloud exceeds a share: over all places of the cloud. */
static double area_above(double share, double width) {
    enum { STEPS = 3000 };
    const double from = -6 * width, to = 1 + 6 * width, step = (to - from) / STEPS;
    static double along[STEPS];
    double area = 0;
    for (int i = 0; i < STEPS; i++) {
        const double x = from + (i + 0.5) * step;
        along[i] = 0.5 * (erf((1 - x) / (sqrt(2) * width)) + erf(x / (sqrt(2) * width)));
    }
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) area += along[i] * along[j] > share ? step * step : 0;
    return area;
}

/* A cloud of one width: the counts of a photon are the area in which the pixel gets enough of it. */
START_TEST(clouds_share_charge_as_areas_do) {
    static const double shares[] = {0.1, 0.25, 0.5, 0.75, 0.9};
    const double kev = 24, width = 0.012;
    for (int k = 0; k < 5; k++) {
        const double threshold = shares[k] * kev;
        skg_counting c = plain(&threshold, 1);
        double counts = 0, spread[PIXELS];
        c.cloud_mm = width;
        skg_counter *counter = make(&c);
        ck_skg(skg_counter_counts_get(counter, kev, &counts));
        const double area = area_above(shares[k], width / 0.1) * interacting(kev);
        ck_skg(skg_counter_spread_get(counter, kev, 0, spread));
        printf("threshold %g of the energy: %.4f counts for each photon, %.4f by area; beside it %.4f\n",
               shares[k], counts, area, spread[MIDDLE + 1]);
        /* 1 % of the photons is scattered first, and most of these are absorbed elsewhere; the histories are good for 2e-3. */
        ck_assert_double_eq_tol(counts / area, 1, 0.013);
        skg_counter_release(&counter);
    }
}
END_TEST

/* The cloud grows by diffusion: with a bias, by as much as with the width that the mean depth gives. */
START_TEST(a_lower_bias_shares_more) {
    const double threshold = 10;
    double before = 0, alone = 0;
    for (double bias = 3200; bias > 100; bias /= 2) {
        skg_counting c = plain(&threshold, 1);
        double spread[PIXELS];
        c.bias_v = bias;
        skg_counter *counter = make(&c);
        ck_skg(skg_counter_spread_get(counter, 60, 0, spread));
        ck_assert_double_gt(spread[MIDDLE + 1], before);
        before = spread[MIDDLE + 1];
        skg_counter_release(&counter);
    }
    skg_counting c = plain(&threshold, 1);
    /* Photons of 26 keV stop within 0.1 mm, so that their charge crosses all of the sensor: 2 kT/e d^2 / U, with d = 0.93 mm on average. */
    const double width = sqrt(2 * 0.02585 / 200);
    double spread[2][PIXELS];
    for (int k = 0; k < 2; k++) {
        c.bias_v = k ? 200 : 0, c.cloud_mm = k ? 0 : width * sqrt(0.93);
        skg_counter *counter = make(&c);
        ck_skg(skg_counter_spread_get(counter, 26, 0, spread[k]));
        skg_counter_release(&counter);
    }
    alone = spread[0][MIDDLE + 1];
    /* The width is that at the mean depth, and histories are good for 2e-3 of 0.1. */
    ck_assert_double_eq_tol(spread[1][MIDDLE + 1] / alone, 1, 0.05);
}
END_TEST

/* Electronic noise lets half of the pulses pass that lie on the threshold, and the share of a normal distribution otherwise. */
START_TEST(noise_lets_pulses_pass) {
    const double kev = 24, noise = 2;
    for (double threshold = 18; threshold <= 30; threshold += 2) {
        skg_counting c = plain(&threshold, 1);
        double counts = 0;
        c.electronic_kev = noise;
        skg_counter *counter = make(&c);
        ck_skg(skg_counter_counts_get(counter, kev, &counts));
        const double share = 0.5 * erfc((threshold - kev) / (sqrt(2) * noise));
        /* 1 % of the photons is scattered first. */
        ck_assert_double_eq_tol(counts / interacting(kev), share, 0.012);
        skg_counter_release(&counter);
    }
}
END_TEST

/* Sums of 2 x 2 pixels have all of a cloud that is small beside a pixel: every photon counts once, whatever it shares. */
START_TEST(anti_coincidence_puts_photons_together) {
    const double thresholds[] = {8, 22};
    skg_counting c = plain(thresholds, 2);
    double counts[2], pairs[PIXELS];
    c.cloud_mm = 0.012, c.electronic_kev = 0.2, c.anti_coincidence = 1;
    skg_counter *counter = make(&c);
    ck_skg(skg_counter_counts_get(counter, 24, counts));
    /* Scattered photons; clouds within 5 standard deviations reach at most two pixels along each direction but for 2 % of their charge. */
    ck_assert_double_eq_tol(counts[1] / interacting(24), 1, 0.02);
    ck_skg(skg_counter_pairs_get(counter, 24, 0, 0, pairs));
    /* Of the 1 % of photons that are scattered. */
    ck_assert_double_le(pairs[MIDDLE + 1], 1e-3);
    skg_counter_release(&counter);
}
END_TEST

/* Above the K edges of Cd and Te, lines carry energy out of the pixel: E - line counts in a window of its own. */
START_TEST(fluorescence_fills_the_escape_window) {
    const double thresholds[] = {10, 50};
    double counts[2][2], spread[PIXELS];
    for (int f = 0; f < 2; f++) {
        skg_counting c = plain(thresholds, 2);
        c.fluorescence = f;
        skg_counter *counter = make(&c);
        ck_skg(skg_counter_counts_get(counter, 60, counts[f]));
        if (f) ck_skg(skg_counter_spread_get(counter, 60, 0, spread));
        skg_counter_release(&counter);
    }
    printf("60 keV in CdTe: windows 10 to 50 and above: %.4f, %.4f; with fluorescence %.4f, %.4f\n",
           counts[0][0], counts[0][1], counts[1][0], counts[1][1]);
    ck_assert_double_gt(counts[1][0], 10 * counts[0][0]);
    ck_assert_double_lt(counts[1][1], counts[0][1]);
    ck_assert_double_gt(spread[MIDDLE + 1], spread[MIDDLE + 2]); /* lines end nearby */
}
END_TEST

START_TEST(dead_time_leaves_what_renewals_leave) {
    double counted = 0, fano = 0;
    for (double n = 0; n < 5; n += 0.25) {
        ck_skg(skg_pile_up_get(SKG_PILE_UP_NONPARALYSABLE, n, &counted, &fano));
        ck_assert_double_eq_tol(counted, n / (1 + n), 1e-15);          /* rounding */
        ck_assert_double_eq_tol(fano, 1 / ((1 + n) * (1 + n)), 1e-15); /* rounding */
        ck_skg(skg_pile_up_get(SKG_PILE_UP_PARALYSABLE, n, &counted, &fano));
        ck_assert_double_eq_tol(counted, n * exp(-n), 1e-15);      /* rounding */
        ck_assert_double_eq_tol(fano, 1 - 2 * n * exp(-n), 1e-15); /* rounding */
    }
    ck_skg_fails(skg_pile_up_get(3, 1, &counted, NULL), SKG_ERR_ARGUMENT, "no SKG_PILE_UP_ value");
    ck_skg_fails(skg_pile_up_get(0, -1, &counted, NULL), SKG_ERR_ARGUMENT, "give 0 or more");
}
END_TEST

static void fails(const skg_counting *c, skg_status expected, const char *text) {
    skg_counter *counter = NULL;
    ck_skg_fails(skg_counter_create(c, &counter), expected, text);
    ck_assert_ptr_null(counter);
}

START_TEST(bad_detectors_get_a_sentence) {
    static const double falling[] = {20, 10}, low[] = {5}, good[] = {20};
    skg_counting c = plain(falling, 2);
    fails(&c, SKG_ERR_BEAM, "threshold 2 is 10 keV");
    c = plain(low, 1), c.electronic_kev = 2;
    fails(&c, SKG_ERR_BEAM, "2.5 standard deviations");
    c = plain(low, 1), c.electronic_kev = 1, c.anti_coincidence = 1;
    fails(&c, SKG_ERR_BEAM, "that of four pixels");
    c = plain(good, 9);
    fails(&c, SKG_ERR_BEAM, "9 thresholds; give 1 to 8");
    c = plain(good, 1), c.thickness_mm = 0;
    fails(&c, SKG_ERR_BEAM, "a thickness of 0 mm");
    c = plain(good, 1), c.pixel_mm[1] = -1;
    fails(&c, SKG_ERR_BEAM, "a pixel of -1 mm");
    c = plain(good, 1), c.bias_v = (double)NAN;
    fails(&c, SKG_ERR_BEAM, "a bias of nan V");
    c = plain(good, 1), c.pile_up = SKG_PILE_UP_PARALYSABLE;
    fails(&c, SKG_ERR_BEAM, "a dead time of 0 ns");
    c.dead_time_ns = 100;
    fails(&c, SKG_ERR_BEAM, "the exposure is 0 s");
    c.pile_up = SKG_PILE_UP_NONE;
    fails(&c, SKG_ERR_BEAM, "pile-up is not asked for");
    c = plain(good, 1), c.fluorescence = 2;
    fails(&c, SKG_ERR_BEAM, "fluorescence is 2");
    c = plain(good, 1), c.material = NULL;
    fails(&c, SKG_ERR_BEAM, "no material");
    c = plain(good, 1);
    skg_counter *counter = make(&c);
    double counts = 0, table[PIXELS];
    ck_skg_fails(skg_counter_counts_get(counter, 2000, &counts), SKG_ERR_BEAM, "1 to 1022 keV");
    ck_skg_fails(skg_counter_spread_get(counter, 60, 1, table), SKG_ERR_ARGUMENT, "no window 1");
    int64_t count = 0;
    ck_skg(skg_counter_thresholds_get(counter, &count));
    ck_assert_int_eq(count, 1);
    skg_counter_release(&counter);
}
END_TEST

static void set_up(void) {
    cdte = named("CdTe");
}

static void add_tests(TCase *tests) {
    tcase_add_unchecked_fixture(tests, set_up, NULL);
    tcase_add_test(tests, without_sharing_a_photon_counts_once);
    tcase_add_test(tests, clouds_share_charge_as_areas_do);
    tcase_add_test(tests, a_lower_bias_shares_more);
    tcase_add_test(tests, noise_lets_pulses_pass);
    tcase_add_test(tests, anti_coincidence_puts_photons_together);
    tcase_add_test(tests, fluorescence_fills_the_escape_window);
    tcase_add_test(tests, dead_time_leaves_what_renewals_leave);
    tcase_add_test(tests, bad_detectors_get_a_sentence);
}

SKG_SUITE_MAIN("counter", add_tests)
