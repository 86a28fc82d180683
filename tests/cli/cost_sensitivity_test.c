/* The verb cost with --sensitivity: how much the image changes when a part moves, against formulas. */
#include "cli/cost_scene.h"

#include <math.h>

/* A parallel beam along y, and two rods along z that reach beyond the detector: a square one that is turned by 45 degrees, whose
 * path lengths are 2 (5 - |x + 10|) mm, and a flat one, 12 mm deep, whose sides contain rays. */
static const char rods[] =
    "{ \"Source\": { \"Position\": [0, -400, 0, \"mm\"], \"Shape\": \"Parallel\",\n"
    "    \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 100}] },\n"
    "  \"Detector\": { \"Position\": [0, 100, 0, \"mm\"], \"UpVector\": [0, 0, -1],\n"
    "    \"NumberOfPixels\": [160, 8], \"Spacing\": [0.25, 1, \"mm\"] },\n"
    "  \"Samples\": [\n"
    "    {\"Label\": \"roof\", \"Cuboid\": [7.0710678118654755, 7.0710678118654755, 40, \"mm\"], \"Type\": \"outer\",\n"
    "     \"Material\": [\"mu\", 0.4], \"Transform\": [[\"Translation\", -10, 0, 0, \"mm\"], [\"Rotation\", 45, 0, 0, 1]]},\n"
    "    {\"Label\": \"flat\", \"Cuboid\": [7.3, 12, 40, \"mm\"], \"Type\": \"outer\", \"Material\": [\"mu\", 0.3],\n"
    "     \"Transform\": [[\"Translation\", 10, 0, 0, \"mm\"]]} ] }\n";

static json_t *sensitivity_of(const char *more) {
    ck_run(0, "cost rods.json --quick --within 1 --json %s", more);
    json_t *study = said_json(), *found = json_incref(member(study, "sensitivity"));
    json_decref(study);
    return found;
}

/* A part moves along x alone: y is along the beam, and z along the rods. */
static void check_part(json_t *part, const char *label, double expected) {
    json_t *direction = member(part, "direction");
    ck_assert_str_eq(json_string_value(member(part, "part")), label);
    /* Lengths and mu in single precision, and the exponential of them */
    ck_assert_double_eq_tol(number(part, "x"), expected, 1e-5 * expected);
    ck_assert_double_eq_tol(number(part, "largest"), expected, 1e-5 * expected);
    /* the same */
    ck_assert_double_le(number(part, "y"), 1e-5 * expected);
    ck_assert_double_le(number(part, "z"), 1e-5 * expected);
    /* The square of the 1e-5 that the other axes may have, and some */
    ck_assert_double_eq_tol(fabs(json_number_value(json_array_get(direction, 0))), 1, 1e-9);
}

START_TEST(changes_are_those_of_formulas) {
    const double mu_roof = 0.04, mu_flat = 0.03, pitch = 0.25, depth = 12;
    double squares = 0;
    write_text("rods.json", rods);
    json_t *found = sensitivity_of("--sensitivity"), *parts = member(found, "parts");
    ck_assert_uint_eq(json_array_size(parts), 2);
    ck_assert(json_is_null(member(found, "reason")));
    ck_assert(number(found, "saturated") == 0);
    for (int c = 0; c < 160; c++) {
        const double length = 2 * (5 - fabs(pitch * (c + 0.5) - 20 + 10));
        const double slope = 2 * mu_roof * exp(-mu_roof * length);
        squares += length > 0 ? slope * slope : 0;
    }
    const double of_roof = sqrt(squares / 160);
    /* Each of the two sides changes the mean of one column by its share of the pixel */
    const double of_flat = sqrt(2.0 / 160) * mu_flat * depth * exp(-mu_flat * depth) / pitch;
    ck_assert_double_gt(of_flat, of_roof); /* the table begins with the largest */
    check_part(json_array_get(parts, 0), "flat", of_flat);
    check_part(json_array_get(parts, 1), "roof", of_roof);
    json_decref(found);
}
END_TEST

/* Only with --sensitivity do the study, the table and the page have it. */
START_TEST(it_is_told_where_it_is_asked_for) {
    write_text("rods.json", rods);
    json_t *found = sensitivity_of("");
    ck_assert(json_is_null(found));
    json_decref(found);
    ck_run(0, "cost rods.json --quick --within 1 --sensitivity -o a.html");
    const char *table = strstr(said, "rms change for a mm");
    ck_assert_ptr_nonnull(table);
    const char *flat = strstr(table, "\n  flat "), *roof = strstr(table, "\n  roof ");
    ck_assert(flat && roof && flat < roof);
    ck_assert_ptr_nonnull(strstr(flat, "11 %")); /* along x, and at most */
    char *page = read_page("a.html");
    ck_assert_ptr_nonnull(strstr(page, "\"sensitivity\":{"));
    ck_assert_ptr_nonnull(strstr(page, "\"part\":\"flat\""));
    free(page);
}
END_TEST

/* Repaired meshes have no derivative: the reason is told, and everything else is measured. */
START_TEST(what_has_no_derivative_says_why) {
    write_text("rods.json", rods);
    write_text(
        "open.obj",
        "v -2 -2 -2\nv 2 -2 -2\nv -2 2 -2\nv 2 2 -2\nv -2 -2 2\nv 2 -2 2\nv -2 2 2\nv 2 2 2\n"
        "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n");
    json_t *found = sensitivity_of(
        "--sensitivity --set 'Samples.flat={\"Label\":\"flat\",\"Path\":\"open.obj\",\"Unit\":\"mm\","
        "\"Material\":[\"mu\",0.3]}'");
    const char *reason = json_string_value(member(found, "reason"));
    ck_assert_ptr_nonnull(reason);
    ck_assert_ptr_nonnull(strstr(reason, "the mesh of part flat is not closed"));
    ck_assert_uint_eq(json_array_size(member(found, "parts")), 0);
    json_decref(found);
}
END_TEST

/* `view` has the same numbers as `cost`, and refuses the flag where there is no page. */
START_TEST(view_has_the_same) {
    write_text("rods.json", rods);
    json_t *found = sensitivity_of("--sensitivity");
    ck_run(0, "view rods.json --sensitivity -o v.html --json");
    json_t *seen = said_json();
    ck_assert(json_equal(member(member(seen, "sensitivity"), "parts"), member(found, "parts")));
    json_decref(seen);
    json_decref(found);
    char *page = read_page("v.html");
    ck_assert_ptr_nonnull(strstr(page, "\"sensitivity\":{"));
    free(page);
    ck_run(0, "view rods.json -o v.html --json");
    ck_assert_ptr_null(strstr(said, "sensitivity"));
    ck_run(2, "view rods.json --sensitivity -o v.png");
    ck_assert_ptr_nonnull(strstr(complained, "--sensitivity colours the parts of a page; add -o FILE.html"));
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, changes_are_those_of_formulas);
    tcase_add_test(tests, it_is_told_where_it_is_asked_for);
    tcase_add_test(tests, what_has_no_derivative_says_why);
    tcase_add_test(tests, view_has_the_same);
}

SKG_SUITE_MAIN("cost_sensitivity", add_tests)
