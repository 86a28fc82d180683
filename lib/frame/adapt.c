/* Adaptive sampling of an extended source: doubles the samples until the image stays. */
#include "frame/frames.h"
#include "frame/plans.h"
#include "spectral/model.h"

#include <math.h>
#include <stdlib.h>

/* The fraction of the pixels that a doubling must not change much. */
static const double PIXELS_MAX = 0.999;

static int by_size(const void *a, const void *b) {
    const float *left = a, *right = b;
    return (*left > *right) - (*left < *right);
}

/* The change, as a share of the flat field, that PIXELS_MAX of the pixels of all channels do not exceed. change:
 * workspace. */
static double max_change(const skg_recipe *recipe, const float *before, const float *after, float *change) {
    const skg_model *model = &recipe->model;
    const int64_t size = recipe->view.rows * recipe->view.columns, count = size * model->channels;
    const int is_ratio =
        skg_quantity_is_ratio(&recipe->options) && !skg_quantity_is_absolute(&recipe->options);
    for (int64_t i = 0; i < count; i++) {
        const double flat = is_ratio ? 1 : model->flat_field[i / size];
        change[i] = flat > 0 ? (float)(fabs((double)after[i] - (double)before[i]) / flat) : 0;
    }
    qsort(change, (size_t)count, sizeof *change, by_size);
    return (double)change[(int64_t)(PIXELS_MAX * (double)(count - 1))];
}

/* Renders the mean intensities (a ratio before its logarithm, without noise) with `samples` samples of the source and one
 * ray a pixel. */
static skg_status render(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome,
                         int64_t samples, float *image) {
    skg_recipe *linear = NULL;
    skg_job *job = NULL;
    skg_output output = {.size = sizeof output, .data = image};
    skg_status status = SKG_OK;
    SKG_TRY(skg_recipe_copy(recipe, &linear));
    linear->linear = 1;
    linear->samples.spot_count = samples;
    linear->samples.shifts = linear->samples.fine = 1;
    SKG_TRY_CLEANUP(
        skg_job_create("skg_plan_create", &skg_job_images, linear, machine, outcome, 1, 1, &output, &job));
    job->of_plan = 1;
    SKG_TRY_CLEANUP(skg_submit_frames(&job, NULL, 0));
    status = skg_job_complete(&job);
    if (status == SKG_ERR_CANCELLED)
        status = skg_fail(status, "interrupted while the number of samples of the source was found, at %d",
                          (int)samples);
    if (status == SKG_RANGE) status = SKG_OK; /* the change does not depend on the verified range */
cleanup:
    skg_recipe_release(&linear);
    return status;
}

static skg_status double_samples(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome,
                                 float *images[2], float *change, int64_t *found) {
    const skg_spot *spot = &recipe->samples.spot;
    double *error = &outcome->report.sample_error;
    int small = 0; /* doublings in a row that changed less than the tolerance */
    int64_t samples = 4;
    SKG_TRY(render(recipe, machine, outcome, samples, images[0]));
    for (int turn = 1; small < 2 && 2 * samples <= spot->samples_max; turn++) {
        samples *= 2;
        SKG_TRY(render(recipe, machine, outcome, samples, images[turn % 2]));
        *error = max_change(recipe, images[1 - turn % 2], images[turn % 2], change);
        small = *error < spot->tolerance ? small + 1 : 0;
    }
    *found = samples < spot->samples_max ? samples : spot->samples_max;
    if (small < 2)
        skg_log(
            machine->context, SKG_LOG_WARNING,
            "%d samples of the source change 0.1 %% of the pixels by more than %.2g of the flat field; %.2g was "
            "asked for; allow more",
            (int)*found, *error, spot->tolerance);
    return SKG_OK;
}

static skg_status find_samples(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome,
                               int64_t *found) {
    const int64_t count = recipe->view.rows * recipe->view.columns * recipe->model.channels;
    float *images[2] = {NULL, NULL}, *change = NULL;
    skg_status status = SKG_OK;
    for (int k = 0; k < 2; k++) SKG_TRY_CLEANUP(skg_alloc(count, sizeof **images, "samples", &images[k]));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *change, "samples", &change));
    status = double_samples(recipe, machine, outcome, images, change, found);
cleanup:
    for (int k = 0; k < 2; k++) skg_free(&images[k]);
    skg_free(&change);
    return status;
}

skg_status skg_samples_adapt(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome,
                             skg_recipe **adapted) {
    const skg_spot *spot = &recipe->samples.spot;
    int64_t found = recipe->samples.spot_count;
    *adapted = NULL;
    atomic_store(&machine->context->interrupted, 0);
    if (spot->shape == SKG_SPOT_POINT || spot->samples != 0 || spot->grid != 0) {
        *adapted = skg_recipe_retain(recipe);
    } else {
        SKG_TRY(find_samples(recipe, machine, outcome, &found));
        SKG_TRY(skg_recipe_copy(recipe, adapted));
        (*adapted)->samples.spot_count = found;
    }
    outcome->report.samples = skg_samples_count(&(*adapted)->samples);
    return SKG_OK;
}
