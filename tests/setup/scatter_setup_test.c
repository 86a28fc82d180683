/* The key Scatter of scene files. */
#include "setup/setup_files.h"

static skg_status load_with(const char *one, const char *two) {
    const char *const settings[] = {one, two};
    skg_setup_release(&setup);
    write_file("scene.json", good);
    return skg_setup_load(NULL, path, two ? 2 : 1, settings, &setup);
}

static const skg_scatter *given(void) {
    skg_plan_options o;
    skg_plan_options_init(&o);
    ck_skg(skg_setup_options_get(setup, &o));
    return o.scatter;
}

START_TEST(absent_unless_asked_for) {
    static const char *const none[] = {"Tolerance=0", "Scatter=false"};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        ck_skg(load_with(none[i], NULL));
        ck_assert_ptr_null(given());
    }
    ck_skg(load_with("Scatter=0.02", "Scatter=null"));
    ck_assert_ptr_null(given());
}
END_TEST

START_TEST(short_forms) {
    skg_scatter defaults;
    skg_scatter_init(&defaults);
    static const char *const same[] = {"Scatter=true", "Scatter={}", "Scatter=0.01",
                                       "Scatter={\"Tolerance\": 0.01}"};
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        ck_skg(load_with(same[i], NULL));
        ck_assert_ptr_nonnull(given());
        ck_assert_int_eq(memcmp(given(), &defaults, sizeof defaults), 0);
    }
    ck_assert_double_eq(defaults.tolerance, 0.01);
    ck_skg(load_with("Scatter=0.05", NULL));
    ck_assert_double_eq(given()->tolerance, 0.05);
}
END_TEST

START_TEST(every_key) {
    ck_skg(load_with(
        "Scatter={\"Histories\": 1e6, \"Seed\": -7, \"Voxel\": [0.25, \"cm\"], \"Detector\": [40, 30]}",
        NULL));
    ck_assert_double_eq(given()->tolerance, 0); /* so that the histories decide */
    ck_assert_int_eq(given()->histories, 1000000);
    ck_assert_int_eq(given()->seed, -7);
    ck_assert_double_eq(given()->voxel_mm, 2.5);
    ck_assert_int_eq(given()->columns, 40);
    ck_assert_int_eq(given()->rows, 30);
    ck_skg(load_with("Scatter={\"Tolerance\": 0.1, \"seed\": 3}", "Scatter.Tolerance=0.02"));
    ck_assert_double_eq(given()->tolerance, 0.02);
    ck_assert_int_eq(given()->histories, 0);
    ck_assert_int_eq(given()->seed, 3);
}
END_TEST

/* The text of a set-up is a scene file again. */
START_TEST(the_text_keeps_it) {
    const char *text = NULL;
    ck_skg(load_with("Scatter={\"Histories\": 5000}", NULL));
    ck_skg(skg_setup_text_get(setup, &text));
    ck_assert_msg(strstr(text, "\"Scatter\"") && strstr(text, "5000"), "%s", text);
}
END_TEST

static const struct {
    const char *setting;
    const char *text;
    const char *place;
} bad[] = {
    {"Scater=true", "did you mean Scatter", "Scater"},
    {"Scatter=yes", "give 0.01, or {\"Tolerance\": 0.01}", "Scatter"},
    {"Scatter=[0.01]", "give 0.01, or {\"Tolerance\": 0.01}", "Scatter"},
    {"Scatter=0", "above 0 and below 1", "Scatter"},
    {"Scatter=-0.01", "above 0 and below 1", "Scatter"},
    {"Scatter=100000", "{\"Histories\": 1000000}", "Scatter"},
    {"Scatter={\"Tolerence\": 0.01}", "did you mean Tolerance", "Scatter.Tolerence"},
    {"Scatter={\"Tolerance\": \"fine\"}", "give a number", "Scatter.Tolerance"},
    {"Scatter={\"Tolerance\": 0.01, \"Histories\": 1000}", "and Tolerance exclude each other",
     "Scatter.Histories"},
    {"Scatter={\"Histories\": 0}", "give 1 to 1073741824", "Scatter.Histories"},
    {"Scatter={\"Histories\": 2e9}", "give 1 to 1073741824", "Scatter.Histories"},
    {"Scatter={\"Histories\": 10.5}", "give a whole number", "Scatter.Histories"},
    {"Scatter={\"Seed\": 0.5}", "give a whole number", "Scatter.Seed"},
    {"Scatter={\"Voxel\": 5}", "[5, \"mm\"]", "Scatter.Voxel"},
    {"Scatter={\"Voxel\": [5]}", "has no unit", "Scatter.Voxel"},
    {"Scatter={\"Voxel\": [0, \"mm\"]}", "give a length above 0", "Scatter.Voxel"},
    {"Scatter={\"Detector\": 32}", "[32, 32]", "Scatter.Detector"},
    {"Scatter={\"Detector\": [32]}", "has 1 elements; give columns and rows", "Scatter.Detector"},
    {"Scatter={\"Detector\": [32, 0]}", "give 1 to 256", "Scatter.Detector[1]"},
    {"Scatter={\"Detector\": [257, 32]}", "give 1 to 256", "Scatter.Detector[0]"},
};

START_TEST(refused) {
    ck_skg_fails(load_with(bad[_i].setting, NULL), SKG_ERR_FORMAT, bad[_i].text);
    char place[64];
    snprintf(place, sizeof place, "%s: ", bad[_i].place);
    ck_assert_msg(strstr(skg_last_error(), place) != NULL, "%s: no %s", skg_last_error(), place);
}
END_TEST

/* WorldScatter is kept without the key Scatter, too: flags and programs may ask for scatter later. */
START_TEST(the_world_may_be_left_out) {
    static const char *const settings[] = {"Tolerance=0", "WorldScatter=true", "WorldScatter=false"};
    for (int i = 0; i < 3; i++) {
        skg_plan_options o;
        skg_plan_options_init(&o);
        ck_skg(load_with(settings[i], NULL));
        ck_skg(skg_setup_options_get(setup, &o));
        ck_assert_int_eq(o.world_scatter_off, i == 2);
    }
    ck_skg_fails(load_with("WorldScatter=3", NULL), SKG_ERR_FORMAT, "WorldScatter");
}
END_TEST

/* A scene of one box with form factors in a file; or of what else a sample is. */
static skg_status load_formed(const char *sample, const char *file) {
    char text[512];
    skg_setup_release(&setup);
    write_file("form.txt", file);
    snprintf(
        text, sizeof text,
        "{\"Source\": {\"Position\": [0, 0, 100, \"mm\"], \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", "
        "\"PhotonCount\": 1}]}, \"Detector\": {\"Position\": [0, 0, -50, \"mm\"], \"UpVector\": [0, 1, 0], "
        "\"NumberOfPixels\": [4, 4], \"Spacing\": [1, 1, \"mm\"]}, \"Samples\": [{\"FormFactor\": \"form.txt\", %s}]}",
        sample);
    write_file("scene.json", text);
    return skg_setup_load(NULL, path, 0, NULL, &setup);
}

START_TEST(form_factors_are_read) {
    static const char box[] = "\"Cuboid\": [1, 2, 3, \"mm\"], \"Material\": \"Water\", \"Density\": 0.9";
    int64_t count = 0;
    double x[3], squares[3];
    ck_skg(load_formed(box, "# 1/Angstrom, F^2\n0 1\n0.2 8\n0.5 2\n"));
    skg_part part;
    skg_part_init(&part);
    ck_skg(skg_scene_part_get(setup->scene, 0, &part));
    ck_skg(skg_material_form_factor_get(part.material, 3, x, squares, &count));
    ck_assert_int_eq(count, 3);
    ck_assert_double_eq(x[1], 0.2);
    ck_assert_double_eq_tol(squares[1] / squares[0], 8, 1e-12); /* rounding */
    ck_skg_fails(load_formed(box, "0 1\n0.2 8\n"), SKG_ERR_MATERIAL, "FormFactor: Water");
    ck_skg_fails(load_formed(box, "0 1\n0.2\n"), SKG_ERR_FORMAT, "form.txt");
    ck_skg_fails(load_formed("\"Cuboid\": [1, 2, 3, \"mm\"], \"Material\": [\"mu\", 0.2]", "0 1\n0.5 8\n"),
                 SKG_ERR_MATERIAL, "does not say how it scatters");
    ck_skg_fails(load_formed("\"Volume\": \"form.txt\"", "0 1\n0.5 8\n"), SKG_ERR_FORMAT,
                 "stands beside Volume");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, absent_unless_asked_for);
    tcase_add_test(tests, short_forms);
    tcase_add_test(tests, every_key);
    tcase_add_test(tests, the_text_keeps_it);
    tcase_add_test(tests, the_world_may_be_left_out);
    tcase_add_test(tests, form_factors_are_read);
    tcase_add_loop_test(tests, refused, 0, sizeof bad / sizeof *bad);
}

SKG_SUITE_MAIN("scatter_setup", add_tests)
