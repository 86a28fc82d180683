/* The open field of a view: what noisy images are shown over where a world or falloff make it differ from
 * pixel to pixel. */
#include "frame/frame.h"
#include "stage/raster_private.h"

#include <string.h>

static skg_status enqueue(skg_plan *plan, skg_job *job, const skg_view *view, skg_image_place *place) {
    const int averages = skg_plan_averages(plan);
    const int64_t passes = averages ? skg_samples_count(&plan->samples) : 1;
    const int64_t accumulators = plan->main->options.planes;
    const skg_sums sums = {.raster = plan->main,
                           .scale = 1,
                           .mixed = accumulators == plan->model.planes ? 0 : (int32_t)accumulators,
                           .lists = plan->mix_lists.memory};
    for (int64_t s = 0; s < passes; s++) {
        skg_camera camera;
        double source[3], shift[2] = {0, 0};
        if (averages) skg_samples_at(&plan->samples, view, s, source, shift);
        SKG_TRY(skg_camera_make(view, averages ? source : NULL, shift[0], shift[1], &camera));
        place->add = s > 0;
        SKG_TRY(skg_attenuate_open(plan->attenuator, &sums, &camera, &plan->attenuation, 1 / (double)passes,
                                   plan->negative.memory, place, &job->log));
    }
    if (!plan->blur) return SKG_OK;
    return skg_blur_run(plan->blur, place, view->columns, view->rows, plan->model.channels, &job->log);
}

skg_status skg_field_find(skg_plan *plan, skg_job *job, const skg_frame_work *work) {
    skg_open_field *field = &plan->field;
    const int64_t size = plan->view.rows * plan->view.columns;
    const int32_t is_double = work->place.output_double;
    if (!field->wanted) return SKG_OK;
    if (field->known && field->is_double == is_double &&
        memcmp(&field->view, work->view, sizeof field->view) == 0)
        return SKG_OK;
    field->known = 0;
    SKG_TRY(skg_buffer_reserve(plan->context, &field->image,
                               plan->model.channels * size *
                                   (int64_t)(is_double ? sizeof(double) : sizeof(float)),
                               CL_MEM_READ_WRITE, "open field"));
    skg_image_place place = {.memory = field->image.memory,
                             .output_double = is_double,
                             .row_stride = plan->view.columns,
                             .channel_stride = size};
    SKG_TRY(enqueue(plan, job, work->view, &place));
    field->known = 1;
    field->is_double = is_double;
    field->view = *work->view;
    return SKG_OK;
}
