/* Renders the self-tests of images and path lengths, and compares. */
#include "core/clock.h"
#include "frame/plans.h"
#include "geometry/optics.h"
#include "selftest/selftest.h"

#include <skiagraph/frame.h>
#include <skiagraph/plan.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

enum { N = SKG_SELF_TEST_PIXELS, PIXELS = N * N, SCORED_PIXELS = 512, SCORED_FRAMES = 3, REPAIRED = 8 };

typedef struct {
    skg_self_test_scene scene;
    skg_plan *plan;
    double lengths[PIXELS], image[PIXELS]; /* what the device gives */
    double surface[PIXELS], shown[PIXELS]; /* what it should give */
    double blurred[PIXELS];
    double longest, open;
    int32_t pixels; /* that the image has */
    int32_t reserved;
    int64_t bad_pixels; /* as the image's report has them */
} test_run;

static void read_floats(const test_run *run, const void *from, double *to) {
    for (int p = 0; p < run->pixels; p++)
        to[p] = run->scene.number == SKG_SELF_TEST_DOUBLE ? ((const double *)from)[p]
                                                          : (double)((const float *)from)[p];
}

/* Path lengths are shown by kernels of their own, which have a test of their own: a first start need not compile them. */
static int shows_lengths(skg_self_test number) {
    switch (number) {
    case SKG_SELF_TEST_CORE:
    case SKG_SELF_TEST_COPIES:
    case SKG_SELF_TEST_TILES:
    case SKG_SELF_TEST_ATOMICS:
    case SKG_SELF_TEST_DETECTOR:
    case SKG_SELF_TEST_SHADES:
    case SKG_SELF_TEST_RAYS:
    case SKG_SELF_TEST_HEEL:
    case SKG_SELF_TEST_DEPTHS:
    case SKG_SELF_TEST_APART:
    case SKG_SELF_TEST_PASSES:
    case SKG_SELF_TEST_SIDE:
    case SKG_SELF_TEST_VARIANCE:
    case SKG_SELF_TEST_LINEAR:
        return 0;
    default:
        return 1;
    }
}

static int is_blurred(skg_self_test number) {
    return number == SKG_SELF_TEST_BLUR || number == SKG_SELF_TEST_DEPTHS;
}

/* Renders the image or its variance, and the lengths of part 0. */
static skg_status render(test_run *run) {
    double memory[PIXELS] = {0}; /* floats or doubles */
    skg_output output;
    skg_plan_report report;
    skg_output_init(&output);
    output.data = memory;
    output.type = run->scene.number == SKG_SELF_TEST_DOUBLE ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
    if (run->scene.number == SKG_SELF_TEST_VARIANCE) output.kind = SKG_OUTPUT_VARIANCE;
    skg_status status = skg_plan_image(run->plan, &output);
    if (SKG_FAILED(status)) return status;
    read_floats(run, memory, run->image);
    skg_plan_report_init(&report);
    SKG_TRY(skg_plan_report_get(run->plan, &report));
    run->bad_pixels = report.bad_pixels;
    if (!shows_lengths(run->scene.number)) return SKG_OK;
    output.kind = SKG_OUTPUT_LENGTHS;
    output.lengths = SKG_LENGTHS_SURFACE;
    status = skg_plan_image(run->plan, &output);
    read_floats(run, memory, run->lengths);
    return SKG_FAILED(status) ? status : SKG_OK;
}

/* The mean over the samples of the source and the rays of a pixel. */
static double mean_intensity(test_run *run, const skg_samples *samples, int row, int column,
                             const double *shares) {
    skg_view *view = &run->scene.view;
    const skg_view point = *view;
    const int p = row * (int)view->columns + column, side = run->scene.options.supersampling;
    double net[SKG_SELF_TEST_PARTS], shift[2], sum = 0;
    for (int64_t s = 0; s < samples->spot_count; s++) {
        if (run->scene.options.spot) skg_samples_at(samples, &point, s, view->source, shift);
        for (int k = 0; k < side * side; k++) {
            const double down = (k / side + 0.5) / side - 0.5, right = (k % side + 0.5) / side - 0.5;
            skg_self_test_lengths(&run->scene, row + down, column + right, &run->surface[p], net);
            sum += skg_self_test_intensity(&run->scene, shares, net, &run->open);
        }
    }
    *view = point;
    return sum / (double)(samples->spot_count * side * side);
}

static skg_status expect(test_run *run) {
    const skg_self_test number = run->scene.number;
    const int columns = (int)run->scene.view.columns;
    double shares[SKG_SELF_TEST_ENERGIES_MAX];
    for (int e = 0; e < SKG_SELF_TEST_ENERGIES_MAX; e++) shares[e] = 1;
    skg_samples samples;
    SKG_TRY(skg_samples_make(run->scene.options.spot, 1, &samples));
    for (int p = 0; p < run->pixels; p++) {
        const int row = p / columns, column = p % columns;
        if (number == SKG_SELF_TEST_SHADES) SKG_TRY(skg_self_test_shade(&run->scene, row, column, shares));
        if (number == SKG_SELF_TEST_HEEL) SKG_TRY(skg_self_test_heel(&run->scene, row, column, shares));
        run->shown[p] = mean_intensity(run, &samples, row, column, shares);
        run->longest = fmax(run->longest, run->surface[p]);
    }
    return is_blurred(number) ? skg_self_test_blur(&run->scene, run->shown, run->blurred) : SKG_OK;
}

/* Compares `got` with `wanted`: at most `most` pixels may differ by more than `bar`. */
static int compare(const test_run *run, const double *got, const double *wanted, double bar, int most,
                   const char *what, skg_verdict *verdict) {
    const int columns = (int)run->scene.view.columns;
    int outside = 0, first = -1;
    for (int p = 0; p < run->pixels; p++)
        if (!(fabs(got[p] - wanted[p]) <= bar)) {
            if (first < 0) first = p;
            outside++;
        }
    if (outside <= most) return 1;
    snprintf(verdict->reason, sizeof verdict->reason,
             "%d of %d pixels are wrong; pixel (%d, %d) has %s of %.6g instead of %.6g", outside, run->pixels,
             first / columns, first % columns, what, got[first], wanted[first]);
    return 0;
}

/* The corner in the middle of an edge is rounded, so that a ray or two may pass beside it. */
static void compare_count(const test_run *run, skg_verdict *verdict) {
    verdict->good = run->bad_pixels >= 0 && run->bad_pixels <= REPAIRED;
    if (!verdict->good)
        snprintf(verdict->reason, sizeof verdict->reason,
                 "%" PRId64 " of %d pixels are counted as bad instead of at most %d", run->bad_pixels,
                 run->pixels, REPAIRED);
}

/* Images per second, by the fastest of some; by the same kernels as the plan that was compared. */
static skg_status score(skg_context *context, int32_t strategy, double *result) {
    test_run *run = NULL;
    float *image = NULL;
    skg_output output;
    skg_status status = SKG_OK;
    double fastest = DBL_MAX;
    SKG_TRY(skg_alloc(1, sizeof *run, "device test", &run));
    SKG_TRY_CLEANUP(skg_alloc((int64_t)SCORED_PIXELS * SCORED_PIXELS, sizeof *image, "device test", &image));
    SKG_TRY_CLEANUP(skg_self_test_scene_create(context, SKG_SELF_TEST_CORE, SCORED_PIXELS, &run->scene));
    run->scene.options.strategy = strategy;
    SKG_TRY_CLEANUP(skg_plan_create(context, run->scene.scene, &run->scene.view, run->scene.beam,
                                    &run->scene.options, &run->plan));
    skg_output_init(&output);
    output.data = image;
    for (int k = 0; k < SCORED_FRAMES; k++) {
        const double start = skg_seconds();
        SKG_TRY_CLEANUP(skg_plan_image(run->plan, &output));
        fastest = fmin(fastest, skg_seconds() - start);
    }
    *result = fastest > 0 ? 1 / fastest : 0;
cleanup:
    skg_plan_release(&run->plan);
    skg_self_test_scene_release(&run->scene);
    skg_free(&image);
    skg_free(&run);
    return status;
}

static void compare_all(test_run *run, skg_verdict *verdict) {
    const skg_self_test number = run->scene.number;
    const skg_tolerance tolerance = skg_self_test_tolerance(number);
    const int most = number == SKG_SELF_TEST_LEAKY ? REPAIRED : 0;
    verdict->good =
        !shows_lengths(number) || compare(run, run->lengths, run->surface, tolerance.length * run->longest,
                                          most, "a path length in mm", verdict);
    if (!verdict->good) return;
    if (number == SKG_SELF_TEST_DETECTOR) {
        verdict->good = 0;
        skg_self_test_detector_compare(&run->scene.view, run->image, run->shown, run->open, verdict);
    } else if (number == SKG_SELF_TEST_NOISE || number == SKG_SELF_TEST_APART) {
        skg_self_test_noise_compare(&run->scene, run->image, run->shown, run->open, verdict);
    } else if (number == SKG_SELF_TEST_VARIANCE) {
        skg_self_test_variance_compare(&run->scene, run->image, run->shown, verdict);
    } else {
        verdict->good = compare(run, run->image, is_blurred(number) ? run->blurred : run->shown,
                                tolerance.image * run->open, most, "an energy in keV", verdict);
    }
}

skg_status skg_self_test_image(skg_context *context, skg_self_test number, skg_verdict *verdict) {
    test_run *run = NULL;
    skg_buffer positions = {0};
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof *run, "device test", &run));
    SKG_TRY_CLEANUP(skg_self_test_scene_create(context, number, N, &run->scene));
    run->pixels = (int32_t)(run->scene.view.rows * run->scene.view.columns);
    if (number == SKG_SELF_TEST_DETECTOR) skg_self_test_detector_choose(&run->scene.options);
    if (number == SKG_SELF_TEST_SHADES) SKG_TRY_CLEANUP(skg_self_test_shades_choose(&run->scene));
    if (number == SKG_SELF_TEST_HEEL) skg_self_test_heel_choose(&run->scene);
    SKG_TRY_CLEANUP(skg_self_test_blurs_choose(&run->scene));
    SKG_TRY_CLEANUP(skg_plan_create(context, run->scene.scene, &run->scene.view, run->scene.beam,
                                    &run->scene.options, &run->plan));
    if (number == SKG_SELF_TEST_PLACE)
        SKG_TRY_CLEANUP(skg_self_test_place(context, &run->scene, run->plan, &positions));
    SKG_TRY_CLEANUP(render(run));
    SKG_TRY_CLEANUP(expect(run));
    compare_all(run, verdict);
    if (verdict->good && number == SKG_SELF_TEST_LEAKY) compare_count(run, verdict);
    if (verdict->good && number == SKG_SELF_TEST_CORE)
        status = score(context, run->plan->recipe->strategy, &verdict->score);
cleanup:
    skg_plan_release(&run->plan);
    skg_self_test_scene_release(&run->scene);
    skg_buffer_release(&positions);
    skg_free(&run);
    return status;
}
