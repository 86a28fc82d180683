/* How many samples an extended source needs at the plan's view: doubled until two doublings in a row change
 * little (contracts 4.5). */
#include "frame/plan.h"

#include <math.h>
#include <stdlib.h>

static int by_size(const void *a, const void *b) {
    const float *left = a, *right = b;
    return (*left > *right) - (*left < *right);
}

/* What 99.9 % of the pixels of all channels change by at most, of the open beam. change: workspace. */
static double most_change(const skg_plan *plan, const float *before, const float *after, float *change) {
    const int64_t size = plan->view.rows * plan->view.columns, count = size * plan->model.channels;
    const int is_ratio = skg_quantity_is_ratio(&plan->options) && !skg_quantity_is_absolute(&plan->options);
    for (int64_t i = 0; i < count; i++) {
        const double open = is_ratio ? 1 : plan->model.flat_field[i / size];
        change[i] = open > 0 ? (float)(fabs((double)after[i] - (double)before[i]) / open) : 0;
    }
    qsort(change, (size_t)count, sizeof *change, by_size);
    return (double)change[(int64_t)(0.999 * (double)(count - 1))];
}

/* The linear image (a ratio before its logarithm, without noise) with so many samples of the source, one ray
 * a pixel. */
static skg_status take(skg_plan *plan, int64_t samples, float *image) {
    const int32_t quantity = plan->options.quantity;
    const int64_t shifts = plan->samples.shifts;
    skg_detector *detector = plan->detector;
    plan->detector = NULL;
    plan->attenuation.noise = 0;
    skg_output output;
    skg_output_init(&output);
    output.data = image;
    plan->samples.spot_count = samples;
    plan->samples.shifts = 1;
    if (quantity == SKG_QUANTITY_ATTENUATION) plan->options.quantity = SKG_QUANTITY_TRANSMISSION;
    skg_status status = skg_plan_image(plan, &output);
    if (status == SKG_RANGE) status = SKG_OK; /* how it differs from the last one does not depend on it */
    plan->options.quantity = quantity;
    plan->detector = detector;
    plan->attenuation.noise = plan->options.noise;
    plan->samples.shifts = shifts;
    return status;
}

static skg_status double_samples(skg_plan *plan, float *images[2], float *change) {
    const skg_spot *spot = &plan->samples.spot;
    int small = 0;
    int64_t samples = 4;
    SKG_TRY(take(plan, samples, images[0]));
    for (int turn = 1; small < 2 && 2 * samples <= spot->most; turn++) {
        samples *= 2;
        SKG_TRY(take(plan, samples, images[turn % 2]));
        plan->report.sample_error = most_change(plan, images[1 - turn % 2], images[turn % 2], change);
        small = plan->report.sample_error < spot->tolerance ? small + 1 : 0;
    }
    plan->samples.spot_count = samples < spot->most ? samples : spot->most;
    if (small < 2)
        skg_log(
            plan->context, SKG_LOG_WARNING,
            "%d samples of the source change 0.1 %% of the pixels by more than %.2g of the open beam; %.2g was "
            "asked for; allow more",
            (int)plan->samples.spot_count, plan->report.sample_error, spot->tolerance);
    return SKG_OK;
}

skg_status skg_plan_find_samples(skg_plan *plan) {
    const skg_spot *spot = &plan->samples.spot;
    const int64_t count = plan->view.rows * plan->view.columns * plan->model.channels;
    float *images[2] = {NULL, NULL}, *change = NULL;
    skg_status status = SKG_OK;
    if (spot->shape != SKG_SPOT_POINT && spot->samples == 0 && spot->grid == 0) {
        for (int k = 0; k < 2; k++) SKG_TRY_CLEANUP(skg_alloc(count, sizeof **images, "samples", &images[k]));
        SKG_TRY_CLEANUP(skg_alloc(count, sizeof *change, "samples", &change));
        status = double_samples(plan, images, change);
    }
    plan->report.samples = skg_samples_count(&plan->samples);
cleanup:
    for (int k = 0; k < 2; k++) skg_free(&images[k]);
    skg_free(&change);
    return status;
}
