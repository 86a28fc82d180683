/* The verb register: a body is found in radiographs that the command made, what it prints and writes, and what it refuses. */
#include "cli/command.h"

#include <math.h>

/* A body of two blocks in a cube that lies askew, seen from two sides of a Scan. */
static const char text[] =
    "{ \"Source\": { \"Position\": [0, -600, 0, \"mm\"], \"Shape\": \"PointSource\",\n"
    "    \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}] },\n"
    "  \"Detector\": { \"Position\": [0, 200, 0, \"mm\"], \"UpVector\": [0, 0, -1],\n"
    "    \"NumberOfPixels\": [64, 64], \"Spacing\": [3, 3, \"mm\"], \"Oversampling\": 3 },\n"
    "  \"Scan\": {\"NumberOfProjections\": 2, \"AngleStep\": 90},\n"
    "  \"Samples\": [\n"
    "    {\"Label\": \"skin\", \"Cube\": [90, \"mm\"], \"Type\": \"outer\", \"Material\": [\"mu\", 0.2],\n"
    "     \"Transform\": [[\"Rotation\", 10, 1, 2, 3]]},\n"
    "    {\"Label\": \"bone 1\", \"Cuboid\": [20, 24, 40, \"mm\"], \"Material\": [\"mu\", 0.5],\n"
    "     \"Transform\": [[\"Translation\", MOVED, 2, -3, \"mm\"], [\"Rotation\", 12, 1, -2, 1]]},\n"
    "    {\"Label\": \"bone 2\", \"Cuboid\": [34, 9, 11, \"mm\"], \"Material\": [\"mu\", 0.5],\n"
    "     \"Transform\": [[\"Translation\", MOVED, 8, 31, \"mm\"], [\"Rotation\", 17, 3, 2, 1]]} ] }\n";

static void write_scene(const char *name, const char *x) {
    char scene[sizeof text + 64] = "";
    for (const char *from = text; *from;) {
        const size_t used = strlen(scene);
        if (!strncmp(from, "MOVED", 5)) {
            snprintf(scene + used, sizeof scene - used, "%s", x);
            from += 5;
        } else {
            scene[used] = *from++;
        }
    }
    write_text(name, scene);
}

/* The radiographs show the bones 4 mm beside where the scene has them. */
static void set_up_scene(void) {
    set_up();
    write_scene("scene.json", "3");
    write_scene("truth.json", "7");
    ck_run(0, "scan truth.json -o fixed.mha --quiet");
    ck_run(0, "image truth.json -o front.tif --quiet");
}

static double number_at(json_t *object, const char *key, size_t index) {
    return json_number_value(json_array_get(member(object, key), index));
}

#define TWO "--image fixed.mha@0 --image fixed.mha@1 --part 'bone*' "

START_TEST(a_body_is_found_and_written) {
    ck_run(0, "register scene.json " TWO "-o found.json --report page.html --json --quiet");
    json_t *object = said_json(), *part = json_array_get(member(object, "parts"), 0);
    ck_assert_str_eq(json_string_value(member(part, "label")), "bone*");
    /* a hundredth of the pixel of 2.2 mm at the body, whose rays are those of the radiograph, and what that turns its rim by */
    for (size_t k = 0; k < 6; k++)
        ck_assert_double_eq_tol(number_at(part, "twist", k), (k == 0 ? 4 : 0), (k < 3 ? 0.02 : 0.0012));
    ck_assert_uint_eq(json_array_size(member(part, "sigma")), 6);
    ck_assert_uint_eq(json_array_size(member(part, "determined")), 6);
    ck_assert_uint_eq(json_array_size(member(part, "directions")), 6);
    ck_assert_uint_eq(json_array_size(member(object, "views")), 2);
    ck_assert_str_eq(json_string_value(member(object, "status")), "agrees");
    ck_assert_double_lt(json_number_value(member(object, "loss")),
                        json_number_value(member(object, "loss_start")));
    ck_assert(json_integer_value(member(object, "evaluations")) > 4);
    ck_assert(json_integer_value(member(member(object, "worst"), "view")) < 2);
    json_decref(object);
    static char page[1 << 20];
    read_back("page.html", page, sizeof page);
    ck_assert_ptr_nonnull(strstr(page, "fixed.mha@1"));
    ck_assert_ptr_nonnull(strstr(page, "data:image/png;base64,"));
    ck_assert_ptr_null(strstr(page, "http"));
    /* in the scene that was written nothing is left to move */
    ck_run(0, "register found.json " TWO "-o again.json --json --quiet");
    object = said_json(), part = json_array_get(member(object, "parts"), 0);
    /* as above, and both are beside the truth by the same */
    ck_assert_double_lt(json_number_value(member(part, "shift_mm")), 0.05);
    json_decref(object);
    ck_run(0, "register scene.json " TWO "-o found.json");
    ck_assert_ptr_nonnull(strstr(said, "bone*: moved by "));
    ck_assert_ptr_nonnull(strstr(said, "wrote found.json"));
}
END_TEST

/* One body after the other: the second begins where the first has led. */
START_TEST(bodies_follow_each_other) {
    ck_run(0, "register scene.json " TWO "--part 'bone 1' -o found.json --json --quiet");
    json_t *object = said_json(), *parts = member(object, "parts");
    ck_assert_uint_eq(json_array_size(parts), 2);
    /* a twentieth of a pixel, as above */
    ck_assert_double_eq_tol(number_at(json_array_get(parts, 0), "twist", 0), 4, 0.1);
    ck_assert_double_lt(json_number_value(member(json_array_get(parts, 1), "shift_mm")), 0.1);
    json_decref(object);
}
END_TEST

/* Intensities with a flat field and a mask in one view, which sees little along its beam; grey values of a PNG. */
START_TEST(other_radiographs_are_taken) {
    ck_run(
        0,
        "register scene.json --image front.tif --quantity intensity --flat 60000 --mask front.tif --part 'bone*' "
        "-o found.json --json --quiet --need 50");
    json_t *object = said_json();
    /* a quarter of a pixel: one view turns the body a little for what it does not see along the beam */
    ck_assert_double_eq_tol(number_at(json_array_get(member(object, "parts"), 0), "twist", 0), 4, 0.5);
    json_decref(object);
    ck_run(0, "image truth.json -o front.png --display transmission --range 0:1 --quiet");
    ck_run(
        0,
        "register scene.json --image front.png --flat 65535 --loss ncc --part 'bone*' -o found.json --json --quiet --need 50");
    object = said_json();
    /* a quarter of a pixel, as above */
    ck_assert_double_eq_tol(number_at(json_array_get(member(object, "parts"), 0), "twist", 0), 4, 0.5);
    json_decref(object);
    ck_run_fails(
        3, "these are grey values",
        "register scene.json --image front.png --quantity attenuation --part 'bone*' -o g.json --quiet");
}
END_TEST

/* The geometry of the scene's own view. */
START_TEST(a_geometry_is_found) {
    ck_run(
        0,
        "register truth.json --image front.tif --set 'Detector.Position=[1.5, 200, -1, \"mm\"]' --free detector -o found.json "
        "--json --quiet");
    json_t *object = said_json(), *view = json_array_get(member(object, "views"), 0);
    ck_assert_double_eq_tol(number_at(view, "centre", 0), 0, 0.1); /* a thirtieth of a pixel */
    ck_assert_double_eq_tol(number_at(view, "centre", 2), 0, 0.1);
    json_decref(object);
    ck_run(0, "image found.json -o again.tif --quiet");
}
END_TEST

/* A file whose pixels have another pitch than the scene's is taken, with a warning. */
START_TEST(another_pitch_is_said) {
    ck_run(0, "image truth.json -o front.mha --quiet");
    ck_run(0, "register scene.json --image front.mha --part 'bone*' -o found.json --need 50");
    ck_assert_ptr_null(strstr(complained, "says that its pixels"));
    ck_run(0, "register scene.json --set 'Detector.Spacing=[2.95,3,\"mm\"]' --image front.mha --part 'bone*' "
              "-o found.json --need 50");
    ck_assert_ptr_nonnull(strstr(complained,
                                 "front.mha: says that its pixels are 3 x 3 mm, and those of the scene's "
                                 "detector are 2.95 x 3 mm"));
}
END_TEST

START_TEST(mistakes_are_named) {
    ck_run_fails(2, "give at least one radiograph", "register scene.json --part skin -o f.json --quiet");
    ck_run_fails(2, "say which part moves", "register scene.json --image front.tif -o f.json --quiet");
    ck_run_fails(2, "add -o registered.json", "register scene.json --image front.tif --part skin --quiet");
    ck_run_fails(2, "did you mean \"bone 1\"",
                 "register scene.json --image front.tif --part 'bone 9' -o f.json --quiet");
    ck_run_fails(2, "give six numbers",
                 "register scene.json --image front.tif --part skin --start 1,2 -o f.json --quiet");
    ck_run_fails(3, "nothere.mha", "register scene.json --image nothere.mha --part skin -o f.json --quiet");
    ck_run_fails(
        3, "has 64 x 64 pixels, and its view has 32 x 32",
        "register scene.json --image front.tif --part skin -o f.json --set Detector.NumberOfPixels=[32,32] --quiet");
    ck_run_fails(3, "the Scan has 2 projections",
                 "register scene.json --image fixed.mha@2 --part skin -o f.json --quiet");
    ck_run_fails(3, "has 2 pages; say by @K",
                 "register scene.json --image fixed.mha --part skin -o f.json --quiet");
    ck_run_fails(3, "has no Scan",
                 "register scene.json --image front.tif@0 --part skin -o f.json --set Scan=null --quiet");
    ck_run_fails(
        3, "is not seen in this view",
        "register scene.json --image front.tif --part 'bone 1' --start 400,0,0,0,0,0 -o f.json --quiet");
    ck_run_fails(
        3, "lies behind the detector",
        "register scene.json --image front.tif --part 'bone 1' --start 0,400,0,0,0,0 -o f.json --quiet");
    ck_run(
        0,
        "lbuffer scene.json --part skin --surface -o none.tif --set Detector.Position=[0,300,900,'\"mm\"'] --quiet");
    ck_run_fails(3, "the mask hides every pixel",
                 "register scene.json --image front.tif --mask none.tif --part 'bone 1' -o f.json --quiet");
    ck_run_fails(3, "every value is",
                 "register scene.json --image none.tif --part 'bone 1' -o f.json --quiet");
    ck_assert_int_eq(has_file("f.json"), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scene, tear_down);
    tcase_add_test(tests, a_body_is_found_and_written);
    tcase_add_test(tests, bodies_follow_each_other);
    tcase_add_test(tests, other_radiographs_are_taken);
    tcase_add_test(tests, a_geometry_is_found);
    tcase_add_test(tests, another_pitch_is_said);
    tcase_add_test(tests, mistakes_are_named);
}

SKG_SUITE_MAIN("register_verb", add_tests)
