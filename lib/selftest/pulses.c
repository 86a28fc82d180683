/* The self-test of detectors that count: weights of neighbours, dead time, pulses that move, variances. */
#include "selftest/selftest.h"
#include "stage/readout.h"

#include <math.h>
#include <stdio.h>

enum {
    COLUMNS = 19,
    ROWS = 7,
    WINDOWS = 2,
    REACH = 1,
    SIDE = 2 * REACH + 1,
    SQUARE = SIDE * SIDE,
    PIXELS = ROWS * COLUMNS,
    TABLES = WINDOWS * (1 + WINDOWS) * SQUARE
};

/* The share of the exposure that a dead time is: some tenths of a pulse in each. */
static const double dead = 2e-4;

/* Weights without any symmetry, what moves pulses, means and deviations. */
typedef struct {
    double weights[TABLES + 2 * WINDOWS * SKG_PULSE_STEPS];
    float images[2 * WINDOWS * PIXELS], shown[WINDOWS * PIXELS];
} trial;

/* The detector of the trials that move pulses. */
static const double thresholds[WINDOWS] = {20, 50};
static skg_counting counting_of(int pile_up) {
    return (skg_counting){.size = sizeof(skg_counting),
                          .pile_up = pile_up,
                          .count = WINDOWS,
                          .threshold_kev = thresholds,
                          .electronic_kev = 1,
                          .dead_time_ns = dead * 1e9,
                          .exposure_s = 1};
}

static void fill(trial *t) {
    double *heights = t->weights + TABLES + WINDOWS * SKG_PULSE_STEPS;
    const skg_counting counting = counting_of(SKG_PILE_UP_PARALYSABLE);
    for (int k = 0; k < TABLES; k++) t->weights[k] = 0.11 + 0.05 * sin(1.7 * k + 1);
    skg_pile_up_below(&counting, t->weights + TABLES);
    /* Of the lower window from 20 to 50 keV; of the upper one at the last step. */
    for (int j = skg_pulse_first(&counting); j < SKG_PULSE_STEPS; j++)
        heights[j] = 0.02, heights[SKG_PULSE_STEPS + j] = j == SKG_PULSE_STEPS - 1;
    for (int k = 0; k < 2 * WINDOWS * PIXELS; k++)
        t->images[k] = (float)(k < WINDOWS * PIXELS ? 500 + 300 * sin(0.9 * k) : 20 * sin(2.3 * k));
}

static int within(int at, int count) {
    return at < 0 ? 0 : at >= count ? count - 1 : at;
}

/* The sum over a square, or that of the variances of independent pixels. */
static double sum_of(const double *weights, const float *image, int row, int column, int of_variance) {
    double sum = 0, together[PIXELS] = {0};
    for (int j = -REACH; j <= REACH; j++)
        for (int i = -REACH; i <= REACH; i++) {
            const int at = within(row - j, ROWS) * COLUMNS + within(column - i, COLUMNS);
            together[at] += weights[(j + REACH) * SIDE + i + REACH];
        }
    for (int k = 0; k < PIXELS; k++)
        sum += (of_variance ? together[k] * together[k] : together[k]) * (double)image[k];
    return sum;
}

static void expect(const trial *t, int pixel, int pile_up, double *wanted) {
    double mean[WINDOWS], noise[WINDOWS] = {0}, all = 0, moved = 0, counted = 0, fano = 0;
    for (int c = 0; c < WINDOWS; c++) {
        const double *own = t->weights + (WINDOWS + c * WINDOWS) * SQUARE;
        mean[c] =
            sum_of(t->weights + c * SQUARE, t->images + c * PIXELS, pixel / COLUMNS, pixel % COLUMNS, 0);
        for (int k = 0; k < WINDOWS; k++)
            noise[c] += sum_of(own + k * SQUARE, t->images + (WINDOWS + k) * PIXELS, pixel / COLUMNS,
                               pixel % COLUMNS, 0);
        all += mean[c], moved += noise[c];
    }
    skg_pile_up_get(pile_up, all * dead, &counted, &fano); /* valid */
    const double left = counted / (all * dead);
    for (int c = 0; c < WINDOWS; c++) {
        const double part = mean[c] / all * moved;
        wanted[c] = left * mean[c] + sqrt(left * fano) * part + sqrt(left) * (noise[c] - part);
    }
}

/* Without noise, whose deviates are those of other self-tests. */
static void expect_moved(const trial *t, int pixel, int pile_up, double *wanted) {
    const skg_counting counting = counting_of(pile_up);
    for (int c = 0; c < WINDOWS; c++)
        wanted[c] =
            sum_of(t->weights + c * SQUARE, t->images + c * PIXELS, pixel / COLUMNS, pixel % COLUMNS, 0);
    skg_counter_pile(&counting, t->weights + TABLES + WINDOWS * SKG_PULSE_STEPS, wanted);
}

static void expect_variance(const trial *t, int pixel, double *wanted) {
    for (int c = 0; c < WINDOWS; c++) {
        wanted[c] = 0;
        for (int k = 0; k < WINDOWS; k++)
            wanted[c] += sum_of(t->weights + (WINDOWS + c * WINDOWS + k) * SQUARE, t->images + k * PIXELS,
                                pixel / COLUMNS, pixel % COLUMNS, 1);
    }
}

/* Variant of the test. pile_up -1: variances; moved: pulses are moved to other windows. */
typedef struct {
    int pile_up, moved;
} kind;

static void compare(const trial *t, const kind *k, skg_verdict *verdict) {
    double wanted[WINDOWS];
    for (int p = 0; p < PIXELS && verdict->good; p++) {
        if (k->pile_up < 0)
            expect_variance(t, p, wanted);
        else if (k->moved)
            expect_moved(t, p, k->pile_up, wanted);
        else
            expect(t, p, k->pile_up, wanted);
        for (int c = 0; c < WINDOWS && verdict->good; c++) {
            const double shown = (double)t->shown[c * PIXELS + p];
            verdict->good = fabs(shown - wanted[c]) <= 1e-4 * fabs(wanted[c]) + 1e-3; /* rounding of floats */
            if (!verdict->good)
                snprintf(verdict->reason, sizeof verdict->reason,
                         "pixel (%d, %d) has %.6g %s instead of %.6g in window %d", p / COLUMNS, p % COLUMNS,
                         shown, k->pile_up < 0 ? "of variance" : "counts", wanted[c], c);
        }
    }
}

static skg_status run(skg_context *context, trial *t, const kind *k, skg_verdict *verdict) {
    const skg_counting counting = counting_of(k->pile_up);
    const skg_noise_args key = {.seed = {1}};
    skg_counter_kernels kernels = {.windows = WINDOWS,
                                   .reach = REACH,
                                   .means = t->weights,
                                   .first = k->moved ? skg_pulse_first(&counting) : 0};
    skg_buffer from = {0}, to = {0};
    skg_pulses *pulses = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_pulses_create(context, &kernels, k->pile_up < 0 ? 0 : k->pile_up, dead, &pulses));
    SKG_TRY_CLEANUP(skg_buffer_write(context, &from, sizeof t->images, t->images, "device test"));
    SKG_TRY_CLEANUP(skg_buffer_reserve(context, &to, sizeof t->shown, CL_MEM_READ_WRITE, "device test"));
    const skg_image_place before = {.memory = from.memory, .row_stride = COLUMNS, .channel_stride = PIXELS};
    const skg_image_place after = {.memory = to.memory, .row_stride = COLUMNS, .channel_stride = PIXELS};
    SKG_TRY_CLEANUP(k->pile_up < 0 ? skg_pulses_run_variance(pulses, &before, &after, COLUMNS, ROWS, NULL)
                                   : skg_pulses_run(pulses, k->moved ? NULL : &key, &before, &after, COLUMNS,
                                                    ROWS, NULL));
    const cl_int code = clEnqueueReadBuffer(context->device->queue, to.memory, CL_TRUE, 0, sizeof t->shown,
                                            t->shown, 0, NULL, NULL);
    if (code != CL_SUCCESS) status = skg_cl_fail(code, "clEnqueueReadBuffer", __FILE__, __LINE__);
    if (status == SKG_OK) compare(t, k, verdict);
cleanup:
    skg_pulses_release(&pulses);
    skg_buffer_release(&from);
    skg_buffer_release(&to);
    return status;
}

skg_status skg_self_test_pulses(skg_context *context, skg_verdict *verdict) {
    static const kind kinds[] = {{SKG_PILE_UP_NONE, 0},           {SKG_PILE_UP_NONPARALYSABLE, 0},
                                 {SKG_PILE_UP_PARALYSABLE, 0},    {-1, 0},
                                 {SKG_PILE_UP_NONPARALYSABLE, 1}, {SKG_PILE_UP_PARALYSABLE, 1}};
    enum { KINDS = sizeof kinds / sizeof *kinds };
    trial *t = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof *t, "device test", &t));
    fill(t);
    verdict->good = 1;
    for (int k = 0; k < KINDS && status == SKG_OK && verdict->good; k++)
        status = run(context, t, &kinds[k], verdict);
    skg_free(&t);
    return status;
}
