/* Runs: every projection is the image of its view, whatever batch, shard or file it comes in. */
#include "suite.h"
#include "support/run.h"

#include <skiagraph/scanning.h>

#include <math.h>
#include <string.h>

enum { SIDE = 40, PIXELS = SIDE * SIDE, COUNT = 11 };

#define PI 3.14159265358979323846

static skg_view view;
static skg_scene *scene;
static skg_mesh *blob;
static skg_plan *plan;
static skg_scan *scan;
static skg_scan_options geometry;
static skg_scan_run_options options;
static float expected[COUNT][PIXELS], got[COUNT][PIXELS];
static int64_t order[COUNT], batches, arrived;

static void make_scan(void) {
    skg_scan_release(&scan);
    ck_skg(skg_scan_create(&view, &geometry, &scan));
}

static void open_scene(void) {
    run_open();
    view = run_view(SIDE, 4);
    solid s = solid_blob(60, 40, 20, 1);
    blob = run_mesh(&s);
    solid_free(&s);
    ck_skg(skg_scene_create(run_context, &scene));
    run_part(scene, "blob", blob, 0.2, NULL, -1);
    plan = run_plan(scene, &view, (run_choice){.quantity = SKG_QUANTITY_TRANSMISSION});
    skg_scan_options_init(&geometry);
    geometry.projections = COUNT;
    geometry.step_rad = 2 * PI / COUNT;
    geometry.axis[1] = 1;
    geometry.axis[2] = 0;
    scan = NULL;
    make_scan();
    skg_scan_run_options_init(&options);
    batches = arrived = 0;
}

static void close_scene(void) {
    skg_scan_release(&scan);
    skg_plan_release(&plan);
    skg_mesh_release(&blob);
    skg_scene_release(&scene);
    run_close();
}

/* The image of one view, without a run. */
static void image(const skg_view *of, float *to) {
    skg_output output;
    skg_output_init(&output);
    output.data = to;
    ck_skg(skg_plan_view_set(plan, of));
    ck_skg(skg_plan_image(plan, &output));
}

static void expect_all(void) {
    for (int64_t k = 0; k < COUNT; k++) {
        skg_view of;
        skg_view_init(&of);
        ck_skg(skg_scan_view_get(scan, k, &of));
        image(&of, expected[k]);
    }
}

static skg_status take(const skg_scan_batch *batch, void *user) {
    (void)user;
    for (int64_t i = 0; i < batch->count; i++) {
        memcpy(got[batch->indices[i]], (const float *)batch->images + i * PIXELS, sizeof got[0]);
        order[arrived++] = batch->indices[i];
    }
    batches++;
    return SKG_OK;
}

START_TEST(a_run_is_one_image_for_each_view) {
    expect_all();
    for (int64_t size = 1; size <= COUNT + 1; size++) {
        memset(got, 0, sizeof got);
        options.batch = size;
        batches = arrived = 0;
        ck_skg(skg_scan_run_each(plan, scan, &options, take, NULL));
        ck_assert_mem_eq(got, expected, sizeof got);
        ck_assert_int_eq(arrived, COUNT);
        ck_assert_int_eq(batches, (COUNT + size - 1) / size);
        for (int64_t i = 0; i < COUNT; i++) ck_assert_int_eq(order[i], i);
    }
}
END_TEST

START_TEST(shards_are_the_whole) {
    expect_all();
    for (int64_t shards = 1; shards <= COUNT + 2; shards++) {
        memset(got, 0, sizeof got);
        arrived = 0;
        options.shards = shards;
        for (options.shard = 0; options.shard < shards; options.shard++)
            ck_skg(skg_scan_run_each(plan, scan, &options, take, NULL));
        ck_assert_int_eq(arrived, COUNT);
        ck_assert_mem_eq(got, expected, sizeof got);
    }
}
END_TEST

/* Projections that come one by one, two or more before they are needed or after the run has finished those before. */
START_TEST(projections_are_added) {
    static const int64_t late[] = {3, 4, 5, 6, 7, 8, 9, 10}, beyond = COUNT;
    skg_scan_run *run = NULL;
    skg_scan_batch batch;
    int64_t count = 0;
    expect_all();
    options.only = (const int64_t[]){0, 1, 2};
    options.only_count = 3;
    ck_skg(skg_scan_run_create(plan, scan, &options, &run));
    ck_skg_fails(skg_scan_run_add(run, 1, &beyond), SKG_ERR_ARGUMENT, "projection 11");
    skg_scan_batch_init(&batch);
    for (int k = 0; arrived < COUNT; k++) {
        if (_i == 0 && k == 0) ck_skg(skg_scan_run_add(run, 8, late));
        ck_skg(skg_scan_run_next(run, &batch));
        ck_skg(take(&batch, NULL));
        if (_i == 1 && batch.count == 0) ck_skg(skg_scan_run_add(run, 1, late + (arrived - 3)));
        if (_i == 2 && k < 4) ck_skg(skg_scan_run_add(run, 2, late + 2 * k));
    }
    ck_skg(skg_scan_run_next(run, &batch));
    ck_assert_int_eq(batch.count, 0);
    ck_skg(skg_scan_run_projection_count(run, &count));
    ck_assert_int_eq(count, COUNT);
    skg_scan_run_release(&run);
    for (int64_t i = 0; i < COUNT; i++) ck_assert_int_eq(order[i], i);
    ck_assert_mem_eq(got, expected, sizeof got);
}
END_TEST

START_TEST(some_projections) {
    static const int64_t only[] = {1, 4, 5, 10};
    expect_all();
    options.from = 3;
    options.to = 7;
    ck_skg(skg_scan_run_each(plan, scan, &options, take, NULL));
    ck_assert_int_eq(arrived, 4);
    ck_assert_int_eq(order[0], 3);
    ck_assert_mem_eq(got[6], expected[6], sizeof got[6]);
    arrived = 0;
    options.only = only;
    options.only_count = 4;
    ck_skg(skg_scan_run_each(plan, scan, &options, take, NULL));
    ck_assert_int_eq(arrived, 2);
    ck_assert(order[0] == 4 && order[1] == 5);
}
END_TEST

/* A projection of three sub-frames is the mean of images at the middles of thirds of the exposure; that of attenuation
 * is the attenuation of the mean intensity. */
START_TEST(subframes_are_averaged) {
    static float part[3][PIXELS];
    geometry.interval_s = 2;
    geometry.exposure_s = 1.5;
    make_scan();
    options.subframes = 3;
    options.batch = 4;
    ck_skg(skg_scan_run_each(plan, scan, &options, take, NULL));
    for (int64_t k = 0; k < COUNT; k += 5) {
        for (int s = 0; s < 3; s++) {
            skg_view of;
            skg_view_init(&of);
            ck_skg(skg_scan_view_at(scan, (double)k + 0.25 * (s - 1), &of));
            image(&of, part[s]);
        }
        for (int i = 0; i < PIXELS; i++) {
            const double mean = ((double)part[0][i] + (double)part[1][i] + (double)part[2][i]) / 3;
            ck_assert_double_eq_tol((double)got[k][i], mean, 1e-7); /* a rounding to float of at most 1 */
        }
    }
    skg_plan_release(&plan);
    plan = run_plan(scene, &view, (run_choice){.quantity = SKG_QUANTITY_ATTENUATION});
    memcpy(expected, got, sizeof got);
    arrived = 0;
    ck_skg(skg_scan_run_each(plan, scan, &options, take, NULL));
    for (int i = 0; i < PIXELS; i++)
        ck_assert_double_eq_tol(exp(-(double)got[5][i]), (double)expected[5][i],
                                2e-6); /* exp and logarithm of the device, three times */
}
END_TEST

/* The variance of a mean of sub-frames is that of one exposure: keV times the mean image, and that of the electronics. The scan
 * stands still, or turns by 1 rad about an axis beside the body during the exposure; then pixels count in which the sub-frames differ much. Few photons are
 * drawn one by one, many at once. */
START_TEST(subframes_have_the_noise_of_one_exposure) {
    enum { SUBFRAMES = 4, DRAWS = 200 };
    static float parts[SUBFRAMES][PIXELS];
    const double kev = 100, electronic = 50;
    const int is_few = _i & 1, is_turning = _i & 2;
    double sum = 0, count = 0;
    skg_spectrum *beam = NULL;
    skg_plan_options choice;
    skg_plan_options_init(&choice);
    ck_skg(skg_spectrum_create_mono(kev, is_few ? 12 : 4000, &beam));
    geometry.step_rad = is_turning ? 1 : 0;
    geometry.centre[2] = 100;
    geometry.interval_s = geometry.exposure_s = 1;
    make_scan();
    skg_plan_release(&plan);
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &choice, &plan));
    for (int f = 0; f < SUBFRAMES; f++) {
        skg_view of;
        skg_view_init(&of);
        ck_skg(skg_scan_view_at(scan, (f + 0.5) / SUBFRAMES - 0.5, &of));
        image(&of, parts[f]);
    }
    skg_plan_release(&plan);
    choice.noise = 1;
    choice.electronic_kev = electronic;
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &choice, &plan));
    options.subframes = SUBFRAMES;
    options.to = 1;
    for (options.noise_seed = 0; options.noise_seed < DRAWS; options.noise_seed++) {
        arrived = 0;
        ck_skg(skg_scan_run_each(plan, scan, &options, take, NULL));
        for (int i = 0; i < PIXELS; i++) {
            double mean = 0, least = HUGE_VAL, most = 0;
            for (int f = 0; f < SUBFRAMES; f++) {
                mean += (double)parts[f][i] / SUBFRAMES;
                least = fmin(least, (double)parts[f][i]);
                most = fmax(most, (double)parts[f][i]);
            }
            if (is_turning && !(most > 2 * least)) continue;
            sum += pow((double)got[0][i] - mean, 2) / (kev * mean + electronic * electronic);
            count++;
        }
    }
    ck_assert_double_gt(count, 1e4);
    /* The mean of n squares has the standard deviation sqrt(2 / n) for normal deviates, at most sqrt(3 / n) for one photon and
     * more; five of them. */
    const double bar = 5 * sqrt(3 / count);
    ck_assert_msg(fabs(sum / count - 1) < bar, "variance %g of one exposure's, bar %g", sum / count, bar);
    skg_spectrum_release(&beam);
}
END_TEST

/* A part that moves with the poses of each projection. */
START_TEST(parts_move_from_one_projection_to_the_next) {
    static double poses[COUNT][16];
    const int64_t part = 0;
    for (int64_t k = 0; k < COUNT; k++) {
        for (int i = 0; i < 16; i++) poses[k][i] = i % 5 == 0;
        poses[k][3] = 7.0 * (double)k;
    }
    options.moving_count = 1;
    options.moving_parts = &part;
    options.moving_poses = poses[0];
    ck_skg(skg_scan_run_each(plan, scan, &options, take, NULL));
    for (int64_t k = 0; k < COUNT; k++) {
        skg_view of;
        skg_view_init(&of);
        ck_skg(skg_scan_view_get(scan, k, &of));
        ck_skg(skg_scene_part_pose_set(scene, 0, poses[k]));
        image(&of, expected[k]);
    }
    ck_assert_mem_eq(got, expected, sizeof got);
    options.moving_poses = NULL;
    ck_skg_fails(skg_scan_run_each(plan, scan, &options, take, NULL), SKG_ERR_ARGUMENT, "moving parts");
}
END_TEST

/* Projections of another scan, with its views, angles and times. */
START_TEST(a_subset_has_the_projections_of_the_whole) {
    static const int64_t indices[] = {4, 1, 4};
    skg_scan *subset = NULL;
    geometry.interval_s = 2;
    make_scan();
    ck_skg(skg_scan_create_subset(scan, 3, indices, &subset));
    for (int64_t k = 0; k < 3; k++) {
        skg_view whole, its;
        double angle = 0, its_angle = 0, time = 0;
        skg_view_init(&whole);
        skg_view_init(&its);
        ck_skg(skg_scan_view_get(scan, indices[k], &whole));
        ck_skg(skg_scan_view_get(subset, k, &its));
        ck_assert_mem_eq(&its, &whole, sizeof its);
        ck_skg(skg_scan_angle_get(scan, indices[k], &angle));
        ck_skg(skg_scan_angle_get(subset, k, &its_angle));
        ck_skg(skg_scan_time_get(subset, k, &time, NULL));
        ck_assert(angle <= its_angle && its_angle <= angle);
        ck_assert(time <= 2.0 * (double)indices[k] && 2.0 * (double)indices[k] <= time);
    }
    skg_scan_release(&subset);
    ck_skg_fails(skg_scan_create_subset(scan, 0, indices, &subset), SKG_ERR_ARGUMENT, "0 projections");
    const int64_t beyond = COUNT;
    ck_skg_fails(skg_scan_create_subset(scan, 1, &beyond, &subset), SKG_ERR_ARGUMENT, "no projection");
}
END_TEST

START_TEST(a_run_can_be_left) {
    skg_scan_run *run = NULL;
    skg_scan_batch batch;
    int64_t count = 0;
    options.batch = 2;
    ck_skg(skg_scan_run_create(plan, scan, &options, &run));
    ck_skg(skg_scan_run_projection_count(run, &count));
    ck_assert_int_eq(count, COUNT);
    skg_scan_batch_init(&batch);
    ck_skg(skg_scan_run_next(run, &batch));
    ck_assert_int_eq(batch.count, 2);
    ck_assert_ptr_null(batch.phases);
    skg_scan_run_release(&run);
    ck_assert_ptr_null(run);
    skg_scan_run_release(&run);
}
END_TEST

static skg_status refuse(const skg_scan_batch *batch, void *user) {
    (void)batch;
    ++*(int *)user;
    return SKG_ERR_OUTPUT;
}

/* 1e6 photons of 80 keV are 80,000 MeV, more than 16 bits hold: an answer, after which every field is there. */
START_TEST(flat_fields_beyond_the_range_are_all_made) {
    skg_spectrum *beam = NULL;
    skg_plan *coarse = NULL;
    skg_plan_options its;
    ck_skg(skg_spectrum_create_mono(80, 1e6, &beam));
    skg_plan_options_init(&its);
    its.precision = SKG_PRECISION_HALF;
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &its, &coarse));
    memset(got, 0, sizeof got);
    ck_skg_fails(skg_scan_flat_fields_render(coarse, scene, scan, NULL, COUNT, got), SKG_RANGE, "not finite");
    for (int64_t f = 0; f < COUNT; f++) ck_assert(isinf(got[f][0]));
    skg_plan_release(&coarse);
    skg_spectrum_release(&beam);
}
END_TEST

START_TEST(what_is_refused) {
    static const int64_t falling[] = {3, 2};
    int calls = 0;
    skg_scan_run *run = NULL;
    options.batch = 1;
    ck_assert_int_eq(skg_scan_run_each(plan, scan, &options, refuse, &calls), SKG_ERR_OUTPUT);
    ck_assert_int_eq(calls, 1);
    options.to = COUNT + 1;
    ck_skg_fails(skg_scan_run_create(plan, scan, &options, &run), SKG_ERR_ARGUMENT, "the scan has 11");
    options.to = 0;
    options.shard = 1;
    ck_skg_fails(skg_scan_run_create(plan, scan, &options, &run), SKG_ERR_ARGUMENT, "shard 1 of 1");
    options.shard = 0;
    options.subframes = 0;
    ck_skg_fails(skg_scan_run_create(plan, scan, &options, &run), SKG_ERR_ARGUMENT, "sub-frames");
    options.subframes = 1;
    options.type = 7;
    ck_skg_fails(skg_scan_run_create(plan, scan, &options, &run), SKG_ERR_ARGUMENT, "type 7");
    options.type = SKG_TYPE_FLOAT32;
    options.only = falling;
    options.only_count = 2;
    ck_skg_fails(skg_scan_run_create(plan, scan, &options, &run), SKG_ERR_ARGUMENT, "projection 2");
    options.only_count = 0;
    options.batch = -1;
    ck_skg_fails(skg_scan_run_create(plan, scan, &options, &run), SKG_ERR_ARGUMENT, "-1 projections");
    ck_assert_ptr_null(run);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_test(tests, a_run_is_one_image_for_each_view);
    tcase_add_test(tests, shards_are_the_whole);
    tcase_add_loop_test(tests, projections_are_added, 0, 3);
    tcase_add_test(tests, some_projections);
    tcase_add_test(tests, subframes_are_averaged);
    tcase_add_loop_test(tests, subframes_have_the_noise_of_one_exposure, 0, 4);
    tcase_add_test(tests, parts_move_from_one_projection_to_the_next);
    tcase_add_test(tests, a_subset_has_the_projections_of_the_whole);
    tcase_add_test(tests, a_run_can_be_left);
    tcase_add_test(tests, flat_fields_beyond_the_range_are_all_made);
    tcase_add_test(tests, what_is_refused);
}

SKG_SUITE_MAIN("scan_run", add_tests)
