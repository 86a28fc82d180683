/* The flat field of a view, by the stages of an image. */
#include "stage/readout.h"

#include <string.h>

static skg_status enqueue(const skg_flat_field_work *work, const skg_view *view, const skg_image_place *image,
                          skg_staging *staging) {
    const skg_attenuation *attenuation = work->attenuation;
    const int64_t channels = attenuation->channels / attenuation->layers;
    /* There is no layer of noise. */
    const int32_t used = work->pulses                                ? SKG_PULSES_LAYERS
                         : work->layers->count < attenuation->layers ? work->layers->count
                                                                     : attenuation->layers;
    const int64_t passes = work->samples ? skg_samples_passes(work->samples) : 1;
    const int64_t rays = work->samples ? skg_samples_count(work->samples) : 1;
    skg_image_place place;
    SKG_TRY(skg_layers_place(staging->context, work->layers, used, image, view->columns, view->rows, channels,
                             &place));
    for (int64_t s = 0; s < passes; s++) {
        skg_camera camera;
        if (work->samples)
            SKG_TRY(skg_samples_camera(work->samples, view, s, &camera));
        else
            SKG_TRY(skg_camera_make(view, NULL, 0, 0, &camera));
        place.add = s > 0;
        SKG_TRY(skg_attenuate_flat_field(work->attenuator, work->sums, &camera, attenuation,
                                         work->exposure / (double)rays, work->negative, &place,
                                         &staging->log));
    }
    if (work->pulses)
        return skg_pulses_run(work->pulses, NULL, &place, image, view->columns, view->rows, &staging->log);
    return skg_layers_blur(work->layers, used, &place, image, view->columns, view->rows, channels,
                           &staging->log);
}

skg_status skg_flat_field_find(skg_flat_field *field, const skg_flat_field_work *work, const skg_view *view,
                               int32_t is_double, skg_staging *staging) {
    const int64_t size = view->rows * view->columns;
    if (field->known && field->is_double == is_double && memcmp(&field->view, view, sizeof *view) == 0)
        return SKG_OK;
    field->known = 0;
    SKG_TRY(skg_buffer_reserve(staging->context, &field->image,
                               work->attenuation->channels / work->attenuation->layers * size *
                                   (int64_t)(is_double ? sizeof(double) : sizeof(float)),
                               CL_MEM_READ_WRITE, "flat field"));
    skg_image_place place = {.memory = field->image.memory,
                             .output_double = is_double,
                             .row_stride = view->columns,
                             .channel_stride = size};
    SKG_TRY(enqueue(work, view, &place, staging));
    field->known = 1;
    field->is_double = is_double;
    field->view = *view;
    return SKG_OK;
}
