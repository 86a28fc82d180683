/* Geometries for TIGRE and CIL: numbers by hand, and the projections that the documented conventions of both make of them.
 * The view has its rows along -z, so z of either tool is -z of the scene; the source stands at -y. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { LIMIT = 40, NUMBERS = 12 };

static const double close_mm =
    1e-9; /* some ten roundings of 1e-16 of 1e3 mm, and a rotation of 1e-16 over 1e3 mm */

static skg_view view;
static skg_scan_options options;
static skg_scan *scan;
static char folder[64], path[128], text[40000];
static double rows[LIMIT][NUMBERS];

static void set_up(void) {
    skg_view_init(&view);
    view.columns = 101;
    view.rows = 51;
    view.source[1] = -1000;
    view.centre[1] = 500;
    view.column_step[0] = -2;
    view.row_step[2] = -3;
    skg_scan_options_init(&options);
    scan = NULL;
    strcpy(folder, "/tmp/skg-tools-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
}

static void tear_down(void) {
    skg_scan_release(&scan);
    unlink(path);
    ck_assert_int_eq(rmdir(folder), 0);
}

/* Writes a geometry, and reads it, with the numbers of its lines in brackets. */
static int write_for(const char *name, int numbers) {
    int count = 0;
    if (!scan) ck_skg(skg_scan_create(&view, &options, &scan));
    snprintf(path, sizeof path, "%s/%s", folder, name);
    ck_skg(skg_scan_geometry_save(scan, path));
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    text[fread(text, 1, sizeof text - 1, stream)] = '\0';
    fclose(stream);
    for (char *at = text; count < LIMIT && (at = strstr(at, "\n    [")); count++) {
        at += 6;
        for (int i = 0; i < numbers; i++) {
            rows[count][i] = strtod(at, &at);
            ck_assert_int_eq(*at, i + 1 < numbers ? ',' : ']');
            at++;
        }
    }
    return count;
}

/* The numbers after a name of the file. */
static void ck_numbers(const char *name, int count, const double *expected) {
    char *at = strstr(text, name);
    ck_assert_msg(at != NULL, "%s is not in the file", name);
    at += strcspn(at, "[") + 1;
    for (int i = 0; i < count; i++) {
        const double got = strtod(at, &at);
        ck_assert_msg(fabs(got - expected[i]) < close_mm, "%s: %.15g instead of %.15g", name, got,
                      expected[i]);
        at++;
    }
}

/* From the axes of the scene into those of the tool, which are its rows. */
static void into(const double world[9], const double *origin, const double *v, double *result) {
    for (int r = 0; r < 3; r++) {
        result[r] = 0;
        for (int c = 0; c < 3; c++) result[r] += world[3 * r + c] * (v[c] - (origin ? origin[c] : 0));
    }
}

static void ck_near(const double *a, const double *b, const char *what, int64_t k) {
    for (int i = 0; i < 3; i++)
        ck_assert_msg(fabs(a[i] - b[i]) < close_mm, "%s of projection %d: %.15g instead of %.15g", what,
                      (int)k, a[i], b[i]);
}

/* x from the axis to the source (-y), z = -z, y = z cross x = -x. */
static const double tigre_world[9] = {0, -1, 0, -1, 0, 0, 0, 0, -1};

static void turn(int axis, double angle, double *v) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double p = v[a], q = v[b];
    v[a] = cos(angle) * p - sin(angle) * q;
    v[b] = sin(angle) * p + cos(angle) * q;
}

/* A place on TIGRE's detector, mm along its columns and rows, after its documentation. */
static void tigre_place(const double *p, double along_u, double along_v, double *place) {
    place[0] = 0, place[1] = along_u, place[2] = along_v;
    for (int axis = 0; axis < 3; axis++) turn(axis, p[6 + axis], place);
    place[0] -= p[1] - p[2];
    place[1] += p[5];
    place[2] += p[4];
    turn(2, p[0], place);
    place[2] -= p[3];
}

/* Source and corners of the detector. */
static void ck_tigre(int64_t k) {
    const double *p = rows[k];
    double expected[3], got[3] = {p[2], 0, 0}, corner[3];
    skg_view v;
    skg_view_init(&v);
    ck_skg(skg_scan_view_get(scan, k, &v));
    turn(2, p[0], got);
    got[2] -= p[3];
    into(tigre_world, options.centre, v.source, expected);
    ck_near(got, expected, "source", k);
    for (int c = 0; c < 4; c++) {
        const double u = (c & 1 ? 0.5 : -0.5) * (double)v.columns, w = (c & 2 ? 0.5 : -0.5) * (double)v.rows;
        for (int i = 0; i < 3; i++) corner[i] = v.centre[i] + u * v.column_step[i] + w * v.row_step[i];
        into(tigre_world, options.centre, corner, expected);
        tigre_place(p, 2 * u, 3 * w, got);
        ck_near(got, expected, "corner", k);
    }
}

START_TEST(a_circle_for_tigre) {
    const double sizes[2] = {51, 101}, pixel[2] = {3, 2};
    options.projections = 8;
    options.start_rad = 0.25;
    options.step_rad = PI / 4;
    options.detector_offset_mm[0] = 9;
    options.detector_offset_mm[1] = 4;
    ck_assert_int_eq(write_for("scan.tigre.py", 9), 8);
    for (int k = 0; k < 8; k++) {
        const double expected[9] = {0.25 + k * PI / 4, 1500, 1000, 0, 4, 9, 0, 0, 0};
        for (int i = 0; i < 9; i++) ck_assert_double_eq_tol(rows[k][i], expected[i], close_mm);
        ck_tigre(k);
    }
    ck_numbers("geo.nDetector", 2, sizes);
    ck_numbers("geo.dDetector", 2, pixel);
}
END_TEST

/* Everything at once: a helix beside the origin, a detector that is tilted, drift and jitter. */
static void make_crooked(void) {
    options.projections = 20;
    options.step_rad = -0.7;
    options.pitch_mm = 40;
    options.centre[0] = 3;
    options.centre[1] = -5;
    options.centre[2] = 11;
    options.detector_tilt_rad[0] = 0.1;
    options.detector_tilt_rad[1] = -0.2;
    options.detector_tilt_rad[2] = 0.3;
    options.detector_drift_mm[2] = 7;
    options.source_jitter_mm = 0.5;
    options.angle_jitter_rad = 0.01;
    view.source[0] = 3;
    view.source[2] = 17;
}

START_TEST(any_pose_for_tigre) {
    make_crooked();
    ck_assert_int_eq(write_for("scan.tigre.py", 9), 20);
    for (int k = 0; k < 20; k++) ck_tigre(k);
    /* Angles fall without a step of 2 pi: rows are reversed, so they have the sign of the step. */
    for (int k = 1; k < 20; k++) ck_assert_double_eq_tol(rows[k][0] - rows[k - 1][0], -0.7, 0.1); /* jitter */
}
END_TEST

/* A detector that stands still is seen from behind after half a turn; TIGRE turns it. */
START_TEST(a_fixed_detector_for_tigre) {
    options.projections = 12;
    options.step_rad = PI / 6;
    options.detector_fixed = 1;
    view.centre[1] = 200;
    ck_assert_int_eq(write_for("scan.tigre.py", 9), 12);
    for (int k = 0; k < 12; k++) ck_tigre(k);
}
END_TEST

/* x = y cross z, y from the source to the axis (y of the scene), z = -z. */
static const double cil_world[9] = {-1, 0, 0, 0, 1, 0, 0, 0, -1};

/* CIL turns source and detector by minus the angle about z. In the scene they turn by minus the angle about +z, which is
 * -z of CIL. */
START_TEST(a_circle_for_cil) {
    const double source[3] = {0, -1000, 0}, detector[3] = {9, 500, 4}, x[3] = {1, 0, 0}, y[3] = {0, 0, 1};
    const double sizes[2] = {101, 51}, pixel[2] = {2, 3};
    options.projections = 3;
    options.start_rad = 0.5;
    options.step_rad = PI / 3;
    options.detector_offset_mm[0] = 9;
    options.detector_offset_mm[1] = 4;
    write_for("scan.cil.py", 9);
    ck_assert_ptr_nonnull(strstr(text, "create_Cone3D("));
    ck_numbers("source_position", 3, source);
    ck_numbers("detector_position", 3, detector);
    ck_numbers("detector_direction_x", 3, x);
    ck_numbers("detector_direction_y", 3, y);
    ck_numbers("set_panel(", 2, sizes);
    ck_numbers("pixel_size", 2, pixel);
    char *at = strstr(text, "set_angles(np.array([");
    ck_assert_ptr_nonnull(at);
    at = strchr(at, '\n');
    for (int k = 0; k < 3; k++) {
        const double degrees = strtod(at, &at), a = -degrees * PI / 180;
        skg_view v;
        double expected[3], got[3] = {0, -1000, 0};
        skg_view_init(&v);
        ck_assert_double_eq_tol(degrees, -(0.5 + k * PI / 3) * 180 / PI, 1e-12 * 180); /* some roundings */
        turn(2, a, got);
        ck_skg(skg_scan_view_get(scan, k, &v));
        into(cil_world, NULL, v.source, expected);
        ck_near(got, expected, "source", k);
        at++;
    }
}
END_TEST

START_TEST(any_pose_for_cil) {
    make_crooked();
    ck_assert_int_eq(write_for("scan.cil.py", NUMBERS), 20);
    ck_assert_ptr_nonnull(strstr(text, "create_Cone3D_SOUV("));
    /* The source is beside the axis by 5 mm and more: the plane of CIL's y is that of the source. */
    const double away = hypot(view.source[0] - 3, view.source[1] + 5);
    ck_assert_double_eq_tol(away, 995, close_mm);
    for (int k = 0; k < 20; k++) {
        skg_view v;
        double expected[4][3];
        skg_view_init(&v);
        ck_skg(skg_scan_view_get(scan, k, &v));
        into(cil_world, options.centre, v.source, expected[0]);
        into(cil_world, options.centre, v.centre, expected[1]);
        into(cil_world, NULL, v.column_step, expected[2]);
        into(cil_world, NULL, v.row_step, expected[3]);
        for (int i = 0; i < 3; i++) expected[2][i] /= 2, expected[3][i] /= 3; /* lengths of the steps */
        for (int i = 0; i < 4; i++) ck_near(rows[k] + 3 * i, expected[i], "vector", k);
    }
}
END_TEST

START_TEST(a_parallel_beam_for_cil) {
    const double ray[3] = {0, 1, 0};
    options.projections = 2;
    options.step_rad = 1;
    view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    view.source[1] = 1;
    write_for("scan.cil.py", 9);
    ck_assert_ptr_nonnull(strstr(text, "create_Parallel3D("));
    ck_numbers("ray_direction", 3, ray);
}
END_TEST

/* A table that names its rotation, as CTSimU scenarios are kept, is a circle too. */
START_TEST(a_table_that_turns) {
    double poses[4 * NUMBERS];
    options.projections = 4;
    options.start_rad = 0.2;
    options.step_rad = 0.3;
    ck_skg(skg_scan_create(&view, &options, &scan));
    for (int k = 0; k < 4; k++) {
        skg_view v;
        skg_view_init(&v);
        ck_skg(skg_scan_view_get(scan, k, &v));
        const double *from[] = {v.source, v.centre, v.column_step, v.row_step};
        for (int i = 0; i < NUMBERS; i++) poses[NUMBERS * k + i] = from[i / 3][i % 3];
    }
    skg_scan_release(&scan);
    ck_skg(skg_scan_create_table(&view, &options, 4, poses, &scan));
    ck_assert_int_eq(write_for("scan.tigre.py", 9), 4);
    for (int k = 0; k < 4; k++) ck_tigre(k);
    unlink(path);
    write_for("scan.cil.py", 9);
    ck_assert_ptr_nonnull(strstr(text, "create_Cone3D("));
}
END_TEST

START_TEST(what_is_refused) {
    options.projections = 2;
    view.row_step[0] = 1;
    ck_skg(skg_scan_create(&view, &options, &scan));
    snprintf(path, sizeof path, "%s/scan.tigre.py", folder);
    ck_skg_fails(skg_scan_geometry_save(scan, path), SKG_ERR_UNSUPPORTED, "TIGRE has no skewed detector");
    skg_scan_release(&scan);
    view.row_step[0] = 0;
    view.projection = SKG_PROJECTION_PARALLEL;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_skg_fails(skg_scan_geometry_save(scan, path), SKG_ERR_UNSUPPORTED, "parallel beams");
    options.pitch_mm = 3;
    options.step_rad = 1;
    skg_scan_release(&scan);
    ck_skg(skg_scan_create(&view, &options, &scan));
    snprintf(path, sizeof path, "%s/scan.cil.py", folder);
    ck_skg_fails(skg_scan_geometry_save(scan, path), SKG_ERR_UNSUPPORTED, "on a circle only");
    ck_skg_fails(skg_scan_geometry_save(scan, "scan.py"), SKG_ERR_ARGUMENT, ".tigre.py");
    ck_assert_int_ne(access(path, F_OK), 0);
}
END_TEST

/* Pixels of different sizes are no detector of these tools. */
START_TEST(pixels_that_differ) {
    double poses[2 * NUMBERS] = {0, -1000, 0, 0, 500, 0, -2,   0, 0, 0, 0, -3,
                                 0, -1000, 0, 0, 500, 0, -2.1, 0, 0, 0, 0, -3};
    ck_skg(skg_scan_create_table(&view, NULL, 2, poses, &scan));
    snprintf(path, sizeof path, "%s/scan.cil.py", folder);
    ck_skg_fails(skg_scan_geometry_save(scan, path), SKG_ERR_UNSUPPORTED, "projection 1: its pixels");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, a_circle_for_tigre);
    tcase_add_test(tests, any_pose_for_tigre);
    tcase_add_test(tests, a_fixed_detector_for_tigre);
    tcase_add_test(tests, a_circle_for_cil);
    tcase_add_test(tests, any_pose_for_cil);
    tcase_add_test(tests, a_parallel_beam_for_cil);
    tcase_add_test(tests, a_table_that_turns);
    tcase_add_test(tests, what_is_refused);
    tcase_add_test(tests, pixels_that_differ);
}

SKG_SUITE_MAIN("tools", add_tests)
