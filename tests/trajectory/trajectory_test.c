/* Where source and detector are in each projection: closed forms of every kind of motion. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static const double close_mm = 1e-11; /* some thousand roundings of 1e-16 of 1000 mm */

static skg_view view;
static skg_scan_options options;
static skg_scan *scan;
static char folder[64], path[128];

/* Source 1000 mm in front of the axis z, detector 500 mm behind it, rows along -z, columns along -x: seen from the
 * front. */
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
    strcpy(folder, "/tmp/skg-trajectory-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/table.csv", folder);
}

static void tear_down(void) {
    skg_scan_release(&scan);
    unlink(path);
    snprintf(path, sizeof path, "%s/rtk.xml", folder);
    unlink(path);
    ck_assert_int_eq(rmdir(folder), 0);
}

static skg_view view_of(int64_t index) {
    skg_view got;
    skg_view_init(&got);
    ck_skg(skg_scan_view_get(scan, index, &got));
    return got;
}

#define ck_vector(v, x, y, z)                                                                                \
    do {                                                                                                     \
        const double *ck_v = (v), ck_w[3] = {x, y, z};                                                       \
        for (int ck_k = 0; ck_k < 3; ck_k++)                                                                 \
            ck_assert_msg(fabs(ck_v[ck_k] - ck_w[ck_k]) < close_mm, "%s is (%.15g, %.15g, %.15g)", #v,       \
                          ck_v[0], ck_v[1], ck_v[2]);                                                        \
    } while (0)

/* Samples that turn counter-clockwise see the source turn clockwise: from -y to -x in a quarter. */
START_TEST(a_circle) {
    options.projections = 360;
    options.step_rad = PI / 180;
    ck_skg(skg_scan_create(&view, &options, &scan));
    for (int64_t k = 0; k < 360; k++) {
        const skg_view v = view_of(k);
        const double a = (double)k * PI / 180, c = cos(a), s = sin(a);
        ck_vector(v.source, -1000 * s, -1000 * c, 0);
        ck_vector(v.centre, 500 * s, 500 * c, 0);
        ck_vector(v.column_step, -2 * c, 2 * s, 0);
        ck_vector(v.row_step, 0, 0, -3);
        double angle = 0;
        ck_skg(skg_scan_angle_get(scan, k, &angle));
        ck_assert_double_eq_tol(angle, a, 1e-15 * (1 + a)); /* one rounding of a product */
    }
    ck_skg_fails(skg_scan_view_get(scan, 360, &view), SKG_ERR_ARGUMENT, "no projection 360");
    ck_skg_fails(skg_scan_view_get(scan, -1, &view), SKG_ERR_ARGUMENT, "no projection -1");
}
END_TEST

/* An axis beside the origin, of any length; start and direction. */
START_TEST(any_axis_start_and_direction) {
    options.projections = 3;
    options.start_rad = PI / 2;
    options.step_rad = -PI / 2;
    options.axis[2] = 7;
    options.centre[0] = 100;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_vector(view_of(0).source, -900, 100, 0);
    ck_vector(view_of(1).source, 0, -1000, 0);
    ck_vector(view_of(2).source, 1100, -100, 0);
}
END_TEST

/* Samples that move up along the axis see source and detector move down. */
START_TEST(a_helix) {
    options.projections = 21;
    options.step_rad = PI / 5;
    options.pitch_mm = 30;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_vector(view_of(5).source, 0, 1000, -15);
    ck_vector(view_of(20).source, 0, -1000, -60);
    ck_vector(view_of(20).centre, 0, 500, -60);
    ck_vector(view_of(20).row_step, 0, 0, -3);
}
END_TEST

/* The axis leans by 30 degrees from the beam's perpendicular: the source stays on a cone about it. */
START_TEST(laminography) {
    options.projections = 12;
    options.step_rad = PI / 6;
    options.axis[1] = 0.5;
    options.axis[2] = sqrt(0.75);
    ck_skg(skg_scan_create(&view, &options, &scan));
    for (int64_t k = 0; k < 12; k++) {
        const skg_view v = view_of(k);
        const double along = v.source[1] * 0.5 + v.source[2] * sqrt(0.75);
        ck_assert_double_eq_tol(along, -500, close_mm);
        ck_assert_double_eq_tol(hypot(hypot(v.source[0], v.source[1]), v.source[2]), 1000, close_mm);
    }
    ck_vector(view_of(6).source, 0, 500, -1000 * sqrt(0.75));
}
END_TEST

START_TEST(tomosynthesis_on_a_line_and_on_an_arc) {
    options.projections = 5;
    options.source_travel_mm[0] = 200;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_vector(view_of(0).source, -100, -1000, 0);
    ck_vector(view_of(2).source, 0, -1000, 0);
    ck_vector(view_of(4).source, 100, -1000, 0);
    ck_vector(view_of(4).centre, 0, 500, 0);
    skg_scan_release(&scan);
    options.source_travel_mm[0] = 0;
    options.detector_fixed = 1;
    options.start_rad = -PI / 4;
    options.step_rad = PI / 8;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_vector(view_of(0).source, 1000 * sqrt(0.5), -1000 * sqrt(0.5), 0);
    ck_vector(view_of(2).source, 0, -1000, 0);
    ck_vector(view_of(0).centre, 0, 500, 0);
    ck_vector(view_of(0).column_step, -2, 0, 0);
}
END_TEST

/* Offset, tilt and skew are in the axes of the detector and turn with it. */
START_TEST(a_detector_that_is_displaced) {
    options.projections = 2;
    options.step_rad = PI;
    options.detector_offset_mm[0] = 10;
    options.detector_offset_mm[1] = 4;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_vector(view_of(0).centre, -10, 500, -4);
    ck_vector(view_of(1).centre, 10, -500, -4);
    skg_scan_release(&scan);
    options.detector_tilt_rad[2] = PI / 2; /* about -x cross -z = -y */
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_vector(view_of(0).column_step, 0, 0, -2);
    ck_vector(view_of(0).row_step, 3, 0, 0);
    skg_scan_release(&scan);
    options.detector_tilt_rad[2] = 0;
    options.detector_skew_rad = PI / 6;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_vector(view_of(0).column_step, -2, 0, 0);
    ck_vector(view_of(0).row_step, -1.5, 0, -3 * sqrt(0.75));
}
END_TEST

/* Offset, drift and jitter of the detector do not turn a parallel beam, whose direction is that of the undisplaced pair. */
START_TEST(a_displaced_detector_in_a_parallel_beam) {
    view.projection = SKG_PROJECTION_PARALLEL;
    options.projections = 5;
    options.step_rad = 2 * PI / 5;
    options.detector_offset_mm[0] = 20;
    options.detector_drift_mm[2] = 7;
    options.detector_jitter_mm = 0.5;
    ck_skg(skg_scan_create(&view, &options, &scan));
    for (int k = 0; k < 5; k++) {
        const skg_view now = view_of(k);
        const double angle = -k * options.step_rad;
        double ray[3];
        for (int i = 0; i < 3; i++) ray[i] = now.centre[i] - now.source[i];
        ck_vector(ray, -1500 * sin(angle), 1500 * cos(angle), 0);
    }
}
END_TEST

START_TEST(drift_grows_to_its_end) {
    options.projections = 11;
    options.source_drift_mm[2] = 5;
    options.detector_drift_mm[0] = -1;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_vector(view_of(0).source, 0, -1000, 0);
    ck_vector(view_of(10).source, 0, -1000, 5);
    ck_vector(view_of(5).centre, -0.5, 500, 0);
}
END_TEST

/* Mean and standard deviation of 3 x 20,000 normal deviates, within five standard errors; the same seed gives the same
 * jitter in whatever scan the projection is. */
START_TEST(jitter_is_normal_and_repeatable) {
    enum { COUNT = 20000 };
    double sum = 0, square = 0;
    options.projections = COUNT;
    options.source_jitter_mm = 0.25;
    options.jitter_seed = 7;
    ck_skg(skg_scan_create(&view, &options, &scan));
    for (int64_t k = 0; k < COUNT; k++) {
        const skg_view v = view_of(k);
        for (int i = 0; i < 3; i++) {
            const double e = v.source[i] - view.source[i];
            sum += e;
            square += e * e;
        }
    }
    const double n = 3.0 * COUNT, deviation = sqrt(square / n);
    ck_assert_double_lt(fabs(sum / n), 5 * 0.25 / sqrt(n));           /* five standard errors of a mean */
    ck_assert_double_eq_tol(deviation, 0.25, 5 * 0.25 / sqrt(2 * n)); /* five of a standard deviation */
    const skg_view before = view_of(12345);
    skg_scan_release(&scan);
    options.projections = COUNT / 2 + 10000;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_assert_double_eq(view_of(12345).source[0], before.source[0]);
    skg_scan_release(&scan);
    options.jitter_seed = 8;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_assert_double_ne(view_of(12345).source[0], before.source[0]);
}
END_TEST

START_TEST(times) {
    double start = 0, exposure = 0;
    options.projections = 10;
    options.start_s = 2;
    options.interval_s = 0.5;
    options.exposure_s = 0.125;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_skg(skg_scan_time_get(scan, 9, &start, &exposure));
    ck_assert_double_eq(start, 6.5);
    ck_assert_double_eq(exposure, 0.125);
}
END_TEST

START_TEST(positions_between_projections) {
    skg_view half;
    options.projections = 4;
    options.step_rad = PI / 2;
    ck_skg(skg_scan_create(&view, &options, &scan));
    skg_view_init(&half);
    ck_skg(skg_scan_view_at(scan, 0.5, &half));
    ck_vector(half.source, -1000 * sqrt(0.5), -1000 * sqrt(0.5), 0);
    ck_skg_fails(skg_scan_view_at(scan, 4.5, &half), SKG_ERR_ARGUMENT, "no position 4.5");
}
END_TEST

/* A fan of atan(101 / 1500) on each side. */
START_TEST(a_short_scan) {
    double range = 0;
    ck_skg(skg_scan_short_range_get(&view, &options, &range));
    ck_assert_double_eq_tol(range, PI + 2 * atan(101.0 / 1500), 1e-14); /* a few roundings of 3 */
    view.projection = SKG_PROJECTION_PARALLEL;
    ck_skg_fails(skg_scan_short_range_get(&view, &options, &range), SKG_ERR_SCENE, "point source");
}
END_TEST

/* A circle that is written as a table and read again has the same bits in every view, and the kind of beam: a reconstruction knows
 * nothing but the table. _i: enum skg_projection */
START_TEST(a_table_is_read_as_it_was_written) {
    skg_scan *table = NULL;
    const skg_view any = view;
    view.projection = (int32_t)_i;
    options.projections = 33;
    options.step_rad = 0.1;
    options.centre[0] = 1.0 / 3;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_skg(skg_scan_geometry_save(scan, path));
    ck_skg(skg_scan_load_table(&any, NULL, path, &table));
    int64_t count = 0;
    ck_skg(skg_scan_projection_count(table, &count));
    ck_assert_int_eq(count, 33);
    for (int64_t k = 0; k < count; k++) {
        skg_view mine = view_of(k), its;
        skg_view_init(&its);
        ck_skg(skg_scan_view_get(table, k, &its));
        ck_assert_mem_eq(&mine, &its, sizeof mine);
    }
    skg_scan_release(&table);
}
END_TEST

static void write_table(const char *text) {
    FILE *stream = fopen(path, "wb");
    ck_assert_ptr_nonnull(stream);
    fputs(text, stream);
    ck_assert_int_eq(fclose(stream), 0);
}

START_TEST(tables_in_other_hands) {
    write_table("sx sy sz dx dy dz ux uy uz vx vy vz\n\n# a comment\n0;-1000;0; 0;500;0; 1;0;0; 0;0;-1\n");
    ck_skg(skg_scan_load_table(&view, NULL, path, &scan));
    ck_vector(view_of(0).source, 0, -1000, 0);
    skg_scan_release(&scan);
    write_table("0 -1000 0 0 500 0 1 0 0 0 0\n");
    ck_skg_fails(skg_scan_load_table(&view, NULL, path, &scan), SKG_ERR_FORMAT, "line 1: number 12");
    write_table("0 -1000 0 0 500 0 1 0 0 0 0 1 1500 9\n");
    ck_skg_fails(skg_scan_load_table(&view, NULL, path, &scan), SKG_ERR_FORMAT, "more than 12");
    write_table("0 -1000 0 0 500 0 1 0 0 0 0 1 1500\n0 -1000 0 0 500 0 1 0 0 0 0 1\n");
    ck_skg_fails(skg_scan_load_table(&view, NULL, path, &scan), SKG_ERR_FORMAT,
                 "line 2: behind the row step");
    write_table("0 -1000 0 0 500 0 1 0 0 0 0 1\n0 -1000 0 0 500 0 1 0 0 2 0 0\n");
    ck_skg_fails(skg_scan_load_table(&view, NULL, path, &scan), SKG_ERR_SCENE, "projection 1 of the table");
    write_table("# nothing\n");
    ck_skg_fails(skg_scan_load_table(&view, NULL, path, &scan), SKG_ERR_FORMAT, "no line");
    unlink(path);
    ck_skg_fails(skg_scan_load_table(&view, NULL, path, &scan), SKG_ERR_FILE, "table.csv");
    ck_assert_ptr_null(scan);
}
END_TEST

/* The value behind the next key. */
static double number_behind(char **at, const char *key) {
    *at = strstr(*at, key);
    ck_assert_ptr_nonnull(*at);
    *at += strlen(key);
    return strtod(*at, at);
}

/* A camera of transforms.json sees a point where the ray through it meets the detector; the middle of pixel 0 is at 0.5. */
START_TEST(nerf_sees_points_where_we_do) {
    char text[8192], *at = text;
    const double point[3] = {12, -34, 21};
    options.projections = 5;
    options.step_rad = 0.4;
    options.detector_offset_mm[0] = 9, options.detector_offset_mm[1] = -4;
    options.detector_tilt_rad[0] = 0.05, options.detector_tilt_rad[2] = -0.3;
    snprintf(path, sizeof path, "%s/transforms.json", folder);
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_skg_fails(skg_scan_geometry_save(scan, path), SKG_ERR_UNSUPPORTED, "mirrored");
    skg_scan_release(&scan);
    view.column_step[0] = 2;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_skg(skg_scan_geometry_save(scan, path));
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    text[fread(text, 1, sizeof text - 1, stream)] = '\0';
    fclose(stream);
    unlink(path);
    at = strstr(text, "frames");
    for (int k = 0; k < 5; k++) {
        const skg_view v = view_of(k);
        double m[12], c[3] = {0}, normal[3], ray[3], seen[2];
        const double fx = number_behind(&at, "fl_x\": "), fy = number_behind(&at, "fl_y\": "),
                     cx = number_behind(&at, "cx\": "), cy = number_behind(&at, "cy\": ");
        at = strstr(at, "matrix\": [");
        for (int i = 0; i < 12; i++) {
            at += strcspn(at, "-0123456789");
            m[i] = strtod(at, &at);
        }
        for (int i = 0; i < 3; i++)
            for (int r = 0; r < 3; r++) c[i] += m[4 * r + i] * (point[r] - m[4 * r + 3]);
        for (int i = 0; i < 3; i++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3;
            normal[i] = v.column_step[a] * v.row_step[b] - v.column_step[b] * v.row_step[a];
            ray[i] = point[i] - v.source[i];
        }
        double down = 0, along = 0;
        for (int i = 0; i < 3; i++)
            down += normal[i] * (v.centre[i] - v.source[i]), along += normal[i] * ray[i];
        for (int s = 0; s < 2; s++) {
            const double *step = s ? v.row_step : v.column_step;
            double on = 0, square = 0;
            for (int i = 0; i < 3; i++) {
                on += step[i] * (v.source[i] + ray[i] * down / along - v.centre[i]);
                square += step[i] * step[i];
            }
            seen[s] = on / square + 0.5 * (double)(s ? v.rows : v.columns);
        }
        /* sums of doubles of up to 1e3 pixels */
        ck_assert_double_eq_tol(cx + fx * c[0] / -c[2], seen[0], 1e-9);
        ck_assert_double_eq_tol(cy - fy * c[1] / -c[2], seen[1], 1e-9);
    }
}
END_TEST

/* RTK's matrix applied to a point gives the place where the ray through it meets the detector. Its world has y along the
 * axis (z of ours), z from the axis to the source (-y), x = y cross z (x). */
START_TEST(rtk_projects_points_where_we_do) {
    char text[20000], *at = text;
    const double point[3] = {12, -34, 21}, centre[3] = {5, 6, 7};
    options.projections = 7;
    options.step_rad = 0.4;
    memcpy(options.centre, centre, sizeof centre);
    options.detector_offset_mm[0] = 9;
    options.detector_tilt_rad[0] = 0.05;
    options.detector_tilt_rad[1] = 0.02;
    options.detector_tilt_rad[2] = -0.3;
    view.source[0] = 5;
    ck_skg(skg_scan_create(&view, &options, &scan));
    snprintf(path, sizeof path, "%s/rtk.xml", folder);
    ck_skg(skg_scan_geometry_save(scan, path));
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    text[fread(text, 1, sizeof text - 1, stream)] = '\0';
    fclose(stream);
    for (int64_t k = 0; k < 7; k++) {
        const skg_view v = view_of(k);
        double m[12], p[3], ray[3], n[3];
        at = strstr(at, "<Matrix>");
        ck_assert_ptr_nonnull(at);
        at += 8;
        for (int i = 0; i < 12; i++) m[i] = strtod(at, &at);
        const double q[4] = {point[0] - centre[0], point[2] - centre[2], -(point[1] - centre[1]), 1};
        for (int r = 0; r < 3; r++)
            p[r] = m[4 * r] * q[0] + m[4 * r + 1] * q[1] + m[4 * r + 2] * q[2] + m[4 * r + 3];
        /* the ray meets the plane of the detector */
        for (int i = 0; i < 3; i++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3;
            n[i] = v.column_step[a] * v.row_step[b] - v.column_step[b] * v.row_step[a];
            ray[i] = point[i] - v.source[i];
        }
        double up = 0, down = 0, u = 0, w = 0;
        for (int i = 0; i < 3; i++) up += n[i] * (v.centre[i] - v.source[i]), down += n[i] * ray[i];
        for (int i = 0; i < 3; i++) {
            const double hit = v.source[i] + up / down * ray[i] - v.centre[i];
            u += hit * v.column_step[i] / 2; /* the length of a step */
            w += hit * v.row_step[i] / 3;
        }
        ck_assert_double_eq_tol(p[0] / p[2], u, 1e-9); /* some roundings of 1e-16 of 1e6 mm2, over 1000 mm */
        ck_assert_double_eq_tol(p[1] / p[2], w, 1e-9); /* the same */
    }
}
END_TEST

/* A table has the radius, as cyl_cone_vec of ASTRA, and RTK an element of its own, where its bend is ours; others are refused. */
START_TEST(curved_detectors) {
    static const char *const others[] = {"a.tigre.py", "a.cil.py", "transforms.json"};
    char text[4000];
    options.projections = 3, options.step_rad = 0.4;
    view.radius = 1500;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_skg(skg_scan_geometry_save(scan, path));
    skg_scan *table = NULL;
    skg_view flat = view;
    flat.radius = 0;
    ck_skg(skg_scan_load_table(&flat, NULL, path, &table));
    for (int64_t k = 0; k < 3; k++) {
        const skg_view want = view_of(k);
        skg_view got;
        skg_view_init(&got);
        ck_skg(skg_scan_view_get(table, k, &got));
        ck_assert_mem_eq(&got, &want, sizeof got);
    }
    skg_scan_release(&table);
    for (int n = 0; n < 3; n++)
        ck_skg_fails(skg_scan_geometry_save(scan, others[n]), SKG_ERR_UNSUPPORTED, "no curved detector");
    unlink(path);
    snprintf(path, sizeof path, "%s/rtk.xml", folder);
    ck_skg(skg_scan_geometry_save(scan, path));
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    text[fread(text, 1, sizeof text - 1, stream)] = '\0';
    fclose(stream);
    ck_assert_ptr_nonnull(strstr(text, "<RadiusCylindricalDetector>1500</RadiusCylindricalDetector>"));
    skg_scan_release(&scan);
    options.detector_offset_mm[0] = 30;
    ck_skg(skg_scan_create(&view, &options, &scan));
    /* on the circle about the source, 30 mm along it */
    const skg_view moved = view_of(0);
    ck_vector(moved.centre, -1500 * sin(0.02), -1000 + 1500 * cos(0.02), 0);
    unlink(path);
    ck_skg_fails(skg_scan_geometry_save(scan, path), SKG_ERR_UNSUPPORTED, "where RTK bends it");
}
END_TEST

START_TEST(what_cannot_be_written) {
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_skg_fails(skg_scan_geometry_save(scan, "a.txt"), SKG_ERR_ARGUMENT, ".csv");
    skg_scan_release(&scan);
    view.row_step[2] = 3; /* seen from behind */
    ck_skg(skg_scan_create(&view, &options, &scan));
    snprintf(path, sizeof path, "%s/rtk.xml", folder);
    ck_skg_fails(skg_scan_geometry_save(scan, path), SKG_ERR_UNSUPPORTED, "from behind");
    ck_assert_int_ne(access(path, F_OK), 0);
    skg_scan_release(&scan);
    view.row_step[0] = 1;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_skg_fails(skg_scan_geometry_save(scan, path), SKG_ERR_UNSUPPORTED, "skewed");
    skg_scan_release(&scan);
    view.projection = SKG_PROJECTION_PARALLEL;
    ck_skg(skg_scan_create(&view, &options, &scan));
    ck_skg_fails(skg_scan_geometry_save(scan, path), SKG_ERR_UNSUPPORTED, "parallel");
}
END_TEST

START_TEST(options_out_of_range) {
    static const struct {
        size_t at;
        double value;
        const char *text;
    } cases[] = {{offsetof(skg_scan_options, step_rad), HUGE_VAL, "not finite"},
                 {offsetof(skg_scan_options, axis) + 16, 0, "no length"},
                 {offsetof(skg_scan_options, detector_skew_rad), 1.5, "skew"},
                 {offsetof(skg_scan_options, source_jitter_mm), -1, "jitter"},
                 {offsetof(skg_scan_options, interval_s), -1, "or more"},
                 {offsetof(skg_scan_options, exposure_s), 1, "exposure"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        skg_scan_options_init(&options);
        memcpy((char *)&options + cases[i].at, &cases[i].value, sizeof(double));
        ck_skg_fails(skg_scan_create(&view, &options, &scan), SKG_ERR_ARGUMENT, cases[i].text);
    }
    skg_scan_options_init(&options);
    options.projections = 0;
    ck_skg_fails(skg_scan_create(&view, &options, &scan), SKG_ERR_ARGUMENT, "0 projections");
    options.projections = 1;
    view.columns = 0;
    ck_skg_fails(skg_scan_create(&view, &options, &scan), SKG_ERR_SCENE, "");
    ck_assert_ptr_null(scan);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, a_circle);
    tcase_add_test(tests, any_axis_start_and_direction);
    tcase_add_test(tests, a_helix);
    tcase_add_test(tests, laminography);
    tcase_add_test(tests, tomosynthesis_on_a_line_and_on_an_arc);
    tcase_add_test(tests, a_detector_that_is_displaced);
    tcase_add_test(tests, a_displaced_detector_in_a_parallel_beam);
    tcase_add_test(tests, drift_grows_to_its_end);
    tcase_add_test(tests, jitter_is_normal_and_repeatable);
    tcase_add_test(tests, times);
    tcase_add_test(tests, positions_between_projections);
    tcase_add_test(tests, a_short_scan);
    tcase_add_loop_test(tests, a_table_is_read_as_it_was_written, 0, 3);
    tcase_add_test(tests, tables_in_other_hands);
    tcase_add_test(tests, nerf_sees_points_where_we_do);
    tcase_add_test(tests, rtk_projects_points_where_we_do);
    tcase_add_test(tests, curved_detectors);
    tcase_add_test(tests, what_cannot_be_written);
    tcase_add_test(tests, options_out_of_range);
}

SKG_SUITE_MAIN("trajectory", add_tests)
