/* The verb distance: what it prints and writes. */
#include "cli/command.h"

#include <float.h>
#include <math.h>

/* Two squares of 10 x 10 mm, at z = 0 and z = 3; the second one is twice as wide. */
static const char low[] = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3\nf 1 3 4\n";
static const char high[] = "v 0 0 3\nv 20 0 3\nv 20 10 3\nv 0 10 3\nf 1 2 3\nf 1 3 4\n";

static void set_up_squares(void) {
    set_up();
    write_text("a.obj", low);
    write_text("b.obj", high);
    write_text("b.ply", "ply");
}

static double number(json_t *object, const char *key) {
    return json_number_value(member(object, key));
}

START_TEST(json_has_both_directions) {
    const double rounding = 1e6 * DBL_EPSILON; /* sums of 1e5 samples of about 10 mm */
    ck_run(0, "distance a.obj b.obj --json");
    json_t *object = said_json(), *back = member(object, "back");
    const char *const keys[] = {"mean_mm", "rms_mm", "p95_mm", "max_mm"};
    for (int k = 0; k < 4; k++) ck_assert_double_eq_tol(number(object, keys[k]), 3, rounding);
    /* Half of B lies over A; over the other half the square of the distance is 9 + x^2, x to 10. */
    ck_assert_double_eq_tol(number(back, "max_mm"), sqrt(109), rounding);
    /* Midpoint rule with triangles of 0.05 mm. */
    ck_assert_double_eq_tol(number(back, "rms_mm"), sqrt(9 + 0.5 * 100 / 3), 1e-4);
    ck_assert_double_eq_tol(number(object, "hausdorff_mm"), sqrt(109), rounding);
    ck_assert_str_eq(json_string_value(member(object, "sampling")), "surface");
    json_decref(object);

    ck_run(0, "distance a.obj b.obj --json --sampling vertices --unit cm");
    object = said_json();
    ck_assert_double_eq_tol(number(object, "mean_mm"), 30, rounding);
    ck_assert_int_eq(json_integer_value(member(object, "samples")), 4);
    ck_assert_str_eq(json_string_value(member(object, "sampling")), "vertices");
    json_decref(object);
}
END_TEST

START_TEST(table_and_files) {
    ck_run(0, "distance a.obj b.obj --map map.ply -o map.png --spacing 0.5");
    ck_assert_ptr_nonnull(strstr(said, "A to B"));
    ck_assert_ptr_nonnull(strstr(said, "Hausdorff distance 10.44 mm"));
    ck_assert_ptr_nonnull(strstr(said, "wrote map.ply"));
    ck_assert_ptr_nonnull(strstr(said, "wrote map.png"));
    ck_assert_int_eq(has_file("map.ply"), 1);
    ck_assert_int_eq(has_file("map.png"), 1);
    ck_run(1, "mesh map.ply --json"); /* leaky, but readable */
}
END_TEST

START_TEST(failures_leave_nothing) {
    ck_run_fails(2, "the picture is written as .png", "distance a.obj b.obj -o map.jpg");
    ck_run_fails(2, "a map is written as .ply", "distance a.obj b.obj --map map.stl");
    ck_run_fails(5, "was not written by skiagraph", "distance a.obj b.ply --map b.ply");
    ck_run_fails(3, "nothere.stl", "distance a.obj nothere.stl --map map.ply");
    ck_run_fails(2, "give a larger spacing", "distance a.obj b.obj --spacing 1e-5");
    ck_assert_int_eq(has_file("map.ply"), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_squares, tear_down);
    tcase_add_test(tests, json_has_both_directions);
    tcase_add_test(tests, table_and_files);
    tcase_add_test(tests, failures_leave_nothing);
}

SKG_SUITE_MAIN("distance_verb", add_tests)
