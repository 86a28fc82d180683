/* Images of detectors that count: means, where the counts of a photon are, noise that pixels and windows share, dead time. */
#include "suite.h"
#include "support/random.h"
#include "support/run.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum { SIDE = 40, WINDOWS = 2, PIXELS = SIDE * SIDE, VALUES = WINDOWS * PIXELS, FRAMES = 60 };
enum { ACROSS = SKG_COUNTING_SIDE, REACH = SKG_COUNTING_REACH, MIDDLE = ACROSS * ACROSS / 2 };

static skg_scene *scene;
static skg_view view;
static skg_material *cdte;
static skg_counting counting;
static skg_plan_options options;
static const double thresholds[WINDOWS] = {15, 40};
static double photons = 4000;

/* A small cube beside the field: nothing but the beam reaches the detector. */
static void open_scene(void) {
    skg_part part;
    run_open();
    ck_skg(skg_scene_create(run_context, &scene));
    skg_part_init(&part);
    ck_skg(skg_mesh_create_cuboid(1, 1, 1, &part.mesh));
    ck_skg(skg_material_create_named("water", &part.material));
    part.label = "cube", part.pose[3] = 100;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    view = run_view(SIDE, 0.1);
    ck_skg(skg_material_create_named("CdTe", &cdte));
    skg_counting_init(&counting);
    counting.material = cdte, counting.thickness_mm = 1;
    counting.pixel_mm[0] = counting.pixel_mm[1] = 0.1;
    counting.count = WINDOWS, counting.threshold_kev = thresholds;
    counting.electronic_kev = 1.5, counting.bias_v = 400, counting.fluorescence = 1;
    skg_plan_options_init(&options);
    options.quantity = SKG_QUANTITY_PHOTONS, options.overlaps = 0;
    photons = 4000;
}

static void close_scene(void) {
    skg_counter_release(&options.counter);
    skg_material_release(&cdte);
    skg_scene_release(&scene);
    run_close();
}

static skg_plan *make_plan(void) {
    static const double kev = 60;
    skg_spectrum *spectrum = NULL;
    skg_plan *plan = NULL;
    skg_counter_release(&options.counter);
    ck_skg(skg_counter_create(&counting, &options.counter));
    ck_skg(skg_spectrum_create_bins(1, &kev, &photons, &spectrum));
    ck_skg(skg_plan_create(run_context, scene, &view, spectrum, &options, &plan));
    skg_spectrum_release(&spectrum);
    return plan;
}

static void render(skg_plan *plan, int32_t kind, int64_t index, double *image) {
    skg_output output;
    skg_frame frame;
    skg_job *job = NULL;
    skg_frame_init(&frame);
    frame.index = index;
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = image, output.kind = kind;
    ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
}

START_TEST(the_open_beam_makes_the_counts_of_a_photon) {
    static double image[VALUES];
    double counts[WINDOWS];
    skg_plan *plan = make_plan();
    render(plan, SKG_OUTPUT_IMAGE, 0, image);
    ck_skg(skg_counter_counts_get(options.counter, 60, counts));
    for (int i = 0; i < VALUES; i++) /* floats of weights and sums */
        ck_assert_double_eq_tol(image[i] / (photons * counts[i / PIXELS]), 1, 16 * 6e-8);
    skg_plan_release(&plan);
}
END_TEST

/* Jaws that leave one pixel open: its counts lie around it as those of a photon do. */
START_TEST(one_pixel_of_beam_shows_where_counts_are) {
    static double image[VALUES];
    double spread[ACROSS * ACROSS];
    skg_collimation jaws;
    skg_collimation_init(&jaws);
    jaws.kind = SKG_COLLIMATION_RECTANGLE, jaws.distance_mm = 600;
    /* Half as far as the detector; pixel (20, 20) has its middle at half a pixel. */
    for (int k = 0; k < 2; k++) jaws.low[k] = 0, jaws.high[k] = 0.05;
    options.collimation = &jaws;
    skg_plan *plan = make_plan();
    render(plan, SKG_OUTPUT_IMAGE, 0, image);
    for (int w = 0; w < WINDOWS; w++) {
        double all = 0;
        ck_skg(skg_counter_spread_get(options.counter, 60, w, spread));
        for (int j = -REACH; j <= REACH; j++)
            for (int i = -REACH; i <= REACH; i++) {
                const double shown = image[w * PIXELS + (20 + j) * SIDE + 20 + i] / photons;
                /* Of the weights of a window, 1e-3 are cut off at most, and the others are made to have the same sum. */
                ck_assert_double_eq_tol(shown, spread[(j + REACH) * ACROSS + i + REACH], 2e-3);
                all += shown;
            }
        double counts[WINDOWS];
        ck_skg(skg_counter_counts_get(options.counter, 60, counts));
        ck_assert_double_eq_tol(all / counts[w], 1, 1e-5); /* floats of 121 weights */
    }
    skg_plan_release(&plan);
}
END_TEST

/* The mean over pixels and frames of the products of deviations at an offset. */
static double covariance(const double *frames, const double *counts, int a, int b, int columns, int rows) {
    double sum = 0;
    int64_t count = 0;
    for (int f = 0; f < FRAMES; f++)
        for (int j = REACH; j < SIDE - REACH; j++)
            for (int i = REACH; i < SIDE - REACH; i++, count++) {
                const double *frame = frames + (int64_t)f * VALUES;
                sum += (frame[a * PIXELS + j * SIDE + i] - photons * counts[a]) *
                       (frame[b * PIXELS + (j + rows) * SIDE + i + columns] - photons * counts[b]);
            }
    return sum / (double)count;
}

/* Counts of windows and neighbours vary together as often as a photon counts in both. */
START_TEST(noise_is_shared_as_photons_are) {
    static double frames[FRAMES * VALUES];
    static const int offsets[4][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    double counts[WINDOWS], pairs[ACROSS * ACROSS];
    photons = _i ? 30 : 4000;
    options.noise = 1;
    counting.cloud_mm = 0.01;
    skg_plan *plan = make_plan();
    for (int f = 0; f < FRAMES; f++) render(plan, SKG_OUTPUT_IMAGE, f, frames + (int64_t)f * VALUES);
    ck_skg(skg_counter_counts_get(options.counter, 60, counts));
    /* Of FRAMES * 900 products of correlated pixels: four standard errors, and 1 % for weights that are cut off. */
    const double error = 4 * 1.5 / sqrt(FRAMES * 900.0);
    for (int w = 0; w < WINDOWS * WINDOWS; w++)
        for (int k = 0; k < 4; k++) {
            const int a = w / WINDOWS, b = w % WINDOWS;
            ck_skg(skg_counter_pairs_get(options.counter, 60, a, b, pairs));
            const double scale = sqrt(counts[a] * counts[b]);
            const double wanted = pairs[MIDDLE + offsets[k][0] + offsets[k][1] * ACROSS] / scale;
            const double found =
                covariance(frames, counts, a, b, offsets[k][0], offsets[k][1]) / (photons * scale);
            printf("windows %d and %d, (%d, %d): correlation %.4f, pairs %.4f\n", a, b, offsets[k][0],
                   offsets[k][1], found, wanted);
            ck_assert_double_eq_tol(found, wanted, error + 0.01);
        }
    skg_plan_release(&plan);
}
END_TEST

/* SKG_OUTPUT_VARIANCE knows what frames show. */
START_TEST(variances_are_counts) {
    static double variance[VALUES];
    double counts[WINDOWS];
    options.noise = 1;
    skg_plan *plan = make_plan();
    render(plan, SKG_OUTPUT_VARIANCE, 0, variance);
    ck_skg(skg_counter_counts_get(options.counter, 60, counts));
    for (int w = 0; w < WINDOWS; w++) /* weights that are cut off */
        ck_assert_double_eq_tol(variance[w * PIXELS + 20 * SIDE + 20] / (photons * counts[w]), 1, 5e-3);
    /* On the border, pixels stand for those beyond. */
    ck_assert_double_gt(variance[20 * SIDE], variance[20 * SIDE + 20]);
    skg_plan_release(&plan);
}
END_TEST

/* Pulses at random times, one after the other: the counts of a long time. */
static void count_pulses(int32_t kind, double rate, double length, uint64_t *seed, double *counted) {
    double now = 0, free_from = 0;
    *counted = 0;
    for (;;) {
        now -= log1p(-draw(seed, 0, 1)) / rate;
        if (now > length) return;
        const int counts = now >= free_from;
        *counted += counts;
        if (counts || kind == SKG_PILE_UP_PARALYSABLE) free_from = now + 1;
    }
}

/* Dead times that follow pulses one by one leave the numbers, and the variances, of the closed forms. */
START_TEST(dead_time_is_that_of_single_pulses) {
    enum { TIMES = 4000 };
    static const double rates[] = {0.01, 0.1, 0.4, 1};
    const double length = 200;
    for (int32_t kind = SKG_PILE_UP_NONPARALYSABLE; kind <= SKG_PILE_UP_PARALYSABLE; kind++)
        for (int r = 0; r < 4; r++) {
            double sum = 0, squares = 0, counted = 0, left = 0, fano = 0;
            uint64_t seed = 5;
            for (int t = 0; t < TIMES; t++) {
                count_pulses(kind, rates[r], length, &seed, &counted);
                sum += counted, squares += counted * counted;
            }
            const double mean = sum / TIMES, variance = squares / TIMES - mean * mean;
            ck_skg(skg_pile_up_get(kind, rates[r], &left, &fano));
            printf("kind %d, rate %g: %.4f counts, %.4f; variance %.4f of the mean, %.4f\n", (int)kind,
                   rates[r], mean / length, left, variance / mean, fano);
            /* Four standard errors; the time begins alive, which adds up to one count. */
            ck_assert_double_eq_tol(mean, left * length, 4 * sqrt(variance / TIMES) + 1);
            /* Standard error sqrt(2 / TIMES), four of them, and the beginning. */
            ck_assert_double_eq_tol(variance / mean, fano, 0.09 * fano + 1 / length);
        }
}
END_TEST

/* Counts of the open beam in the windows of a plan. */
static void open_beam(const skg_plan *plan, double recorded[WINDOWS]) {
    for (int w = 0; w < WINDOWS; w++) {
        skg_channel channel;
        skg_channel_init(&channel);
        ck_skg(skg_plan_channel_get(plan, w, &channel));
        recorded[w] = channel.flat_field;
    }
}

/* The variance over pixels and frames of one window, or of the sum of all (window -1). */
static double variance_of(const double *frames, int window, double mean) {
    double sums = 0, squares = 0;
    for (int f = 0; f < FRAMES; f++)
        for (int p = 0; p < PIXELS; p++) {
            const double *at = frames + (int64_t)f * VALUES + p;
            const double off = (window < 0 ? at[0] + at[PIXELS] : at[(ptrdiff_t)window * PIXELS]) - mean;
            sums += off, squares += off * off;
        }
    const double n = (double)FRAMES * PIXELS;
    return squares / n - sums * sums / (n * n);
}

/* Images lose pulses, and their noise with them; pulses that overlap move to the higher window. */
START_TEST(images_lose_and_move_pulses) {
    static double image[VALUES], plain[VALUES], frames[FRAMES * VALUES];
    double counts[WINDOWS], recorded[WINDOWS], left = 0, fano = 0;
    const int32_t kind = _i;
    skg_plan *plan = make_plan();
    skg_plan_release(&plan);
    ck_skg(skg_counter_counts_get(options.counter, 60, counts));
    const double all = photons * (counts[0] + counts[1]);
    counting.pile_up = kind, counting.dead_time_ns = 100, counting.exposure_s = all * 100e-9 / 0.3;
    options.noise = 1;
    plan = make_plan();
    render(plan, SKG_OUTPUT_MEAN, 0, image);
    ck_skg(skg_pile_up_get(kind, 0.3, &left, &fano));
    open_beam(plan, recorded);
    ck_assert_double_eq_tol((recorded[0] + recorded[1]) / (all * left / 0.3), 1, 1e-9); /* rounding */
    for (int w = 0; w < WINDOWS; w++)                                                   /* floats */
        ck_assert_double_eq_tol(image[w * PIXELS + 820] / recorded[w], 1, 2e-5);
    /* Some 0.3 of the pulses meet another one. */
    ck_assert_double_gt(recorded[1] / (photons * counts[1]), 1.1 * left / 0.3);
    for (int f = 0; f < FRAMES; f++) render(plan, SKG_OUTPUT_IMAGE, f, frames + (int64_t)f * VALUES);
    const double counted = all * left / 0.3, variance = variance_of(frames, -1, counted);
    /* Windows of one pixel have no photon in common, so that without dead time the variance of all counts is their mean. Two per cent are
     * four standard errors of correlated pixels, and what is cut off; borders show more. */
    printf("kind %d: variance %.4f of the mean, %.4f\n", (int)kind, variance / counted, fano);
    ck_assert_double_eq_tol(variance / counted / fano, 1, 0.02 + 0.06);
    /* Which window a count falls into is drawn for each. */
    for (int w = 0; w < WINDOWS; w++) {
        const double wanted = recorded[w] * (1 - recorded[w] / counted * (1 - fano));
        const double found = variance_of(frames, w, recorded[w]);
        printf("  window %d: %.4f of the mean, %.4f\n", w, found / recorded[w], wanted / recorded[w]);
        ck_assert_double_eq_tol(found / wanted, 1, 0.02 + 0.06); /* as above */
    }
    /* Of a long exposure nothing is lost. */
    skg_plan_release(&plan);
    counting.exposure_s = 1e6, options.noise = 0;
    plan = make_plan();
    render(plan, SKG_OUTPUT_IMAGE, 0, plain);
    for (int w = 0; w < WINDOWS; w++) /* floats */
        ck_assert_double_eq_tol(plain[w * PIXELS + 820] / (photons * counts[w]), 1, 1e-5);
    skg_plan_release(&plan);
}
END_TEST

/* A window above the energy of all photons holds nothing but sums, whose noise is that of their number. */
START_TEST(sums_make_counts_where_no_photon_does) {
    static const double above[WINDOWS] = {15, 80};
    static double frames[FRAMES * VALUES];
    double recorded[WINDOWS], counts[WINDOWS];
    counting.threshold_kev = above;
    skg_plan *plan = make_plan();
    skg_plan_release(&plan);
    ck_skg(skg_counter_counts_get(options.counter, 60, counts));
    ck_assert_double_lt(counts[1], 1e-12); /* 13 standard deviations of the noise above */
    counting.pile_up = SKG_PILE_UP_NONPARALYSABLE, counting.dead_time_ns = 100;
    counting.exposure_s = photons * counts[0] * 100e-9 / 0.1;
    options.noise = 1;
    plan = make_plan();
    open_beam(plan, recorded);
    ck_assert_double_gt(recorded[1], 0.01 * photons);
    for (int f = 0; f < FRAMES; f++) render(plan, SKG_OUTPUT_IMAGE, f, frames + (int64_t)f * VALUES);
    const double variance = variance_of(frames, 1, recorded[1]);
    printf("%.1f sums with a variance of %.1f\n", recorded[1], variance);
    /* Dead time takes less than a share of 2 n of the part that this window is; the rest as above. */
    ck_assert_double_eq_tol(variance / recorded[1], 1, 0.05);
    skg_plan_release(&plan);
    counting.threshold_kev = thresholds;
}
END_TEST

/* A transmission is over the flat field as it counts. */
START_TEST(ratios_are_those_of_counts) {
    static double image[VALUES];
    counting.pile_up = SKG_PILE_UP_PARALYSABLE, counting.dead_time_ns = 100, counting.exposure_s = 1e-3;
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    skg_plan *plan = make_plan();
    render(plan, SKG_OUTPUT_IMAGE, 0, image);
    for (int i = 0; i < VALUES; i++) ck_assert_double_eq_tol(image[i], 1, 1e-5); /* floats */
    skg_plan_release(&plan);
}
END_TEST

static void refuses(skg_status expected, const char *text) {
    static const double kev = 60;
    skg_spectrum *spectrum = NULL;
    skg_plan *plan = NULL;
    ck_skg(skg_spectrum_create_bins(1, &kev, &photons, &spectrum));
    ck_skg_fails(skg_plan_create(run_context, scene, &view, spectrum, &options, &plan), expected, text);
    skg_spectrum_release(&spectrum);
}

START_TEST(what_cannot_be_combined_is_named) {
    static const double one = 1, edges[2] = {10, 90};
    skg_detector_blur blur;
    skg_scatter scatter;
    skg_detector_blur_init(&blur);
    skg_scatter_init(&scatter);
    blur.columns = blur.rows = 1, blur.along_row = blur.along_column = &one;
    skg_plan *plan = make_plan();
    skg_plan_release(&plan);
    const skg_plan_options good = options;
    options.quantity = SKG_QUANTITY_ENERGY;
    refuses(SKG_ERR_UNSUPPORTED, "take the quantity photons");
    options = good, options.blur = &blur;
    refuses(SKG_ERR_UNSUPPORTED, "a blur (LSF, PSF, MTF)");
    options = good, options.bands = 1, options.band_kev = edges;
    refuses(SKG_ERR_UNSUPPORTED, "bands of energy");
    options = good, options.scatter = &scatter;
    refuses(SKG_ERR_UNSUPPORTED, "scatter, whose energies");
    options = good, options.swank = 0.9;
    refuses(SKG_ERR_UNSUPPORTED, "a Swank factor");
    options = good, options.precision = SKG_PRECISION_HALF;
    refuses(SKG_ERR_UNSUPPORTED, "photon counting");
    options = good, view.column_step[0] = 0.2;
    refuses(SKG_ERR_SCENE, "pixels of 0.1 x 0.1 mm, those of the view are 0.2 x 0.1 mm");
    options = good;
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_test(tests, the_open_beam_makes_the_counts_of_a_photon);
    tcase_add_test(tests, one_pixel_of_beam_shows_where_counts_are);
    tcase_add_loop_test(tests, noise_is_shared_as_photons_are, 0, 2);
    tcase_add_test(tests, variances_are_counts);
    tcase_add_test(tests, dead_time_is_that_of_single_pulses);
    tcase_add_test(tests, sums_make_counts_where_no_photon_does);
    tcase_add_loop_test(tests, images_lose_and_move_pulses, SKG_PILE_UP_NONPARALYSABLE,
                        SKG_PILE_UP_PARALYSABLE + 1);
    tcase_add_test(tests, ratios_are_those_of_counts);
    tcase_add_test(tests, what_cannot_be_combined_is_named);
}

SKG_SUITE_MAIN("counting", add_tests)
