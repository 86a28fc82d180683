/* Noise against what physics says of it: means and variances of the photons detected, and their distribution where
 * they are few. */
#include "analytic/noise_scene.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Not that of one Poisson variable of the summed energy. */
START_TEST(two_energies_in_iodide) {
    const double many[2] = {9000, 4000}, few[2] = {30, 10}, hardly[2] = {0.4, 0.2};
    skg_plan_options options = noisy();
    options.response = scintillator;
    check_two_energies(many, &options);
    check_two_energies(few, &options);
    check_two_energies(hardly, &options);
    options.swank = 0.9;
    check_two_energies(many, &options);
    check_two_energies(few, &options);
    options.precision = SKG_PRECISION_DOUBLE;
    check_two_energies(many, &options);
    check_two_energies(few, &options);
}
END_TEST

/* The mean is the same, whatever a table means; the variance is that of its efficiency and second moment. */
START_TEST(meanings_of_a_table) {
    static const double e[2] = {30, 90}, recorded[2] = {24, 45}, efficiency[2] = {0.9, 0.7},
                        swank[2] = {0.95, 0.6};
    const double many[2] = {9000, 4000}, few[2] = {30, 10};
    skg_plan_options options = noisy();
    double variances[3];
    for (int k = 0; k < 3; k++) {
        skg_response_table table;
        skg_response_table_init(&table);
        table.count = 2, table.energies_kev = e, table.recorded_kev = recorded;
        if (k == 1) table.meaning = SKG_RESPONSE_MEANING_ABSORBED;
        if (k == 2) table.efficiency = efficiency, table.swank = swank;
        ck_skg(skg_response_create_table(&table, &options.response));
        variances[k] = sum_energies(2, two_kev, many, &options).variance;
        check_two_energies(many, &options);
        check_two_energies(few, &options);
        skg_response_release(&options.response);
    }
    /* By hand for 40 and 80 keV: recorded 27.5 and 41.5 keV, efficiency 0.8667 and 0.7333, Swank 0.8917 and 0.6583. */
    ck_assert_double_lt(variances[0], variances[1]);
    double by_hand = 0;
    for (int i = 0; i < 2; i++) {
        double per_cm = 0;
        const double r = i ? 41.5 : 27.5, both = i ? 0.7333333 * 0.6583333 : 0.8666667 * 0.8916667;
        ck_skg(skg_material_attenuation_get(tissue, two_kev[i], &per_cm));
        by_hand += many[i] * exp(-0.1 * per_cm * THICKNESS) * r * r / both;
    }
    ck_assert_double_eq_tol(variances[2] / by_hand, 1, 1e-6); /* the digits of the fractions above */
}
END_TEST

/* Counted photons all add 1: the variance is the mean, sum N T eta, and neither signal nor Swank factor shows. */
START_TEST(counted_photons_have_no_size) {
    static double images[4 * PIXELS];
    static const double e[2] = {30, 90}, recorded[2] = {24, 45}, efficiency[2] = {0.9, 0.7},
                        swank[2] = {0.95, 0.6};
    const double photons[2] = {900, 400}, edges[2] = {20, 200};
    skg_response_table table;
    skg_plan_options options = noisy();
    double expected = 0;
    skg_response_table_init(&table);
    table.count = 2, table.energies_kev = e, table.recorded_kev = recorded;
    table.efficiency = efficiency, table.swank = swank;
    ck_skg(skg_response_create_table(&table, &options.response));
    options.quantity = SKG_QUANTITY_PHOTONS, options.swank = 0.5;
    options.bands = 1, options.band_kev = edges;
    for (int i = 0; i < 2; i++) {
        double per_cm = 0, seen = 0;
        ck_skg(skg_material_attenuation_get(tissue, two_kev[i], &per_cm));
        ck_skg(skg_response_get(options.response, two_kev[i], 1, NULL, &seen));
        expected += photons[i] * exp(-0.1 * per_cm * THICKNESS) * seen;
    }
    skg_spectrum *spectrum = energies(2, two_kev, photons);
    take(spectrum, &options, 9, 4, images);
    const moments m = moments_of(4 * PIXELS, images);
    /* Four standard errors of a mean and of a variance. */
    ck_assert_double_eq_tol(m.mean, expected, 4 * sqrt(expected / (4 * PIXELS)));
    ck_assert_double_eq_tol(m.variance, expected, 4 * expected * sqrt(2.0 / (4 * PIXELS)));
    skg_response_release(&options.response);
    skg_spectrum_release(&spectrum);
}
END_TEST

/* Fewer energies stand for the same means and variances, where photons are many and where they are few. */
START_TEST(compressed_spectra) {
    static double images[4 * PIXELS];
    enum { ENERGIES = 60 };
    double kev[ENERGIES], photons[ENERGIES];
    skg_plan_options options = noisy();
    options.response = scintillator;
    for (int few = 0; few < 2; few++) {
        skg_plan *plan = NULL;
        skg_plan_report report;
        for (int i = 0; i < ENERGIES; i++) {
            kev[i] = 20.5 + i;
            photons[i] = (few ? 1e-3 : 1) * (i + 1) * (ENERGIES - i);
        }
        skg_spectrum *spectrum = energies(ENERGIES, kev, photons);
        const truth t = sum_energies(ENERGIES, kev, photons, &options);
        ck_assert(few ? t.detected > 1 && t.detected < 10 : t.detected > 1000);
        options.tolerance = 1e-3;
        skg_plan_report_init(&report);
        ck_skg(skg_plan_create(context, scene, &view, spectrum, &options, &plan));
        ck_skg(skg_plan_report_get(plan, &report));
        ck_assert_int_lt(report.nodes, 16);
        ck_assert(report.bound > 0 && report.bound <= 1e-3);
        skg_plan_release(&plan);
        take(spectrum, &options, 7, 4, images);
        check_moments(4 * PIXELS, images, &t);
        skg_spectrum_release(&spectrum);
    }
}
END_TEST

/* One energy, photons counted: whole numbers with Poisson's distribution; DQE(0) = eta A_S follows from mean
 * and variance. */
START_TEST(few_photons_are_exact) {
    static double images[4 * PIXELS];
    enum { LIMIT = 40 };
    const double kev = 60, photons = 20;
    double counts[LIMIT] = {0}, chi = 0, expected;
    int bins = 0;
    skg_plan_options options = noisy();
    options.quantity = SKG_QUANTITY_PHOTONS;
    options.response = scintillator;
    skg_spectrum *spectrum = energies(1, &kev, &photons);
    const truth t = sum_energies(1, &kev, &photons, &options);
    take(spectrum, &options, 3, 4, images);
    for (int i = 0; i < 4 * PIXELS; i++) {
        const double count = images[i];
        /* a photon counts as v / w, a ratio of rounded numbers */
        ck_assert_double_eq_tol(count, round(count), 1e-5);
        ck_assert_msg(round(count) < LIMIT, "%g photons where %g are expected", count, t.detected);
        counts[(int)round(count)]++;
    }
    expected = exp(-t.detected) * 4 * PIXELS;
    for (int k = 0; k < LIMIT; k++) {
        if (expected > 10) chi += (counts[k] - expected) * (counts[k] - expected) / expected, bins++;
        expected *= t.detected / (k + 1);
    }
    ck_assert_int_gt(bins, 10);
    ck_assert_double_le(chi, bins + 4 * sqrt(2.0 * bins));
    skg_spectrum_release(&spectrum);
}
END_TEST

START_TEST(detective_quantum_efficiency) {
    static double images[4 * PIXELS];
    const double kev = 60, photons = 20000;
    double per_cm = 0, efficiency = 0;
    skg_plan_options options = noisy();
    options.response = scintillator;
    options.swank = 0.92;
    skg_spectrum *spectrum = energies(1, &kev, &photons);
    take(spectrum, &options, 11, 4, images);
    const moments m = moments_of(4 * PIXELS, images);
    ck_skg(skg_material_attenuation_get(tissue, kev, &per_cm));
    ck_skg(skg_response_get(scintillator, kev, 1, NULL, &efficiency));
    const double arriving = photons * exp(-0.1 * per_cm * THICKNESS);
    /* of a variance from n values: sqrt(2 / n) */
    ck_assert_double_eq_tol(m.mean * m.mean / m.variance / arriving / (efficiency * 0.92), 1,
                            4 * sqrt(2.0 / (4 * PIXELS)));
    skg_spectrum_release(&spectrum);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_test(tests, two_energies_in_iodide);
    tcase_add_test(tests, meanings_of_a_table);
    tcase_add_test(tests, counted_photons_have_no_size);
    tcase_add_test(tests, compressed_spectra);
    tcase_add_test(tests, few_photons_are_exact);
    tcase_add_test(tests, detective_quantum_efficiency);
}

SKG_SUITE_MAIN("noise", add_tests)
