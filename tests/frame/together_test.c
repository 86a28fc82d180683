/* Small frames that one launch draws: each has the bits that it has by itself, a bad one is named, and the count of negative exponents is
 * that of the last one. */
#include "frame/plans.h"
#include "suite.h"
#include "support/run.h"

#include <string.h>

enum { SIDE = 40, PIXELS = SIDE * SIDE, FRAMES = 45, PARTS = 3, BOX = 0, CORE = 1, BALL = 2 };

static skg_view view;
static skg_scene *scene;
static skg_plan *plan;
static float together[FRAMES * PIXELS], alone[PIXELS];
static double poses[FRAMES][PARTS][16];
static skg_frame frames[FRAMES];
static skg_view views[FRAMES];

/* A box with a core of the shape of a ball, and a ball beside it; in each frame they stand elsewhere. */
static void open_scene(void) {
    static const int64_t numbers[PARTS] = {BOX, CORE, BALL};
    solid s = solid_box(60, 50, 40);
    run_open();
    skg_mesh *box = run_mesh(&s);
    solid_free(&s);
    s = solid_sphere(15, 24, 12);
    skg_mesh *ball = run_mesh(&s);
    solid_free(&s);
    view = run_view(SIDE, 4);
    ck_skg(skg_scene_create(run_context, &scene));
    run_part(scene, "box", box, 0.2, NULL, -1);
    run_part(scene, "core", ball, 0.5, NULL, BOX);
    run_part(scene, "ball", ball, 0.3, NULL, -1);
    skg_mesh_release(&box);
    skg_mesh_release(&ball);
    for (int f = 0; f < FRAMES; f++) {
        skg_frame_init(&frames[f]);
        for (int p = 0; p < PARTS; p++) {
            const double pose[16] = {1, 0, 0, p == BALL ? 50 - f : 1 + f % 7, 0, 1, 0, f % 5, 0, 0, 1, f, 0,
                                     0, 0, 1};
            memcpy(poses[f][p], pose, sizeof pose);
        }
        views[f] = view;
        views[f].source[0] = f % 3;
        frames[f].view = f % 2 ? &views[f] : NULL;
        frames[f].pose_count = PARTS, frames[f].pose_parts = numbers, frames[f].poses = poses[f][0];
        frames[f].noise_seed = f, frames[f].index = 3 * f;
    }
}

static void close_scene(void) {
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    run_close();
}

static void plan_with(const skg_plan_options *options) {
    skg_spectrum *beam = NULL;
    skg_plan_release(&plan);
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    ck_skg(skg_plan_create(run_context, scene, &view, beam, options, &plan));
    skg_spectrum_release(&beam);
}

static skg_status take(int64_t count, const skg_frame *of, float *to) {
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.data = to;
    ck_skg(skg_plan_submit(plan, count, of, 1, &output, &job));
    return skg_job_wait(&job);
}

/* least: how many groups are drawn together at least */
static void compare(int64_t least) {
    ck_skg(take(FRAMES, frames, together));
    ck_assert_int_ge(plan->machine.together_next, least);
    for (int f = 0; f < FRAMES; f++) {
        ck_skg(take(1, &frames[f], alone));
        ck_assert_msg(memcmp(alone, together + f * PIXELS, sizeof alone) == 0, "frame %d", f);
    }
}

static int is_cpu(void) {
    skg_device_info device;
    skg_device_info_init(&device);
    ck_skg(skg_context_device_get(run_context, &device));
    return device.cpu;
}

/* Plain, and with noise behind a blur; then frames between which cannot be drawn with the others: one part has another density, is
 * not there, or reaches the source. */
START_TEST(same_bits) {
    static const int64_t changed[2] = {CORE, BALL};
    static const double densities[2] = {1.25, 0};
    skg_plan_options options;
    skg_detector_blur blur;
    const int groups = is_cpu() ? 2 : 0;
    skg_plan_options_init(&options);
    options.strategy = is_cpu() ? SKG_STRATEGY_COPIES : SKG_STRATEGY_AUTO;
    options.overlaps = 0;
    if (_i == 1) {
        static const double line[3] = {0.25, 0.5, 0.25};
        skg_detector_blur_init(&blur);
        blur.along_row = line, blur.along_column = line;
        blur.columns = blur.rows = 3;
        options.blur = &blur;
        options.noise = 1;
        options.supersampling = 2;
    }
    plan_with(&options);
    if (_i == 2) {
        for (int k = 0; k < 2; k++) {
            frames[11 + k].override_count = 1 + k;
            frames[11 + k].override_parts = changed, frames[11 + k].density_ratios = densities;
        }
        poses[20][BALL][11] = -1000; /* where the source is */
    }
    compare(groups);
}
END_TEST

/* The first frame of which a vertex has no place is named; the others have their images. */
START_TEST(bad_frame) {
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.overlaps = 0;
    plan_with(&options);
    poses[13][BALL][3] = poses[30][CORE][3] = 1e60;
    ck_assert_int_eq(take(FRAMES, frames, together), SKG_ERR_MESH);
    ck_assert_ptr_nonnull(strstr(skg_last_error(), "frame 13: part ball"));
    ck_skg(take(1, &frames[12], alone));
    ck_assert_mem_eq(alone, together + 12 * PIXELS, sizeof alone);
    ck_skg(take(1, &frames[14], alone));
    ck_assert_mem_eq(alone, together + 14 * PIXELS, sizeof alone);
    poses[13][BALL][3] = poses[30][CORE][3] = 0; /* nothing stays behind */
    ck_skg(take(FRAMES, frames, together));
}
END_TEST

/* A core beside its box subtracts what is not there: in the last frame, in one before, and in none. */
START_TEST(negative_exponents) {
    skg_plan_options options;
    skg_plan_report report;
    skg_plan_options_init(&options);
    skg_plan_report_init(&report);
    options.overlaps = 0;
    plan_with(&options);
    frames[FRAMES - 1].override_count = 0;
    for (int turn = 0; turn < 3; turn++) {
        poses[FRAMES - 1][CORE][3] = turn == 0 ? 70 : 0;
        poses[20][CORE][3] = turn == 1 ? 70 : 0;
        static const double thin[1] = {0.1};
        static const int64_t core[1] = {CORE};
        for (int f = 20; f < FRAMES; f += FRAMES - 21) {
            frames[f].override_count = 1;
            frames[f].override_parts = core, frames[f].density_ratios = thin;
        }
        ck_skg(take(FRAMES, frames, together));
        ck_skg(skg_plan_report_get(plan, &report));
        const int64_t of_last = report.negative_pixels;
        ck_skg(take(1, &frames[FRAMES - 1], alone));
        ck_skg(skg_plan_report_get(plan, &report));
        ck_assert_int_eq(of_last, report.negative_pixels);
        ck_assert(turn == 0 ? of_last > 0 : of_last == 0);
    }
}
END_TEST

/* A plan keeps as many pieces of memory between jobs whatever the jobs were, waited for or cancelled. */
START_TEST(memory_between_jobs) {
    int64_t one = 0, many = 0;
    skg_plan_options options;
    skg_plan_options_init(&options);
    plan_with(&options);
    ck_skg(take(FRAMES, frames, together));
    ck_skg(take(1, frames, alone));
    ck_skg(skg_allocation_count(&one));
    for (int turn = 0; turn < 5; turn++) {
        skg_job *job = NULL;
        skg_output output;
        skg_output_init(&output);
        output.data = together;
        ck_skg(skg_plan_submit(plan, FRAMES, frames, 1, &output, &job));
        if (turn % 2) ck_skg(skg_job_cancel(job));
        const skg_status status = skg_job_wait(&job);
        ck_assert(status == SKG_OK || status == SKG_ERR_CANCELLED);
        ck_skg(take(1 + turn, frames, together));
        ck_skg(skg_allocation_count(&many));
        ck_assert_int_eq(one, many);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_loop_test(tests, same_bits, 0, 3);
    tcase_add_test(tests, bad_frame);
    tcase_add_test(tests, negative_exponents);
    tcase_add_test(tests, memory_between_jobs);
}

SKG_SUITE_MAIN("together", add_tests)
