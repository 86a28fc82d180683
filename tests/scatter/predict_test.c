/* The prediction of the scatter: against images that have it, and of scenes that cannot have it. */
#include "subject.h"
#include "suite.h"

#include <math.h>

/* Promised error of a prediction: 15 %. */
static const double PROMISED = 0.15;

static skg_scatter_prediction predict(subject *s) {
    skg_scatter_prediction p;
    skg_scatter_prediction_init(&p);
    ck_skg(skg_plan_scatter_predict(s->plan, &p));
    return p;
}

/* Makes a plan without scatter. */
static void plan_without(subject *s, skg_spectrum *beam) {
    s->options.scatter = NULL;
    skg_plan_release(&s->plan);
    ck_skg(skg_plan_create(run_context, s->scene, &s->view, beam, &s->options, &s->plan));
}

/* Sum over sum where less than .99 of the open beam arrives, from an image with scatter. */
static double found_ratio(const subject *s, const pictures *p) {
    double scatter = 0, primary = 0;
    for (int64_t i = 0; i < p->count; i++) {
        const double own = (double)p->image[i] - (double)p->scatter[i];
        if (own >= 0.99 * s->kev * s->photons) continue;
        scatter += (double)p->scatter[i];
        primary += own;
    }
    return scatter / primary;
}

/* Noise and blur change nothing of it. */
START_TEST(as_an_image_that_has_it) {
    subject s;
    skg_spectrum *beam = NULL;
    static const double line[] = {0.25, 0.5, 0.25};
    skg_detector_blur blur;
    skg_detector_blur_init(&blur);
    subject_open(&s);
    subject_fill(&s);
    s.options.falloff = SKG_FALLOFF_OFF;
    s.scatter.histories = 1 << 18;
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    const double wanted = found_ratio(&s, &p);
    ck_skg(skg_spectrum_create_mono(s.kev, s.photons, &beam));
    s.options.noise = 1;
    blur.columns = blur.rows = 3, blur.along_row = blur.along_column = line;
    s.options.blur = &blur;
    plan_without(&s, beam);
    const skg_scatter_prediction found = predict(&s);
    ck_assert_double_eq_tol(found.ratio / wanted, 1, PROMISED);
    ck_assert_int_eq(found.called_for, 1);
    /* of images without it: root mean square and maximum */
    double square = 0, max = 0;
    for (int64_t i = 0; i < p.count; i++) {
        const double share = (double)p.scatter[i] / (s.kev * s.photons);
        square += share * share / (double)p.count;
        max = fmax(max, share);
    }
    ck_assert_double_eq_tol(found.rms / sqrt(square), 1, PROMISED);
    /* a maximum is noisier than a sum: 30 % */
    ck_assert_double_eq_tol(found.max / max, 1, 0.3);
    skg_spectrum_release(&beam);
    pictures_free(&p);
    subject_close(&s);
}
END_TEST

/* A slab over the whole detector, whose shadow is everywhere: 1.1452 by EGSnrc in the middle (docs/validation.md), a few per cent
 * less over the whole detector. Another seed of the plan's own scatter changes no prediction, and neither does its tolerance. */
START_TEST(as_a_monte_carlo_program) {
    subject s;
    subject_open(&s);
    subject_add_box(&s, 300, 300, 200, "Water, Liquid");
    s.view.source[2] = -900, s.view.centre[2] = 300;
    s.view.columns = s.view.rows = 80;
    s.view.column_step[0] = s.view.row_step[1] = 3.75;
    subject_plan(&s);
    const skg_scatter_prediction found = predict(&s);
    ck_assert_double_eq_tol(found.ratio / 1.1452, 1, PROMISED);
    ck_assert_double_gt(found.seconds, 0);
    const skg_scatter_prediction again = predict(&s);
    ck_assert_double_eq(found.ratio, again.ratio);
    subject_close(&s);
}
END_TEST

/* A grid takes more scatter than primary. */
START_TEST(behind_a_grid) {
    subject s;
    skg_grid grid;
    subject_open(&s);
    subject_add_box(&s, 80, 60, 60, "Water, Liquid");
    subject_plan(&s);
    const skg_scatter_prediction bare = predict(&s);
    ck_assert(bare.grid_primary == 1 && bare.grid_scatter == 1 && bare.grid_total == 1);
    skg_grid_init(&grid);
    ck_skg(skg_material_create_named("aluminium", &grid.interspace));
    grid.ratio = 10, grid.lines_per_cm = 40, grid.strip_mm = 0.05, grid.focus_mm = 700;
    s.options.grid = &grid;
    subject_plan(&s);
    const skg_scatter_prediction found = predict(&s);
    ck_assert(found.ratio > 0.05 * bare.ratio && found.ratio < 0.7 * bare.ratio);
    /* Strips take 20 % of the beam; 0.4 mm of aluminium between them about as much. Their definitions: */
    ck_assert(found.grid_primary > 0.5 && found.grid_primary < 0.8 &&
              found.grid_scatter < 0.5 * found.grid_primary);
    ck_assert(found.grid_total > found.grid_scatter && found.grid_total < found.grid_primary);
    skg_material_release(&grid.interspace);
    subject_close(&s);
}
END_TEST

START_TEST(nothing_in_the_beam) {
    subject s;
    skg_mesh *mesh = NULL;
    subject_open(&s);
    ck_skg(skg_mesh_create_cube(10, &mesh));
    subject_add(&s, mesh, "Water, Liquid", 400, 0, 0, -1);
    subject_plan(&s);
    const skg_scatter_prediction found = predict(&s);
    ck_assert_double_eq(found.ratio, 0);
    ck_assert_double_eq(found.rms, 0);
    ck_assert_int_eq(found.called_for, 0);
    subject_close(&s);
}
END_TEST

/* Whether a scene calls for it depends on the tolerance. */
START_TEST(the_tolerance_decides) {
    static const double tolerances[] = {0, 1e-4, 0.9};
    for (int k = 0; k < 3; k++) {
        subject s;
        skg_spectrum *beam = NULL;
        subject_open(&s);
        subject_fill(&s);
        s.options.tolerance = tolerances[k];
        ck_skg(skg_spectrum_create_mono(s.kev, s.photons, &beam));
        plan_without(&s, beam);
        ck_assert_int_eq(predict(&s).called_for, k < 2);
        skg_spectrum_release(&beam);
        subject_close(&s);
    }
}
END_TEST

START_TEST(what_cannot_scatter) {
    subject s;
    skg_spectrum *beam = NULL;
    skg_material *odd = NULL;
    skg_scatter_prediction found;
    skg_scatter_prediction_init(&found);
    subject_open(&s);
    subject_fill(&s);
    ck_skg(skg_material_create_mu("odd", 0.2, &odd));
    ck_skg(skg_scene_part_material_set(s.scene, 0, odd));
    skg_material_release(&odd);
    ck_skg(skg_spectrum_create_mono(s.kev, s.photons, &beam));
    plan_without(&s, beam);
    ck_skg_fails(skg_plan_scatter_predict(s.plan, &found), SKG_ERR_MATERIAL, "scatter: part 0");
    ck_skg_fails(skg_plan_scatter_predict(s.plan, NULL), SKG_ERR_ARGUMENT, "prediction");
    ck_skg_fails(skg_plan_scatter_predict(NULL, &found), SKG_ERR_ARGUMENT, "plan");
    skg_spectrum_release(&beam);
    subject_close(&s);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, as_an_image_that_has_it);
    tcase_add_test(tests, as_a_monte_carlo_program);
    tcase_add_test(tests, behind_a_grid);
    tcase_add_test(tests, nothing_in_the_beam);
    tcase_add_test(tests, the_tolerance_decides);
    tcase_add_test(tests, what_cannot_scatter);
}

SKG_SUITE_MAIN("scatter/predict", add_tests)
