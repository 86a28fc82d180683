#include "trial/judge.h"
#include "frame/plan.h"
#include "trial/exposure.h"
#include "trial/place.h"

#include <skiagraph/frame.h>
#include <skiagraph/plan.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <time.h>

enum { N = SKG_TRIAL_PIXELS, PIXELS = N * N, SCORED_PIXELS = 512, SCORED_FRAMES = 3, REPAIRED = 8 };

typedef struct {
    skg_trial_scene scene;
    skg_plan *plan;
    double lengths[PIXELS], image[PIXELS]; /* what the device gives */
    double surface[PIXELS], shown[PIXELS]; /* what it should give */
    double blurred[PIXELS];
    double longest, open;
    int64_t bad_pixels; /* as the image's report has them */
} trial_run;

static void read_floats(const skg_trial_scene *scene, const void *from, double *to) {
    for (int p = 0; p < PIXELS; p++)
        to[p] =
            scene->number == SKG_TRIAL_DOUBLE ? ((const double *)from)[p] : (double)((const float *)from)[p];
}

/* Path lengths are shown by kernels of their own, which have a test of their own: a first start need not compile them. */
static int shows_lengths(skg_trial_number number) {
    switch (number) {
    case SKG_TRIAL_CORE:
    case SKG_TRIAL_COPIES:
    case SKG_TRIAL_TILES:
    case SKG_TRIAL_ATOMICS:
    case SKG_TRIAL_DETECTOR:
    case SKG_TRIAL_SHADES:
    case SKG_TRIAL_RAYS:
        return 0;
    default:
        return 1;
    }
}

/* Renders the image, and the lengths of part 0. */
static skg_status render(trial_run *run) {
    double memory[PIXELS] = {0}; /* floats or doubles */
    skg_output output;
    skg_job *job = NULL;
    skg_plan_report report;
    skg_output_init(&output);
    output.data = memory;
    output.type = run->scene.number == SKG_TRIAL_DOUBLE ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
    skg_status status = skg_plan_image(run->plan, &output);
    if (status < 0) return status;
    read_floats(&run->scene, memory, run->image);
    skg_plan_report_init(&report);
    SKG_TRY(skg_plan_report_get(run->plan, &report));
    run->bad_pixels = report.bad_pixels;
    if (!shows_lengths(run->scene.number)) return SKG_OK;
    SKG_TRY(skg_plan_lengths_enqueue(run->plan, 0, SKG_LENGTHS_SURFACE, 1, NULL, &output, &job));
    status = skg_job_wait(&job);
    read_floats(&run->scene, memory, run->lengths);
    return status < 0 ? status : SKG_OK;
}

/* A pixel beyond the edge has the value of the nearest one. */
static double blurred(const trial_run *run, int row, int column) {
    const int half = SKG_TRIAL_BLUR_SAMPLES / 2;
    double sum = 0;
    for (int j = 0; j < SKG_TRIAL_BLUR_SAMPLES; j++)
        for (int i = 0; i < SKG_TRIAL_BLUR_SAMPLES; i++) {
            const int r = (int)fmin(fmax(row - (j - half), 0), N - 1);
            const int c = (int)fmin(fmax(column - (i - half), 0), N - 1);
            sum += run->scene.along_column[j] * run->scene.along_row[i] * run->shown[r * N + c];
        }
    return sum;
}

/* The mean over the rays of a pixel. */
static double mean_intensity(trial_run *run, int row, int column) {
    const int side = run->scene.options.supersampling;
    double net[2], sum = 0;
    for (int k = 0; k < side * side; k++) {
        const double down = (k / side + 0.5) / side - 0.5, right = (k % side + 0.5) / side - 0.5;
        skg_trial_lengths(&run->scene, row + down, column + right, &run->surface[row * N + column], net);
        sum += skg_trial_intensity(&run->scene, net, &run->open);
    }
    return sum / (side * side);
}

static skg_status expect(trial_run *run) {
    double share = 1;
    for (int p = 0; p < PIXELS; p++) {
        if (run->scene.number == SKG_TRIAL_SHADES)
            SKG_TRY(skg_trial_shade(&run->scene, p / N, p % N, &share));
        run->shown[p] = share * mean_intensity(run, p / N, p % N);
        run->longest = fmax(run->longest, run->surface[p]);
    }
    return SKG_OK;
}

/* Compares `got` with `wanted`: at most `most` pixels may differ by more than `bar`. */
static int compare(const double *got, const double *wanted, double bar, int most, const char *what,
                   skg_finding *finding) {
    int outside = 0, first = -1;
    for (int p = 0; p < PIXELS; p++)
        if (!(fabs(got[p] - wanted[p]) <= bar)) {
            if (first < 0) first = p;
            outside++;
        }
    if (outside <= most) return 1;
    snprintf(finding->reason, sizeof finding->reason,
             "%d of %d pixels are wrong; pixel (%d, %d) has %s of %.6g instead of %.6g", outside, PIXELS,
             first / N, first % N, what, got[first], wanted[first]);
    return 0;
}

/* Noise: with the expected mean and variance, normal deviates have the sum 0 and the sum of squares n, with standard
 * deviations sqrt(n) and sqrt(2 n). Six of them. */
static int compare_noise(const trial_run *run, skg_finding *finding) {
    double sum = 0, squares = 0;
    const double kev = run->open / 1000; /* 1000 photons reach a pixel of the open beam */
    for (int p = 0; p < PIXELS; p++) {
        const double deviate = (run->image[p] - run->shown[p]) / sqrt(kev * run->shown[p]);
        sum += deviate, squares += deviate * deviate;
    }
    if (fabs(sum) <= 6 * sqrt(PIXELS) && fabs(squares - PIXELS) <= 6 * sqrt(2 * PIXELS)) return 1;
    snprintf(
        finding->reason, sizeof finding->reason,
        "over %d pixels the noise has a mean of %.3g standard deviations and a variance of %.3g instead of 1",
        PIXELS, sum / PIXELS, squares / PIXELS);
    return 0;
}

/* The corner in the middle of an edge is rounded, so that a ray or two may pass beside it. */
static void compare_count(const trial_run *run, skg_finding *finding) {
    finding->good = run->bad_pixels >= 0 && run->bad_pixels <= REPAIRED;
    if (!finding->good)
        snprintf(finding->reason, sizeof finding->reason,
                 "%" PRId64 " of %d pixels are counted as bad instead of at most %d", run->bad_pixels, PIXELS,
                 REPAIRED);
}

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Images per second, by the fastest of some; by the same kernels as the plan that was compared. */
static skg_status score(skg_context *context, int32_t strategy, double *result) {
    trial_run *run = NULL;
    float *image = NULL;
    skg_output output;
    skg_status status = SKG_OK;
    double fastest = DBL_MAX;
    SKG_TRY(skg_alloc(1, sizeof *run, "device test", &run));
    SKG_TRY_CLEANUP(skg_alloc((int64_t)SCORED_PIXELS * SCORED_PIXELS, sizeof *image, "device test", &image));
    SKG_TRY_CLEANUP(skg_trial_scene_create(context, SKG_TRIAL_CORE, SCORED_PIXELS, &run->scene));
    run->scene.options.strategy = strategy;
    SKG_TRY_CLEANUP(skg_plan_make(context, run->scene.scene, &run->scene.view, run->scene.beam,
                                  &run->scene.options, &run->plan));
    skg_output_init(&output);
    output.data = image;
    for (int k = 0; k < SCORED_FRAMES; k++) {
        const double start = now();
        SKG_TRY_CLEANUP(skg_plan_image(run->plan, &output));
        fastest = fmin(fastest, now() - start);
    }
    *result = fastest > 0 ? 1 / fastest : 0;
cleanup:
    skg_plan_release(&run->plan);
    skg_trial_scene_release(&run->scene);
    skg_free(&image);
    skg_free(&run);
    return status;
}

static void compare_all(trial_run *run, skg_finding *finding) {
    const skg_trial_number number = run->scene.number;
    const skg_trial *trial = skg_trial_get(number);
    const int most = number == SKG_TRIAL_LEAKY ? REPAIRED : 0;
    finding->good =
        !shows_lengths(number) || compare(run->lengths, run->surface, trial->length_error * run->longest,
                                          most, "a path length in mm", finding);
    if (!finding->good) return;
    if (number == SKG_TRIAL_DETECTOR) {
        finding->good = 0;
        skg_trial_detector_compare(&run->scene.view, run->image, run->shown, run->open, finding);
        return;
    }
    if (number == SKG_TRIAL_NOISE) {
        finding->good = compare_noise(run, finding);
        return;
    }
    double *wanted = run->shown;
    if (number == SKG_TRIAL_BLUR) {
        for (int p = 0; p < PIXELS; p++) run->blurred[p] = blurred(run, p / N, p % N);
        wanted = run->blurred;
    }
    finding->good =
        compare(run->image, wanted, trial->image_error * run->open, most, "an energy in keV", finding);
}

skg_status skg_trial_judge(skg_context *context, skg_trial_number number, skg_finding *finding) {
    trial_run *run = NULL;
    skg_buffer positions = {0};
    skg_status status = SKG_OK;
    *finding = (skg_finding){0};
    SKG_TRY(skg_alloc(1, sizeof *run, "device test", &run));
    SKG_TRY_CLEANUP(skg_trial_scene_create(context, number, N, &run->scene));
    if (number == SKG_TRIAL_DETECTOR) skg_trial_detector_choose(&run->scene.options);
    if (number == SKG_TRIAL_SHADES) SKG_TRY_CLEANUP(skg_trial_shades_choose(&run->scene));
    SKG_TRY_CLEANUP(skg_plan_make(context, run->scene.scene, &run->scene.view, run->scene.beam,
                                  &run->scene.options, &run->plan));
    if (number == SKG_TRIAL_PLACE)
        SKG_TRY_CLEANUP(skg_trial_place(context, &run->scene, run->plan, &positions));
    SKG_TRY_CLEANUP(render(run));
    SKG_TRY_CLEANUP(expect(run));
    compare_all(run, finding);
    if (finding->good && number == SKG_TRIAL_LEAKY) compare_count(run, finding);
    if (finding->good && number == SKG_TRIAL_CORE)
        status = score(context, run->plan->recipe->strategy, &finding->score);
cleanup:
    skg_plan_release(&run->plan);
    skg_trial_scene_release(&run->scene);
    skg_buffer_release(&positions);
    skg_free(&run);
    return status;
}
