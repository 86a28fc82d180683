/* Means and variances of images against many frames with noise. The noise of frames is independent, so every statistic of a frame
 * has a standard error that follows from how it spreads over the frames, also where pixels of a frame are correlated by a blur. */
#include "suite.h"
#include "support/run.h"

#include <math.h>
#include <string.h>

enum { COLUMNS = 24, ROWS = 20, FRAMES = 100, CHANNELS_MAX = 2, VALUES_MAX = CHANNELS_MAX * ROWS * COLUMNS };

static skg_scene *scene;
static skg_view view;
static skg_spectrum *spectrum;
static skg_response *csi;
static skg_plan_options options;
static const double line[5] = {0.1, 0.15, 0.5, 0.2, 0.05}, other_line[3] = {0.3, 0.6, 0.1};
static const double spread[15] = {0, 0.1, 0, 0.1, 0.3, 0.1, 0.05, 0.15, 0, 0.1, 0, 0, 0.02, 0.03, 0.05};
static const double bands[3] = {20, 50, 100};
static const skg_detector_blur lines = {
    .size = sizeof lines, .columns = 5, .rows = 3, .along_row = line, .along_column = other_line};
static const skg_detector_blur point = {.size = sizeof point, .columns = 3, .rows = 5, .point = spread};

/* A box of water that covers half of the detector, under two energies. */
static void open_scene(void) {
    static const double kev[2] = {40, 80}, photons[2] = {20000, 30000};
    skg_material *iodide = NULL;
    skg_part part;
    run_open();
    ck_skg(skg_scene_create(run_context, &scene));
    skg_part_init(&part);
    ck_skg(skg_mesh_create_cuboid(10, 12, 20, &part.mesh));
    ck_skg(skg_material_create_named("water", &part.material));
    part.label = "box";
    part.pose[3] = 3;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    skg_view_init(&view);
    view.columns = COLUMNS, view.rows = ROWS;
    view.source[2] = -150, view.centre[2] = 50;
    view.column_step[0] = view.row_step[1] = 1;
    ck_skg(skg_spectrum_create_bins(2, kev, photons, &spectrum));
    ck_skg(skg_material_create_named("CsI", &iodide));
    ck_skg(skg_response_create_scintillator(iodide, 0.6, 0.8, &csi));
    skg_material_release(&iodide);
    skg_plan_options_init(&options);
    options.noise = 1;
}

static void close_scene(void) {
    skg_response_release(&csi);
    skg_spectrum_release(&spectrum);
    skg_scene_release(&scene);
    run_close();
}

/* --- statistics */

typedef struct {
    double sum, squares;
} statistic;

static void add_to(statistic *s, double value) {
    s->sum += value;
    s->squares += value * value;
}

/* Whether the mean over the frames is `expected` within four standard errors, and floats of images: 16 roundings of 6e-8. */
static void check_statistic(const char *name, const statistic *s, double expected, double scale) {
    const double mean = s->sum / FRAMES, variance = s->squares / FRAMES - mean * mean;
    const double error = sqrt(fmax(variance, 0) / FRAMES);
    ck_assert_msg(fabs(mean - expected) <= 4 * error + 1e-6 * scale, "%s: %g, expected %g +- %g", name, mean,
                  expected, error);
}

/* Which pixels a group takes: all, those whose blur reaches over the border, the corners. */
static int is_in(int group, int64_t pixel) {
    const int64_t row = pixel / COLUMNS % ROWS, column = pixel % COLUMNS;
    const int edges = (row < 2 || row >= ROWS - 2) + (column < 2 || column >= COLUMNS - 2);
    return edges >= group;
}

/* Over the pixels of a group, the mean deviation in standard deviations and its mean square are 0 and 1. */
static void check_group(int group, int64_t values, const double *frames, const double *mean,
                        const double *variance) {
    statistic first = {0}, second = {0};
    double largest = 0;
    for (int64_t f = 0; f < FRAMES; f++) {
        double sum = 0, squares = 0;
        int64_t count = 0;
        for (int64_t i = 0; i < values; i++) {
            if (!is_in(group, i)) continue;
            const double deviation = (frames[f * values + i] - mean[i]) / sqrt(variance[i]);
            sum += deviation, squares += deviation * deviation, count++;
            largest = fmax(largest, fabs(mean[i]) / sqrt(variance[i]));
        }
        add_to(&first, sum / (double)count);
        add_to(&second, squares / (double)count);
    }
    check_statistic("mean", &first, 0, largest);
    check_statistic("variance", &second, 1, 1);
}

/* Renders mean and variance, in doubles. */
static void expect(skg_plan *plan, int32_t subframes, double *mean, double *variance) {
    skg_output outputs[2];
    skg_frame frame;
    skg_job *job = NULL;
    skg_frame_init(&frame);
    frame.subframes = subframes;
    for (int k = 0; k < 2; k++) {
        skg_output_init(&outputs[k]);
        outputs[k].type = SKG_TYPE_FLOAT64;
        outputs[k].kind = k ? SKG_OUTPUT_VARIANCE : SKG_OUTPUT_MEAN;
        outputs[k].data = k ? variance : mean;
    }
    ck_skg(skg_plan_submit(plan, 1, &frame, 2, outputs, &job));
    ck_skg(skg_job_wait(&job));
}

static skg_plan *make_plan(void) {
    skg_plan *plan = NULL;
    ck_skg(skg_plan_create(run_context, scene, &view, spectrum, &options, &plan));
    return plan;
}

/* Compares mean and variance of a plan with its noisy frames. */
static void check_plan(int32_t subframes) {
    static double frames[FRAMES * VALUES_MAX], mean[VALUES_MAX], variance[VALUES_MAX];
    static skg_frame list[FRAMES];
    const int64_t values = (options.bands ? options.bands : 1) * ROWS * COLUMNS;
    skg_plan *plan = make_plan();
    skg_output output;
    skg_job *job = NULL;
    for (int64_t f = 0; f < FRAMES; f++) {
        skg_frame_init(&list[f]);
        list[f].index = f;
        list[f].subframes = subframes;
    }
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64;
    output.data = frames;
    ck_skg(skg_plan_submit(plan, FRAMES, list, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    expect(plan, subframes, mean, variance);
    for (int group = 0; group < 3; group++) check_group(group, values, frames, mean, variance);
    skg_plan_release(&plan);
}

/* --- tests */

START_TEST(quantum_noise) {
    options.response = csi;
    check_plan(1);
    check_plan(4);
    options.swank = 0.8;
    options.supersampling = 2;
    check_plan(1);
    options.precision = SKG_PRECISION_DOUBLE;
    check_plan(1);
}
END_TEST

/* So few photons that they are drawn one by one. */
START_TEST(few_photons) {
    static const double kev[2] = {40, 80}, photons[2] = {10, 20};
    skg_spectrum_release(&spectrum);
    ck_skg(skg_spectrum_create_bins(2, kev, photons, &spectrum));
    options.response = csi;
    check_plan(1);
    options.blur = &lines;
    check_plan(1);
}
END_TEST

START_TEST(blurs) {
    skg_depth_blur depths;
    const skg_detector_blur of_depths[2] = {lines, point};
    static const double to[2] = {0.4, 1};
    options.blur = &lines;
    check_plan(1);
    options.blur = &point;
    check_plan(3);
    skg_depth_blur_init(&depths);
    depths.count = 2, depths.to = to, depths.blur = of_depths;
    options.blur = NULL, options.depth_blur = &depths, options.response = csi;
    check_plan(1);
}
END_TEST

START_TEST(noise_power) {
    static const double per_mm[3] = {0, 0.25, 0.5}, values[3] = {0.5, 0.4, 0.2};
    skg_dqe dqe;
    skg_dqe_init(&dqe);
    dqe.count = 3, dqe.per_mm = per_mm, dqe.dqe = values;
    options.dqe = &dqe;
    check_plan(1);
    options.blur = &lines;
    options.electronic_kev = 3000;
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    check_plan(1);
}
END_TEST

START_TEST(electronics_and_steps) {
    options.blur = &lines;
    options.electronic_kev = 4000;
    check_plan(1);
    options.quantum_step_kev = 5000;
    check_plan(2);
    options.noise = 0; /* and no quantum noise */
    options.quantum_step_kev = 0;
    check_plan(2);
}
END_TEST

/* The step is 100 times the change over a pixel, and so its error is anywhere in a step; without other noise it is the same in all
 * frames. */
START_TEST(steps_alone) {
    double mean[VALUES_MAX], variance[VALUES_MAX];
    options.noise = 0;
    options.quantum_step_kev = 6;
    skg_plan *plan = make_plan();
    expect(plan, 1, mean, variance);
    for (int64_t i = 0; i < ROWS * COLUMNS; i++) ck_assert_double_eq(variance[i], 3); /* 6^2 / 12 */
    skg_plan_release(&plan);
}
END_TEST

START_TEST(quantities) {
    skg_material *air = NULL;
    options.blur = &lines;
    options.electronic_kev = 2000;
    for (int32_t q = SKG_QUANTITY_ENERGY; q <= SKG_QUANTITY_ATTENUATION; q++) {
        options.quantity = q;
        options.electronic_kev = q == SKG_QUANTITY_PHOTONS ? 0 : 2000;
        check_plan(1);
    }
    /* Ratios to a flat field that differs from pixel to pixel. */
    ck_skg(skg_material_create_named("Air, Dry (near sea level)", &air));
    options.world = air, options.falloff = SKG_FALLOFF_ON;
    check_plan(1);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    check_plan(1);
    skg_material_release(&air);
}
END_TEST

START_TEST(bands_of_a_counter) {
    options.bands = 2, options.band_kev = bands;
    options.quantity = SKG_QUANTITY_PHOTONS;
    check_plan(1);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    check_plan(1);
    options.band_weight = SKG_BAND_WEIGHT_ENERGY;
    options.blur = &point;
    check_plan(1);
}
END_TEST

START_TEST(samples_of_a_source) {
    skg_spot spot;
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_RECTANGLE, spot.extent[0] = spot.extent[1] = 5, spot.samples = 8;
    options.spot = &spot;
    options.quantity = SKG_QUANTITY_ATTENUATION;
    check_plan(1);
    options.supersampling = 3;
    options.blur = &point;
    check_plan(2);
}
END_TEST

/* Of scattered photons, too. Their histories are the same in all frames, so their own error is not in the noise. */
START_TEST(scatter) {
    skg_scatter scattered;
    skg_scatter_init(&scattered);
    scattered.histories = 4096;
    options.scatter = &scattered;
    options.response = csi;
    check_plan(1);
    options.blur = &lines;
    options.quantity = SKG_QUANTITY_ATTENUATION;
    check_plan(2);
}
END_TEST

/* The sum over the squares of weights, from one energy and no part in the beam: with the border. */
static double squares_of(const skg_detector_blur *blur, int64_t row, int64_t column) {
    double weights[ROWS][COLUMNS] = {{0}}, sum = 0;
    for (int64_t j = 0; j < blur->rows; j++)
        for (int64_t i = 0; i < blur->columns; i++) {
            /* A sample before the middle takes the pixel behind. */
            int64_t y = row - (j - blur->rows / 2), x = column - (i - blur->columns / 2);
            y = y < 0 ? 0 : y < ROWS ? y : ROWS - 1;
            x = x < 0 ? 0 : x < COLUMNS ? x : COLUMNS - 1;
            weights[y][x] +=
                blur->point ? blur->point[j * blur->columns + i] : blur->along_row[i] * blur->along_column[j];
        }
    for (int64_t y = 0; y < ROWS; y++)
        for (int64_t x = 0; x < COLUMNS; x++) sum += weights[y][x] * weights[y][x];
    return sum;
}

START_TEST(squares_of_a_blur) {
    static double mean[VALUES_MAX], variance[VALUES_MAX];
    static const double kev = 50, photons = 1000;
    const double away[16] = {1, 0, 0, 9000, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    skg_spectrum_release(&spectrum);
    ck_skg(skg_spectrum_create_bins(1, &kev, &photons, &spectrum));
    ck_skg(skg_scene_part_pose_set(scene, 0, away));
    options.electronic_kev = 100;
    for (int k = 0; k < 2; k++) {
        options.blur = k ? &point : &lines;
        skg_plan *plan = make_plan();
        expect(plan, 1, mean, variance);
        for (int64_t i = 0; i < ROWS * COLUMNS; i++) {
            const double truth =
                photons * kev * kev * squares_of(options.blur, i / COLUMNS, i % COLUMNS) + 100.0 * 100;
            /* 16 roundings of single precision. */
            ck_assert_double_eq_tol(mean[i], photons * kev, 1e-6 * photons * kev);
            ck_assert_double_eq_tol(variance[i], truth, 1e-6 * truth);
        }
        skg_plan_release(&plan);
    }
}
END_TEST

/* Nothing passes the jaws: no photons, no noise but that of the electronics. -ln of nothing is a constant. */
START_TEST(stopped_by_jaws) {
    static double mean[VALUES_MAX], variance[VALUES_MAX];
    skg_collimation jaws;
    skg_collimation_init(&jaws);
    jaws.kind = SKG_COLLIMATION_DETECTOR, jaws.margin_mm = -4;
    options.collimation = &jaws;
    options.quantity = SKG_QUANTITY_ATTENUATION;
    skg_plan *plan = make_plan();
    expect(plan, 1, mean, variance);
    ck_assert_double_eq(variance[0], 0);
    ck_assert_double_gt(variance[ROWS / 2 * COLUMNS + COLUMNS / 2], 0);
    /* 126 ln 2, rounded to single precision */
    ck_assert_double_eq_tol(mean[0], 126 * log(2), 1e-5);
    skg_plan_release(&plan);
}
END_TEST

/* Without noise the mean is the image, bit for bit, and there is no variance. */
START_TEST(plans_without_noise) {
    static float image[VALUES_MAX], mean[VALUES_MAX];
    skg_output output;
    skg_job *job = NULL;
    options.noise = 0;
    for (int32_t q = SKG_QUANTITY_ENERGY; q <= SKG_QUANTITY_ATTENUATION; q++) {
        options.quantity = q;
        options.blur = q == SKG_QUANTITY_ATTENUATION ? &lines : NULL;
        skg_plan *plan = make_plan();
        skg_output_init(&output);
        output.data = image;
        ck_skg(skg_plan_image(plan, &output));
        output.kind = SKG_OUTPUT_MEAN, output.data = mean;
        ck_skg(skg_plan_image(plan, &output));
        ck_assert_mem_eq(image, mean, ROWS * COLUMNS * sizeof *image);
        output.kind = SKG_OUTPUT_VARIANCE;
        ck_skg_fails(skg_plan_submit(plan, 1, NULL, 1, &output, &job), SKG_ERR_ARGUMENT,
                     "the variance of the noise is asked for, but the plan has none; set "
                     "skg_plan_options.noise (Noise)");
        skg_plan_release(&plan);
    }
}
END_TEST

/* The mean of a noisy plan is the image of a plan without noise, within roundings: weights are those of photons instead of ratios. */
START_TEST(mean_of_a_noisy_plan) {
    static double with[VALUES_MAX], variance[VALUES_MAX], without[VALUES_MAX];
    skg_output output;
    options.blur = &lines;
    for (int32_t q = SKG_QUANTITY_ENERGY; q <= SKG_QUANTITY_ATTENUATION; q++) {
        options.quantity = q;
        options.noise = 1;
        skg_plan *plan = make_plan();
        expect(plan, 1, with, variance);
        skg_plan_release(&plan);
        options.noise = 0;
        plan = make_plan();
        skg_output_init(&output);
        output.data = without, output.type = SKG_TYPE_FLOAT64;
        ck_skg(skg_plan_image(plan, &output));
        skg_plan_release(&plan);
        for (int64_t i = 0; i < ROWS * COLUMNS; i++)
            /* 16 roundings of single precision; of a logarithm absolute. */
            ck_assert_double_eq_tol(with[i], without[i], 1e-6 * fmax(fabs(without[i]), 1));
    }
}
END_TEST

/* Outputs of one submission have the bits that each has alone, whether the sums of the image are there or not. */
START_TEST(beside_an_image) {
    static float alone[3][VALUES_MAX], together[3][VALUES_MAX];
    static const int32_t kinds[3] = {SKG_OUTPUT_IMAGE, SKG_OUTPUT_VARIANCE, SKG_OUTPUT_MEAN};
    skg_output outputs[3];
    skg_job *job = NULL;
    options.quantity = SKG_QUANTITY_ATTENUATION;
    options.blur = &point;
    skg_plan *plan = make_plan();
    for (int k = 0; k < 3; k++) {
        skg_output_init(&outputs[k]);
        outputs[k].kind = kinds[k], outputs[k].data = alone[k];
        ck_skg(skg_plan_image(plan, &outputs[k]));
        outputs[k].data = together[k];
    }
    ck_skg(skg_plan_submit(plan, 1, NULL, 3, outputs, &job));
    ck_skg(skg_job_wait(&job));
    ck_assert_mem_eq(alone, together, sizeof alone);
    skg_plan_release(&plan);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_test(tests, quantum_noise);
    tcase_add_test(tests, few_photons);
    tcase_add_test(tests, blurs);
    tcase_add_test(tests, noise_power);
    tcase_add_test(tests, electronics_and_steps);
    tcase_add_test(tests, steps_alone);
    tcase_add_test(tests, quantities);
    tcase_add_test(tests, bands_of_a_counter);
    tcase_add_test(tests, samples_of_a_source);
    tcase_add_test(tests, scatter);
    tcase_add_test(tests, squares_of_a_blur);
    tcase_add_test(tests, stopped_by_jaws);
    tcase_add_test(tests, plans_without_noise);
    tcase_add_test(tests, mean_of_a_noisy_plan);
    tcase_add_test(tests, beside_an_image);
}

SKG_SUITE_MAIN("variance", add_tests)
