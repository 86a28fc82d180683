/* The field of a beam in the world, and the pixels that its rays reach. */
#include "geometry/optics.h"

#include "core/maths.h"
#include "suite.h"

#include <skiagraph/scene.h>

#include <math.h>

static skg_view view;
static skg_collimation jaws;

/* 40 x 30 pixels of 2 mm x 3 mm, 500 mm from the source along -y, beside the source's foot by 100 mm. */
static void set_up(void) {
    skg_view_init(&view);
    view.columns = 40, view.rows = 30;
    view.source[0] = 10, view.source[1] = 20, view.source[2] = 30;
    view.centre[0] = 110, view.centre[1] = -480, view.centre[2] = 30;
    view.column_step[0] = 2;
    view.row_step[2] = -3;
    skg_collimation_init(&jaws);
}

static void check_point(const double *found, double x, double y, double z) {
    const double wanted[3] = {x, y, z};
    for (int k = 0; k < 3; k++)
        ck_assert_double_eq_tol(found[k], wanted[k], 1e-12 * 500); /* some roundings */
}

/* Without a collimation, or an open one: the outer edges of the pixels, on the detector. */
START_TEST(the_detector_is_the_field_of_an_open_beam) {
    const skg_collimation *const given[2] = {NULL, &jaws};
    skg_field field;
    for (int k = 0; k < 2; k++) {
        ck_skg(skg_field_make(given[k], &view, &field));
        check_point(field.centre, 110, -480, 30);
        check_point(field.column, 1, 0, 0);
        check_point(field.row, 0, 0, -1);
        ck_assert_double_eq(field.low[0], -40);
        ck_assert_double_eq(field.high[0], 40);
        ck_assert_double_eq(field.low[1], -45);
        ck_assert_double_eq(field.high[1], 45);
        ck_assert(!skg_collimation_limits(given[k]));
    }
    jaws.kind = SKG_COLLIMATION_DETECTOR;
    jaws.margin_mm = 1.5;
    ck_skg(skg_field_make(&jaws, &view, &field));
    ck_assert_double_eq(field.high[0], 41.5);
    ck_assert_double_eq(field.low[1], -46.5);
}
END_TEST

/* The plane is at its distance along the normal; the centre lies on the ray to the detector's centre. */
START_TEST(jaws_stand_on_the_central_ray) {
    skg_field field;
    jaws.kind = SKG_COLLIMATION_RECTANGLE;
    jaws.distance_mm = 200;
    jaws.low[0] = -3, jaws.high[0] = 5, jaws.low[1] = -7, jaws.high[1] = 11;
    ck_skg(skg_field_make(&jaws, &view, &field));
    check_point(field.centre, 50, -180, 30);
    check_point(field.column, 1, 0, 0);
    check_point(field.row, 0, 0, -1);
    ck_assert_double_eq(field.low[1], -7);
    ck_assert_double_eq(field.high[0], 5);
    view.projection = SKG_PROJECTION_PARALLEL;
    ck_skg(skg_field_make(&jaws, &view, &field));
    check_point(field.centre, 110, -480, 30);
}
END_TEST

/* The rays through the opening, carried from 200 to 500 mm; a parallel beam carries it unchanged. */
START_TEST(corners_lie_on_the_rays_of_the_opening) {
    const double low[3] = {110 - 2.5 * 3, -480, 30 + 2.5 * 7}, high[3] = {110 + 2.5 * 5, -480, 30 - 2.5 * 11};
    double corners[4][3];
    ck_skg(skg_collimation_corners_get(NULL, &view, 0, corners[0]));
    check_point(corners[0], 110 - 40, -480, 30 + 45);
    check_point(corners[2], 110 + 40, -480, 30 - 45);
    jaws.kind = SKG_COLLIMATION_RECTANGLE;
    jaws.distance_mm = 200;
    jaws.low[0] = -3, jaws.high[0] = 5, jaws.low[1] = -7, jaws.high[1] = 11;
    ck_skg(skg_collimation_corners_get(&jaws, &view, 0, corners[0]));
    check_point(corners[0], low[0], low[1], low[2]);
    check_point(corners[1], high[0], low[1], low[2]);
    check_point(corners[2], high[0], high[1], high[2]);
    check_point(corners[3], low[0], high[1], high[2]);
    ck_skg(skg_collimation_corners_get(&jaws, &view, 1, corners[0]));
    check_point(corners[0], 50 - 3, -180, 30 + 7);
    view.projection = SKG_PROJECTION_PARALLEL;
    ck_skg(skg_collimation_corners_get(&jaws, &view, 0, corners[0]));
    check_point(corners[2], 110 + 5, -480, 30 - 11);
    view.projection = SKG_PROJECTION_POINT;
    jaws.distance_mm = 600;
    ck_skg_fails(skg_collimation_corners_get(&jaws, &view, 0, corners[0]), SKG_ERR_SCENE,
                 "behind the detector");
}
END_TEST

/* Each pixel of random views by its own ray, whose passage of the plane is computed here. */
START_TEST(windows_hold_the_rays_that_pass) {
    uint64_t state = 77 + (uint64_t)_i;
    double random[16];
    for (int k = 0; k < 16; k++) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        random[k] = (double)(state >> 11) * 0x1p-53 - 0.5;
    }
    for (int k = 0; k < 3; k++) {
        view.column_step[k] = 2 * random[k] + (k == 0 ? 3 : 0);
        view.row_step[k] = 2 * random[3 + k] - (k == 2 ? 3 : 0);
    }
    skg_field field;
    skg_camera camera;
    int32_t window[4];
    double normal[3], source[3];
    jaws.kind = SKG_COLLIMATION_RECTANGLE;
    jaws.distance_mm = 150 + 100 * random[6];
    for (int a = 0; a < 2; a++) {
        jaws.low[a] = -9 + 10 * random[7 + a];
        jaws.high[a] = 9 + 10 * random[9 + a];
    }
    for (int k = 0; k < 3; k++) source[k] = view.source[k] + 4 * random[11 + k];
    ck_skg(skg_view_check(&view));
    ck_skg(skg_field_make(&jaws, &view, &field));
    ck_skg(skg_camera_make(&view, source, random[14], random[15], &camera));
    ck_skg(skg_field_window(&field, &camera, window));
    skg_cross(field.column, field.row, normal);
    /* Coordinates along steps that are not perpendicular: by the vectors across the other step, in the plane. */
    double across[2][3];
    skg_cross(field.row, normal, across[0]);
    skg_cross(normal, field.column, across[1]);
    int inside = 0;
    for (int64_t p = 0; p < view.columns * view.rows; p++) {
        const int64_t column = p % view.columns, row = p / view.columns;
        double ray[3], at[3], to[3];
        for (int k = 0; k < 3; k++) {
            to[k] = field.centre[k] - source[k];
            ray[k] = camera.first[k] + (double)column * camera.column[k] + (double)row * camera.row[k];
        }
        skg_scale_vector(skg_dot(to, normal) / skg_dot(ray, normal), ray, at);
        skg_add_scaled(at, -1, to, at);
        const double x = skg_dot(at, across[0]) / skg_dot(field.column, across[0]),
                     y = skg_dot(at, across[1]) / skg_dot(field.row, across[1]);
        const int passes = x > jaws.low[0] && x < jaws.high[0] && y > jaws.low[1] && y < jaws.high[1];
        const int held = column >= window[0] && column < window[1] && row >= window[2] && row < window[3];
        ck_assert_msg(held == passes, "pixel (%d, %d) at (%g, %g) mm", (int)row, (int)column, x, y);
        inside += held;
    }
    ck_assert(inside > 0 && inside < view.columns * view.rows);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, NULL);
    tcase_add_test(tests, the_detector_is_the_field_of_an_open_beam);
    tcase_add_test(tests, jaws_stand_on_the_central_ray);
    tcase_add_test(tests, corners_lie_on_the_rays_of_the_opening);
    tcase_add_loop_test(tests, windows_hold_the_rays_that_pass, 0, 20);
}

SKG_SUITE_MAIN("field", add_tests)
