/* Frames that cannot be, changes that a plan cannot absorb, and what an image of several parts holds. */
#include "suite.h"
#include "support/run.h"

#include <limits.h>
#include <math.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SIDE = 40, PIXELS = SIDE * SIDE };

static skg_view view;
static skg_scene *scene;
static skg_mesh *box;
static skg_plan *plan;
static float pixels[2 * PIXELS];
static skg_output output;
static skg_frame frame;
static skg_job *job;

static void open_plan(void) {
    run_open();
    view = run_view(SIDE, 4);
    solid s = solid_box(60, 50, 40);
    box = run_mesh(&s);
    solid_free(&s);
    ck_skg(skg_scene_create(run_context, &scene));
    run_part(scene, "box", box, 0.2, NULL, -1);
    plan = run_plan(scene, &view, (run_choice){0});
    skg_output_init(&output);
    output.data = pixels;
    skg_frame_init(&frame);
    job = NULL;
}

static void close_plan(void) {
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    skg_mesh_release(&box);
    run_close();
}

/* The frame is refused, and the output is as it was. */
static void refused(int64_t count, skg_status status, const char *text) {
    for (int p = 0; p < 2 * PIXELS; p++) pixels[p] = -5;
    ck_skg_fails(skg_plan_submit(plan, count, &frame, 1, &output, &job), status, text);
    ck_assert_ptr_null(job);
    for (int p = 0; p < 2 * PIXELS; p++) ck_assert(pixels[p] == -5);
}

/* A good frame still works. */
static void still_good(void) {
    ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    ck_assert(pixels[PIXELS / 2] > 0);
}

START_TEST(arguments) {
    ck_skg_fails(skg_plan_submit(NULL, 1, &frame, 1, &output, &job), SKG_ERR_ARGUMENT, "plan");
    ck_skg_fails(skg_plan_submit(plan, 1, &frame, 1, NULL, &job), SKG_ERR_ARGUMENT, "output");
    ck_skg_fails(skg_plan_submit(plan, 1, &frame, 1, &output, NULL), SKG_ERR_ARGUMENT, "job");
    ck_skg_fails(skg_plan_image(plan, NULL), SKG_ERR_ARGUMENT, "output");
    output.kind = SKG_OUTPUT_LENGTHS;
    output.part = 1;
    ck_skg_fails(skg_plan_submit(plan, 1, &frame, 1, &output, &job), SKG_ERR_ARGUMENT, "part");
    output.part = -1;
    ck_skg_fails(skg_plan_submit(plan, 1, &frame, 1, &output, &job), SKG_ERR_ARGUMENT, "part");
    output.part = 0;
    output.lengths = 7;
    ck_skg_fails(skg_plan_submit(plan, 1, &frame, 1, &output, &job), SKG_ERR_ARGUMENT, "kind 7");
    output.kind = 99;
    ck_skg_fails(skg_plan_submit(plan, 1, &frame, 1, &output, &job), SKG_ERR_ARGUMENT,
                 "kind 99 is no SKG_OUTPUT_");
    output.kind = SKG_OUTPUT_IMAGE;
    ck_skg_fails(skg_plan_submit(plan, 1, &frame, 0, &output, &job), SKG_ERR_ARGUMENT, "no output");
    refused(0, SKG_ERR_ARGUMENT, "frames");
    refused(-3, SKG_ERR_ARGUMENT, "frames");
    const skg_output good = output;
    output.data = NULL;
    refused(1, SKG_ERR_ARGUMENT, "memory");
    output = good;
    output.type = 9;
    refused(1, SKG_ERR_ARGUMENT, "type");
    output = good;
    output.row_stride = SIDE - 1;
    refused(1, SKG_ERR_ARGUMENT, "row stride");
    output.row_stride = -SIDE;
    refused(1, SKG_ERR_ARGUMENT, "row stride");
    output.row_stride = INT64_MAX / 2; /* times the rows: beyond any integer */
    refused(1, SKG_ERR_ARGUMENT, "stride");
    output = good;
    output.channel_stride = PIXELS - 1;
    refused(1, SKG_ERR_ARGUMENT, "channel stride");
    output = good;
    output.frame_stride = PIXELS - 1;
    refused(2, SKG_ERR_ARGUMENT, "frame stride");
    output = good;
    still_good();
}
END_TEST

START_TEST(poses_and_views) {
    double pose[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    int64_t id = 1;
    frame.pose_count = 1;
    refused(1, SKG_ERR_ARGUMENT, "pose");
    frame.pose_parts = &id;
    frame.poses = pose;
    refused(1, SKG_ERR_ARGUMENT, "part");
    id = 0;
    pose[10] = 0;
    refused(1, SKG_ERR_SCENE, "box");
    pose[10] = (double)NAN;
    refused(1, SKG_ERR_SCENE, "box");
    pose[10] = 1;
    frame.pose_count = -1;
    refused(1, SKG_ERR_ARGUMENT, "-1");
    frame.pose_count = 0;
    skg_view other = view;
    frame.view = &other;
    other.source[2] = 200; /* on the detector */
    refused(1, SKG_ERR_SCENE, "source");
    other = view;
    other.columns = SIDE + 1;
    refused(1, SKG_STALE, "41");
    ck_skg_fails(skg_plan_view_set(plan, &other), SKG_STALE, "41");
    other.columns = SIDE;
    still_good();
}
END_TEST

START_TEST(changes_of_the_scene) {
    still_good();
    run_part(scene, "another", box, 0.1, NULL, -1);
    refused(1, SKG_STALE, "plan");
    ck_assert_int_eq(skg_plan_image(plan, &output), SKG_STALE);
    skg_plan_release(&plan);
    plan = run_plan(scene, &view, (run_choice){0});
    still_good();
}
END_TEST

START_TEST(a_vertex_that_is_not_finite) {
    float *offsets = NULL;
    const double *origin = NULL;
    ck_skg(skg_mesh_offsets_get(box, &offsets, &origin));
    const float kept = offsets[3 * 5 + 1];
    offsets[3 * 5 + 1] = NAN;
    (void)skg_mesh_offsets_moved(box);
    skg_status status = skg_plan_submit(plan, 1, &frame, 1, &output, &job);
    if (status == SKG_OK) status = skg_job_wait(&job); /* found by the host or by the device */
    ck_assert_int_eq(status, SKG_ERR_MESH);
    ck_assert_msg(strstr(skg_last_error(), "box") && strstr(skg_last_error(), "5"), "%s", skg_last_error());
    ck_assert_ptr_null(job);
    offsets[3 * 5 + 1] = kept;
    ck_skg(skg_mesh_offsets_moved(box));
    still_good();
}
END_TEST

enum { MANY = 1000, BAD = 617 };

/* Frames whose part turns a little further each time; one of them is `far` mm away. */
static void turn(skg_frame *frames, double (*poses)[16], double far) {
    static const int64_t id = 0;
    for (int n = 0; n < MANY; n++) {
        const double c = cos(0.01 * n), s = sin(0.01 * n);
        const double pose[16] = {c, -s, 0, n == BAD ? far : 0, s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        memcpy(poses[n], pose, sizeof pose);
        skg_frame_init(&frames[n]);
        frames[n].pose_parts = &id;
        frames[n].poses = poses[n];
        frames[n].pose_count = 1;
    }
}

/* Frames are independent: one that cannot be is named, and changes no bit of the others nor of later jobs. */
START_TEST(one_bad_frame_in_a_thousand) {
    static float good[MANY][PIXELS], with[MANY][PIXELS];
    static skg_frame frames[MANY];
    static double poses[MANY][16];
    turn(frames, poses, 0);
    output.data = good;
    ck_skg(skg_plan_submit(plan, MANY, frames, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    turn(frames, poses, 1e60);
    output.data = with;
    ck_skg(skg_plan_submit(plan, MANY, frames, 1, &output, &job));
    ck_skg_fails(skg_job_wait(&job), SKG_ERR_MESH, "frame 617: part box: vertex 0 ");
    for (int n = 0; n < MANY; n++)
        if (n != BAD) ck_assert_msg(memcmp(with[n], good[n], sizeof good[n]) == 0, "frame %d", n);
    output.data = pixels;
    ck_skg(skg_plan_submit(plan, 1, &frames[BAD], 1, &output, &job));
    ck_skg_fails(skg_job_wait(&job), SKG_ERR_MESH, "part box: vertex 0 ");
    ck_skg(skg_plan_submit(plan, 1, &frames[0], 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    ck_assert_int_eq(memcmp(pixels, good[0], sizeof good[0]), 0);
}
END_TEST

/* A child of fork cannot use the context: a call returns an error at once and does not hang. */
START_TEST(a_fork) {
    const pid_t child = fork();
    if (child == 0) {
        const skg_status status = skg_plan_submit(plan, 1, &frame, 1, &output, &job);
        _exit(status == SKG_ERR_FORK && job == NULL ? 0 : 1);
    }
    int status = -1;
    ck_assert_int_gt(child, 0);
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    still_good();
}
END_TEST

START_TEST(structs_of_other_sizes) {
    struct {
        skg_output output;
        int64_t more;
    } newer = {.output = output};
    newer.output.size = (int32_t)sizeof newer;
    ck_skg(skg_plan_image(plan, &newer.output)); /* zero: the default of what we do not know */
    newer.more = 1;
    ck_skg_fails(skg_plan_image(plan, &newer.output), SKG_ERR_ARGUMENT, "skg_output");
    output.size = 0;
    ck_assert_int_lt(skg_plan_image(plan, &output), SKG_OK);
}
END_TEST

extern char **environ;

START_TEST(the_environment_stays) {
    char *before[512];
    int count = 0;
    for (; environ[count] && count < 511; count++) before[count] = strdup(environ[count]);
    still_good();
    close_plan();
    open_plan();
    still_good();
    for (int n = 0; n < count; n++) {
        ck_assert_str_eq(environ[n], before[n]);
        free(before[n]);
    }
    ck_assert_ptr_null(environ[count]);
}
END_TEST

/* --- what an image holds --------------------------------------------------------------------------------- */

/* A ball in a box: lengths are net of children or the mesh's own, and the image is exp(-sum mu L) of the net
 * ones. */
START_TEST(nested_parts_and_quantities) {
    static float lengths[3][PIXELS], image[PIXELS];
    const double mu[2] = {0.02, 0.05}, open[5] = {100, 100 / 16.0, 1, 1, 0}; /* per mm; pixels of 16 mm2 */
    solid s = solid_sphere(15, 24, 12);
    skg_mesh *ball = run_mesh(&s);
    solid_free(&s);
    run_part(scene, "ball", ball, 0.5, NULL, 0);
    skg_mesh_release(&ball);
    for (int32_t quantity = SKG_QUANTITY_ENERGY; quantity <= SKG_QUANTITY_ATTENUATION; quantity++) {
        skg_plan_release(&plan);
        plan = run_plan(scene, &view, (run_choice){.quantity = quantity});
        const int32_t kinds[3] = {SKG_LENGTHS_NET, SKG_LENGTHS_NET, SKG_LENGTHS_SURFACE};
        for (int n = 0; n < 3; n++) {
            output.data = lengths[n];
            output.kind = SKG_OUTPUT_LENGTHS;
            output.part = n % 2;
            output.lengths = kinds[n];
            ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
            ck_skg(skg_job_wait(&job));
        }
        output.kind = SKG_OUTPUT_IMAGE;
        output.data = image;
        ck_skg(skg_plan_image(plan, &output));
        for (int p = 0; p < PIXELS; p++) {
            const double exponent = mu[0] * (double)lengths[0][p] + mu[1] * (double)lengths[1][p];
            const double expected =
                quantity == SKG_QUANTITY_ATTENUATION ? exponent : open[quantity] * exp(-exponent);
            /* The net length is the surface's less the child's: floats of 60 mm. Exponents up to 2. */
            ck_assert_double_eq_tol((double)lengths[2][p], (double)lengths[0][p] + (double)lengths[1][p],
                                    60 * 0x1p-21);
            /* 16 to 24 roundings of single precision, of the largest of what is summed. */
            ck_assert_double_eq_tol((double)image[p], expected, 3e-6 * fmax(expected, 1e-6 + open[quantity]));
        }
    }
}
END_TEST

/* A part that attenuates as its parent does is not seen; a child where its parent is not counts below zero,
 * and is reported. */
START_TEST(invisible_and_negative) {
    static float alone[PIXELS], with[PIXELS];
    skg_plan_report report;
    double aside[16] = {1, 0, 0, 70, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    solid s = solid_sphere(15, 24, 12);
    skg_mesh *ball = run_mesh(&s);
    solid_free(&s);
    output.data = alone;
    ck_skg(skg_plan_image(plan, &output));
    run_part(scene, "ball", ball, 0.2, NULL, 0);
    skg_plan_release(&plan);
    plan = run_plan(scene, &view, (run_choice){0});
    output.data = with;
    ck_skg(skg_plan_image(plan, &output));
    for (int p = 0; p < PIXELS; p++)
        ck_assert_double_eq_tol((double)with[p], (double)alone[p],
                                100 * 0x1p-21); /* another scale: other rounding */
    skg_plan_report_init(&report);
    ck_skg(skg_plan_report_get(plan, &report));
    ck_assert_int_eq(report.negative_pixels, 0);
    run_part(scene, "hole", ball, 0, aside, 0); /* beside the box that it is said to lie in */
    skg_plan_release(&plan);
    plan = run_plan(scene, &view, (run_choice){.quantity = SKG_QUANTITY_ATTENUATION});
    ck_skg(skg_plan_image(plan, &output));
    int64_t negative = 0;
    for (int p = 0; p < PIXELS; p++) negative += with[p] < -1e-5F;
    ck_skg(skg_plan_report_get(plan, &report));
    ck_assert_int_gt(negative, 0);
    ck_assert_int_eq(report.negative_pixels, negative);
    skg_mesh_release(&ball);
}
END_TEST

/* A box thinner than the water around it, from a place and from infinity: it takes from the world, and no more than there is. */
START_TEST(thinner_than_the_world) {
    static const int32_t shown[] = {SKG_QUANTITY_ATTENUATION, SKG_QUANTITY_ATTENUATION, SKG_QUANTITY_PHOTONS};
    skg_plan_options options;
    skg_plan_report report;
    skg_spectrum *beam = NULL;
    skg_plan_options_init(&options);
    skg_plan_report_init(&report);
    ck_skg(skg_material_create_named("Water", &options.world));
    ck_skg(skg_spectrum_create_mono(30, 1e6, &beam));
    for (int k = 0; k < 3; k++) {
        view.projection = k == 0 ? SKG_PROJECTION_PARALLEL_FROM_INFINITY : SKG_PROJECTION_POINT;
        view.source[2] = k == 0 ? 1 : -1000; /* a direction, then a place */
        options.quantity = shown[k];
        skg_plan_release(&plan);
        ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &plan));
        ck_skg(skg_plan_image(plan, &output));
        ck_skg(skg_plan_report_get(plan, &report));
        ck_assert_int_eq(report.negative_pixels, 0);
        /* 0.2 and 0.3756 per cm (NIST SRD 126, liquid water at 30 keV) over 4 cm; rays are oblique */
        if (k < 2) ck_assert_double_eq_tol((double)pixels[SIDE / 2 * (SIDE + 1)], (0.2 - 0.3756) * 4, 0.01);
    }
    skg_spectrum_release(&beam);
    skg_material_release(&options.world);
}
END_TEST

static void keep(int32_t level, const char *sentence, void *user) {
    char *kept = user;
    if (level == SKG_LOG_WARNING && strstr(sentence, "over itself")) snprintf(kept, 64, "%s", sentence);
}

/* A prism over the star {7/3}, whose middle has three layers, with a spike so long that the columns of the mesh miss the middle: sums
 * wrap, and that is said. Nothing is said of the star alone, and its lengths are right. */
START_TEST(sums_that_wrap_are_said) {
    for (int spike = 0; spike < 2; spike++) {
        char said[64] = "";
        solid s = solid_star(7, 3, 15, 16);
        if (spike) s.positions[0] = s.positions[21] = 3000;
        skg_mesh *star = run_mesh(&s);
        solid_free(&s);
        skg_scene *own = NULL;
        ck_skg(skg_scene_create(run_context, &own));
        ck_skg(skg_context_log_set(run_context, keep, said));
        run_part(own, "star", star, 0.2, NULL, -1);
        skg_plan_release(&plan);
        plan = run_plan(own, &view, (run_choice){.quantity = SKG_QUANTITY_ATTENUATION});
        ck_assert_int_eq(skg_plan_image(plan, &output), spike ? SKG_RANGE : SKG_OK);
        ck_assert_int_eq(said[0] != 0, spike);
        float most = 0;
        for (int p = 0; p < PIXELS; p++) most = fmaxf(most, pixels[p]);
        if (!spike) ck_assert_double_eq_tol((double)most, 3 * 16 * 0.02, 1e-3); /* rays are oblique */
        ck_skg(skg_context_log_set(run_context, NULL, NULL));
        skg_plan_release(&plan);
        skg_scene_release(&own);
        skg_mesh_release(&star);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_plan, close_plan);
    tcase_add_test(tests, arguments);
    tcase_add_test(tests, poses_and_views);
    tcase_add_test(tests, changes_of_the_scene);
    tcase_add_test(tests, a_vertex_that_is_not_finite);
    tcase_add_test(tests, one_bad_frame_in_a_thousand);
    tcase_add_test(tests, a_fork);
    tcase_add_test(tests, structs_of_other_sizes);
    tcase_add_test(tests, the_environment_stays);
    tcase_add_test(tests, nested_parts_and_quantities);
    tcase_add_test(tests, invisible_and_negative);
    tcase_add_test(tests, thinner_than_the_world);
    tcase_add_test(tests, sums_that_wrap_are_said);
}

SKG_SUITE_MAIN("frames_bad", add_tests)
