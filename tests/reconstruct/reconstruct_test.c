/* Reconstruction from exact projections of an ellipsoid and of a sphere within it: the attenuation coefficient within
 * 1 % of its own value in the middle plane, two voxels from the surfaces, as the issue of the paper's section 4.3
 * asks. */
#include "suite.h"

#include <skiagraph/scanning.h>
#include <skiagraph/skiagraph.h>

#include <math.h>
#include <string.h>

enum { COLUMNS = 320, ROWS = 2, SLICES = 1 };

#define PI 3.14159265358979323846

/* Radius that every projection sees: 400 mm times the sine of the fan, 80 mm at 600 mm. */
static double field_mm = 52;

typedef struct {
    double centre[3], radii[3], per_cm; /* more than what it lies in */
} ellipsoid;

static const ellipsoid bodies[] = {{{4, -6, 0}, {40, 32, 36}, 0.2}, {{10, 4, 1}, {14, 10, 12}, 0.3}};
enum { BODIES = sizeof bodies / sizeof *bodies };

/* Voxels that are sampled in other places, from 0.9 mm on: 2.7 samples of the detector at the axis. */
static const struct {
    double mm;
    int side;
} grids[] = {{1.8, 56}, {1.5, 66}, {1.2, 84}, {0.9, 112}};
enum { GRIDS = sizeof grids / sizeof *grids };

static skg_view view;
static skg_scan_options geometry;
static skg_fdk_options options;
static skg_scan *scan;
static skg_fdk *fdk;

static void choose_grid(int grid) {
    options.voxels[0] = options.voxels[1] = grids[grid].side;
    options.voxel_mm = grids[grid].mm;
}

static void set_up(void) {
    skg_view_init(&view);
    view.columns = COLUMNS;
    view.rows = ROWS;
    view.source[1] = -400;
    view.centre[1] = 200;
    view.column_step[0] = -0.5;
    view.row_step[2] = -0.5;
    skg_scan_options_init(&geometry);
    geometry.projections = 480;
    geometry.step_rad = 2 * PI / 480;
    skg_fdk_options_init(&options);
    options.voxels[2] = SLICES;
    choose_grid(0);
    scan = NULL;
    fdk = NULL;
}

static void tear_down(void) {
    skg_fdk_release(&fdk);
    skg_scan_release(&scan);
}

/* The length of the line from a, in units of b - a, within an ellipsoid. */
static double length_in(const ellipsoid *e, const double *a, const double *b) {
    double dd = 0, dp = 0, pp = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        const double d = (b[k] - a[k]) / e->radii[k], p = (a[k] - e->centre[k]) / e->radii[k];
        dd += d * d, dp += d * p, pp += p * p;
        length += (b[k] - a[k]) * (b[k] - a[k]);
    }
    const double inside = dp * dp - dd * (pp - 1);
    return inside > 0 ? 2 * sqrt(inside) / dd * sqrt(length) : 0;
}

/* The path through the bodies of a ray to a place on the detector, in pixels. */
static double attenuation(const skg_view *v, double column, double row) {
    double pixel[3], start[3], sum = 0;
    for (int k = 0; k < 3; k++) {
        pixel[k] = v->centre[k] + (column - 0.5 * (COLUMNS - 1)) * v->column_step[k] +
                   (row - 0.5 * (ROWS - 1)) * v->row_step[k];
        start[k] = v->source[k];
    }
    if (v->radius > 0) { /* on a circle about the source; the detector's axis is z */
        const double x = v->centre[0] - v->source[0], y = v->centre[1] - v->source[1];
        const double sense = v->column_step[0] * -y + v->column_step[1] * x > 0 ? 1 : -1;
        const double angle =
            sense * (column - 0.5 * (COLUMNS - 1)) * hypot(v->column_step[0], v->column_step[1]) / v->radius;
        pixel[0] = v->source[0] + cos(angle) * x - sin(angle) * y;
        pixel[1] = v->source[1] + sin(angle) * x + cos(angle) * y;
        pixel[2] = v->centre[2] + (row - 0.5 * (ROWS - 1)) * v->row_step[2];
    }
    for (int k = 0; k < 3 && v->projection != SKG_PROJECTION_POINT; k++)
        start[k] = pixel[k] + v->source[k] - v->centre[k];
    for (int b = 0; b < BODIES; b++) sum += bodies[b].per_cm / 10 * length_in(&bodies[b], start, pixel);
    return sum;
}

/* A pixel is the mean over its width, as a detector has it. */
static void add_projection(int64_t index) {
    enum { PARTS = 4 };
    static float image[ROWS * COLUMNS];
    skg_view v;
    skg_view_init(&v);
    ck_skg(skg_scan_view_get(scan, index, &v));
    for (int64_t r = 0; r < ROWS; r++)
        for (int64_t c = 0; c < COLUMNS; c++) {
            double sum = 0;
            for (int p = 0; p < PARTS; p++)
                sum += attenuation(&v, (double)c + (p + 0.5) / PARTS - 0.5, (double)r) / PARTS;
            image[r * COLUMNS + c] = (float)sum;
        }
    ck_skg(skg_fdk_add(fdk, index, image));
}

static void reconstruct(void) {
    ck_skg(skg_scan_create(&view, &geometry, &scan));
    ck_skg(skg_fdk_create(scan, &options, &fdk));
    for (int64_t k = 0; k < geometry.projections; k++) add_projection(k);
}

/* How far a point is within (below 1) or outside a surface that is moved by some mm. */
static int within(const ellipsoid *e, const double *point, double by) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double q = (point[k] - e->centre[k]) / (e->radii[k] + by);
        sum += q * q;
    }
    return sum < 1;
}

/* The largest error in the middle plane over voxels that are two voxels or more from every surface, as a share of the
 * coefficient there; outside as a share of the outer body's. */
static double worst_error(double *outside, double *rms) {
    const double margin = 2 * options.voxel_mm;
    const float *volume = NULL;
    double worst = 0, square = 0;
    *outside = 0;
    int64_t voxels = 0;
    const int64_t side = options.voxels[0];
    const double middle = 0.5 * (double)(side - 1);
    ck_skg(skg_fdk_volume_get(fdk, &volume));
    for (int64_t y = 0; y < side; y++)
        for (int64_t x = 0; x < side; x++) {
            const double point[3] = {((double)x - middle) * options.voxel_mm,
                                     ((double)y - middle) * options.voxel_mm, 0};
            double expected = 0;
            int near = 0;
            for (int b = 0; b < BODIES; b++) {
                near |= within(&bodies[b], point, margin) && !within(&bodies[b], point, -margin);
                if (within(&bodies[b], point, 0)) expected += bodies[b].per_cm;
            }
            if (near || hypot(point[0], point[1]) > field_mm) continue;
            const double got = (double)volume[(SLICES / 2 * side + y) * side + x];
            const double error = fabs(got - expected) / (expected > 0 ? expected : bodies[0].per_cm);
            double *which = expected > 0 ? &worst : outside;
            *which = fmax(*which, error);
            square += error * error;
            voxels++;
        }
    ck_assert_int_gt(voxels, 1500);
    *rms = sqrt(square / (double)voxels);
    return worst;
}

/* With a Hann window: 1 % of the coefficient, which is the bar, inside of the bodies; outside, of the outer one's. */
static void ck_smooth(void) {
    double outside = 0, rms = 0;
    const double worst = worst_error(&outside, &rms);
    ck_assert_msg(worst < 0.01 && outside < 0.01, "inside %g, outside %g, rms %g", worst, outside, rms);
}

/* The ramp alone has ripples beside an edge, of the jump over pi^2 times the distance in samples: the bar holds for the
 * mean, and each voxel is within 5 times that. */
static void ck_sharp(void) {
    double outside = 0, rms = 0;
    const double worst = worst_error(&outside, &rms);
    ck_assert_msg(rms < 0.01 && worst < 0.05 && outside < 0.05, "inside %g, outside %g, rms %g", worst,
                  outside, rms);
}

START_TEST(a_full_turn) {
    options.filter = _i;
    reconstruct();
    if (_i == SKG_FDK_FILTER_HANN)
        ck_smooth();
    else
        ck_sharp();
}
END_TEST

START_TEST(voxels_of_any_size) {
    choose_grid(_i);
    options.filter = SKG_FDK_FILTER_HANN;
    reconstruct();
    ck_smooth();
}
END_TEST

/* Opposite projections see the places between those of each other, so that the detector samples twice as finely: a quarter
 * of the bar. */
START_TEST(a_quarter_of_a_pixel_aside) {
    choose_grid(GRIDS - 1);
    options.filter = SKG_FDK_FILTER_HANN;
    geometry.detector_offset_mm[0] = 0.125;
    reconstruct();
    double outside = 0, rms = 0;
    const double worst = worst_error(&outside, &rms);
    ck_assert_msg(worst < 0.0025 && rms < 0.001, "inside %g, outside %g, rms %g", worst, outside, rms);
}
END_TEST

START_TEST(a_full_turn_the_other_way) {
    geometry.step_rad = -geometry.step_rad;
    geometry.start_rad = 1;
    options.filter = SKG_FDK_FILTER_HANN;
    reconstruct();
    ck_smooth();
}
END_TEST

static skg_fdk_report seen(void) {
    skg_fdk_report report;
    skg_fdk_report_init(&report);
    ck_skg(skg_fdk_report_get(fdk, &report));
    return report;
}

/* Half-fan: each side of the bodies is cut off in half of the turn, and Wang's weights make it as good as a whole one; to one side, to
 * the other and the other way round, and in a parallel beam. */
START_TEST(a_displaced_detector) {
    geometry.detector_offset_mm[0] = _i == 1 ? -50 : 50;
    if (_i == 1) geometry.step_rad = -geometry.step_rad;
    if (_i == 2) {
        view.projection = SKG_PROJECTION_PARALLEL;
        view.column_step[0] = view.row_step[2] = -0.33;
        geometry.detector_offset_mm[0] *= 0.66;
    }
    options.filter = SKG_FDK_FILTER_HANN;
    reconstruct();
    ck_smooth();
    const skg_fdk_report report = seen();
    /* half the height of the detector between the middles of its rows, as seen at the axis */
    const double half = 0.5 * (ROWS - 1) * (_i == 2 ? 0.33 : 0.5 * 400 / 600);
    for (int k = 0; k < 2; k++)
        ck_assert_double_eq_tol(report.along_mm[k], k ? half : -half,
                                1e-9 * half); /* rounding of some products, 1e7 times epsilon */
    ck_assert_int_eq(report.displaced, 1);
    ck_assert_double_eq(report.truncated, 0);
    ck_assert(report.overlap_mm > 15 && report.overlap_mm < 25 && report.covered_mm > field_mm);
}
END_TEST

/* The detector sees 35 of 46 mm: every row is counted, and continued rows hold the bar up to 90 % of what is covered. */
START_TEST(a_detector_that_is_too_narrow) {
    view.column_step[0] = -0.33;
    options.filter = SKG_FDK_FILTER_HANN;
    options.truncation = SKG_FDK_TRUNCATION_EXTRAPOLATE;
    field_mm = 31;
    options.voxels[0] = options.voxels[1] = 56;
    options.voxel_mm = 1.2;
    reconstruct();
    ck_smooth();
    ck_assert_double_ge(seen().truncated, 0.7);
    ck_assert_double_eq_tol(seen().covered_mm, 35, 0.5); /* mm: half a pixel */
    field_mm = 52;
}
END_TEST

/* Parker's weights make a short scan as good as a full one, in both directions. */
START_TEST(a_short_scan) {
    double range = 0;
    const double sign = _i ? -1 : 1;
    ck_skg(skg_scan_short_range_get(&view, &geometry, &range));
    geometry.projections = 280;
    geometry.step_rad = sign * range / 279;
    options.filter = SKG_FDK_FILTER_HANN;
    reconstruct();
    ck_smooth();
}
END_TEST

START_TEST(a_parallel_beam) {
    view.projection = SKG_PROJECTION_PARALLEL;
    view.column_step[0] = -0.33;
    view.row_step[2] = -0.33;
    options.filter = SKG_FDK_FILTER_HANN;
    reconstruct();
    ck_smooth();
}
END_TEST

/* Third-generation CT: columns at equal angles about the source, up to 28.6 degrees from the middle. A full turn either way, a short scan,
 * a detector that is displaced along its cylinder, and one that is moved by a quarter of a column. */
START_TEST(an_equiangular_fan) {
    view.source[1] = -112, view.centre[1] = 48;
    view.radius = 160;
    geometry.projections = 960; /* fewer show streaks beyond the bodies, which are near the source */
    geometry.step_rad = 2 * PI / 960;
    options.filter = SKG_FDK_FILTER_HANN;
    if (_i == 1) geometry.step_rad = -geometry.step_rad;
    if (_i == 2) {
        double range = 0;
        ck_skg(skg_scan_short_range_get(&view, &geometry, &range));
        ck_assert_double_eq_tol(range, PI + COLUMNS * 0.5 / 160, 1e-12); /* some roundings of 2^-53 */
        geometry.projections = 660;
        geometry.step_rad = range / 659;
    }
    if (_i == 3) geometry.detector_offset_mm[0] = 40;
    if (_i == 4) geometry.detector_offset_mm[0] = 0.125, choose_grid(GRIDS - 1);
    reconstruct();
    ck_smooth();
    if (_i == 3) ck_assert_int_eq(seen().displaced, 1);
}
END_TEST

START_TEST(what_is_refused_of_curved_detectors) {
    view.radius = 700; /* the axis lies behind the source */
    ck_skg(skg_scan_create(&view, &geometry, &scan));
    ck_skg_fails(skg_fdk_create(scan, &options, &fdk), SKG_ERR_UNSUPPORTED, "does not go through the source");
    skg_scan_release(&scan);
    view.radius = 600;
    options.truncation = SKG_FDK_TRUNCATION_EXTRAPOLATE;
    ck_skg(skg_scan_create(&view, &geometry, &scan));
    ck_skg_fails(skg_fdk_create(scan, &options, &fdk), SKG_ERR_UNSUPPORTED, "not continued");
}
END_TEST

/* A volume elsewhere has the values of the same places. */
START_TEST(a_detail) {
    const float *volume = NULL;
    options.middle[0] = 10;
    options.middle[1] = 4;
    options.voxels[0] = options.voxels[1] = 5;
    options.voxels[2] = 1;
    reconstruct();
    ck_skg(skg_fdk_volume_get(fdk, &volume));
    for (int i = 0; i < 25; i++) ck_assert_double_eq_tol((double)volume[i], 0.5, 0.005); /* 1 %, the bar */
}
END_TEST

/* An axis that leans towards the beam, or beside it, by 5 degrees is taken; by 15 degrees it is not. */
START_TEST(an_axis_that_leans) {
    static const char *const said[] = {
        "the rows of the detector do not run across the axis of rotation but lean by 15 degrees",
        "the axis of rotation leans out of the detector's plane by 15 degrees"};
    for (int lean = 15; lean > 0; lean -= 10) {
        memset(geometry.axis, 0, sizeof geometry.axis);
        geometry.axis[_i] = sin(lean * PI / 180);
        geometry.axis[2] = cos(lean * PI / 180);
        memcpy(options.axis, geometry.axis, sizeof options.axis);
        ck_skg(skg_scan_create(&view, &geometry, &scan));
        if (lean == 15) ck_skg_fails(skg_fdk_create(scan, &options, &fdk), SKG_ERR_UNSUPPORTED, said[_i]);
        if (lean == 5) ck_skg(skg_fdk_create(scan, &options, &fdk));
        skg_scan_release(&scan);
    }
}
END_TEST

/* A beam that passes the plane across the axis on one side: the detector stands upright, 15 degrees below its source. */
START_TEST(a_beam_that_leans) {
    view.source[2] = 600 * tan(15 * PI / 180);
    ck_skg(skg_scan_create(&view, &geometry, &scan));
    ck_skg_fails(skg_fdk_create(scan, &options, &fdk), SKG_ERR_UNSUPPORTED,
                 "the beam passes the plane across the axis of rotation by 15 degrees");
}
END_TEST

START_TEST(what_is_refused) {
    geometry.pitch_mm = 100;
    ck_skg(skg_scan_create(&view, &geometry, &scan));
    ck_skg_fails(skg_fdk_create(scan, &options, &fdk), SKG_ERR_UNSUPPORTED, "leaves its circle");
    ck_skg_fails(skg_fdk_create(scan, &options, &fdk), SKG_ERR_UNSUPPORTED,
                 ".csv for ASTRA, .tigre.py for TIGRE");
    skg_scan_release(&scan);
    geometry.pitch_mm = 0;
    geometry.detector_offset_mm[0] = 90;
    ck_skg(skg_scan_create(&view, &geometry, &scan));
    ck_skg_fails(skg_fdk_create(scan, &options, &fdk), SKG_ERR_UNSUPPORTED, "does not see the axis");
    geometry.detector_offset_mm[0] = 0;
    skg_scan_release(&scan);
    geometry.projections = 100;
    ck_skg(skg_scan_create(&view, &geometry, &scan));
    ck_skg_fails(skg_fdk_create(scan, &options, &fdk), SKG_ERR_UNSUPPORTED, "range of 74.25 degrees");
    options.axis[2] = 0;
    options.axis[0] = 1;
    ck_skg_fails(skg_fdk_create(scan, &options, &fdk), SKG_ERR_UNSUPPORTED, "");
    options.voxels[1] = 0;
    ck_skg_fails(skg_fdk_create(scan, &options, &fdk), SKG_ERR_ARGUMENT, "0 voxels along y");
    ck_assert_ptr_null(fdk);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_loop_test(tests, a_full_turn, SKG_FDK_FILTER_RAMP, SKG_FDK_FILTER_HANN + 1);
    tcase_add_loop_test(tests, voxels_of_any_size, 1, GRIDS);
    tcase_add_test(tests, a_quarter_of_a_pixel_aside);
    tcase_add_test(tests, a_full_turn_the_other_way);
    tcase_add_loop_test(tests, a_short_scan, 0, 2);
    tcase_add_loop_test(tests, a_displaced_detector, 1,
                        suite_turns(3, 2)); /* the other way round: the same weights */
    tcase_add_test(tests, a_detector_that_is_too_narrow);
    tcase_add_test(tests, a_parallel_beam);
    tcase_add_test(tests, a_detail);
    tcase_add_loop_test(tests, an_equiangular_fan, suite_full() ? 0 : 2,
                        4); /* a short scan, a displaced one */
    if (suite_full()) tcase_add_loop_test(tests, an_equiangular_fan, 4, 5);
    tcase_add_test(tests, what_is_refused_of_curved_detectors);
    tcase_add_loop_test(tests, an_axis_that_leans, 0, 2);
    tcase_add_test(tests, a_beam_that_leans);
    tcase_add_test(tests, what_is_refused);
}

SKG_SUITE_MAIN("reconstruct", add_tests)
