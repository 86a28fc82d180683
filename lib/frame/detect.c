/* What the detector makes of intensities: which stages of noise and blur there are, and in which order. */
#include "frame/frame.h"

#include <math.h>

/* Bounds of a number of keV. */
static skg_status check_kev(const char *what, double kev) {
    if (kev >= 0 && isfinite(kev)) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s is %g keV; 0 or more", what, kev);
}

skg_status skg_plan_check_detector(const skg_plan_options *options) {
    const int kev = options->electronic_kev > 0 || options->quantum_step_kev > 0;
    if (options->noise != 0 && options->noise != 1)
        return skg_fail(SKG_ERR_ARGUMENT, "noise is %d; 1 or 0", (int)options->noise);
    SKG_TRY(check_kev("electronic noise", options->electronic_kev));
    SKG_TRY(check_kev("the quantisation's step", options->quantum_step_kev));
    if (!(options->swank > 0 && options->swank <= 1))
        return skg_fail(SKG_ERR_ARGUMENT, "the Swank factor is %g; above 0, at most 1", options->swank);
    if (kev && options->quantity == SKG_QUANTITY_PHOTONS)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "electronic noise and quantisation are in keV, but photons are counted; take "
                        "another quantity or leave them out");
    return SKG_OK;
}

/* The stage after the blur, where anything is left to do there. */
static skg_status make_last_stage(skg_plan *plan) {
    const skg_plan_options *options = &plan->options;
    const int ratio = skg_quantity_is_ratio(options), areas = options->quantity == SKG_QUANTITY_FLUENCE;
    const skg_detection detection = {.electronic = options->electronic_kev,
                                     .step = options->quantum_step_kev,
                                     .channels = plan->model.channels,
                                     .over_field = ratio && (options->world || options->falloff)};
    double factors[SKG_CHANNELS_MAX];
    if (!skg_quantity_is_absolute(options)) return SKG_OK;
    if (!ratio && !areas && !(detection.electronic > 0) && !(detection.step > 0)) return SKG_OK;
    for (int32_t c = 0; c < plan->model.channels; c++) {
        if (ratio && !(plan->model.flat_field[c] > 0))
            return skg_fail(SKG_ERR_BEAM,
                            "channel %d records nothing of the open beam, so there is no ratio to it",
                            (int)c);
        factors[c] = ratio && !detection.over_field ? 1 / plan->model.flat_field[c] : 1;
    }
    plan->field.wanted = detection.over_field;
    return skg_detector_create(plan->context, &detection, factors, &plan->detector);
}

skg_status skg_plan_make_detector(skg_plan *plan) {
    if (plan->options.blur) SKG_TRY(skg_blur_create(plan->context, plan->options.blur, &plan->blur));
    plan->options.blur = NULL; /* the caller's, and read */
    return make_last_stage(plan);
}

int skg_plan_is_late(const skg_plan *plan) {
    return skg_plan_averages(plan) || plan->blur || skg_quantity_is_absolute(&plan->options);
}

skg_status skg_plan_detect(skg_plan *plan, skg_job *job, const skg_frame_work *work) {
    const int64_t columns = plan->view.columns, rows = plan->view.rows;
    const skg_image_place *image = &work->place;
    skg_camera camera;
    if (plan->blur) SKG_TRY(skg_blur_run(plan->blur, image, columns, rows, plan->model.channels, &job->log));
    if (!plan->detector) return SKG_OK;
    SKG_TRY(skg_camera_make(work->view, NULL, 0, 0, &camera));
    const double factor =
        plan->options.quantity == SKG_QUANTITY_FLUENCE ? 1 / skg_camera_pixel_area(&camera) : 1;
    SKG_TRY(skg_field_find(plan, job, work));
    return skg_detector_run(plan->detector, &work->noise, factor, plan->field.image.memory, image, columns,
                            rows, &job->log);
}
