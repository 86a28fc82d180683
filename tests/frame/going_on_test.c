/* Jobs that go on by themselves: of the scene as it was submitted, whether anybody asks or not, into several outputs, in steps. */
#include "jobs.h"

#include <skiagraph/opencl.h>

#include <math.h>
#include <string.h>
#include <time.h>

/* Frames that are given to the device while the job is waited for show the scene as it was submitted. */
START_TEST(the_scene_of_the_submission) {
    static const double away[16] = {1, 0, 0, 5, 0, 1, 0, 3, 0, 0, 1, 0, 0, 0, 0, 1};
    int64_t vertices = 0, triangles = 0;
    skg_job *job = jobs_submit();
    ck_skg(skg_scene_part_pose_set(jobs_scene, 0, away));
    ck_skg(skg_mesh_count(jobs_ball, &vertices, &triangles));
    double *positions = malloc((size_t)(3 * vertices) * sizeof *positions);
    ck_skg(skg_mesh_positions_get(jobs_ball, positions, 0));
    for (int64_t i = 0; i < 3 * vertices; i++) positions[i] = 1.5 * positions[i] + 100;
    ck_skg(skg_mesh_positions_set(jobs_ball, positions, 0));
    free(positions);
    skg_plan_release(&jobs_plan);
    ck_skg(skg_job_wait(&job));
    jobs_check(jobs_frames);
}
END_TEST

/* The caller's frames, with their views and poses, may be written as soon as they are submitted. */
START_TEST(the_frames_of_the_submission) {
    skg_frame *given = calloc((size_t)jobs_frames, sizeof *given);
    skg_view *views = calloc((size_t)jobs_frames, sizeof *views);
    double *poses = calloc((size_t)jobs_frames, 16 * sizeof *poses);
    const int64_t part = 0;
    float *expected = malloc((size_t)(jobs_frames * PIXELS) * sizeof *expected);
    skg_output output = jobs_output(expected);
    skg_job *job = NULL, *later = NULL;
    for (int64_t f = 0; f < jobs_frames; f++) {
        views[f] = jobs_view;
        views[f].source[0] = (double)(f % 7);
        for (int k = 0; k < 4; k++) poses[16 * f + 5 * k] = 1;
        poses[16 * f + 3] = 0.1 * (double)(f % 5);
        skg_frame_init(&given[f]);
        given[f].view = &views[f];
        given[f].pose_count = 1, given[f].pose_parts = &part, given[f].poses = poses + 16 * f;
        given[f].index = f;
    }
    for (int64_t f = 0; f < jobs_frames && f < 35; f++) { /* then they repeat */
        output.data = expected + f * PIXELS;
        ck_skg(skg_plan_submit(jobs_plan, 1, given + f, 1, &output, &job));
        ck_skg(skg_job_wait(&job));
    }
    output = jobs_output(jobs_pixels);
    ck_skg(skg_plan_submit(jobs_plan, jobs_frames, given, 1, &output, &job));
    memset(given, 0, (size_t)jobs_frames * sizeof *given);
    memset(views, 0, (size_t)jobs_frames * sizeof *views);
    memset(poses, 0, (size_t)jobs_frames * 16 * sizeof *poses);
    static float again[PIXELS];
    output = jobs_output(again); /* the frames that were held back come before this one */
    ck_skg(skg_plan_submit(jobs_plan, 1, NULL, 1, &output, &later));
    ck_skg(skg_job_wait(&later));
    ck_assert_mem_eq(again, jobs_reference, sizeof again);
    ck_skg(skg_job_wait(&job));
    for (int64_t f = 0; f < jobs_frames; f++)
        ck_assert_mem_eq(jobs_pixels + f * PIXELS, expected + f % 35 * PIXELS, sizeof again);
    free(expected);
    free(poses);
    free(views);
    free(given);
}
END_TEST

/* Enough to move the scene's memory. */
static void add_parts(void) {
    char label[16];
    solid s = solid_sphere(5, 8, 4);
    skg_mesh *more = run_mesh(&s);
    solid_free(&s);
    for (int k = 0; k < 20; k++) {
        snprintf(label, sizeof label, "more %d", k);
        run_part(jobs_scene, label, more, 0.1, NULL, -1);
    }
    skg_mesh_release(&more);
}

START_TEST(a_part_that_is_added_later) {
    skg_job *job = jobs_submit();
    add_parts();
    ck_skg(skg_job_wait(&job));
    jobs_check(jobs_frames);
    {
        const skg_output output = jobs_output(jobs_pixels);
        ck_skg_fails(skg_plan_submit(jobs_plan, 1, NULL, 1, &output, &job), SKG_STALE, "make a new plan");
    }
    skg_plan_release(&jobs_plan);
    jobs_plan = jobs_fine_plan();
}
END_TEST

/* Frames, and steps of one: all are made without a call, of the scene as it was, while it and its mesh change. */
START_TEST(nobody_asks) {
    static const double away[16] = {1, 0, 0, 5, 0, 1, 0, 3, 0, 0, 1, 0, 0, 0, 0, 1};
    static float whole[PIXELS];
    int64_t vertices = 0, triangles = 0;
    skg_plan *slow = jobs_long_plan(0);
    skg_output output = jobs_output(whole);
    skg_job *job = NULL;
    ck_skg(skg_plan_image(slow, &output));
    ck_skg(skg_mesh_count(jobs_ball, &vertices, &triangles));
    double *positions = malloc((size_t)(3 * vertices) * sizeof *positions);
    ck_skg(skg_mesh_positions_get(jobs_ball, positions, 0));
    if (_i) {
        output = jobs_output(jobs_pixels);
        ck_skg(skg_plan_submit(slow, 1, NULL, 1, &output, &job));
    } else {
        job = jobs_submit();
    }
    ck_skg(skg_scene_part_pose_set(jobs_scene, 0, away));
    add_parts();
    for (int64_t i = 0; i < 3 * vertices; i++) positions[i] = 1.5 * positions[i] + 100;
    ck_skg(skg_mesh_positions_set(jobs_ball, positions, 0));
    free(positions);
    skg_plan_report report;
    skg_plan_report_init(&report);
    ck_skg(skg_plan_report_get(_i ? slow : jobs_plan, &report));
    jobs_look_only(_i ? jobs_pixels + PIXELS - 1 : jobs_pixels + (jobs_frames - 1) * PIXELS);
    ck_skg(skg_job_wait(&job));
    if (_i)
        ck_assert_mem_eq(jobs_pixels, whole, sizeof whole);
    else
        jobs_check(jobs_frames);
    skg_plan_release(&slow);
}
END_TEST

/* The program ends while frames are left: the thread that goes on with them must not meet a driver that is gone. */
START_TEST(the_program_ends) {
    const struct timespec pause = {0, 1000000 * (17 * _i % 50)};
    (void)jobs_submit();
    nanosleep(&pause, NULL);
    exit(0);
}
END_TEST

/* Each output of a list has the bits that it has alone, in any order. */
START_TEST(several_outputs) {
    enum { FRAMES = 3, OUTPUTS = 4 };
    static float alone[OUTPUTS][FRAMES * PIXELS], together[OUTPUTS][FRAMES * PIXELS];
    skg_output outputs[OUTPUTS];
    skg_frame some[FRAMES];
    skg_view views[FRAMES];
    skg_job *job = NULL;
    solid s = solid_sphere(5, 8, 4);
    skg_mesh *inner = run_mesh(&s);
    solid_free(&s);
    run_part(jobs_scene, "inner", inner, 0.9, NULL, 0);
    skg_mesh_release(&inner);
    skg_plan_release(&jobs_plan);
    jobs_plan = jobs_fine_plan();
    for (int f = 0; f < FRAMES; f++) {
        views[f] = jobs_view;
        views[f].source[1] = 10 * f;
        skg_frame_init(&some[f]);
        some[f].view = &views[f];
    }
    for (int o = 0; o < OUTPUTS; o++) {
        outputs[o] = jobs_output(alone[o]);
        if (o == 1) continue; /* the image stands between lengths */
        outputs[o].kind = SKG_OUTPUT_LENGTHS;
        outputs[o].part = o == 2;
        outputs[o].lengths = o == 3 ? SKG_LENGTHS_SURFACE : SKG_LENGTHS_NET;
    }
    for (int o = 0; o < OUTPUTS; o++) {
        ck_skg(skg_plan_submit(jobs_plan, FRAMES, some, 1, &outputs[o], &job));
        ck_skg(skg_job_wait(&job));
        outputs[o].data = together[o];
    }
    ck_skg(skg_plan_submit(jobs_plan, FRAMES, some, OUTPUTS, outputs, &job));
    ck_skg(skg_job_wait(&job));
    ck_assert_mem_eq(together, alone, sizeof alone);
    const int middle = SIDE / 2 * SIDE +
                       SIDE / 2; /* the outer part's net length is that of its surface less the inner part */
    const double net = (double)alone[0][middle] + (double)alone[2][middle];
    ck_assert_double_eq_tol(net, (double)alone[3][middle], 1e-5 * net); /* a few roundings of float */
    ck_assert(alone[2][middle] > 9);
}
END_TEST

/* A frame in steps has the bits of one that is given whole, beside another output, however it is asked, and of the scene as it was. */
START_TEST(steps_do_not_change_bits) {
    static const double away[16] = {1, 0, 0, 5, 0, 1, 0, 3, 0, 0, 1, 0, 0, 0, 0, 1};
    static float whole[2 * PIXELS], steps[2 * PIXELS], lengths[2 * PIXELS], again[PIXELS];
    skg_plan *slow = jobs_long_plan(0);
    skg_output outputs[2] = {jobs_output(steps), jobs_output(lengths)}, output = jobs_output(whole);
    skg_job *job = NULL, *later = NULL;
    cl_event event = NULL;
    outputs[1].kind = SKG_OUTPUT_LENGTHS;
    ck_skg(skg_plan_submit_cl(slow, 2, NULL, 1, &output, 0, NULL, &event, &job)); /* all at once */
    ck_skg(skg_job_wait(&job));
    clReleaseEvent(event);
    ck_skg(skg_plan_submit(slow, 2, NULL, 2, outputs, &job));
    ck_skg(skg_scene_part_pose_set(jobs_scene, 0, away));
    if (_i) { /* another job comes in between */
        output = jobs_output(again);
        ck_skg(skg_plan_submit(jobs_plan, 1, NULL, 1, &output, &later));
        ck_skg(skg_job_wait(&later));
    }
    ck_skg(skg_job_wait(&job));
    ck_assert_mem_eq(steps, whole, sizeof whole);
    ck_assert_mem_eq(lengths, lengths + PIXELS, sizeof again);
    skg_plan_release(&slow);
}
END_TEST

/* The variance of a logarithm is made in the steps of a mean and its own. */
START_TEST(steps_of_a_variance) {
    static float whole[PIXELS], steps[PIXELS];
    skg_plan *slow = jobs_long_plan(1);
    skg_output output = jobs_output(whole);
    skg_job *job = NULL;
    output.kind = SKG_OUTPUT_VARIANCE;
    ck_skg(skg_plan_submit_cl(slow, 1, NULL, 1, &output, 0, NULL, NULL, &job)); /* all at once */
    ck_skg(skg_job_wait(&job));
    output.data = steps;
    ck_skg(skg_plan_submit(slow, 1, NULL, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    ck_assert(whole[PIXELS / 2 + SIDE / 2] > 0);
    ck_assert_mem_eq(steps, whole, sizeof whole);
    skg_plan_release(&slow);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, jobs_open, jobs_close);
    tcase_add_test(tests, the_scene_of_the_submission);
    tcase_add_test(tests, the_frames_of_the_submission);
    tcase_add_test(tests, a_part_that_is_added_later);
    tcase_add_loop_test(tests, nobody_asks, 0, 2);
    tcase_add_loop_exit_test(tests, the_program_ends, 0, 0, 10);
    tcase_add_test(tests, several_outputs);
    tcase_add_loop_test(tests, steps_do_not_change_bits, 0, 2);
    tcase_add_test(tests, steps_of_a_variance);
}

SKG_SUITE_MAIN("going_on", add_tests)
