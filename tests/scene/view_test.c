/* Views and cameras against each other. */
#include "core/maths.h"
#include "geometry/optics.h"
#include "suite.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* A detector of 64 x 48 pixels of 0.5 x 0.4 mm across y, 500 mm from the source. */
static skg_view good_view(int32_t projection) {
    skg_view view;
    skg_view_init(&view);
    view.projection = projection;
    view.columns = 64, view.rows = 48;
    view.source[1] = projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY ? 2 : -300;
    view.centre[1] = 200;
    view.column_step[0] = 0.5;
    view.row_step[2] = -0.4;
    return view;
}

/* An oblique one, skewed, off the axis. */
static skg_view oblique_view(int32_t projection) {
    skg_view view = good_view(projection);
    view.source[0] = 12, view.source[2] = projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY ? 1 : -40;
    view.centre[0] = -30, view.centre[2] = 25;
    view.column_step[1] = 0.21, view.column_step[2] = 0.05;
    view.row_step[0] = 0.06, view.row_step[1] = 0.1;
    return view;
}

static void pixel_centre(const skg_view *view, double i, double j, double *pixel) {
    skg_add_scaled(view->centre, i - 0.5 * (double)(view->columns - 1), view->column_step, pixel);
    skg_add_scaled(pixel, j - 0.5 * (double)(view->rows - 1), view->row_step, pixel);
}

/* 64 eps: a dozen operations on numbers that the coordinates exceed by at most the detector's width over a
 * pixel's. */
static const double TOLERANCE = 64 * 64 * 2.3e-16;

static skg_camera camera_of(const skg_view *view) {
    skg_camera camera;
    ck_skg(skg_camera_make(view, NULL, 0, 0, &camera));
    return camera;
}

/* mm before the pixel at which the path of a parallel ray starts. */
static double start_of(const skg_camera *camera, double i, double j) {
    return (1 - (camera->start[0] + i * camera->start[1] + j * camera->start[2])) * skg_length(camera->first);
}

/* A point on the ray of pixel (i, j) must project there, at the depth where it was put. */
static void check_projection(const skg_view *view) {
    const skg_camera camera = camera_of(view);
    for (int k = 0; k < 200; k++) {
        double i = (k * 37 % 64) + 0.25 * (k % 3), j = k * 29 % 48, depth = 0.05 + 0.0045 * k;
        double pixel[3], start[3], x[3], h[3];
        pixel_centre(view, i, j, pixel);
        if (!camera.parallel) {
            memcpy(start, view->source, sizeof start);
        } else if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY) {
            ck_assert_double_gt(start_of(&camera, i, j), 1e29);
            skg_add_scaled(pixel, -400 / skg_length(camera.first), camera.first, start);
        } else { /* the start lies in the plane through the source across the beam */
            double way[3];
            skg_add_scaled(pixel, -start_of(&camera, i, j) / skg_length(camera.first), camera.first, start);
            skg_add_scaled(start, -1, view->source, way);
            ck_assert_double_eq_tol(skg_dot(way, camera.first) / skg_length(camera.first), 0,
                                    128 * DBL_EPSILON * 300);
        }
        for (int c = 0; c < 3; c++) x[c] = start[c] + depth * (pixel[c] - start[c]);
        skg_camera_see(&camera, x, h);
        double w = camera.parallel ? 1 : h[2], length[3];
        ck_assert_double_eq_tol(h[0] / w, i, 64 * TOLERANCE / depth);
        ck_assert_double_eq_tol(h[1] / w, j, 64 * TOLERANCE / depth);
        skg_add_scaled(x, -1, pixel, length);
        if (camera.parallel)
            ck_assert_double_eq_tol(h[2] * skg_length(camera.first), -skg_length(length),
                                    128 * DBL_EPSILON * 300);
        else
            ck_assert_double_eq_tol(h[2], depth, TOLERANCE);
    }
}

START_TEST(points_project_to_their_pixel) {
    for (int32_t projection = SKG_PROJECTION_POINT; projection <= SKG_PROJECTION_PARALLEL_FROM_INFINITY;
         projection++) {
        skg_view straight = good_view(projection), oblique = oblique_view(projection);
        check_projection(&straight);
        check_projection(&oblique);
    }
}
END_TEST

/* The direction of a parallel beam is detector's centre - source, not to any pixel. */
START_TEST(parallel_direction_and_start) {
    skg_view view = good_view(SKG_PROJECTION_PARALLEL);
    view.source[0] = -300; /* 45 degrees... */
    view.centre[0] = 200;
    const skg_camera camera = camera_of(&view);
    ck_assert_double_eq_tol(camera.first[0] / skg_length(camera.first), sqrt(0.5), 4 * DBL_EPSILON);
    ck_assert_double_eq_tol(camera.first[1] / skg_length(camera.first), sqrt(0.5), 4 * DBL_EPSILON);
    /* ...so the rays of columns one step apart differ by half a mm times cos 45 in length */
    ck_assert_double_eq_tol(start_of(&camera, 11, 0) - start_of(&camera, 10, 0), 0.5 * sqrt(0.5), 1e-12);
    ck_assert_double_eq_tol(start_of(&camera, 31.5, 23.5), 500 * sqrt(2), 1e-10);
}
END_TEST

typedef struct {
    const char *what, *sentence;
    int32_t projection;
    void (*spoil)(skg_view *view);
} bad_view;

static void no_columns(skg_view *v) {
    v->columns = 0;
}
static void negative_rows(skg_view *v) {
    v->rows = -5;
}
static void too_many(skg_view *v) {
    v->columns = 32769;
}
static void far_too_many(skg_view *v) {
    v->rows = INT64_MAX;
}
static void zero_step(skg_view *v) {
    v->row_step[2] = 0;
}
static void parallel_steps(skg_view *v) {
    v->row_step[0] = -3, v->row_step[2] = 0;
}
static void nearly_parallel_steps(skg_view *v) {
    v->row_step[0] = 1, v->row_step[2] = 1e-12;
}
static void source_on_detector(skg_view *v) {
    memcpy(v->source, v->centre, sizeof v->source);
}
static void source_in_plane(skg_view *v) {
    v->source[0] = 777, v->source[1] = v->centre[1];
}
static void edge_on(skg_view *v) {
    v->column_step[0] = 0, v->column_step[1] = 0.5;
}
static void edge_on_source(skg_view *v) {
    v->column_step[0] = 0, v->column_step[1] = 0.5, v->source[0] = 0;
}
static void nan_source(skg_view *v) {
    v->source[2] = (double)NAN;
}
static void infinite_centre(skg_view *v) {
    v->centre[0] = HUGE_VAL;
}
static void nan_step(skg_view *v) {
    v->column_step[1] = (double)NAN;
}
static void huge(skg_view *v) {
    v->column_step[0] = 1e200, v->row_step[2] = 1e200;
}
static void tiny(skg_view *v) {
    v->column_step[0] = 1e-200;
}
static void no_direction(skg_view *v) {
    memset(v->source, 0, sizeof v->source);
}
static void bad_projection(skg_view *v) {
    v->projection = 7;
}

static const bad_view bad_views[] = {
    {"columns", "0 columns", SKG_PROJECTION_POINT, no_columns},
    {"rows", "-5 rows", SKG_PROJECTION_POINT, negative_rows},
    {"too many", "1 to 32768", SKG_PROJECTION_POINT, too_many},
    {"far too many", "1 to 32768", SKG_PROJECTION_PARALLEL, far_too_many},
    {"zero step", "no size", SKG_PROJECTION_POINT, zero_step},
    {"parallel steps", "must not be parallel", SKG_PROJECTION_POINT, parallel_steps},
    {"nearly parallel", "must not be parallel", SKG_PROJECTION_PARALLEL, nearly_parallel_steps},
    {"source on detector", "lies on the detector", SKG_PROJECTION_POINT, source_on_detector},
    {"source in plane", "in its plane", SKG_PROJECTION_POINT, source_in_plane},
    {"source at centre", "no direction", SKG_PROJECTION_PARALLEL, source_on_detector},
    {"edge on", "edge-on", SKG_PROJECTION_PARALLEL, edge_on},
    {"edge on to a point", "in its plane", SKG_PROJECTION_POINT, edge_on_source},
    {"edge on from infinity", "edge-on", SKG_PROJECTION_PARALLEL_FROM_INFINITY, edge_on},
    {"nan", "source's position is not finite", SKG_PROJECTION_POINT, nan_source},
    {"infinite", "detector's position is not finite", SKG_PROJECTION_POINT, infinite_centre},
    {"nan step", "column step is not finite", SKG_PROJECTION_POINT, nan_step},
    {"huge", "too large", SKG_PROJECTION_POINT, huge},
    {"tiny", "no size", SKG_PROJECTION_POINT, tiny},
    {"no direction", "direction is (0, 0, 0)", SKG_PROJECTION_PARALLEL_FROM_INFINITY, no_direction},
    {"projection", "projection is 7", SKG_PROJECTION_POINT, bad_projection},
};

START_TEST(bad_views_are_refused) {
    const bad_view *bad = &bad_views[_i];
    skg_view view = good_view(bad->projection);
    ck_skg(skg_view_check(&view));
    bad->spoil(&view);
    ck_skg_fails(skg_view_check(&view), SKG_ERR_SCENE, bad->sentence);
}
END_TEST

START_TEST(directions_of_any_length) {
    static const double lengths[] = {1e-300, 1e-3, 1e12, 1e300};
    for (int k = 0; k < 4; k++) {
        skg_view view = good_view(SKG_PROJECTION_PARALLEL_FROM_INFINITY);
        view.source[0] = view.source[1] = lengths[k];
        const skg_camera camera = camera_of(&view);
        ck_assert_double_eq_tol(camera.first[0] / skg_length(camera.first), sqrt(0.5), 4 * DBL_EPSILON);
        ck_assert_double_eq_tol(camera.first[1] / skg_length(camera.first), sqrt(0.5), 4 * DBL_EPSILON);
    }
}
END_TEST

START_TEST(unprepared_views_are_refused) {
    skg_view view = {0};
    ck_skg_fails(skg_view_check(NULL), SKG_ERR_ARGUMENT, "skg_view_init");
    ck_skg_fails(skg_view_check(&view), SKG_ERR_ARGUMENT, "skg_view_init");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, points_project_to_their_pixel);
    tcase_add_test(tests, parallel_direction_and_start);
    tcase_add_loop_test(tests, bad_views_are_refused, 0, (int)(sizeof bad_views / sizeof *bad_views));
    tcase_add_test(tests, directions_of_any_length);
    tcase_add_test(tests, unprepared_views_are_refused);
}

SKG_SUITE_MAIN("view", add_tests)
