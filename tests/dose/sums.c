/* Exposures together: sums, and scans around a body that looks the same from all sides. */
#include "dose/exposed.h"

#include <skiagraph/scan_dose.h>

static const double PI = 3.14159265358979323846;

/* Of sums of a few numbers. */
static const double ROUNDING = 1e-12;

/* A ball of water in the middle of turns. */
static subject open_ball(void) {
    solid ball = solid_sphere(40, 96, 48);
    subject s;
    subject_open(&s);
    subject_add(&s, run_mesh(&ball), "Water, Liquid", 0, 0, 0, -1);
    solid_free(&ball);
    return s;
}

START_TEST(sums_are_sums) {
    static const double times[2] = {3, 0.5}, place[3] = {0, 0, -40.1};
    subject s = open_ball();
    skg_dose *of[2], *sum = NULL, *twice = NULL;
    skg_dose_options options = options_of(6400);
    options.point_count = 1, options.points = place;
    of[0] = dose_of(&s, &options);
    s.kev = 80, options.seed = 5;
    of[1] = dose_of(&s, &options);
    ck_skg(skg_dose_sum(2, of, times, &sum));
    ck_skg(skg_dose_sum(2, of, NULL, &twice));
    const skg_dose_report a = report_of(of[0]), b = report_of(of[1]), all = report_of(sum);
    const skg_dose_part pa = part_of(of[0], 0), pb = part_of(of[1], 0), part = part_of(sum, 0);
    const skg_dose_point ka = point_of(of[0], 0), kb = point_of(of[1], 0), point = point_of(sum, 0);
    ck_assert_double_eq_tol(all.kap_ugy_cm2 / (3 * a.kap_ugy_cm2 + 0.5 * b.kap_ugy_cm2), 1, ROUNDING);
    ck_assert_double_eq_tol(all.incident_kev / (3 * a.incident_kev + 0.5 * b.incident_kev), 1, ROUNDING);
    ck_assert_double_eq_tol(part.dose_ugy / (3 * pa.dose_ugy + 0.5 * pb.dose_ugy), 1, ROUNDING);
    ck_assert_double_eq_tol(part.sigma_ugy / hypot(3 * pa.sigma_ugy, 0.5 * pb.sigma_ugy), 1, ROUNDING);
    ck_assert_double_eq_tol(point.air_kerma_ugy / (3 * ka.air_kerma_ugy + 0.5 * kb.air_kerma_ugy), 1,
                            ROUNDING);
    ck_assert_double_eq_tol(
        point.backscatter * point.air_kerma_ugy /
            (3 * ka.air_kerma_ugy * ka.backscatter + 0.5 * kb.air_kerma_ugy * kb.backscatter),
        1, ROUNDING);
    ck_assert_double_eq_tol(report_of(twice).kap_ugy_cm2 / (a.kap_ugy_cm2 + b.kap_ugy_cm2), 1, ROUNDING);
    ck_assert_double_eq(part.mass_g, pa.mass_g);
    ck_assert_int_eq(all.histories, a.histories + b.histories);
    ck_assert_int_eq(all.followed, 1);
    ck_assert(isnan(all.exposure_index) && !all.has_darkest);
    skg_dose_release(&sum);
    skg_dose_release(&twice);
    for (int k = 0; k < 2; k++) skg_dose_release(&of[k]);
    subject_close(&s);
}
END_TEST

START_TEST(sums_refuse_other_places) {
    static const double times[2] = {1, -1}, here[3] = {0, 0, 0}, there[3] = {0, 0, 1};
    subject s = open_ball();
    skg_dose *of[2], *sum = NULL;
    skg_dose_options options = options_of(0);
    options.point_count = 1, options.points = here;
    of[0] = dose_of(&s, &options);
    options.points = there;
    of[1] = dose_of(&s, &options);
    ck_skg_fails(skg_dose_sum(2, of, NULL, &sum), SKG_ERR_ARGUMENT, "exposure 1 has other places");
    ck_skg_fails(skg_dose_sum(0, of, NULL, &sum), SKG_ERR_ARGUMENT, "0 exposures");
    ck_skg_fails(skg_dose_sum(2, of, times, &sum), SKG_ERR_ARGUMENT, "-1 times exposure 1");
    ck_assert_ptr_null(sum);
    for (int k = 0; k < 2; k++) skg_dose_release(&of[k]);
    subject_close(&s);
}
END_TEST

/* From all sides the ball gets what it gets from one; of 100 projections 64 are followed. */
START_TEST(scans_are_their_projections) {
    static const int64_t counts[] = {5, 100};
    static const double middle[3] = {0, 0, 0};
    subject s = open_ball();
    skg_dose_options options = options_of(32000);
    options.point_count = 1, options.points = middle;
    skg_dose *one = dose_of(&s, &options);
    for (int c = 0; c < 2; c++) {
        const double n = (double)counts[c];
        skg_scan_options geometry;
        skg_scan *scan = NULL;
        skg_dose *all = NULL;
        skg_scan_options_init(&geometry);
        geometry.projections = counts[c], geometry.step_rad = 2 * PI / n;
        geometry.axis[0] = geometry.axis[2] = 0, geometry.axis[1] = 1;
        ck_skg(skg_scan_create(&s.view, &geometry, &scan));
        ck_skg(skg_scan_dose_create(s.plan, scan, &options, &all));
        const skg_dose_part single = part_of(one, 0), part = part_of(all, 0);
        printf("%g projections: %.4f +- %.4f of as many times one\n", n, part.dose_ugy / single.dose_ugy / n,
               part.sigma_ugy / part.dose_ugy + single.sigma_ugy / single.dose_ugy);
        fflush(stdout); /* before an assertion ends the process */
        /* Four standard errors of both. */
        ck_assert_double_eq_tol(part.dose_ugy / single.dose_ugy / n, 1,
                                4 * (part.sigma_ugy / part.dose_ugy + single.sigma_ugy / single.dose_ugy));
        /* Rounding. */
        ck_assert_double_eq_tol(report_of(all).kap_ugy_cm2 / report_of(one).kap_ugy_cm2 / n, 1, 1e-9);
        ck_assert_double_eq_tol(point_of(all, 0).air_kerma_ugy / point_of(one, 0).air_kerma_ugy / n, 1, 1e-9);
        /* 96 sectors are seen from elsewhere. */
        ck_assert_double_eq_tol(
            report_of(all).detector_air_kerma_ugy / report_of(one).detector_air_kerma_ugy / n, 1, 1e-3);
        skg_dose_release(&all);
        skg_scan_release(&scan);
    }
    /* The plan has the view that it had. */
    skg_dose *again = NULL;
    ck_skg(skg_dose_create(s.plan, &options, &again));
    ck_assert_double_eq(part_of(again, 0).dose_ugy, part_of(one, 0).dose_ugy);
    skg_dose_release(&again);
    skg_dose_release(&one);
    subject_close(&s);
}
END_TEST

void add_sums(TCase *tests) {
    tcase_add_test(tests, sums_are_sums);
    tcase_add_test(tests, sums_refuse_other_places);
    tcase_add_test(tests, scans_are_their_projections);
}
