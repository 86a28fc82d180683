/* Where derivatives along directions go: memory that is checked, cleared, and filled when all passes were added. */
#include "gradient/direction_results.h"

#include <inttypes.h>
#include <string.h>

skg_status skg_direction_results_place(const skg_context *context, const skg_recipe *recipe,
                                       const skg_output *derivatives, skg_gradient_work *work) {
    skg_frame_output *results = &work->results;
    const skg_output *to = &results->to;
    const skg_view *view = &recipe->view;
    const int64_t size = view->rows * view->columns, count = recipe->model.channels * size;
    skg_output_init(&results->to);
    SKG_TRY(skg_struct_read(derivatives, "skg_output", &results->to, sizeof results->to));
    if (to->kind != SKG_OUTPUT_IMAGE)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: an output of kind %" PRId32 "; there are derivatives of SKG_OUTPUT_IMAGE alone",
                        work->call, to->kind);
    results->channels = recipe->model.channels;
    SKG_TRY(skg_frame_output_check(work->call, view, context, work->direction_count, results));
    const int is_dense =
        to->row_stride == view->columns && (results->channels == 1 || to->channel_stride == size);
    const int stays = to->buffer || to->type != SKG_TYPE_FLOAT64 || !is_dense;
    if (stays)
        SKG_TRY(skg_alloc(work->direction_count * count, sizeof *work->images, "derivative", &work->images));
    for (int64_t d = 0; d < work->direction_count; d++)
        work->directions[d].image =
            stays ? work->images + d * count : (double *)to->data + d * to->frame_stride;
    return SKG_OK;
}

void skg_direction_results_clear(const skg_job *job) {
    const skg_gradient_work *work = skg_gradient_of(job);
    const skg_view *view = &job->recipe->view;
    const int64_t count = work->results.channels * view->rows * view->columns;
    for (int64_t d = 0; d < work->direction_count; d++)
        memset(work->directions[d].image, 0, (size_t)count * sizeof *work->directions[d].image);
}

/* Puts a channel into the caller's memory, all rows at once where they are dense. first: its first element. */
static skg_status put_channel(const skg_job *job, int64_t first, const void *from) {
    const skg_frame_output *results = &skg_gradient_of(job)->results;
    const skg_output *to = &results->to;
    const skg_view *view = &job->recipe->view;
    const int64_t element = skg_frame_output_element(results);
    const int64_t pieces = to->row_stride == view->columns ? 1 : view->rows;
    const size_t bytes = (size_t)(view->rows / pieces * view->columns * element);
    for (int64_t k = 0; k < pieces; k++) {
        const int64_t at = (first + k * to->row_stride) * element;
        const char *piece = (const char *)from + (size_t)k * bytes;
        if (to->buffer)
            SKG_CL_TRY(clEnqueueWriteBuffer(job->machine->context->device->queue, to->buffer, CL_TRUE,
                                            (size_t)at, bytes, piece, 0, NULL, NULL));
        else
            memcpy((char *)to->data + at, piece, bytes);
    }
    return SKG_OK;
}

skg_status skg_direction_results_put(const skg_job *job, int64_t direction) {
    const skg_gradient_work *work = skg_gradient_of(job);
    const skg_frame_output *results = &work->results;
    const skg_view *view = &job->recipe->view;
    const int64_t size = view->rows * view->columns;
    const int is_float = results->to.type == SKG_TYPE_FLOAT32;
    float *rounded = NULL;
    skg_status status = SKG_OK;
    SKG_ASSERT(0 <= direction && direction < work->direction_count);
    if (!work->images) return SKG_OK;
    if (is_float) SKG_TRY(skg_alloc(size, sizeof *rounded, "derivative", &rounded));
    for (int64_t c = 0; c < results->channels && status == SKG_OK; c++) {
        const double *image = work->directions[direction].image + c * size;
        const void *from = is_float ? (const void *)rounded : image;
        const int64_t first =
            results->first + direction * results->to.frame_stride + c * results->to.channel_stride;
        for (int64_t i = 0; i < size && is_float; i++) rounded[i] = (float)image[i];
        status = put_channel(job, first, from);
    }
    skg_free(&rounded);
    return status;
}
