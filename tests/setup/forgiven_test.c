/* Faults of scene files in use that are forgiven with a warning: always, or where a file is read leniently. */
#include "core/maths.h"
#include "scene/scene.h"
#include "setup/setup_files.h"

#include <skiagraph/plan.h>

#include <float.h>
#include <math.h>

enum { WARNINGS_MAX = 8 };
static char warnings[WARNINGS_MAX][512];
static int warning_count;
static skg_context *context;

static void keep(int32_t level, const char *sentence, void *user) {
    (void)user;
    if (level != SKG_LOG_WARNING) return;
    ck_assert_int_lt(warning_count, WARNINGS_MAX);
    snprintf(warnings[warning_count++], sizeof *warnings, "%s", sentence);
}

static void set_up_log(void) {
    set_up();
    warning_count = 0;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_context_log_set(context, keep, NULL));
}

static void tear_down_log(void) {
    tear_down();
    skg_context_release(&context);
}

/* Loads the good file with one piece of its text replaced by another. */
static void load_edited(const char *from, const char *to) {
    skg_setup_release(&setup);
    write_edited(from, to);
    ck_skg(skg_setup_load(context, path, 0, NULL, &setup));
}

/* Reads it leniently, or for path lengths only. */
static skg_status read_edited(const char *from, const char *to, int32_t lenient, int32_t lengths_only) {
    skg_setup_source source;
    skg_setup_source_init(&source);
    source.path = path;
    source.lenient = lenient;
    source.lengths_only = lengths_only;
    write_edited(from, to);
    warning_count = 0;
    skg_setup_release(&setup);
    return skg_setup_create(context, &source, &setup);
}

static const char *label_of(int64_t id) {
    skg_part part;
    skg_part_init(&part);
    ck_skg(skg_scene_part_get(setup->scene, id, &part));
    return part.label;
}

START_TEST(labels_are_numbered) {
    load_edited("\"Label\": \"bone\"", "\"Label\": \"skin\"");
    ck_assert_int_eq(warning_count, 1);
    ck_assert_ptr_nonnull(strstr(warnings[0], "Samples[1].Label (line 20): "));
    ck_assert_ptr_nonnull(strstr(warnings[0], "this one is called \"skin 2\""));
    ck_assert_str_eq(label_of(0), "skin");
    ck_assert_str_eq(label_of(1), "skin 2");
    /* The parent is found among the first. */
    ck_assert_int_eq(setup->scene->parts[1].inside, 0);
}
END_TEST

START_TEST(a_taken_number_is_passed_over) {
    load_edited("\"Label\": \"bone\",\n",
                "\"Label\": \"skin 2\", \"Sphere\": [8, 1, \"mm\"], \"Material\": [\"mu\", 1]},\n"
                "{\"Label\": \"skin\",\n");
    ck_assert_int_eq(warning_count, 1);
    ck_assert_str_eq(label_of(2), "skin 3");
}
END_TEST

START_TEST(asides_are_ignored) {
    load_edited("\"Label\": \"bone\",", "\"Label\": \"bone\", \"Colour\": [1, 0, 0], \"comment\": \"left\",");
    load_edited("\"Source\": {",
                "\"$schema\": \"scene.schema.json\", \"Comment\": \"of a hip\", \"Source\": {\"Color\": 7,");
    ck_assert_int_eq(warning_count, 0);
}
END_TEST

START_TEST(a_line_spread_of_the_source_is_passed_over) {
    load_edited("\"Source\": {", "\"Source\": {\"LSF\": [0.1, 0.8, 0.1],");
    ck_assert_int_eq(warning_count, 1);
    ck_assert_ptr_nonnull(strstr(warnings[0], "Source.LSF"));
    ck_assert_ptr_nonnull(strstr(warnings[0], "belongs to Detector"));
}
END_TEST

START_TEST(size_and_spacing_that_agree) {
    load_edited("\"Size\": [6.4, 9.6, \"cm\"]", "\"Size\": [6.4, 9.6, \"cm\"], \"Spacing\": [1, 2, \"mm\"]");
    ck_assert_double_eq(skg_length(setup->view.column_step), 1);
    ck_assert_double_eq(skg_length(setup->view.row_step), 2);
    ck_assert_int_eq(warning_count, 0);
}
END_TEST

/* With mAs, a tube gives photons per mm2 at 1 m, which a parallel beam keeps as its unit: absolute_test has the warning of the
 * plan. */
START_TEST(parallel_beams_have_no_mas) {
    const char *settings[] = {"Source.Shape=Parallel",
                              "Source.Beam={\"kVp\": 85, \"mAs\": 2, \"Filter\": [[\"Al\", 2.5]]}"};
    skg_quality parallel, tube;
    skg_spectrum *per_pixel = NULL;
    skg_quality_init(&parallel);
    skg_quality_init(&tube);
    write_file("scene.json", good);
    ck_skg(skg_setup_load(context, path, 2, settings, &setup));
    ck_skg(skg_spectrum_create_resolved(setup->spectrum, &setup->view, &per_pixel));
    ck_skg(skg_spectrum_quality_get(per_pixel, &parallel));
    skg_spectrum_release(&per_pixel);
    ck_assert_int_eq(warning_count, 0);
    skg_setup_release(&setup);
    settings[0] = "Detector.Position=[0, 600, 0, \"mm\"]"; /* 1 m from the source */
    ck_skg(skg_setup_load(context, path, 2, settings, &setup));
    ck_skg(skg_spectrum_create_resolved(setup->spectrum, &setup->view, &per_pixel));
    ck_skg(skg_spectrum_quality_get(per_pixel, &tube));
    skg_spectrum_release(&per_pixel);
    /* a pixel of 1 mm by 2 mm; some roundings in each of a hundred energies */
    ck_assert_double_eq_tol(tube.photons / 2 / parallel.photons, 1, 64 * DBL_EPSILON);
}
END_TEST

/* Where the projections of a scan go is said if the file does not say it. */
START_TEST(scans_without_an_end) {
    static const struct {
        const char *scan, *warning;
        int64_t count;
        double source[2]; /* x and y of projection 1; that of projection 0 is at -400 */
    } cases[] = {
        {"\"NumberOfProjections\": 4",
         "neither FinalAngle nor AngleStep: the projections go once around, FinalAngle 360",
         4,
         {-400, 0}},
        {"\"NumberOfProjections\": 3, \"IncludeFinalAngle\": true", "once around", 3, {0, 400}},
        {"\"NumberOfProjections\": 4, \"StartAngle\": -90", "FinalAngle 270", 4, {0, -400}},
        {"\"AngleStep\": 90", "has no FinalAngle: the projections go once around", 4, {-400, 0}},
        {"\"AngleStep\": -90", "FinalAngle -360", 4, {400, 0}},
        {"\"NumberOfProjections\": 4, \"AngleStep\": 90", NULL, 4, {-400, 0}},
        {"\"NumberOfProjections\": 4, \"FinalAngle\": 360", NULL, 4, {-400, 0}},
        {"\"NumberOfProjections\": 4, \"AngleStep\": 90, \"FinalAngle\": 360", NULL, 4, {-400, 0}},
        {"\"NumberOfProjections\": 5, \"AngleStep\": 90, \"FinalAngle\": 360, \"IncludeFinalAngle\": true",
         NULL,
         5,
         {-400, 0}},
        {"\"NumberOfProjections\": 4, \"AngleStep\": 90, \"FinalAngle\": 180",
         "end at 360 degrees, but FinalAngle is 180",
         4,
         {-400, 0}},
        {"\"NumberOfProjections\": 4, \"AngleStep\": 0", NULL, 4, {0, -400}},
        {"\"NumberOfProjections\": 4, \"FinalAngle\": 0", NULL, 4, {0, -400}},
        {"\"NumberOfProjections\": 4, \"StartTime\": 0, \"Interval\": 1", "nothing turns", 4, {0, -400}},
        {"\"NumberOfProjections\": 3, \"SourceTravel\": [40, 0, 0, \"mm\"]", NULL, 3, {0, -400}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char with[256];
        skg_scan *scan = NULL;
        skg_view view;
        int64_t count = 0;
        warning_count = 0;
        snprintf(with, sizeof with, "\"Scan\": {%s, \"RotationAxis\": [0, 0, 1]}, \"Samples\"",
                 cases[k].scan);
        load_edited("\"Samples\"", with);
        ck_assert_msg(warning_count == (cases[k].warning != NULL), "%s: %d warnings", cases[k].scan,
                      warning_count);
        if (cases[k].warning)
            ck_assert_msg(strstr(warnings[0], cases[k].warning) != NULL, "%s: %s", cases[k].scan,
                          warnings[0]);
        ck_skg(skg_setup_scan_get(setup, &scan));
        ck_skg(skg_scan_projection_count(scan, &count));
        ck_assert_int_eq(count, cases[k].count);
        skg_view_init(&view);
        ck_skg(skg_scan_view_get(scan, 1, &view));
        for (int i = 0; i < 2; i++)
            ck_assert_msg(fabs(view.source[i] - cases[k].source[i]) < 1e-9 /* roundings of 400 mm */,
                          "%s: %g %g", cases[k].scan, view.source[0], view.source[1]);
    }
}
END_TEST

START_TEST(a_line_spread_function_from_a_file) {
    write_file("motion.csv", "# measured\n0.1, 0.2;\n0.4\t0.2\n\n0.1 % end\n");
    load_edited("\"UpVector\"", "\"LSF\": \"motion.csv\", \"UpVector\"");
    ck_assert_int_eq(setup->blur.shape.columns, 5);
    ck_assert_int_eq(setup->blur.shape.rows, 5);
    ck_assert_double_eq(setup->blur.shape.along_row[2], 0.4);
    ck_assert_double_eq(setup->blur.shape.along_column[4], 0.1);
    skg_setup_release(&setup);
    static const char *const bad[][2] = {{"1 2 x 4 5", "line 1: \"x 4 5\" is no number"},
                                         {"1 2", "2 samples; give an odd number"},
                                         {"# nothing\n", "holds no number"},
                                         {"1\n2a\n3\n", "line 2: \"2a"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        write_file("motion.csv", bad[i][0]);
        ck_skg_fails(load(), SKG_ERR_FORMAT, bad[i][1]);
    }
}
END_TEST

/* A file of two triangulated boxes as one sample: its material is one. */
START_TEST(a_scene_graph_of_one_file) {
    write_file("open.obj", "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
                           "o b\nv 5 0 0\nv 6 0 0\nv 5 1 0\nv 5 0 1\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n");
    load_edited("\"Samples\": [",
                "\"SceneGraph\": {\"Path\": \"open.obj\", \"Unit\": \"cm\", \"Label\": \"both\", "
                "\"Material\": \"Water\", \"Parent\": null}, \"Samples\": [");
    int64_t count = 0, vertices = 0, triangles = 0;
    ck_skg(skg_scene_part_count(setup->scene, &count));
    ck_assert_int_eq(count, 3);
    ck_assert_str_eq(label_of(0), "both");
    ck_skg(skg_mesh_count(setup->scene->parts[0].mesh, &vertices, &triangles));
    ck_assert_int_eq(triangles, 8);
    ck_assert_int_eq(setup->scene->parts[0].inside, -1);
}
END_TEST

/* Errors that become warnings. Wrong types, missing files and geometry stay errors. */
START_TEST(lenient_reading) {
    static const struct {
        const char *from, *to, *says;
    } faults[] = {
        {"\"Shape\": \"PointSource\",", "\"Shape\": \"PointSource\", \"filters\": [],",
         "Source.filters (line 5): unknown key"},
        {"\"Label\": \"bone\",", "\"Label\": \"bone\", \"Texture\": 1,",
         "Samples[1].Texture (line 20): unknown key"},
        {"\"Size\": [6.4, 9.6, \"cm\"]", "\"Size\": [6.4, 9.6, \"cm\"], \"Spacing\": [1, 1, \"mm\"]",
         "Spacing holds"},
        {"[\"mu\", 0.5]", "[\"Mixture\", [1, 11.2, 8, 88.8]], \"Density\": 1",
         "sum to 100; they are scaled to 1"},
    };
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        ck_assert_int_ne(read_edited(faults[i].from, faults[i].to, 0, 0), SKG_OK);
        ck_assert_ptr_null(setup);
        ck_skg(read_edited(faults[i].from, faults[i].to, 1, 0));
        ck_assert_int_eq(warning_count, 1);
        ck_assert_msg(strstr(warnings[0], faults[i].says) != NULL, "%s", warnings[0]);
    }
    ck_assert_int_eq(read_edited("\"Size\": [6.4, 9.6, \"cm\"]",
                                 "\"Size\": [6.4, 9.6, \"cm\"], \"Spacing\": [1, 1, \"mm\"]", 1, 0),
                     SKG_OK);
    ck_assert_double_eq(skg_length(setup->view.row_step), 1);
    ck_skg_fails(read_edited("[64, 48]", "[64, \"48\"]", 1, 0), SKG_ERR_FORMAT, "is a string");
    ck_skg_fails(read_edited("[0, 0, -1]", "[0, 1, 0]", 1, 0), SKG_ERR_SCENE, "along the beam");
    ck_skg_fails(read_edited("\"Cuboid\": [1, 2, 3, \"cm\"]", "\"Path\": \"no.stl\", \"Unit\": \"mm\"", 1, 0),
                 SKG_ERR_FILE, "no.stl");
}
END_TEST

/* Water by mass in per cent is water. */
START_TEST(scaled_fractions_are_right) {
    skg_material *water = NULL;
    const int32_t z[2] = {1, 8};
    const double parts[2] = {0.112, 0.888};
    double lenient = 0, exact = 0;
    ck_skg(read_edited("[\"mu\", 0.5]", "[\"Mixture\", [1, 11.2, 8, 88.8]], \"Density\": 1", 1, 0));
    ck_skg(skg_material_create_mixture("water", 2, z, parts, 1, &water));
    ck_skg(skg_material_attenuation_get(setup->scene->parts[1].material, 60, &lenient));
    ck_skg(skg_material_attenuation_get(water, 60, &exact));
    skg_material_release(&water);
    ck_assert_double_eq_tol(lenient / exact, 1, 16 * DBL_EPSILON); /* a sum, two quotients and two products */
}
END_TEST

START_TEST(lengths_need_neither_beam_nor_material) {
    static const char beam[] =
        ",\n        \"Beam\": [{\"Energy\": 0.06, \"Unit\": \"MeV\", \"PhotonCount\": 1000}]";
    double mu = 1;
    ck_skg_fails(read_edited(beam, "", 0, 0), SKG_ERR_FORMAT, "Beam is missing");
    ck_skg(read_edited(beam, "", 0, 1));
    ck_assert_int_eq(warning_count, 1);
    ck_assert_ptr_nonnull(strstr(warnings[0], "there is no Beam"));
    ck_assert_ptr_nonnull(setup->spectrum);
    ck_skg_fails(read_edited("[\"mu\", 0.5]", "\"Unobtainium\"", 0, 0), SKG_ERR_MATERIAL, "Unobtainium");
    ck_skg(read_edited("[\"mu\", 0.5]", "\"Unobtainium\"", 0, 1));
    ck_assert_int_eq(warning_count, 1);
    ck_assert_ptr_nonnull(strstr(warnings[0], "Samples[1] (line 19): has no usable Material"));
    ck_skg(skg_material_attenuation_get(setup->scene->parts[1].material, 60, &mu));
    ck_assert_double_eq(mu, 0);
    ck_skg(read_edited(",\n            \"Material\": [\"mu\", 0.5]", "", 0, 1));
    ck_assert_int_eq(warning_count, 1);
    /* A wrong type stays an error. */
    ck_skg_fails(read_edited("[\"mu\", 0.5]", "{}", 0, 1), SKG_ERR_FORMAT, "Material");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_log, tear_down_log);
    tcase_add_test(tests, labels_are_numbered);
    tcase_add_test(tests, a_taken_number_is_passed_over);
    tcase_add_test(tests, asides_are_ignored);
    tcase_add_test(tests, a_line_spread_of_the_source_is_passed_over);
    tcase_add_test(tests, size_and_spacing_that_agree);
    tcase_add_test(tests, parallel_beams_have_no_mas);
    tcase_add_test(tests, scans_without_an_end);
    tcase_add_test(tests, a_line_spread_function_from_a_file);
    tcase_add_test(tests, a_scene_graph_of_one_file);
    tcase_add_test(tests, lenient_reading);
    tcase_add_test(tests, scaled_fractions_are_right);
    tcase_add_test(tests, lengths_need_neither_beam_nor_material);
}

SKG_SUITE_MAIN("forgiven", add_tests)
