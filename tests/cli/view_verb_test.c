/* skiagraph view. */
#include "cli/command.h"

#include <math.h>

static const char scene[] =
    "{\"Source\": {\"Position\": [0, -40, 0, \"cm\"], \"Shape\": \"PointSource\","
    "\"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}]},"
    "\"Detector\": {\"Position\": [0, 10, 0, \"cm\"], \"UpVector\": [0, 0, -1], \"NumberOfPixels\": [32, 24],"
    "\"Size\": [32, 24, \"cm\"]},"
    "\"Samples\": [{\"Label\": \"tissue\", \"Cube\": [80, \"mm\"], \"Material\": [\"mu\", 0.2], \"Type\": \"outer\"},"
    "{\"Label\": \"bone\", \"Cylinder\": [32, 60, 12, \"mm\"], \"Material\": [\"mu\", 0.5]}]}";

static void set_up_scene(void) {
    set_up();
    write_text("s.json", scene);
}

/* Width and height of a PNG file: bytes 16 to 23. */
static void check_size(const char *name, int width, int height) {
    char path[512];
    unsigned char head[24];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    ck_assert_int_eq((int)fread(head, 1, sizeof head, stream), (int)sizeof head);
    fclose(stream);
    ck_assert_int_eq(head[18] << 8 | head[19], width);
    ck_assert_int_eq(head[22] << 8 | head[23], height);
}

START_TEST(a_picture_of_the_scene) {
    ck_run(0, "view s.json -o v.png --json");
    check_size("v.png", 1280, 800);
    json_t *object = said_json();
    ck_assert_double_eq(json_number_value(member(object, "source_detector_mm")), 500);
    /* the middle of the box of the cube is at 0 exactly; 1e-9: some roundings of 400 */
    ck_assert_double_eq_tol(json_number_value(member(object, "source_object_mm")), 400, 1e-9);
    ck_assert_double_eq_tol(json_number_value(member(object, "magnification")), 1.25, 1e-9);
    const json_t *part = json_array_get(member(object, "parts"), 1);
    ck_assert_str_eq(json_string_value(json_object_get(part, "label")), "bone");
    ck_assert(json_number_value(json_object_get(part, "column")) > 0);
    json_decref(object);
}
END_TEST

START_TEST(sides_sizes_and_files) {
    ck_run(0, "view s.json -o a.png -o b.png --from top --size 320,200 --orthographic");
    check_size("a.png", 320, 200);
    ck_assert_ptr_nonnull(strstr(said, "wrote a.png"));
    ck_assert_ptr_nonnull(strstr(said, "wrote b.png"));
    ck_run(0, "view s.json -o a.png --from 1,-2,0.5 --quiet"); /* its own file is overwritten */
    ck_assert_str_eq(said, "");
    write_text("mine.png", "holiday");
    ck_run(5, "view s.json -o mine.png");
    ck_assert_ptr_nonnull(strstr(complained, "was not written by skiagraph"));
}
END_TEST

/* glTF has metres and y up; other programs find the parts by name. */
START_TEST(a_model_of_the_parts) {
    ck_run(0, "view s.json -o v.glb");
    ck_assert_str_eq(said, "wrote v.glb\n");
    ck_run(0, "mesh v.glb --group bone --json");
    json_t *object = said_json();
    const json_t *mesh = json_array_get(member(object, "files"), 0),
                 *bounds = json_object_get(mesh, "bounds");
    const double expected[] = {-12, -12, -30, 12, 12, 30},
                 volume = 16 * 144 * sin(2 * 3.14159265358979 / 32) * 60;
    ck_assert_double_eq_tol(json_number_value(json_object_get(mesh, "volume_mm3")), volume,
                            1e-6 * volume); /* floats */
    for (size_t k = 0; k < 6; k++)
        ck_assert_double_eq_tol(json_number_value(json_array_get(bounds, k)), expected[k], 1e-5);
    json_decref(object);
    ck_run_fails(2, "a model has no --seconds", "view s.json -o v.glb --seconds 2");
    ck_run(0, "thorax -o .");
    for (int again = 0; again < 2; again++) /* its own file is overwritten, however long its list of parts */
        ck_run(0, "view thorax.json -o thorax.glb --quiet --phase 0.5");
}
END_TEST

/* The ball around the cube is as high as the picture, times the zoom; from the front x runs with the columns. */
START_TEST(zoom_shows_a_part_larger) {
    for (int zoom = 1; zoom <= 4; zoom *= 2) {
        ck_run(0,
               "view s.json -o v.png --from front --orthographic --json --zoom %d@tissue "
               "--set 'Samples.bone.Transform=[[\"Translation\",20,0,0,\"mm\"]]'",
               zoom);
        json_t *object = said_json(), *parts = member(object, "parts");
        const json_t *cube = json_array_get(parts, 0), *bone = json_array_get(parts, 1);
        const double scale = 800 * zoom / (2 * 40 * sqrt(3)); /* pixels of a mm */
        const double column = json_number_value(json_object_get(cube, "column"));
        ck_assert_double_eq_tol(column, 640, 1); /* a pixel: its middle or its edge */
        ck_assert_double_eq_tol(json_number_value(json_object_get(cube, "row")), 400, 1);
        ck_assert_double_eq_tol(json_number_value(json_object_get(bone, "column")) - column, 20 * scale,
                                1e-3 * 20 * scale); /* the eye is of floats */
        json_decref(object);
    }
    ck_run(0, "view s.json -o v.png --quiet --zoom 0.5");
    ck_run_fails(2, "--zoom 0 is neither", "view s.json -o v.png --zoom 0");
    ck_run_fails(2, "--zoom 2x is neither", "view s.json -o v.png --zoom 2x");
    ck_run_fails(3, "did you mean bone", "view s.json -o v.png --zoom 2@bome");
}
END_TEST

/* Twelve sheets of one kind, each of which shows at an edge of less than a pixel. */
START_TEST(all_plies_are_named) {
    char text[4096];
    int used = snprintf(
        text, sizeof text,
        "{\"Source\": {\"Position\": [0, -1000, 0, \"mm\"], \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1}]},"
        "\"Detector\": {\"Position\": [0, 100, 0, \"mm\"], \"UpVector\": [0, 0, 1], \"NumberOfPixels\": [32, 32], \"Spacing\": [4, 4, \"mm\"]},"
        "\"Samples\": [");
    for (int i = 0; i < 12; i++)
        used += snprintf(
            text + used, sizeof text - (size_t)used,
            "%s{\"Label\": \"ply %d\", \"Cuboid\": [100, 0.25, 60, \"mm\"], \"Material\": [\"mu\", 0.2], "
            "\"Transform\": [[\"Translation\", 0, %g, 0, \"mm\"]]}",
            i ? ", " : "", i, 0.25 * i);
    snprintf(text + used, sizeof text - (size_t)used, "]}");
    write_text("plies.json", text);
    ck_run(0, "view plies.json -o v.png --json");
    json_t *object = said_json();
    const json_t *parts = member(object, "parts");
    ck_assert_uint_eq(json_array_size(parts), 12);
    for (size_t i = 0; i < 12; i++)
        ck_assert_msg(json_is_array(json_object_get(json_array_get(parts, i), "dot")), "ply %zu has no name",
                      i);
    json_decref(object);
}
END_TEST

/* The large cube is seen beside the small one before it: there is its dot, which its centre is not. The one behind it is not seen,
 * and has no name. */
START_TEST(dots_lie_where_a_part_is_seen) {
    write_text(
        "hidden.json",
        "{\"Source\": {\"Position\": [0, -400, 0, \"mm\"], \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1}]},"
        "\"Detector\": {\"Position\": [0, 200, 0, \"mm\"], \"UpVector\": [0, 0, 1], \"NumberOfPixels\": [32, 24],"
        "\"Size\": [320, 240, \"mm\"]}, \"Samples\": ["
        "{\"Label\": \"large\", \"Cube\": [60, \"mm\"], \"Material\": [\"mu\", 0.2]},"
        "{\"Label\": \"small\", \"Cube\": [40, \"mm\"], \"Material\": [\"mu\", 0.2],"
        "\"Transform\": [[\"Translation\", 0, -80, 0, \"mm\"]]},"
        "{\"Label\": \"back\", \"Cube\": [30, \"mm\"], \"Material\": [\"mu\", 0.2],"
        "\"Transform\": [[\"Translation\", 0, 80, 0, \"mm\"]]}]}");
    ck_run(0, "view hidden.json -o v.png --from front --orthographic --json");
    json_t *object = said_json();
    const json_t *parts = member(object, "parts"), *large = json_array_get(parts, 0);
    const json_t *small = json_array_get(parts, 1), *dot = json_object_get(large, "dot");
    const double column = json_number_value(json_object_get(large, "column"));
    const double row = json_number_value(json_object_get(large, "row"));
    const double away = fmax(fabs(json_number_value(json_array_get(dot, 0)) - column),
                             fabs(json_number_value(json_array_get(dot, 1)) - row));
    ck_assert(json_is_array(dot));
    /* 92 % of the 800 rows show the detector's 240 mm; the small cube ends 20 mm from the centre, the large one 30. */
    ck_assert_double_gt(away, 20 * 0.92 * 800 / 240);
    ck_assert_double_lt(away, 30 * 0.92 * 800 / 240);
    ck_assert(json_is_array(json_object_get(small, "dot")));
    ck_assert(json_is_null(json_object_get(json_array_get(parts, 2), "dot")));
    json_decref(object);
}
END_TEST

/* A scene without beam and material is seen as well, and one with a Scan with the path of its source. */
START_TEST(other_scenes) {
    ck_run(0, "view s.json -o a.png --set Source.Beam=null --set Samples.bone.Material=null");
    ck_run(0, "view s.json -o b.png --set 'Scan={\"NumberOfProjections\": 8, \"FinalAngle\": 360}'");
    ck_run(0, "view s.json -o c.png --set Source.Shape=ParallelBeam");
    ck_run(0, "view s.json -o d.png -o d.html --set "
              "'Collimation={\"Rectangle\": [[-5, 9], [-4, 6], \"mm\"], \"Distance\": [200, \"mm\"]}'");
    ck_run(0, "view s.json -o e.png --set 'Collimation={\"Field\": \"detector\", \"Margin\": [30, \"mm\"]}'");
}
END_TEST

START_TEST(wrong_words) {
    ck_run(2, "view s.json");
    ck_assert_ptr_nonnull(strstr(complained, "add -o FILE.png"));
    ck_run(2, "view s.json -o v.jpg");
    ck_assert_ptr_nonnull(strstr(complained, "v.jpg"));
    ck_run(2, "view s.json -o v.png --from below");
    ck_assert_ptr_nonnull(strstr(complained, "is no side; give front, side, top"));
    ck_run(2, "view s.json -o v.png --size 10,10");
    ck_assert_ptr_nonnull(strstr(complained, "64 to 8192"));
    ck_run(2, "view s.json -o v.png --phase 0.5 --at 1");
    ck_run(3, "view s.json -o v.png --phase 0.5");
    ck_assert_ptr_nonnull(strstr(complained, "no organ that moves"));
    ck_run(5, "view s.json -o nowhere/v.png");
    ck_assert(!has_file("v.png"));
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scene, tear_down);
    tcase_add_test(tests, a_picture_of_the_scene);
    tcase_add_test(tests, sides_sizes_and_files);
    tcase_add_test(tests, a_model_of_the_parts);
    tcase_add_test(tests, zoom_shows_a_part_larger);
    tcase_add_test(tests, all_plies_are_named);
    tcase_add_test(tests, dots_lie_where_a_part_is_seen);
    tcase_add_test(tests, other_scenes);
    tcase_add_test(tests, wrong_words);
}

SKG_SUITE_MAIN("view", add_tests)
