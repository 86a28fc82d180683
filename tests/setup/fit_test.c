/* Detectors that a scene leaves out, and sources of which it gives the side only. */
#include "setup/setup_files.h"

#include "core/maths.h"

#include <float.h>
#include <math.h>

/* A box of 40 x 20 x 60 mm about (1, 2, 3) cm. %s: the source's place; keys after the samples. */
static void write_box(const char *place, const char *keys) {
    char text[2048];
    snprintf(
        text, sizeof text,
        "{ \"Source\": {%s, \"Shape\": \"Point\",\n"
        "    \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1}]},\n"
        "  \"Samples\": [{\"Label\": \"box\", \"Cuboid\": [40, 20, 60, \"mm\"], \"Material\": [\"mu\", 0.2],\n"
        "    \"Transform\": [[\"Translation\", 1, 2, 3, \"cm\"]]}]%s }\n",
        place, keys);
    write_file("scene.json", text);
}

/* Vectors of a few hundred mm that several operations in double made. */
static void check_vector(const double *vector, double x, double y, double z) {
    ck_assert_double_eq_tol(vector[0], x, 1e3 * 16 * DBL_EPSILON);
    ck_assert_double_eq_tol(vector[1], y, 1e3 * 16 * DBL_EPSILON);
    ck_assert_double_eq_tol(vector[2], z, 1e3 * 16 * DBL_EPSILON);
}

/* The share of the detector's half sides that the farthest shadow of the box's corners covers. */
static double covered(void) {
    const skg_view *view = &setup->view;
    double normal[3], most = 0;
    skg_cross(view->column_step, view->row_step, normal);
    for (int corner = 0; corner < 8; corner++) {
        const double x[3] = {10 + (corner & 1 ? 20 : -20), 20 + (corner & 2 ? 10 : -10),
                             30 + (corner & 4 ? 30 : -30)};
        double way[3], to_plane[3], hit[3];
        skg_add_scaled(x, -1, view->source, way);
        skg_add_scaled(view->centre, -1, view->source, to_plane);
        const double t = skg_dot(to_plane, normal) / skg_dot(way, normal);
        skg_add_scaled(view->source, t, way, hit);
        skg_add_scaled(hit, -1, view->centre, hit);
        ck_assert_msg(t > 1, "a corner lies behind the detector");
        const double column = skg_dot(hit, view->column_step) / skg_dot(view->column_step, view->column_step);
        const double row = skg_dot(hit, view->row_step) / skg_dot(view->row_step, view->row_step);
        most = fmax(
            most, fmax(fabs(column) / (0.5 * (double)view->columns), fabs(row) / (0.5 * (double)view->rows)));
    }
    return most;
}

START_TEST(a_detector_is_fitted) {
    write_box("\"Position\": [1, -98, 3, \"cm\"]", "");
    ck_skg(load());
    /* Half as far behind the centre of the box as the source is before it; seen from the source. */
    check_vector(setup->view.centre, 10, 520, 30);
    /* The near face is 990 mm from the source, the detector 1500 mm: half sides of 20 and 30 mm become 30.3 and 45.5. */
    const double pixel = 2 / 0.95 * 30.0 * 1500 / 990 / 512;
    check_vector(setup->view.column_step, pixel, 0, 0);
    check_vector(setup->view.row_step, 0, 0, -pixel);
    ck_assert_int_eq(setup->view.columns, 342); /* 512 * 20 / 30, rounded up */
    ck_assert_int_eq(setup->view.rows, 512);
    ck_assert_double_eq_tol(covered(), 0.95, 16 * DBL_EPSILON);
    ck_assert_int_eq(setup->supersampling, 1);
}
END_TEST

START_TEST(a_detector_keeps_what_it_gives) {
    write_box(
        "\"Position\": [1, -98, 3, \"cm\"]",
        ", \"Detector\": {\"NumberOfPixels\": [100, 80], \"UpVector\": [1, 0.5, 0], \"Oversampling\": 3}");
    ck_skg(load());
    ck_assert_int_eq(setup->view.columns, 100);
    ck_assert_int_eq(setup->view.rows, 80);
    ck_assert_int_eq(setup->supersampling, 3);
    /* Rows grow along x, the part of UpVector across the beam; columns along z. */
    const double pixel = 2 / 0.95 * 30.0 * 1500 / 990 / 100;
    check_vector(setup->view.row_step, pixel, 0, 0);
    check_vector(setup->view.column_step, 0, 0, pixel);
    ck_assert_double_eq_tol(covered(), 0.95, 16 * DBL_EPSILON);
}
END_TEST

START_TEST(sources_stand_on_a_side) {
    write_box("\"From\": \"front\"", "");
    ck_skg(load());
    check_vector(setup->view.source, 10, -980, 30);
    check_vector(setup->view.centre, 10, 520, 30);
    ck_assert(setup->view.column_step[0] > 0 && setup->view.row_step[2] < 0);
    write_box("\"From\": \"side\"", "");
    ck_skg(load());
    check_vector(setup->view.source, 1010, 20, 30);
    ck_assert(setup->view.column_step[1] > 0 && setup->view.row_step[2] < 0);
    write_box("\"From\": \"Top\"", "");
    ck_skg(load());
    check_vector(setup->view.source, 10, 20, 1030);
    ck_assert(setup->view.column_step[0] > 0 && setup->view.row_step[1] < 0);
    write_box("\"From\": [3, -4, 0]", "");
    ck_skg(load());
    check_vector(setup->view.source, 610, -780, 30);
    ck_assert_double_eq_tol(covered(), 0.95, 16 * DBL_EPSILON);
}
END_TEST

/* The body's x goes to its left, y to its back, z to its head. A C-arm's angles say where the detector stands; a picture has the body's
 * right side on the left, and rows from its head to its feet. */
START_TEST(sides_have_the_words_of_the_clinic) {
    static const char arm[] =
        "\"SOD\": [800, \"mm\"], \"SDD\": [1200, \"mm\"], \"Isocentre\": [1, 2, 3, \"cm\"]";
    static const char detector[] =
        ", \"Detector\": {\"NumberOfPixels\": [100, 50], \"Size\": [40, 20, \"cm\"]}";
    const double half = sqrt(0.5), c20 = cos(20 * SKG_PI / 180), s20 = sin(20 * SKG_PI / 180),
                 h = sqrt(3) / 2;
    const struct {
        const char *from;
        double side[3], right[3];
    } all[] = {
        {"AP", {0, -1, 0}, {1, 0, 0}},          {"pa", {0, 1, 0}, {1, 0, 0}},
        {"LAT", {-1, 0, 0}, {0, 1, 0}},         {"LAO 90", {-1, 0, 0}, {0, 1, 0}},
        {"LAO 30", {-0.5, h, 0}, {h, 0.5, 0}},  {"RAO 45", {half, half, 0}, {half, -half, 0}},
        {"CRAN 20", {0, c20, -s20}, {1, 0, 0}}, {"CAU 20, LAO 30", {-0.5 * c20, h * c20, s20}, {h, 0.5, 0}},
        {"RAO 180", {0, -1, 0}, {1, 0, 0}}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        char place[256];
        snprintf(place, sizeof place, "\"From\": \"%s\", %s", all[i].from, arm);
        write_box(place, detector);
        ck_skg(load());
        const double *side = all[i].side, *right = all[i].right;
        check_vector(setup->view.source, 10 + 800 * side[0], 20 + 800 * side[1], 30 + 800 * side[2]);
        check_vector(setup->view.centre, 10 - 400 * side[0], 20 - 400 * side[1], 30 - 400 * side[2]);
        check_vector(setup->view.column_step, 4 * right[0], 4 * right[1], 4 * right[2]);
        ck_assert(setup->view.row_step[2] < 0);
        skg_setup_release(&setup);
    }
}
END_TEST

/* A box of 40 m: 1 m from its centre would be inside. */
START_TEST(a_source_stands_outside) {
    static const char *const settings[] = {"Samples.box.Cuboid=[40, 20, 60, \"m\"]"};
    write_box("\"From\": \"front\"", "");
    ck_skg(skg_setup_load(NULL, path, 1, settings, &setup));
    const double half_diagonal = 0.5e3 * sqrt(40 * 40 + 20 * 20 + 60 * 60);
    ck_assert_double_eq_tol(setup->view.source[1], 20 - 4 * half_diagonal, 1e5 * 16 * DBL_EPSILON);
}
END_TEST

START_TEST(parallel_beams_are_fitted) {
    write_box("\"Position\": [1, -98, 3, \"cm\"]", "");
    static const char *const settings[] = {"Source.Shape=Parallel", "Source.Position=null",
                                           "Source.Direction=[0, 1, 0]"};
    ck_skg(skg_setup_load(NULL, path, 1, settings, &setup));
    const double pixel = 2 / 0.95 * 30.0 / 512;
    check_vector(setup->view.row_step, 0, 0, -pixel);
    check_vector(setup->view.centre, 10, 520, 30);
    skg_setup_release(&setup);
    ck_skg(skg_setup_load(NULL, path, 3, settings, &setup));
    check_vector(setup->view.row_step, 0, 0, -pixel);
    check_vector(setup->view.column_step, pixel, 0, 0);
    check_vector(setup->view.centre, 10, 20 + 10 + 0.05 * 20,
                 30); /* a twentieth of its depth behind the box */
}
END_TEST

static const struct {
    const char *place, *keys;
    skg_status status;
    const char *says;
} bad[] = {
    {"\"Position\": [1, 2, 3, \"cm\"]", "", SKG_ERR_SCENE, "the source is at the centre of the parts"},
    {"\"Position\": [1, 1.5, 3, \"cm\"]", "", SKG_ERR_SCENE, "the parts reach to the source"},
    {"\"From\": \"back\"", "", SKG_ERR_FORMAT, "Source.From: \"back\""},
    {"\"From\": [0, 0, 0]", "", SKG_ERR_FORMAT, "Source.From"},
    {"\"From\": \"LAO\"", "", SKG_ERR_FORMAT, "has a word without its angle"},
    {"\"From\": \"LAO 190\"", "", SKG_ERR_FORMAT, "has an angle out of its range"},
    {"\"From\": \"CRAN 20 CAUD 5\"", "", SKG_ERR_FORMAT, "has two angles of one kind"},
    {"\"From\": \"AP\", \"SOD\": [0, \"mm\"]", "", SKG_ERR_SCENE, "SOD: is 0 mm"},
    {"\"From\": \"AP\", \"SOD\": [800, \"mm\"], \"SDD\": [700, \"mm\"]", "", SKG_ERR_SCENE, "SDD: is 700 mm"},
    {"\"From\": \"AP\", \"SDD\": [700, \"mm\"]", "", SKG_ERR_SCENE, "SDD is 700 mm"},
    {"\"SOD\": [1, \"mm\"], \"Position\": [0, 0, 1, \"m\"]", "", SKG_ERR_FORMAT, "goes with From"},
    {"\"From\": \"top\", \"Position\": [0, 0, 1, \"m\"]", "", SKG_ERR_FORMAT, "either From, or Position"},
    {"\"From\": \"top\"", ", \"Detector\": {\"Position\": [0, 0, 1, \"m\"]}", SKG_ERR_FORMAT,
     "Source.From is a side"},
    {"\"From\": \"top\"", ", \"Detector\": {\"Size\": [1, 1, \"m\"]}", SKG_ERR_FORMAT, "leave out Size"},
    {"\"From\": \"top\"", ", \"Detector\": {\"UpVector\": [0, 0, 1]}", SKG_ERR_SCENE,
     "points along the beam"},
    {"\"From\": \"top\"", ", \"Detector\": {\"NumberOfPixels\": [0, 5]}", SKG_ERR_SCENE, "0 columns"},
    {"\"From\": \"top\"", ", \"Detector\": 5", SKG_ERR_FORMAT, "Detector: is a number"},
    {"\"From\": \"top\"", ", \"Scan\": {\"NumberOfProjections\": 5}", SKG_ERR_FORMAT,
     "Scan: needs a detector"},
};

START_TEST(bad_places_are_refused) {
    write_box(bad[_i].place, bad[_i].keys);
    ck_skg_fails(load(), bad[_i].status, bad[_i].says);
    ck_assert_ptr_null(setup);
}
END_TEST

START_TEST(a_text_is_a_scene) {
    static const char *const settings[] = {"Source.From=side"};
    skg_setup_source source;
    skg_setup_source_init(&source);
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_ARGUMENT, "text");
    source.text =
        "{\"Source\": {\"From\": \"front\", \"Shape\": \"Point\", \"Beam\": [{\"Energy\": 1, \"Unit\": "
        "\"keV\", \"PhotonCount\": 1}]}, \"Samples\": [{\"Cube\": [1, \"mm\"], \"Material\": [\"mu\", 1]}]}";
    source.settings = settings;
    source.setting_count = 1;
    ck_skg(skg_setup_create(NULL, &source, &setup));
    check_vector(setup->view.source, 1000, 0, 0);
    skg_setup_release(&setup);
    source.text = "{";
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_FORMAT, "scene: line 1");
    source.path = "there/mine.json";
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_FORMAT, "there/mine.json: line 1");
    source.setting_count = -1;
    ck_skg_fails(skg_setup_create(NULL, &source, &setup), SKG_ERR_ARGUMENT, "-1");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, a_detector_is_fitted);
    tcase_add_test(tests, a_detector_keeps_what_it_gives);
    tcase_add_test(tests, sources_stand_on_a_side);
    tcase_add_test(tests, sides_have_the_words_of_the_clinic);
    tcase_add_test(tests, a_source_stands_outside);
    tcase_add_test(tests, parallel_beams_are_fitted);
    tcase_add_loop_test(tests, bad_places_are_refused, 0, sizeof bad / sizeof *bad);
    tcase_add_test(tests, a_text_is_a_scene);
}

SKG_SUITE_MAIN("fit", add_tests)
