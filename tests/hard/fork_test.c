/* The child of a fork: calls that OpenMP shares among threads are refused there, where they would hang. */
#include "suite.h"

#include <skiagraph/breathing.h>
#include <skiagraph/scanning.h>
#include <skiagraph/skiagraph.h>

#include <string.h>
#include <sys/wait.h>

enum { PATIENCE = 120 /* seconds; a hang is ended by SIGALRM */ };

static skg_thorax *thorax;
static skg_mesh *ball, *cube;
static skg_scan *scan;
static skg_fdk *fdk;

static skg_status make_thorax(void) {
    skg_thorax_options options;
    skg_thorax_options_init(&options);
    options.simple = 1;
    options.triangles = 10000;
    skg_thorax_release(&thorax);
    return skg_thorax_create(&options, &thorax);
}

static skg_status measure(void) {
    skg_distance distance;
    skg_distance_init(&distance);
    return skg_distance_measure(ball, cube, NULL, &distance);
}

static skg_status measure_points(void) {
    static const double points[3] = {5, 6, 7};
    double distance;
    return skg_distance_of_points(ball, 1, points, &distance);
}

static skg_status make_body(void) {
    skg_body *made = NULL;
    const skg_status status = skg_body_create(NULL, NULL, &made);
    skg_body_release(&made);
    return status;
}

static skg_status reconstruct(void) {
    static float image[64];
    return skg_fdk_add(fdk, 0, image);
}

static skg_status (*const calls[])(void) = {make_thorax, measure, measure_points, make_body};
enum { CALLS = sizeof calls / sizeof *calls };

static void make_reconstruction(void) {
    skg_view view;
    skg_scan_options geometry;
    skg_fdk_options options;
    skg_view_init(&view);
    view.columns = view.rows = 8;
    view.source[1] = -1000;
    view.centre[1] = 500;
    view.column_step[0] = 2;
    view.row_step[2] = -2;
    skg_scan_options_init(&geometry);
    geometry.projections = 8;
    geometry.step_rad = 0.785398163397448;
    ck_skg(skg_scan_create(&view, &geometry, &scan));
    skg_fdk_options_init(&options);
    for (int k = 0; k < 3; k++) options.voxels[k] = 4;
    options.voxel_mm = 1;
    ck_skg(skg_fdk_create(scan, &options, &fdk));
}

/* The child's verdict: the number of the first call that is not refused, or of a reconstruction that is; or 0. */
static int refused_in_child(void) {
    alarm(PATIENCE);
    for (int c = 0; c < CALLS; c++)
        if (calls[c]() != SKG_ERR_FORK || !strstr(skg_last_error(), "OpenMP")) return c + 1;
    return reconstruct() == SKG_OK ? 0 : CALLS + 1; /* its threads end with each call */
}

START_TEST(a_child_is_refused) {
    int status = 0;
    ck_skg(skg_mesh_create_sphere(10, 32, &ball));
    ck_skg(skg_mesh_create_cube(5, &cube));
    make_reconstruction();
    for (int c = 0; c < CALLS; c++) ck_skg(calls[c]());
    ck_skg(reconstruct());
    fflush(NULL);
    const pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child == 0) _exit(refused_in_child());
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert_msg(WIFEXITED(status), "the child hung or crashed: signal %d", WTERMSIG(status));
    ck_assert_int_eq(WEXITSTATUS(status), 0);
    for (int c = 0; c < CALLS; c++) ck_skg(calls[c]()); /* the parent goes on */
}
END_TEST

/* A fork before the first call is none of our business. */
START_TEST(a_child_may_begin) {
    int status = 0;
    fflush(NULL);
    const pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child == 0) {
        alarm(PATIENCE);
        _exit(make_thorax() == SKG_OK ? 0 : 1);
    }
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    ck_skg(make_thorax());
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, a_child_is_refused);
    tcase_add_test(tests, a_child_may_begin);
}

SKG_SUITE_MAIN("fork", add_tests)
