/* Frames: what is submitted, when it is taken, and where it goes. */
#include "suite.h"
#include "support/run.h"

#include <math.h>
#include <skiagraph/opencl.h>
#include <string.h>

enum { SIDE = 48, PIXELS = SIDE * SIDE };

static skg_view view;
static skg_scene *scene; /* 0: a blob of 0.2 per cm; 1: a sphere of 0.5 per cm inside it */
static skg_mesh *blob, *ball;

static skg_mesh *mesh_of(solid s) {
    skg_mesh *mesh = run_mesh(&s);
    solid_free(&s);
    return mesh;
}

static void open_scene(void) {
    run_open();
    view = run_view(SIDE, 4);
    blob = mesh_of(solid_blob(60, 40, 20, 1));
    ball = mesh_of(solid_sphere(15, 24, 12));
    ck_skg(skg_scene_create(run_context, &scene));
    run_part(scene, "blob", blob, 0.2, NULL, -1);
    run_part(scene, "ball", ball, 0.5, NULL, 0);
}

static void close_scene(void) {
    skg_mesh_release(&blob);
    skg_mesh_release(&ball);
    skg_scene_release(&scene);
    run_close();
}

static skg_output output_of(void *data) {
    skg_output output;
    skg_output_init(&output);
    output.data = data;
    return output;
}

static void image(skg_plan *plan, float *to) {
    const skg_output output = output_of(to);
    ck_skg(skg_plan_image(plan, &output));
}

static void shifted(double pose[16], double x, double y, double z) {
    static const double none[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    memcpy(pose, none, sizeof none);
    pose[3] = x, pose[7] = y, pose[11] = z;
}

/* --- where images go ------------------------------------------------------------------------------------- */

/* Strides leave what lies between untouched, and every pixel is where they say. */
START_TEST(strides_of_a_batch) {
    enum { FRAMES = 3, ROW = SIDE + 5, CHANNEL = SIDE * ROW + 11, FRAME = CHANNEL + 7 };
    static float dense[FRAMES][PIXELS], loose[FRAMES * FRAME];
    skg_view views[FRAMES];
    skg_frame frames[FRAMES];
    skg_plan *plan = run_plan(scene, &view, (run_choice){0});
    skg_output output = output_of(loose);
    skg_job *job = NULL;
    for (int n = 0; n < FRAMES; n++) {
        views[n] = view;
        views[n].source[0] = 100 * n;
        skg_frame_init(&frames[n]);
        frames[n].view = &views[n];
        ck_skg(skg_plan_view_set(plan, &views[n]));
        image(plan, dense[n]);
    }
    for (int n = 0; n < FRAMES * FRAME; n++) loose[n] = -77;
    output.row_stride = ROW;
    output.channel_stride = CHANNEL;
    output.frame_stride = FRAME;
    ck_skg(skg_plan_submit(plan, FRAMES, frames, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    ck_assert_ptr_null(job);
    for (int n = 0; n < FRAMES * FRAME; n++) {
        const int row = n % FRAME / ROW, column = n % FRAME % ROW;
        const int held = row < SIDE && column < SIDE;
        const float expected = held ? dense[n / FRAME][row * SIDE + column] : -77;
        ck_assert_msg(loose[n] == expected, "element %d: %g, not %g", n, (double)loose[n], (double)expected);
    }
    skg_plan_release(&plan);
}
END_TEST

/* An image in doubles holds what one in floats rounds: to half a last place of a float (2^-24). */
START_TEST(floats_and_doubles) {
    static float narrow[PIXELS];
    static double wide[PIXELS];
    for (int quantity = SKG_QUANTITY_ENERGY; quantity <= SKG_QUANTITY_ATTENUATION && run_has_double();
         quantity++) {
        skg_plan *plan = run_plan(scene, &view, (run_choice){.quantity = quantity});
        skg_output output = output_of(wide);
        output.type = SKG_TYPE_FLOAT64;
        image(plan, narrow);
        ck_skg(skg_plan_image(plan, &output));
        for (int p = 0; p < PIXELS; p++)
            ck_assert_double_le(fabs(wide[p] - (double)narrow[p]), 0x1p-24 * fabs(wide[p]));
        skg_plan_release(&plan);
    }
}
END_TEST

/* Two frames are under way at once, each with memory of its own, and are waited for in any order. */
START_TEST(two_jobs) {
    static float first[PIXELS], second[PIXELS], expected[2][PIXELS];
    skg_view aside = view;
    skg_frame frame;
    skg_job *jobs[2] = {NULL, NULL};
    aside.source[0] = 150;
    skg_frame_init(&frame);
    skg_plan *plan = run_plan(scene, &view, (run_choice){0});
    image(plan, expected[0]);
    ck_skg(skg_plan_view_set(plan, &aside));
    image(plan, expected[1]);
    for (int swapped = 0; swapped < 2; swapped++) {
        const skg_output to_first = output_of(first), to_second = output_of(second);
        memset(first, 0, sizeof first);
        memset(second, 0, sizeof second);
        frame.view = &view;
        ck_skg(skg_plan_submit(plan, 1, &frame, 1, &to_first, &jobs[swapped]));
        frame.view = &aside;
        ck_skg(skg_plan_submit(plan, 1, &frame, 1, &to_second, &jobs[!swapped]));
        for (int n = 0; n < 2; n++) ck_skg(skg_job_wait(&jobs[n]));
        ck_assert_mem_eq(first, expected[0], sizeof first);
        ck_assert_mem_eq(second, expected[1], sizeof second);
    }
    skg_plan_release(&plan);
}
END_TEST

/* --- what a frame is ------------------------------------------------------------------------------------- */

START_TEST(poses_of_a_frame) {
    static float plain[PIXELS], posed[PIXELS], expected[PIXELS], after[PIXELS];
    double poses[32];
    const int64_t ids[2] = {1, 0};
    skg_frame frame;
    skg_job *job = NULL;
    skg_plan *plan = run_plan(scene, &view, (run_choice){0});
    const skg_output output = output_of(posed);
    image(plan, plain);
    shifted(poses, 12, -7, 5);
    shifted(poses + 16, -20, 3, 9);
    skg_frame_init(&frame);
    frame.pose_count = 2;
    frame.pose_parts = ids;
    frame.poses = poses;
    ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    image(plan, after); /* the frame's poses were its own */
    ck_assert_mem_eq(after, plain, sizeof plain);
    ck_skg(skg_scene_part_pose_set(scene, 1, poses));
    ck_skg(skg_scene_part_pose_set(scene, 0, poses + 16));
    image(plan, expected);
    ck_assert_mem_eq(posed, expected, sizeof posed);
    ck_assert_mem_ne(posed, plain, sizeof posed);
    skg_plan_release(&plan);
}
END_TEST

/* Submit takes vertices, poses and views as they are; what is written after it belongs to the next frame. */
START_TEST(snapshots) {
    enum { FRAMES = 4 };
    static float expected[FRAMES][PIXELS], taken[FRAMES][PIXELS];
    int64_t vertices = 0;
    double pose[16];
    ck_skg(skg_mesh_count(ball, &vertices, NULL));
    double *positions = calloc((size_t)(3 * vertices), sizeof *positions),
           *moved = calloc((size_t)(3 * vertices), sizeof *moved);
    ck_skg(skg_mesh_positions_get(ball, positions, 0));
    for (int late = 0; late < 2; late++) { /* first each frame waited for, then all at the end */
        skg_plan *plan = run_plan(scene, &view, (run_choice){0});
        skg_job *jobs[FRAMES] = {NULL};
        for (int n = 0; n < FRAMES; n++) {
            skg_view aside = view;
            skg_frame frame;
            const skg_output output = output_of(late ? taken[n] : expected[n]);
            for (int64_t k = 0; k < 3 * vertices; k++) moved[k] = positions[k] * (1 + 0.2 * n);
            ck_skg(skg_mesh_positions_set(ball, moved, 0));
            shifted(pose, 6 * n, 0, 0);
            ck_skg(skg_scene_part_pose_set(scene, 1, pose));
            aside.source[1] = 30 * n;
            skg_frame_init(&frame);
            frame.view = &aside;
            ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &jobs[n]));
            memset(pose, 0,
                   sizeof pose); /* neither the caller's arrays nor its structs are looked at again */
            memset(&aside, 0, sizeof aside);
            memset(moved, 0, (size_t)(3 * vertices) * sizeof *moved);
            if (!late) ck_skg(skg_job_wait(&jobs[n]));
        }
        for (int n = 0; n < FRAMES; n++)
            if (late) ck_skg(skg_job_wait(&jobs[n]));
        skg_plan_release(&plan);
    }
    for (int n = 0; n < FRAMES; n++) {
        ck_assert_mem_eq(taken[n], expected[n], sizeof taken[n]);
        if (n) ck_assert_mem_ne(expected[n], expected[n - 1], sizeof taken[n]);
    }
    free(positions);
    free(moved);
}
END_TEST

/* The way without a copy, and two plans that share the mesh: both see every write. */
START_TEST(two_plans_share_a_mesh) {
    static float first[PIXELS], second[PIXELS], before[PIXELS];
    float *offsets = NULL;
    const double *origin = NULL;
    int64_t vertices = 0, version = 0, later = 0;
    skg_plan *plans[2] = {run_plan(scene, &view, (run_choice){0}),
                          run_plan(scene, &view, (run_choice){.strategy = SKG_STRATEGY_ATOMICS})};
    image(plans[0], before);
    ck_skg(skg_mesh_count(ball, &vertices, NULL));
    ck_skg(skg_mesh_version_get(ball, &version));
    ck_skg(skg_mesh_offsets_get(ball, &offsets, &origin));
    for (int64_t k = 0; k < 3 * vertices; k++) offsets[k] *= 1.5F;
    ck_skg(skg_mesh_offsets_moved(ball));
    ck_skg(skg_mesh_version_get(ball, &later));
    ck_assert_int_eq(later, version + 1);
    image(plans[0], first);
    image(plans[1], second);
    ck_assert_mem_eq(first, second, sizeof first);
    ck_assert_mem_ne(first, before, sizeof first);
    for (int n = 0; n < 2; n++) skg_plan_release(&plans[n]);
}
END_TEST

/* --- several of everything ------------------------------------------------------------------------------- */

START_TEST(several_contexts_and_scenes) {
    static float images[4][PIXELS], again[PIXELS];
    skg_context *own = run_context, *other = NULL;
    skg_plan *plans[4];
    skg_scene *scenes[2] = {scene, NULL};
    ck_skg(skg_context_create(NULL, &other));
    ck_skg(skg_scene_create(other, &scenes[1]));
    run_part(scenes[1], "ball", ball, 1, NULL, -1); /* the same mesh */
    for (int n = 0; n < 4; n++) {
        run_context = n & 1 ? other : own;
        plans[n] = run_plan(scenes[n >> 1], &view, (run_choice){0});
    }
    run_context = own;
    for (int n = 0; n < 4; n++) image(plans[n], images[n]);
    ck_assert_mem_eq(images[0], images[1], sizeof again);
    ck_assert_mem_eq(images[2], images[3], sizeof again);
    ck_assert_mem_ne(images[0], images[2], sizeof again);
    skg_context_release(&other); /* its plans keep it */
    skg_scene_release(&scenes[1]);
    for (int n = 3; n >= 0; n--) {
        image(plans[n], again);
        ck_assert_mem_eq(again, images[n], sizeof again);
        skg_plan_release(&plans[n]);
    }
}
END_TEST

/* --- the caller's device memory -------------------------------------------------------------------------- */

/* A device, context and queue of the caller's own. */
static skg_context *callers(cl_context *cl, cl_command_queue *queue) {
    cl_platform_id platforms[8];
    cl_device_id device = NULL;
    cl_uint count = 0;
    cl_int code = CL_DEVICE_NOT_FOUND;
    skg_context *context = NULL;
    ck_assert_int_eq(clGetPlatformIDs(8, platforms, &count), CL_SUCCESS);
    for (cl_uint n = 0; n < count && code != CL_SUCCESS; n++)
        code = clGetDeviceIDs(platforms[n], CL_DEVICE_TYPE_ALL, 1, &device, NULL);
    ck_assert_int_eq(code, CL_SUCCESS);
    *cl = clCreateContext(NULL, 1, &device, NULL, NULL, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    *queue = clCreateCommandQueue(*cl, device, 0, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    ck_skg(skg_context_create_cl(*cl, device, *queue, &context));
    return context;
}

/* Images in a cl_mem, started by an event of the caller's, and their end marked by one of the library's. Submit returns while the
 * caller's event is still open: nothing is waited for. */
START_TEST(device_memory_and_events) {
    enum { FRAMES = 2, OFFSET = 64, ROW = SIDE + 3 };
    static float expected[FRAMES][PIXELS], got[OFFSET / 4 + FRAMES * SIDE * ROW];
    cl_context cl = NULL;
    cl_command_queue queue = NULL;
    cl_int code = CL_SUCCESS, state = CL_QUEUED;
    skg_context *own = run_context;
    run_context = callers(&cl, &queue);
    skg_plan *plan = run_plan(scene, &view, (run_choice){0});
    skg_view views[FRAMES] = {view, view};
    skg_frame frames[FRAMES];
    views[1].source[1] = 90;
    for (int n = 0; n < FRAMES; n++) {
        skg_frame_init(&frames[n]);
        frames[n].view = &views[n];
        ck_skg(skg_plan_view_set(plan, &views[n]));
        image(plan, expected[n]);
    }
    cl_mem buffer = clCreateBuffer(cl, CL_MEM_READ_WRITE, sizeof got, NULL, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    cl_event start = clCreateUserEvent(cl, &code), done = NULL;
    ck_assert_int_eq(code, CL_SUCCESS);
    skg_output output = output_of(NULL);
    skg_job *job = NULL;
    output.row_stride = ROW;
    output.buffer = buffer;
    output.offset = OFFSET;
    ck_skg(skg_plan_submit_cl(plan, FRAMES, frames, 1, &output, 1, &start, &done, &job));
    ck_assert_int_eq(clGetEventInfo(done, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof state, &state, NULL),
                     CL_SUCCESS);
    ck_assert_int_gt(state, CL_COMPLETE); /* it cannot be done: it has not begun */
    ck_assert_int_eq(clSetUserEventStatus(start, CL_COMPLETE), CL_SUCCESS);
    ck_assert_int_eq(clWaitForEvents(1, &done), CL_SUCCESS);
    ck_assert_int_eq(clEnqueueReadBuffer(queue, buffer, CL_TRUE, 0, sizeof got, got, 0, NULL, NULL),
                     CL_SUCCESS);
    for (int n = 0; n < FRAMES * PIXELS; n++) {
        const int row = n % PIXELS / SIDE, column = n % SIDE;
        ck_assert(got[OFFSET / 4 + (n / PIXELS * SIDE + row) * ROW + column] ==
                  expected[n / PIXELS][n % PIXELS]);
    }
    ck_skg(skg_job_wait(&job));
    /* A buffer that is too small, and an offset between two elements. */
    output.offset = OFFSET + 16;
    ck_skg_fails(skg_plan_submit_cl(plan, FRAMES, frames, 1, &output, 0, NULL, NULL, &job), SKG_ERR_ARGUMENT,
                 "buffer");
    output.offset = 2;
    ck_skg_fails(skg_plan_submit_cl(plan, FRAMES, frames, 1, &output, 0, NULL, NULL, &job), SKG_ERR_ARGUMENT,
                 "offset");
    clReleaseEvent(start);
    clReleaseEvent(done);
    clReleaseMemObject(buffer);
    /* A buffer of another context. */
    cl_device_id device = NULL;
    ck_assert_int_eq(clGetCommandQueueInfo(queue, CL_QUEUE_DEVICE, sizeof device, &device, NULL), CL_SUCCESS);
    cl_context other = clCreateContext(NULL, 1, &device, NULL, NULL, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    buffer = clCreateBuffer(other, CL_MEM_READ_WRITE, sizeof got, NULL, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    output.buffer = buffer;
    output.offset = 0;
    ck_skg_fails(skg_plan_submit_cl(plan, FRAMES, frames, 1, &output, 0, NULL, NULL, &job), SKG_ERR_ARGUMENT,
                 "another OpenCL context");
    ck_assert_ptr_null(job);
    clReleaseMemObject(buffer);
    clReleaseContext(other);
    skg_plan_release(&plan);
    skg_context_release(&run_context);
    clReleaseCommandQueue(queue);
    clReleaseContext(cl);
    run_context = own;
}
END_TEST

/* Times of stages on a queue that keeps none: refused when the plan is made, not after the work. */
START_TEST(profile_without_times) {
    cl_context cl = NULL;
    cl_command_queue queue = NULL;
    skg_context *own = run_context;
    skg_spectrum *spectrum = NULL;
    skg_plan *plan = NULL;
    skg_plan_options options;
    run_context = callers(&cl, &queue);
    skg_plan_options_init(&options);
    options.profile = 1;
    ck_skg(skg_spectrum_create_mono(100, 1, &spectrum));
    ck_skg_fails(skg_plan_create(run_context, scene, &view, spectrum, &options, &plan), SKG_ERR_UNSUPPORTED,
                 "CL_QUEUE_PROFILING_ENABLE");
    ck_assert_ptr_null(plan);
    skg_spectrum_release(&spectrum);
    skg_context_release(&run_context);
    clReleaseCommandQueue(queue);
    clReleaseContext(cl);
    run_context = own;
}
END_TEST

/* Flags are 0 or 1. */
START_TEST(flags) {
    static const char *const names[] = {"overlaps is 5", "profile is 5", "falloff is 5", "noise is 5",
                                        "clip is 5"};
    skg_spectrum *spectrum = NULL;
    skg_plan *plan = NULL;
    ck_skg(skg_spectrum_create_mono(100, 1, &spectrum));
    for (int n = 0; n < 5; n++) {
        skg_plan_options options;
        skg_plan_options_init(&options);
        int32_t *const of[] = {&options.overlaps, &options.profile, &options.falloff, &options.noise,
                               &options.clip};
        *of[n] = 5;
        ck_skg_fails(skg_plan_create(run_context, scene, &view, spectrum, &options, &plan), SKG_ERR_ARGUMENT,
                     names[n]);
    }
    skg_spectrum_release(&spectrum);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_test(tests, strides_of_a_batch);
    tcase_add_test(tests, floats_and_doubles);
    tcase_add_test(tests, two_jobs);
    tcase_add_test(tests, poses_of_a_frame);
    tcase_add_test(tests, snapshots);
    tcase_add_test(tests, two_plans_share_a_mesh);
    tcase_add_test(tests, several_contexts_and_scenes);
    tcase_add_test(tests, device_memory_and_events);
    tcase_add_test(tests, profile_without_times);
    tcase_add_test(tests, flags);
}

SKG_SUITE_MAIN("frames", add_tests)
