/* The key Collimation of scene files. */
#include "setup/setup_files.h"

static skg_status load_with(const char *one, const char *two) {
    const char *const settings[] = {one, two};
    skg_setup_release(&setup);
    write_file("scene.json", good);
    return skg_setup_load(NULL, path, two ? 2 : 1, settings, &setup);
}

static const skg_collimation *given(void) {
    skg_plan_options o;
    skg_plan_options_init(&o);
    ck_skg(skg_setup_options_get(setup, &o));
    return o.collimation;
}

#define JAWS "\"Rectangle\": [[-2, 3], [-1, 4], \"cm\"]"

/* The first number of each pair is on the left and at the bottom of a picture; rows grow downward. */
START_TEST(rectangles) {
    ck_skg(load_with("Collimation={" JAWS ", \"Distance\": [0.2, \"m\"]}", NULL));
    const skg_collimation *jaws = given();
    ck_assert_int_eq(jaws->kind, SKG_COLLIMATION_RECTANGLE);
    ck_assert_double_eq(jaws->distance_mm, 200);
    ck_assert_double_eq(jaws->low[0], -20);
    ck_assert_double_eq(jaws->high[0], 30);
    ck_assert_double_eq(jaws->low[1], -40);
    ck_assert_double_eq(jaws->high[1], 10);
    /* A single number of it by a setting. */
    ck_skg(load_with("Collimation={" JAWS ", \"Distance\": [200, \"mm\"]}",
                     "Collimation.Distance=[25, \"cm\"]"));
    ck_assert_double_eq(given()->distance_mm, 250);
    /* In a parallel beam the distance has no effect. */
    ck_skg(load_with("Source.Shape=ParallelBeam", "Collimation={" JAWS "}"));
    ck_assert_int_eq(given()->kind, SKG_COLLIMATION_RECTANGLE);
}
END_TEST

START_TEST(fields_of_the_detector) {
    ck_skg(load_with("Collimation={\"Field\": \"Detector\"}", NULL));
    ck_assert_int_eq(given()->kind, SKG_COLLIMATION_DETECTOR);
    ck_assert_double_eq(given()->margin_mm, 0);
    ck_skg(load_with("Collimation={\"Field\": \"detector\", \"Margin\": [-0.5, \"cm\"]}", NULL));
    ck_assert_double_eq(given()->margin_mm, -5);
}
END_TEST

START_TEST(open_beams) {
    ck_skg(load_with("Tolerance=0", NULL));
    ck_assert_ptr_null(given());
    ck_skg(load_with("Collimation=open", NULL));
    ck_assert_int_eq(given()->kind, SKG_COLLIMATION_OPEN);
    ck_skg(load_with("Collimation=open", "Collimation=null"));
    ck_assert_ptr_null(given());
}
END_TEST

static const struct {
    const char *setting;
    skg_status status;
    const char *text;
    const char *place;
} bad[] = {
    {"Collimator=open", SKG_ERR_FORMAT, "Collimation", "scene.json"},
    {"Collimation=opne", SKG_ERR_FORMAT, "open", "Collimation"},
    {"Collimation=1", SKG_ERR_FORMAT, "object", "Collimation"},
    {"Collimation={}", SKG_ERR_FORMAT, "Rectangle", "Collimation"},
    {"Collimation={\"Rectangel\": 1}", SKG_ERR_FORMAT, "Rectangle", "Collimation"},
    {"Collimation={" JAWS "}", SKG_ERR_FORMAT, "[300, \"mm\"]", "Collimation"},
    {"Collimation={" JAWS ", \"Distance\": 200}", SKG_ERR_FORMAT, "\"mm\"", "Distance"},
    {"Collimation={" JAWS ", \"Distance\": [0, \"mm\"]}", SKG_ERR_SCENE, "give a distance above 0",
     "Distance"},
    {"Collimation={" JAWS ", \"Distance\": [501, \"mm\"]}", SKG_ERR_SCENE, "behind the detector at 500 mm",
     "Collimation"},
    {"Collimation={" JAWS ", \"Distance\": [200, \"mm\"], \"Margin\": [1, \"mm\"]}", SKG_ERR_FORMAT,
     "leave it out", "Margin"},
    {"Collimation={\"Rectangle\": [-2, 3, -1, 4, \"cm\"]}", SKG_ERR_FORMAT, "has 5 entries", "Rectangle"},
    {"Collimation={\"Rectangle\": [[-2, 3], [-1, 4], \"ell\"]}", SKG_ERR_FORMAT, "ell", "Rectangle[2]"},
    {"Collimation={\"Rectangle\": [[3, -2], [-1, 4], \"cm\"]}", SKG_ERR_SCENE, "right edge", "Rectangle[0]"},
    {"Collimation={\"Rectangle\": [[-2, 3], [4, 4], \"cm\"]}", SKG_ERR_SCENE, "top has to exceed",
     "Rectangle[1]"},
    {"Collimation={\"Rectangle\": [[-2], [-1, 4], \"cm\"]}", SKG_ERR_FORMAT, "[left, right]", "Rectangle[0]"},
    {"Collimation={\"Field\": \"screen\"}", SKG_ERR_FORMAT, "detector", "Field"},
    {"Collimation={\"Field\": \"detector\", " JAWS "}", SKG_ERR_FORMAT, "exclude each other", "Rectangle"},
    {"Collimation={\"Field\": \"detector\", \"Distance\": [1, \"mm\"]}", SKG_ERR_FORMAT, "exclude each other",
     "Distance"},
    {"Collimation={\"Field\": \"detector\", \"Margin\": [-32, \"mm\"]}", SKG_ERR_SCENE,
     "leaves nothing of the detector", "Collimation"},
};

START_TEST(refused) {
    ck_skg_fails(load_with(bad[_i].setting, NULL), bad[_i].status, bad[_i].text);
    ck_assert_msg(strstr(skg_last_error(), bad[_i].place) != NULL, "%s: no %s", skg_last_error(),
                  bad[_i].place);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, rectangles);
    tcase_add_test(tests, fields_of_the_detector);
    tcase_add_test(tests, open_beams);
    tcase_add_loop_test(tests, refused, 0, sizeof bad / sizeof *bad);
}

SKG_SUITE_MAIN("collimation_setup", add_tests)
