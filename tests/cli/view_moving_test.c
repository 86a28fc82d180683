/* skiagraph view: pages and films. What a page does in a browser is in view_page_test. */
#include "cli/command.h"
#include "cli/scene.h"

#include <sys/stat.h>

enum { LARGEST_PAGE = 5000000, SIDE = 100 };

static char *page; /* of read_page */

static void read_page(const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    page = malloc(LARGEST_PAGE);
    ck_assert_ptr_nonnull(page);
    const size_t count = fread(page, 1, LARGEST_PAGE, stream);
    ck_assert_uint_lt(count, LARGEST_PAGE); /* the target: below 5 MB */
    page[count] = '\0';
    fclose(stream);
}

/* The scene of the page. */
static json_t *page_scene(void) {
    static const char begin[] = "<script type=\"application/json\" id=\"scene\">";
    const char *at = strstr(page, begin);
    json_error_t error;
    ck_assert_ptr_nonnull(at);
    json_t *found = json_loads(at + sizeof begin - 1, JSON_DISABLE_EOF_CHECK, &error);
    ck_assert_msg(found != NULL, "%s", error.text);
    return found;
}

static int64_t number_at(json_t *object, const char *key, const char *inner) {
    return json_integer_value(json_object_get(json_object_get(object, key), inner));
}

START_TEST(a_page_needs_nothing_else) {
    static const char *const asks[] = {"http",   "src=",           "url(",      "@import",
                                       "fetch(", "XMLHttpRequest", "WebSocket", "import("};
    write_text("s.json", scene);
    ck_run(0, "view s.json -o a.html -o a.png --size 320,200");
    ck_assert(strstr(said, "wrote a.html\n") && strstr(said, "wrote a.png\n"));
    read_page("a.html");
    for (size_t i = 0; i < sizeof asks / sizeof *asks; i++)
        ck_assert_msg(strstr(page, asks[i]) == NULL, "the page has %s", asks[i]);
    json_t *found = page_scene();
    ck_assert_str_eq(json_string_value(json_object_get(found, "name")), "s.json");
    ck_assert_uint_eq(json_array_size(json_object_get(found, "parts")), 2);
    ck_assert_int_eq(number_at(found, "image", "columns"), 65);
    ck_assert_int_eq(number_at(found, "image", "frames"), 1);
    ck_assert(json_is_null(json_object_get(found, "motion")));
    ck_assert_str_eq(json_string_value(json_object_get(json_object_get(found, "view"), "projection")),
                     "parallel");
    json_decref(found);
    free(page);
    ck_run(0, "view s.json -o a.html --quiet"); /* its own page is overwritten */
}
END_TEST

/* A label cannot end the script that holds it. */
START_TEST(a_page_survives_labels) {
    write_text("s.json", scene);
    ck_run(0, "view s.json -o a.html --set 'Samples.bone.Label=</script><b>\"BYTES'");
    read_page("a.html");
    ck_assert_ptr_null(strstr(page, "</script><b>"));
    json_t *found = page_scene();
    const json_t *part = json_array_get(json_object_get(found, "parts"), 1);
    ck_assert_str_eq(json_string_value(json_object_get(part, "label")), "</script><b>\"BYTES");
    ck_assert_ptr_nonnull(strstr(page, "id=\"bytes\">A")); /* the mark was found behind the label */
    json_decref(found);
    free(page);
}
END_TEST

/* The generated thorax: whole when it stands still and when it breathes, and below 5 MB. */
START_TEST(a_page_of_the_thorax_breathes) {
    ck_run(0, "thorax -o . --quiet");
    ck_run(
        0,
        "view thorax.json --set Detector.NumberOfPixels=[200,150] --set Breathing=null --seconds 4 -o a.html");
    read_page("a.html");
    json_t *found = page_scene();
    ck_assert_int_eq(number_at(found, "triangles", "shown"), number_at(found, "triangles", "of"));
    ck_assert_int_eq(number_at(found, "motion", "frames"), 20);
    ck_assert_int_eq(number_at(found, "image", "frames"), 20);
    size_t moving = 0, still = 0, i;
    json_t *part;
    json_array_foreach(json_object_get(found, "parts"), i, part) {
        const int64_t frames = json_integer_value(json_object_get(part, "frames"));
        moving += frames == 20, still += frames == 1;
    }
    ck_assert(moving > 50 && still > 5); /* spine, clavicles and shoulder blades stay */
    ck_assert_uint_eq(moving + still, i);
    json_decref(found);
    free(page);
}
END_TEST

/* A page of more than 100000 triangles, which is below 5 MB. */
static void check_fewer(int64_t least) {
    if (strstr(complained, "libmeshoptimizer-dev")) return;
    ck_assert_ptr_nonnull(strstr(complained, "a.html: shows "));
    read_page("a.html");
    json_t *found = page_scene();
    const int64_t shown = number_at(found, "triangles", "shown");
    /* each part keeps at least 100, and a surface may keep more than was asked for */
    ck_assert(shown > 90000 && shown < 105000);
    ck_assert_int_gt(number_at(found, "triangles", "of"), least);
    json_decref(found);
    free(page);
}

START_TEST(a_page_shows_fewer_triangles) {
    ck_run(0, "thorax -o . --triangles 400000 --quiet");
    ck_run(0, "view thorax.json --set Detector.NumberOfPixels=[40,40] -o a.html");
    check_fewer(350000);
}
END_TEST

/* Each corner of STL is a vertex, and many lie at one place. */
START_TEST(a_page_shows_fewer_triangles_of_stl) {
    ck_run(0, "make gyroid --box 16 --level 0.45 -o sheet.stl --quiet");
    write_text(
        "sheet.json",
        "{\"Source\": {\"Position\": [0, -10, 0, \"cm\"], \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1}]},"
        " \"Detector\": {\"Position\": [0, 10, 0, \"cm\"], \"UpVector\": [0, 0, 1], \"NumberOfPixels\": [40, 40], \"Spacing\": [1, 1, \"mm\"]},"
        " \"Samples\": [{\"Label\": \"sheet\", \"Path\": \"sheet.stl\", \"Unit\": \"mm\", \"Material\": \"Titanium\"}]}");
    ck_run(0, "view sheet.json -o a.html");
    check_fewer(120000);
}
END_TEST

/* ffmpeg, played by a script, gets the frames: SIDE x SIDE pixels of 4 bytes. They differ, because the thorax breathes. */
START_TEST(a_film_has_its_frames) {
    enum { BYTES = 4 * SIDE * SIDE, FRAMES = 4 };
    static unsigned char bytes[(FRAMES + 1) * BYTES];
    char path[512];
    write_text("ffmpeg", "#!/bin/sh\nfor last; do :; done\ncat >\"${last#file:}\"\n");
    snprintf(path, sizeof path, "%s/ffmpeg", folder);
    ck_assert_int_eq(chmod(path, 0755), 0);
    ck_run(0, "thorax -o . --simple --triangles 10000 --quiet");
    ck_run(
        0,
        "PATH=%s:$PATH |view thorax.json --set Breathing=null --set Detector.NumberOfPixels=[40,40] --fps 1 "
        "--size %d,%d -o a.webm -o b.mp4",
        folder, SIDE, SIDE);
    ck_assert_str_eq(said, "wrote a.webm\nwrote b.mp4\n");
    snprintf(path, sizeof path, "%s/a.webm", folder);
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    ck_assert_uint_eq(fread(bytes, 1, sizeof bytes, stream), FRAMES * BYTES);
    fclose(stream);
    ck_assert(memcmp(bytes, bytes + 2 * BYTES, BYTES) != 0);
    ck_run(
        0,
        "view thorax.json --set Breathing=null --set Detector.NumberOfPixels=[40,40] --fps 1 --seconds 2 --size %d,%d "
        "-o a.html",
        SIDE, SIDE);
}
END_TEST

START_TEST(wrong_words) {
    write_text("s.json", scene);
    ck_run_fails(2, "-o a.png: a picture has no --seconds", "view s.json -o a.png --seconds 4");
    ck_run_fails(2, "-o a.gif: a film has more than one moment", "view s.json -o a.gif --phase 0");
    ck_run_fails(2, "give one of them", "view s.json -o a.html --seconds 3 --at 1");
    ck_run_fails(2, "not .png, .html, .glb, .gif, .mp4 or .webm", "view s.json -o a.avi");
    ck_run_fails(5, "its folder does not exist", "view s.json -o nowhere/a.html");
    ck_run_fails(5, "needs the program ffmpeg", "PATH=/nowhere |view s.json -o a.mp4");
    ck_run_fails(3, "no organ that moves", "view s.json -o a.html --seconds 4 --set Samples.skin.Label=box");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, a_page_needs_nothing_else);
    tcase_add_test(tests, a_page_survives_labels);
    tcase_add_test(tests, a_page_of_the_thorax_breathes);
    tcase_add_test(tests, a_page_shows_fewer_triangles);
    tcase_add_test(tests, a_page_shows_fewer_triangles_of_stl);
    tcase_add_test(tests, a_film_has_its_frames);
    tcase_add_test(tests, wrong_words);
}

SKG_SUITE_MAIN("view_moving", add_tests)
