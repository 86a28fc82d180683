/* Promises of frame.h about jobs: asked without waiting, waited for in any order, and alive after their plan, scene and context were
 * released. And the calls that count and tell the version. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <stdio.h>
#include <string.h>

enum { SIDE = 64, FRAMES = 8 };

static skg_context *context;
static skg_scene *scene;
static skg_plan *plan;
static skg_output output;

/* A cube of 2 cm of 0.2/cm, in a beam of two energies along z. */
static void open_plan(void) {
    static const double kev[2] = {40, 80}, photons[2] = {500, 500};
    skg_mesh *cube = NULL;
    skg_material *water = NULL;
    skg_spectrum *beam = NULL;
    skg_part part;
    skg_view view;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_mesh_create_cube(20, &cube));
    ck_skg(skg_material_create_mu("water", 0.2, &water));
    ck_skg(skg_spectrum_create_bins(2, kev, photons, &beam));
    ck_skg(skg_scene_create(context, &scene));
    skg_part_init(&part);
    part.mesh = cube, part.material = water, part.label = "cube";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_view_init(&view);
    view.projection = SKG_PROJECTION_PARALLEL;
    view.columns = view.rows = SIDE;
    view.source[2] = -100, view.centre[2] = 50;
    view.column_step[0] = view.row_step[1] = 0.25;
    ck_skg(skg_plan_create(context, scene, &view, beam, NULL, &plan));
    skg_spectrum_release(&beam);
    skg_material_release(&water);
    skg_mesh_release(&cube);
    skg_output_init(&output);
}

static void close_plan(void) {
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    skg_context_release(&context);
}

static skg_job *submit(float *pixels) {
    skg_job *job = NULL;
    output.data = pixels;
    ck_skg(skg_plan_submit(plan, FRAMES, NULL, 1, &output, &job));
    return job;
}

START_TEST(a_job_is_asked) {
    static float pixels[FRAMES * SIDE * SIDE];
    int32_t done = -1;
    skg_job *job = submit(pixels);
    do {
        ck_skg(skg_job_test(job, &done));
        ck_assert(done == 0 || done == 1);
    } while (!done);
    /* No wait between this and the answer: the images are in place. */
    ck_assert(pixels[(FRAMES - 1) * SIDE * SIDE] > 0);
    ck_skg(skg_job_test(job, &done));
    ck_assert_int_eq(done, 1);
    ck_skg(skg_job_wait(&job));
    ck_assert_ptr_null(job);
    ck_skg_fails(skg_job_test(NULL, &done), SKG_ERR_ARGUMENT, "skg_job_test");
    ck_skg_fails(skg_job_wait(&job), SKG_ERR_ARGUMENT, "skg_job_wait");
}
END_TEST

START_TEST(jobs_are_waited_for_in_any_order) {
    static float pixels[3][FRAMES * SIDE * SIDE];
    skg_job *jobs[3];
    for (int j = 0; j < 3; j++) jobs[j] = submit(pixels[j]);
    for (int j = 2; j >= 0; j--) ck_skg(skg_job_wait(&jobs[j]));
    for (int j = 1; j < 3; j++) ck_assert_mem_eq(pixels[j], pixels[0], sizeof pixels[0]);
    ck_assert(pixels[0][0] > 0);
}
END_TEST

START_TEST(a_job_keeps_what_it_needs) {
    static float pixels[2][FRAMES * SIDE * SIDE];
    skg_job *first = submit(pixels[0]), *second = NULL;
    ck_skg(skg_job_wait(&first));
    second = submit(pixels[1]);
    close_plan();
    ck_skg(skg_job_wait(&second));
    ck_assert_mem_eq(pixels[1], pixels[0], sizeof pixels[0]);
}
END_TEST

START_TEST(nodes_are_counted) {
    int64_t count = 0;
    double kev = 0;
    skg_plan_report report;
    skg_plan_report_init(&report);
    ck_skg(skg_plan_report_get(plan, &report));
    ck_skg(skg_plan_node_count(plan, &count));
    ck_assert_int_eq(count, 2);
    ck_assert_int_eq(count, report.nodes);
    ck_skg(skg_plan_node_get(plan, count - 1, &kev, NULL, NULL));
    ck_skg_fails(skg_plan_node_get(plan, count, &kev, NULL, NULL), SKG_ERR_ARGUMENT, "node 2 of 2");
}
END_TEST

START_TEST(the_version_is_told) {
    char text[64];
    const int number = skg_version_number();
    ck_assert_int_eq(number, SKG_VERSION_NUMBER);
    snprintf(text, sizeof text, "%d.%d.%d", number / 1000000, number / 1000 % 1000, number % 1000);
    ck_assert_str_eq(text, skg_version());
    ck_assert_str_eq(text, SKG_VERSION);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_plan, close_plan);
    tcase_add_test(tests, a_job_is_asked);
    tcase_add_test(tests, jobs_are_waited_for_in_any_order);
    tcase_add_test(tests, a_job_keeps_what_it_needs);
    tcase_add_test(tests, nodes_are_counted);
    tcase_add_test(tests, the_version_is_told);
}

SKG_SUITE_MAIN("jobs", add_tests)
