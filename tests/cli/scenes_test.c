/* The scenes of examples/scenes. */
#include "cli/command.h"

static const char *const scenes[] = {"cube", "step-wedge", "phantom", "laminate", "mammography"};

START_TEST(examples_are_images) {
    const int has_place = _i != 1; /* the step wedge's detector is fitted */
    ck_run(0, "image %s/examples/scenes/%s.json --set Detector.NumberOfPixels=[40,32] %s -o a.mha",
           SKG_SOURCE, scenes[_i], _i >= 3 ? "--set 'Detector.Spacing=[4,4,\"mm\"]'" : "");
    ck_assert_ptr_null(strstr(complained, "warning"));
    ck_assert_int_eq(strstr(complained, "fitted to the parts") == NULL, has_place);
    ck_assert_ptr_nonnull(strstr(said, "40 x 32 pixels"));
}
END_TEST

/* Meshes of the thorax are made by ./demo. */
START_TEST(the_thorax_takes_the_files_of_the_demo) {
    char line[1024];
    ck_run(0, "thorax -o . --triangles 10000 --quiet");
    snprintf(line, sizeof line,
             "mkdir -p %s/a/b %s/demo-pictures && mv %s/*.ply %s/demo-pictures && cd %s/demo-pictures && "
             "mkdir thorax && mv *.ply thorax && cp %s/examples/scenes/thorax.json %s/a/b/",
             folder, folder, folder, folder, folder, SKG_SOURCE, folder);
    ck_assert_int_eq(system(line), 0);
    const int status = run("image a/b/thorax.json --set Detector.NumberOfPixels=[30,60] -o t.mha");
    snprintf(line, sizeof line, "rm -r %s/a %s/demo-pictures", folder, folder);
    ck_assert_int_eq(system(line), 0);
    ck_assert_msg(status == 0, "%s", complained);
    ck_assert_ptr_null(strstr(complained, "warning"));
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_loop_test(tests, examples_are_images, 0, sizeof scenes / sizeof *scenes);
    tcase_add_test(tests, the_thorax_takes_the_files_of_the_demo);
}

SKG_SUITE_MAIN("scenes", add_tests)
