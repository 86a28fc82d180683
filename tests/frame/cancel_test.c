/* Jobs that are cancelled, frames that are given to the device after their submission, and lists of outputs. */
#include "suite.h"
#include "support/run.h"

#include <skiagraph/opencl.h>

#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>

/* Of 24 x 24 pixels with 16 x 16 rays each a core is given some 170 frames at once (lib/frame/submission.c). */
enum { SIDE = 24, PIXELS = SIDE * SIDE, FINE = 16, FRAMES_PER_CORE = 300, UNTOUCHED = -77 };

static skg_view view;
static skg_scene *scene;
static skg_mesh *ball;
static skg_plan *plan;
static int64_t frames;
static float *pixels, reference[PIXELS];

static skg_output output_of(float *to) {
    skg_output output;
    skg_output_init(&output);
    output.data = to;
    return output;
}

/* samples: of the source; 0: a point. noise: 1: -ln of images with noise. */
static skg_plan *plan_of(int32_t samples, int32_t noise) {
    skg_plan *made = NULL;
    skg_plan_options options;
    skg_spot spot;
    skg_spectrum *beam = NULL;
    skg_plan_options_init(&options);
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_DISC;
    spot.extent[0] = 1;
    spot.samples = samples;
    if (samples) options.spot = &spot;
    options.noise = noise;
    if (noise) options.quantity = SKG_QUANTITY_ATTENUATION;
    options.supersampling = FINE;
    options.overlaps = 0;
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &made));
    skg_spectrum_release(&beam);
    return made;
}

static skg_plan *fine_plan(void) {
    return plan_of(0, 0);
}

static void open_plan(void) {
    skg_device_info device;
    run_open();
    view = run_view(SIDE, 2);
    solid s = solid_sphere(15, 24, 12);
    ball = run_mesh(&s);
    solid_free(&s);
    ck_skg(skg_scene_create(run_context, &scene));
    run_part(scene, "ball", ball, 0.5, NULL, -1);
    plan = fine_plan();
    const skg_output output = output_of(reference);
    ck_skg(skg_plan_image(plan, &output));
    skg_device_info_init(&device);
    ck_skg(skg_context_device_get(run_context, &device));
    frames = FRAMES_PER_CORE * (device.cpu ? device.compute_units : 1);
    pixels = malloc((size_t)(frames * PIXELS) * sizeof *pixels);
    for (int64_t i = 0; i < frames * PIXELS; i++) pixels[i] = UNTOUCHED;
}

static void close_plan(void) {
    free(pixels);
    skg_plan_release(&plan);
    skg_mesh_release(&ball);
    skg_scene_release(&scene);
    run_close();
}

static skg_job *submit(void) {
    const skg_output output = output_of(pixels);
    skg_job *job = NULL;
    ck_skg(skg_plan_submit(plan, frames, NULL, &output, &job));
    return job;
}

/* The first `count` frames hold the reference, and the others nothing. */
static void check_images(int64_t count) {
    for (int64_t f = 0; f < frames; f++) {
        const float *image = pixels + f * PIXELS;
        if (f < count) ck_assert_msg(memcmp(image, reference, sizeof reference) == 0, "frame %d", (int)f);
        for (int p = 0; f >= count && p < PIXELS; p++) ck_assert(image[p] == UNTOUCHED);
    }
}

/* A job goes on by itself, so that it may have come to its end before it is cancelled: so often a test tries again. */
enum { TRIES = 50 };

/* Waits for a job that was cancelled, and returns how many frames are in place; 0 if the job came to its end before. */
static int64_t wait_cancelled(skg_job **job) {
    int made = -1, all = -1;
    const skg_status status = skg_job_wait(job);
    ck_assert_ptr_null(*job);
    if (status == SKG_OK) {
        check_images(frames);
        for (int64_t i = 0; i < frames * PIXELS; i++) pixels[i] = UNTOUCHED;
        return 0;
    }
    ck_assert_int_eq(status, SKG_ERR_CANCELLED);
    ck_assert_int_eq(sscanf(skg_last_error(), "the job was cancelled: %d of %d frames", &made, &all), 2);
    ck_assert_int_eq(all, frames);
    ck_assert(made >= 2 && made < frames);
    return made;
}

static int holds_frames(void) {
    skg_device_info device;
    skg_device_info_init(&device);
    ck_skg(skg_context_device_get(run_context, &device));
    return device.cpu; /* a GPU is given more frames at once than a test can wait for */
}

START_TEST(cancelled_at_once) {
    int64_t made = 0;
    if (!holds_frames()) return;
    for (int k = 0; k < TRIES && made == 0; k++) {
        skg_job *job = submit();
        int32_t done = -1;
        ck_skg(skg_job_cancel(job));
        ck_skg(skg_job_cancel(job));
        ck_skg(skg_job_test(job, &done));
        made = wait_cancelled(&job);
    }
    ck_assert_int_gt(made, 0);
    check_images(made);
    /* later jobs are not touched */
    static float again[PIXELS];
    const skg_output output = output_of(again);
    ck_skg(skg_plan_image(plan, &output));
    ck_assert_mem_eq(again, reference, sizeof again);
}
END_TEST

static void *cancel(void *job) {
    ck_skg(skg_job_cancel(job));
    return NULL;
}

static skg_job *interrupted;

static void cancel_in_handler(int number) {
    (void)number;
    (void)skg_job_cancel(interrupted);
}

/* Cancels by another thread, or by the handler of a signal. */
static void cancel_from(int handler, skg_job *job) {
    pthread_t thread;
    if (handler) {
        interrupted = job;
        ck_assert(signal(SIGUSR1, cancel_in_handler) != SIG_ERR);
        ck_assert_int_eq(raise(SIGUSR1), 0);
    } else {
        ck_assert_int_eq(pthread_create(&thread, NULL, cancel, job), 0);
        pthread_join(thread, NULL);
    }
}

/* Another job is not touched. */
START_TEST(cancelled_in_the_middle) {
    int64_t made = 0;
    if (!holds_frames()) return;
    for (int k = 0; k < TRIES && made == 0; k++) {
        skg_job *job = submit(), *later = NULL;
        int64_t done = 0, total = 0, before = 0;
        int32_t is_done = -1;
        while (done < 3) {
            ck_skg(skg_job_progress(job, &done, &total));
            ck_assert(done >= before && total == frames);
            before = done;
        }
        ck_skg(skg_job_test(job, &is_done));
        ck_assert(is_done == 0 || is_done == 1);
        cancel_from(_i, job);
        static float again[PIXELS];
        const skg_output output = output_of(again);
        ck_skg(skg_plan_submit(plan, 1, NULL, &output, &later));
        ck_skg(skg_job_wait(&later));
        ck_assert_mem_eq(again, reference, sizeof again);
        ck_skg(skg_job_progress(job, &done, NULL));
        made = wait_cancelled(&job);
        ck_assert(made == done || (made == 0 && done == total));
    }
    ck_assert_int_gt(made, 0);
    check_images(made);
}
END_TEST

START_TEST(cancelled_after_the_end) {
    skg_job *job = submit();
    int32_t done = 0;
    int64_t count = 0;
    while (!done) ck_skg(skg_job_test(job, &done));
    ck_skg(skg_job_cancel(job));
    ck_skg(skg_job_progress(job, &count, NULL));
    ck_assert_int_eq(count, frames);
    ck_skg(skg_job_wait(&job));
    check_images(frames);
    ck_skg_fails(skg_job_cancel(NULL), SKG_ERR_ARGUMENT, "job");
    ck_skg_fails(skg_job_progress(NULL, &count, NULL), SKG_ERR_ARGUMENT, "job");
}
END_TEST

/* Frames that are given to the device while the job is waited for show the scene as it was submitted. */
START_TEST(the_scene_of_the_submission) {
    static const double away[16] = {1, 0, 0, 5, 0, 1, 0, 3, 0, 0, 1, 0, 0, 0, 0, 1};
    int64_t vertices = 0, triangles = 0;
    skg_job *job = submit();
    ck_skg(skg_scene_part_pose_set(scene, 0, away));
    ck_skg(skg_mesh_count(ball, &vertices, &triangles));
    double *positions = malloc((size_t)(3 * vertices) * sizeof *positions);
    ck_skg(skg_mesh_positions_get(ball, positions, 0));
    for (int64_t i = 0; i < 3 * vertices; i++) positions[i] = 1.5 * positions[i] + 100;
    ck_skg(skg_mesh_positions_set(ball, positions, 0));
    free(positions);
    skg_plan_release(&plan);
    ck_skg(skg_job_wait(&job));
    check_images(frames);
}
END_TEST

/* The caller's frames, with their views and poses, may be written as soon as they are submitted. */
START_TEST(the_frames_of_the_submission) {
    skg_frame *given = calloc((size_t)frames, sizeof *given);
    skg_view *views = calloc((size_t)frames, sizeof *views);
    double *poses = calloc((size_t)frames, 16 * sizeof *poses);
    const int64_t part = 0;
    float *expected = malloc((size_t)(frames * PIXELS) * sizeof *expected);
    skg_output output = output_of(expected);
    skg_job *job = NULL, *later = NULL;
    for (int64_t f = 0; f < frames; f++) {
        views[f] = view;
        views[f].source[0] = (double)(f % 7);
        for (int k = 0; k < 4; k++) poses[16 * f + 5 * k] = 1;
        poses[16 * f + 3] = 0.1 * (double)(f % 5);
        skg_frame_init(&given[f]);
        given[f].view = &views[f];
        given[f].pose_count = 1, given[f].pose_parts = &part, given[f].poses = poses + 16 * f;
        given[f].index = f;
    }
    for (int64_t f = 0; f < frames && f < 35; f++) { /* then they repeat */
        output.data = expected + f * PIXELS;
        ck_skg(skg_plan_submit(plan, 1, given + f, &output, &job));
        ck_skg(skg_job_wait(&job));
    }
    output = output_of(pixels);
    ck_skg(skg_plan_submit(plan, frames, given, &output, &job));
    memset(given, 0, (size_t)frames * sizeof *given);
    memset(views, 0, (size_t)frames * sizeof *views);
    memset(poses, 0, (size_t)frames * 16 * sizeof *poses);
    static float again[PIXELS];
    output = output_of(again); /* the frames that were held back come before this one */
    ck_skg(skg_plan_submit(plan, 1, NULL, &output, &later));
    ck_skg(skg_job_wait(&later));
    ck_assert_mem_eq(again, reference, sizeof again);
    ck_skg(skg_job_wait(&job));
    for (int64_t f = 0; f < frames; f++)
        ck_assert_mem_eq(pixels + f * PIXELS, expected + f % 35 * PIXELS, sizeof again);
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
        run_part(scene, label, more, 0.1, NULL, -1);
    }
    skg_mesh_release(&more);
}

START_TEST(a_part_that_is_added_later) {
    skg_job *job = submit();
    add_parts();
    ck_skg(skg_job_wait(&job));
    check_images(frames);
    {
        const skg_output output = output_of(pixels);
        ck_skg_fails(skg_plan_submit(plan, 1, NULL, &output, &job), SKG_STALE, "make a new plan");
    }
    skg_plan_release(&plan);
    plan = fine_plan();
}
END_TEST

/* One frame of so many samples of the source that it is given to the device in some 20 steps of 50 ms (lib/frame/submission.c), four
 * at a time; the noise of a sample does not matter here. */
static skg_plan *long_plan(int32_t noise) {
    enum { SAMPLES_PER_CORE = 340 };
    return plan_of((int32_t)(SAMPLES_PER_CORE * frames / FRAMES_PER_CORE), noise);
}

/* Waits until the device has written there, without any call of the library. */
static void look_only(const float *pixel) {
    const struct timespec pause = {0, 1000000};
    const volatile float *seen = pixel;
    for (int k = 0; k < 120000 && *seen == UNTOUCHED; k++) nanosleep(&pause, NULL);
    ck_assert_msg(*seen != UNTOUCHED, "the device stood still for 120 s");
}

/* Frames, and steps of one: all are made without a call, of the scene as it was, while it and its mesh change. */
START_TEST(nobody_asks) {
    static const double away[16] = {1, 0, 0, 5, 0, 1, 0, 3, 0, 0, 1, 0, 0, 0, 0, 1};
    static float whole[PIXELS];
    int64_t vertices = 0, triangles = 0;
    skg_plan *slow = long_plan(0);
    skg_output output = output_of(whole);
    skg_job *job = NULL;
    ck_skg(skg_plan_image(slow, &output));
    ck_skg(skg_mesh_count(ball, &vertices, &triangles));
    double *positions = malloc((size_t)(3 * vertices) * sizeof *positions);
    ck_skg(skg_mesh_positions_get(ball, positions, 0));
    if (_i) {
        output = output_of(pixels);
        ck_skg(skg_plan_submit(slow, 1, NULL, &output, &job));
    } else {
        job = submit();
    }
    ck_skg(skg_scene_part_pose_set(scene, 0, away));
    add_parts();
    for (int64_t i = 0; i < 3 * vertices; i++) positions[i] = 1.5 * positions[i] + 100;
    ck_skg(skg_mesh_positions_set(ball, positions, 0));
    free(positions);
    skg_plan_report report;
    skg_plan_report_init(&report);
    ck_skg(skg_plan_report_get(_i ? slow : plan, &report));
    look_only(_i ? pixels + PIXELS - 1 : pixels + (frames - 1) * PIXELS);
    ck_skg(skg_job_wait(&job));
    if (_i)
        ck_assert_mem_eq(pixels, whole, sizeof whole);
    else
        check_images(frames);
    skg_plan_release(&slow);
}
END_TEST

/* The program ends while frames are left: the thread that goes on with them must not meet a driver that is gone. */
START_TEST(the_program_ends) {
    const struct timespec pause = {0, 1000000 * (17 * _i % 50)};
    (void)submit();
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
    run_part(scene, "inner", inner, 0.9, NULL, 0);
    skg_mesh_release(&inner);
    skg_plan_release(&plan);
    plan = fine_plan();
    for (int f = 0; f < FRAMES; f++) {
        views[f] = view;
        views[f].source[1] = 10 * f;
        skg_frame_init(&some[f]);
        some[f].view = &views[f];
    }
    for (int o = 0; o < OUTPUTS; o++) {
        outputs[o] = output_of(alone[o]);
        if (o == 1) continue; /* the image stands between lengths */
        outputs[o].kind = SKG_OUTPUT_LENGTHS;
        outputs[o].part = o == 2;
        outputs[o].lengths = o == 3 ? SKG_LENGTHS_SURFACE : SKG_LENGTHS_NET;
    }
    for (int o = 0; o < OUTPUTS; o++) {
        ck_skg(skg_plan_submit(plan, FRAMES, some, &outputs[o], &job));
        ck_skg(skg_job_wait(&job));
        outputs[o].data = together[o];
    }
    ck_skg(skg_plan_outputs_submit(plan, FRAMES, some, OUTPUTS, outputs, &job));
    ck_skg(skg_job_wait(&job));
    ck_assert_mem_eq(together, alone, sizeof alone);
    const int middle = SIDE / 2 * SIDE +
                       SIDE / 2; /* the outer part's net length is that of its surface less the inner part */
    const double net = (double)alone[0][middle] + (double)alone[2][middle];
    ck_assert_double_eq_tol(net, (double)alone[3][middle], 1e-5 * net); /* a few roundings of float */
    ck_assert(alone[2][middle] > 9);
}
END_TEST

/* What a window's thread does while another one waits: it holds a reference, so that the job outlives the wait. */
static void *cancel_often(void *user) {
    skg_job *held = user;
    for (int k = 0; k < 2000; k++)
        if (skg_job_cancel(held) != SKG_OK) return user;
    skg_job_release(&held);
    return NULL;
}

START_TEST(another_thread_cancels_while_one_waits) {
    for (int round = 0; round < 5; round++) {
        skg_job *job = submit(), *held = job;
        pthread_t thread;
        void *failed = NULL;
        int32_t done = 0;
        int64_t finished = -1, total = -1;
        ck_skg(skg_job_retain(held)); /* of the thread */
        ck_skg(skg_job_retain(held)); /* of this one */
        ck_assert_int_eq(pthread_create(&thread, NULL, cancel_often, held), 0);
        const skg_status status = skg_job_wait(&job);
        ck_assert_ptr_null(job);
        ck_assert(status == SKG_OK || status == SKG_ERR_CANCELLED);
        ck_assert_int_eq(pthread_join(thread, &failed), 0);
        ck_assert_ptr_null(failed);
        ck_skg(skg_job_cancel(held));
        ck_skg(skg_job_test(held, &done));
        ck_skg(skg_job_progress(held, &finished, &total));
        ck_assert(done == 1 && total == frames && finished >= 0 && finished <= total);
        job = held;
        ck_skg_fails(skg_job_wait(&job), SKG_ERR_ARGUMENT, "was waited for");
        skg_job_release(&held);
        ck_assert_ptr_null(held);
    }
}
END_TEST

/* However late it is cancelled: no frame is in place, nothing was written, and its steps were counted. */
START_TEST(cancelled_within_a_frame) {
    if (!holds_frames()) return;
    skg_plan *slow = long_plan(0);
    skg_status status = SKG_OK;
    const skg_output output = output_of(pixels);
    for (int k = 0; k < TRIES && status == SKG_OK; k++) {
        skg_job *job = NULL;
        int64_t done = 0, total = 0, before = 0;
        for (int64_t i = 0; i < PIXELS; i++) pixels[i] = UNTOUCHED;
        ck_skg(skg_plan_submit(slow, 1, NULL, &output, &job));
        while (_i && done == 0) ck_skg(skg_job_progress(job, &done, &total));
        ck_skg(skg_job_cancel(job));
        before = done;
        ck_skg(skg_job_progress(job, &done, &total));
        ck_assert(total > 12 && done >= before && done <= total);
        status = skg_job_wait(&job);
    }
    ck_assert_int_eq(status, SKG_ERR_CANCELLED);
    ck_assert_str_eq(skg_last_error(), "the job was cancelled: 0 of 1 frames are in place");
    check_images(0);
    ck_skg(skg_plan_image(plan, &output)); /* others are not touched */
    ck_assert_mem_eq(pixels, reference, sizeof reference);
    skg_plan_release(&slow);
}
END_TEST

/* A frame in steps has the bits of one that is given whole, beside another output, however it is asked, and of the scene as it was. */
START_TEST(steps_do_not_change_bits) {
    static const double away[16] = {1, 0, 0, 5, 0, 1, 0, 3, 0, 0, 1, 0, 0, 0, 0, 1};
    static float whole[2 * PIXELS], steps[2 * PIXELS], lengths[2 * PIXELS], again[PIXELS];
    skg_plan *slow = long_plan(0);
    skg_output outputs[2] = {output_of(steps), output_of(lengths)}, output = output_of(whole);
    skg_job *job = NULL, *later = NULL;
    cl_event event = NULL;
    outputs[1].kind = SKG_OUTPUT_LENGTHS;
    ck_skg(skg_plan_submit_cl(slow, 2, NULL, 1, &output, 0, NULL, &event, &job)); /* all at once */
    ck_skg(skg_job_wait(&job));
    clReleaseEvent(event);
    ck_skg(skg_plan_outputs_submit(slow, 2, NULL, 2, outputs, &job));
    ck_skg(skg_scene_part_pose_set(scene, 0, away));
    if (_i) { /* another job comes in between */
        output = output_of(again);
        ck_skg(skg_plan_submit(plan, 1, NULL, &output, &later));
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
    skg_plan *slow = long_plan(1);
    skg_output output = output_of(whole);
    skg_job *job = NULL;
    output.kind = SKG_OUTPUT_VARIANCE;
    ck_skg(skg_plan_submit_cl(slow, 1, NULL, 1, &output, 0, NULL, NULL, &job)); /* all at once */
    ck_skg(skg_job_wait(&job));
    output.data = steps;
    ck_skg(skg_plan_submit(slow, 1, NULL, &output, &job));
    ck_skg(skg_job_wait(&job));
    ck_assert(whole[PIXELS / 2 + SIDE / 2] > 0);
    ck_assert_mem_eq(steps, whole, sizeof whole);
    skg_plan_release(&slow);
}
END_TEST

static atomic_int is_back;

static void *interrupt(void *unused) {
    (void)unused;
    while (!atomic_load(&is_back)) ck_skg(skg_context_interrupt(run_context));
    return NULL;
}

/* Samples that never suffice are looked for until another thread ends it; the next plan is not ended. */
START_TEST(a_plan_that_is_made_is_interrupted) {
    skg_plan *made = NULL;
    skg_plan_options options;
    skg_spot spot;
    skg_spectrum *beam = NULL;
    pthread_t thread;
    skg_plan_options_init(&options);
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_DISC, spot.extent[0] = 5;
    spot.tolerance = 1e-12, spot.samples_max = 1 << 16;
    options.spot = &spot;
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    atomic_store(&is_back, 0);
    ck_assert_int_eq(pthread_create(&thread, NULL, interrupt, NULL), 0);
    const skg_status status = skg_plan_create(run_context, scene, &view, beam, &options, &made);
    atomic_store(&is_back, 1);
    pthread_join(thread, NULL);
    ck_skg_fails(status, SKG_ERR_CANCELLED,
                 "interrupted while the number of samples of the source was found");
    ck_assert_ptr_null(made);
    spot.tolerance = 0.01;
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &made));
    ck_skg_fails(skg_context_interrupt(NULL), SKG_ERR_ARGUMENT, "context");
    skg_plan_release(&made);
    skg_spectrum_release(&beam);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_plan, close_plan);
    tcase_add_test(tests, cancelled_at_once);
    tcase_add_loop_test(tests, cancelled_in_the_middle, 0, 2);
    tcase_add_test(tests, cancelled_after_the_end);
    tcase_add_test(tests, another_thread_cancels_while_one_waits);
    tcase_add_test(tests, the_scene_of_the_submission);
    tcase_add_test(tests, the_frames_of_the_submission);
    tcase_add_test(tests, a_part_that_is_added_later);
    tcase_add_loop_test(tests, nobody_asks, 0, 2);
    tcase_add_loop_exit_test(tests, the_program_ends, 0, 0, 10);
    tcase_add_test(tests, several_outputs);
    tcase_add_loop_test(tests, cancelled_within_a_frame, 0, 2);
    tcase_add_loop_test(tests, steps_do_not_change_bits, 0, 2);
    tcase_add_test(tests, steps_of_a_variance);
    tcase_add_test(tests, a_plan_that_is_made_is_interrupted);
}

SKG_SUITE_MAIN("cancel", add_tests)
