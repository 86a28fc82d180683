/* A set-up from a text, partial ones, and the files that a scene names. */
#include "setup/setup_files.h"

static skg_setup_source source;

static void set_up_text(void) {
    set_up();
    skg_setup_source_init(&source);
    source.text = good;
}

static int64_t count_parts(void) {
    int64_t parts = -1;
    ck_skg(skg_scene_part_count(setup->scene, &parts));
    return parts;
}

START_TEST(a_text_is_read_like_a_file) {
    skg_view from_file, from_text;
    skg_view_init(&from_file);
    skg_view_init(&from_text);
    write_file("scene.json", good);
    ck_skg(load());
    ck_skg(skg_setup_view_get(setup, &from_file));
    skg_setup_release(&setup);
    ck_skg(skg_setup_create(NULL, &source, &setup));
    ck_skg(skg_setup_view_get(setup, &from_text));
    ck_assert_mem_eq(&from_file, &from_text, sizeof from_file);
    ck_assert_int_eq(count_parts(), 2);
}
END_TEST

START_TEST(messages_begin_with_the_path) {
    source.text = "{\"Sauce\": 1}";
    source.path = "kitchen/menu.json";
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_FORMAT, "kitchen/menu.json: line 1");
    source.path = NULL;
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_FORMAT, "scene: line 1");
    source.text = NULL;
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_ARGUMENT, "text");
    ck_skg_fails(skg_setup_create(NULL, NULL, &setup), SKG_ERR_ARGUMENT, "skg_setup_source");
}
END_TEST

START_TEST(settings_apply_to_a_text) {
    const char *const settings[] = {"Detector.NumberOfPixels=[8, 4]", NULL};
    source.settings = settings;
    source.setting_count = 1;
    ck_skg(skg_setup_create(NULL, &source, &setup));
    ck_assert_int_eq(setup->view.columns, 8);
    skg_setup_release(&setup);
    source.setting_count = 2;
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_ARGUMENT, "settings[1]");
    source.settings = NULL;
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_ARGUMENT, "settings");
}
END_TEST

/* A text that a program changed is read again, with steps of the detector and bins as they are. */
START_TEST(a_text_goes_around) {
    const char *const settings[] = {
        ("Detector={\"Position\": [1, 2, 30, \"cm\"], \"NumberOfPixels\": [8, 4], \"ColumnStep\": [0.1, 0.30000000000000004, "
         "0, \"mm\"], \"RowStep\": [0, 0, -0.7, \"mm\"]}"),
        "Source.Beam={\"Bins\": [[30, 0.1], [60.5, 7]], \"At1m\": true}", "Source.Shape=null"};
    const char *text = NULL;
    char copy[8192];
    skg_spectrum *spectrum = NULL;
    int32_t absolute = 0;
    double kev = 0, photons = 0;
    source.settings = settings;
    source.setting_count = 3;
    ck_skg(skg_setup_create(NULL, &source, &setup));
    ck_skg(skg_setup_text_get(setup, &text));
    ck_assert_uint_lt(strlen(text), sizeof copy);
    strcpy(copy, text);
    const skg_view view = setup->view;
    skg_setup_release(&setup);
    skg_setup_source_init(&source);
    source.text = copy;
    ck_skg(skg_setup_create(NULL, &source, &setup));
    ck_assert_mem_eq(&setup->view, &view, sizeof view);
    ck_assert_double_eq(view.column_step[1], 0.30000000000000004);
    ck_assert_int_eq(view.projection, SKG_PROJECTION_POINT);
    ck_skg(skg_setup_spectrum_get(setup, &spectrum));
    ck_skg(skg_spectrum_absolute_get(spectrum, &absolute));
    ck_skg(skg_spectrum_bin_get(spectrum, 1, &kev, &photons));
    ck_assert_int_eq(absolute, 1);
    ck_assert_double_eq(kev, 60.5);
    ck_assert_double_eq(photons, 7);
    ck_skg_fails(skg_setup_text_get(NULL, &text), SKG_ERR_ARGUMENT, "setup");
}
END_TEST

START_TEST(steps_exclude_what_they_say_already) {
    const char *const both[] = {"Detector.ColumnStep=[1, 0, 0, \"mm\"]"};
    const char *const half[] = {
        "Detector={\"Position\": [1, 2, 30, \"cm\"], \"NumberOfPixels\": [8, 4], \"ColumnStep\": [1, 0, 0, \"mm\"]}"};
    source.setting_count = 1;
    source.settings = both;
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_FORMAT,
                 "ColumnStep and RowStep say it already");
    source.settings = half;
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_FORMAT, "RowStep is missing");
}
END_TEST

START_TEST(a_partial_text_leaves_sections_out) {
    skg_spectrum *spectrum = NULL;
    skg_view view, plain;
    source.text = "{}";
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_FORMAT, "Source");
    source.partial = 1;
    ck_skg(skg_setup_create(NULL, &source, &setup));
    ck_assert_int_eq(count_parts(), 0);
    ck_skg(skg_setup_spectrum_get(setup, &spectrum));
    ck_assert_ptr_null(spectrum);
    skg_view_init(&view);
    skg_view_init(&plain);
    ck_skg(skg_setup_view_get(setup, &view));
    ck_assert_mem_eq(&view, &plain, sizeof view);
    skg_setup_release(&setup);
    source.text = "{\"Samples\": [{\"Label\": \"a\", \"Cube\": [1, \"mm\"], \"Material\": \"water\"}]}";
    ck_skg(skg_setup_create(NULL, &source, &setup));
    ck_assert_int_eq(count_parts(), 1);
    skg_setup_release(&setup);
    source.text = "{\"Detector\": {\"Position\": [0, 1, 0, \"m\"]}}";
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_FORMAT, "Source");
    source.text = "{\"Scan\": {\"NumberOfProjections\": 4}}";
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_SCENE, "Scan: needs Source and Detector");
}
END_TEST

static const char with_files[] =
    "{\"Samples\": [{\"Label\": \"a\", \"Path\": \"box.ply\", \"Unit\": \"mm\", \"Material\": \"water\"},\n"
    "{\"Label\": \"b\", \"Path\": \"box.ply\", \"Unit\": \"cm\", \"Material\": [\"Table\", \"mu.txt\", \"keV\"],\n"
    " \"Parent\": \"a\"}]}";

static void make_files(void) {
    skg_mesh *mesh = NULL;
    char full[128];
    write_file("box.stl", "10 1.5\n100 0.5\n"); /* read as mu.txt */
    snprintf(full, sizeof full, "%s/box.ply", folder);
    ck_skg(skg_mesh_create_cube(10, &mesh));
    ck_skg(skg_mesh_save(mesh, full));
    skg_mesh_release(&mesh);
}

START_TEST(files_are_listed_and_found_elsewhere) {
    char box[128], mu[128];
    const char *name = NULL, *where = NULL;
    int64_t count = 0;
    make_files();
    snprintf(box, sizeof box, "%s/box.ply", folder);
    snprintf(mu, sizeof mu, "%s/box.stl", folder);
    const char *const names[] = {"mu.txt"}, *const paths[] = {mu};
    source.text = with_files;
    source.path = path;
    source.partial = 1;
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_FILE, "mu.txt");
    source.file_names = names;
    source.file_paths = paths;
    source.file_count = 1;
    ck_skg(skg_setup_create(NULL, &source, &setup));
    ck_skg(skg_setup_file_count(setup, &count));
    ck_assert_int_eq(count, 2);
    ck_skg(skg_setup_file_get(setup, 0, &name, &where));
    ck_assert_str_eq(name, "box.ply");
    ck_assert_str_eq(where, box);
    ck_skg(skg_setup_file_get(setup, 1, &name, &where));
    ck_assert_str_eq(name, "mu.txt");
    ck_assert_str_eq(where, mu);
    ck_skg_fails(skg_setup_file_get(setup, 2, &name, &where), SKG_ERR_ARGUMENT, "index 2");
    ck_skg_fails(skg_setup_file_get(setup, -1, &name, &where), SKG_ERR_ARGUMENT, "index -1");
    source.file_paths = NULL;
    skg_setup_release(&setup);
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_ARGUMENT, "file_paths");
    unlink(box);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_text, tear_down);
    tcase_add_test(tests, a_text_is_read_like_a_file);
    tcase_add_test(tests, messages_begin_with_the_path);
    tcase_add_test(tests, settings_apply_to_a_text);
    tcase_add_test(tests, a_text_goes_around);
    tcase_add_test(tests, steps_exclude_what_they_say_already);
    tcase_add_test(tests, a_partial_text_leaves_sections_out);
    tcase_add_test(tests, files_are_listed_and_found_elsewhere);
}

SKG_SUITE_MAIN("setup_text", add_tests)
