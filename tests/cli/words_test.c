/* Messages of the command to users who come from other programs. */
#include "cli/command.h"

static const char scene[] =
    "{\"Source\": {\"Position\": [0, -500, 0, \"mm\"], \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}]}, "
    "\"Detector\": {\"Position\": [0, 100, 0, \"mm\"], \"UpVector\": [0, 0, -1], \"NumberOfPixels\": [8, 8], "
    "\"Spacing\": [1, 1, \"mm\"]}, \"Samples\": [{\"Label\": \"a\", \"Cube\": [4, \"mm\"], \"Material\": \"Al\"}]}\n";

static void set_up_scene(void) {
    set_up();
    write_text("scene.json", scene);
}

/* As messages write places, "Samples[0].Material". */
START_TEST(a_setting_names_a_place_as_messages_do) {
    ck_run(0, "image scene.json -o a.mha --set 'Samples[0].Material=Fe' --json");
    json_t *object = said_json();
    json_decref(object);
    ck_run(0, "image scene.json -o b.mha --set Samples.0.Material=Fe");
    ck_run(0, "image scene.json -o c.mha --set 'Source.Beam[0].PhotonCount=5'");
    ck_run_fails(2, "neither the label of an element nor a number from 0 to 0",
                 "image scene.json -o a.mha --set 'Samples[3].Material=Fe'");
}
END_TEST

START_TEST(flags_that_are_elsewhere_are_named) {
    ck_run_fails(2, "--set Scan.NumberOfProjections=90", "scan scene.json -o a.h5 --projections 90");
    ck_run_fails(2, "--set Noise=true", "image scene.json -o a.mha --noise");
    ck_run_fails(2, "device=cpu threads=4", "image scene.json -o a.mha --threads=4");
    ck_run_fails(2, "only breathe and view make films", "image scene.json -o a.mha --seconds 3");
    ck_run_fails(2, "did you mean --precision?", "image scene.json -o a.mha --precison double");
}
END_TEST

START_TEST(a_file_that_is_neither_scene_nor_mesh) {
    write_text("README.md", "# Words\n");
    ck_run_fails(3, "README.md: is neither a scene nor a mesh", "image README.md -o a.mha");
    ck_run_fails(3, "line 1, column 1", "image README.md -o a.mha");
    write_text("bad.json", "{\"Source\": }\n");
    ck_run_fails(3, "bad.json: line 1, column 12: ", "image bad.json -o a.mha");
}
END_TEST

START_TEST(a_file_of_one_line_has_columns) {
    write_text("one.json", "{\"Source\": {}, \"Sauce\": 1}\n");
    ck_run_fails(3, "one.json: line 1, column 16: Sauce: unknown key", "image one.json -o a.mha");
    write_text("two.json", "{\"Source\": {},\n\"Sauce\": 1}\n");
    ck_run_fails(3, "two.json: line 2: Sauce: unknown key", "image two.json -o a.mha");
    ck_run_fails(3, "read leniently (--lenient), this is a warning", "image two.json -o a.mha");
}
END_TEST

START_TEST(projections_without_geometry_are_not_reconstructed) {
    write_text("s.mha", "projections");
    ck_run_fails(3, "s.mha: holds projections without the places of source and detector",
                 "reconstruct s.mha -o v.mha");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scene, tear_down);
    tcase_add_test(tests, a_setting_names_a_place_as_messages_do);
    tcase_add_test(tests, flags_that_are_elsewhere_are_named);
    tcase_add_test(tests, a_file_that_is_neither_scene_nor_mesh);
    tcase_add_test(tests, a_file_of_one_line_has_columns);
    tcase_add_test(tests, projections_without_geometry_are_not_reconstructed);
}

SKG_SUITE_MAIN("words", add_tests)
