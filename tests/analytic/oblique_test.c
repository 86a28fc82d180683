/* Scintillators that rays cross obliquely, against sums over the energies, ray by ray. */
#include "in_beam.h"

static skg_view tilted(double degrees) {
    skg_view v = view;
    v.column_step[0] = 30 * cos(degrees * degree), v.column_step[2] = 30 * sin(degrees * degree);
    v.column_step[0] /= 2, v.column_step[2] /= 2; /* half the detector, so that it stays behind the slab */
    return v;
}

START_TEST(oblique_rays) {
    const skg_view turned = tilted(35);
    options.oblique = 1, options.response = scintillator;
    check(&view, NULL, BAR);
    check(&turned, NULL, BAR);
    options.quantity = SKG_QUANTITY_PHOTONS;
    check(&turned, NULL, BAR);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    check(&turned, NULL, BAR);
    options.tolerance = 1e-4;
    check(&turned, NULL, BAR + options.tolerance);
    options.tolerance = 0, options.quantity = SKG_QUANTITY_ENERGY, options.response = escaping;
    check(&turned, NULL, BAR);
    if (run_has_double()) {
        options.precision = SKG_PRECISION_DOUBLE;
        check(&turned, NULL, BAR);
    }
}
END_TEST

/* One energy: (1 - exp(-mu t / cos beta)) / (1 - exp(-mu t)) times what photons that cross it straight would give. */
START_TEST(oblique_slab_of_one_energy) {
    options.response = scintillator;
    double *straight = image_of(&view, mono), most = 0;
    options.oblique = 1;
    double *pixels = image_of(&view, mono);
    for (int64_t p = 0; p < PIXELS * PIXELS; p++) {
        const double all = mu(csi, 60) * 0.48;
        const double truth = expm1(-all * oblique_of(&view, p)) / expm1(-all);
        /* Some 30 roundings of floats, 6e-8 each. */
        ck_assert_double_eq_tol(pixels[p] / straight[p], truth, 2e-6);
        most = fmax(most, truth);
    }
    ck_assert_double_gt(most, 1.02); /* the effect */
    free(straight);
    free(pixels);
}
END_TEST

/* A parallel beam has one angle to the detector, and noise of what is recorded there. */
START_TEST(oblique_parallel_beam_with_noise) {
    enum { SIDE = 128, COUNT = SIDE * SIDE };
    const double angle = 40 * degree, s = 1 / cos(angle);
    skg_view v;
    skg_view_init(&v);
    v.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    v.columns = v.rows = SIDE, v.source[2] = 1, v.centre[2] = 300;
    v.column_step[0] = 0.2 * cos(angle), v.column_step[2] = 0.2 * sin(angle), v.row_step[1] = 0.2;
    options.oblique = 1, options.noise = 1, options.response = escaping;
    double *pixels = image_of(&v, beam), mean = 0, variance = 0, truth = 0, truth_variance = 0;
    for (int64_t p = 0; p < COUNT; p++) mean += pixels[p] / COUNT;
    for (int64_t p = 0; p < COUNT; p++) variance += pow(pixels[p] - mean, 2) / (COUNT - 1);
    for (int e = 0; e < ENERGIES; e++) {
        double recorded = 0, efficiency = 0, swank = 0;
        const double arrive = photons[e] * exp(-mu(water, kev[e]) * 50);
        ck_skg(skg_response_get(escaping, kev[e], s, &recorded, &efficiency));
        ck_skg(skg_response_swank_get(escaping, kev[e], s, &swank));
        truth += arrive * recorded;
        truth_variance += arrive * recorded * recorded / (efficiency * swank);
    }
    /* Four standard errors; the variance changes with the angle as the mean does, which docs/physics.md states to 0.4 % for this layer. */
    ck_assert_double_eq_tol(mean, truth, 4 * sqrt(truth_variance / COUNT) + BAR * truth);
    ck_assert_double_eq_tol(variance, truth_variance, (4 * sqrt(2.0 / COUNT) + 5e-3) * truth_variance);
    free(pixels);
    ck_assert(effect_is_on(&v, beam, "oblique scintillator", "1.3"));
    ck_assert(effect_is_on(&v, beam, "K escape", "pulse heights"));
}
END_TEST

START_TEST(oblique_is_absent_or_refused) {
    skg_plan *plan = NULL;
    skg_view straight = view;
    straight.projection = SKG_PROJECTION_PARALLEL;
    ck_assert(!effect_is_on(&view, beam, "oblique scintillator", "ideal"));
    ck_assert(!effect_is_on(&view, beam, "K escape", "ideal"));
    options.response = scintillator;
    ck_assert(!effect_is_on(&view, beam, "oblique scintillator", "not asked for"));
    ck_assert(!effect_is_on(&view, beam, "K escape", "not asked for"));
    double *plain = image_of(&straight, beam);
    options.oblique = 1;
    ck_assert(!effect_is_on(&straight, beam, "oblique scintillator", "straight"));
    double *same = image_of(&straight, beam);
    ck_assert_mem_eq(plain, same, PIXELS * PIXELS * sizeof *plain);
    free(plain);
    free(same);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    ck_assert(!effect_is_on(&view, mono, "oblique scintillator", "one energy over its flat field"));
    options.response = NULL;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_ARGUMENT,
                 "the detector is ideal");
    options.response = scintillator, options.precision = SKG_PRECISION_HALF;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_UNSUPPORTED,
                 "oblique");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_test(tests, oblique_rays);
    tcase_add_test(tests, oblique_slab_of_one_energy);
    tcase_add_test(tests, oblique_parallel_beam_with_noise);
    tcase_add_test(tests, oblique_is_absent_or_refused);
}

SKG_SUITE_MAIN("oblique", add_tests)
