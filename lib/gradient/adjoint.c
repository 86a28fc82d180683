/* From d loss / d image to d loss / d intensities: the transpose of what the detector does. */
#include "gradient/adjoint.h"

#include "plan/decisions.h"
#include "spectral/model.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

void skg_adjoint_init_sized(void *adjoint, int32_t size) {
    const skg_adjoint defaults = {.type = SKG_TYPE_FLOAT64};
    skg_struct_init(adjoint, size, &defaults, sizeof defaults);
}

static skg_status check(const char *call, const skg_recipe *recipe, const skg_adjoint *a) {
    const skg_view *view = &recipe->view;
    if (a->channels != recipe->model.channels || a->rows != view->rows || a->columns != view->columns)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: the adjoint has %" PRId64 " channels of %" PRId64 " x %" PRId64
                        " (rows x columns), the image %" PRId32 " of %" PRId64 " x %" PRId64,
                        call, a->channels, a->rows, a->columns, recipe->model.channels, view->rows,
                        view->columns);
    if (a->type != SKG_TYPE_FLOAT32 && a->type != SKG_TYPE_FLOAT64)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: an adjoint of type %" PRId32 "; SKG_TYPE_FLOAT32 or SKG_TYPE_FLOAT64", call,
                        a->type);
    if (!a->buffer && !a->data)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: the adjoint has no memory: its data is NULL", call);
    return SKG_OK;
}

/* Enqueues the read of a buffer of the caller. */
static skg_status read_buffer(skg_job *job, int64_t bytes) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    const skg_adjoint *a = &gradient->given;
    int64_t size = 0;
    SKG_TRY(skg_caller_buffer_check(gradient->call, job->machine->context, a->buffer, &size));
    if (a->offset < 0 || a->offset > size || bytes > size - a->offset)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: the adjoint ends at byte %" PRId64 ", its buffer at %" PRId64,
                        gradient->call, a->offset + bytes, size);
    SKG_TRY(skg_alloc(bytes, 1, "adjoint", &gradient->raw));
    SKG_CL_TRY(clEnqueueReadBuffer(job->machine->context->device->queue, a->buffer, CL_FALSE,
                                   (size_t)a->offset, (size_t)bytes, gradient->raw, 0, NULL, NULL));
    return SKG_OK;
}

/* Where the first value that is not finite stands. */
static skg_status check_finite(const char *call, const skg_adjoint *a, const double *values) {
    for (int64_t i = 0; i < a->channels * a->rows * a->columns; i++)
        if (!isfinite(values[i]))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "%s: the adjoint is %g in channel %" PRId64 ", row %" PRId64 ", column %" PRId64
                            "; it has to be finite",
                            call, values[i], i / (a->rows * a->columns), i / a->columns % a->rows,
                            i % a->columns);
    return SKG_OK;
}

/* Sums of faces are integers, whose scale has an end in single precision (scales.c). */
static skg_status check_size(const char *call, double most) {
    static const double LEAST = 1e-30, MOST = 1e30;
    if (!(most > 0) || (most >= LEAST && most <= MOST)) return SKG_OK;
    return skg_fail(
        SKG_ERR_ARGUMENT,
        "%s: the largest magnitude of the adjoint is %g; give the loss in a unit in which it is %g to %g, or 0",
        call, most, LEAST, MOST);
}

/* The bits of a double that is not finite, shifted by one, are at least these. */
static const uint64_t INFINITE = (uint64_t)0x7ff << 53;

static skg_status take_values(skg_gradient_work *gradient, const void *from) {
    const skg_adjoint *a = &gradient->given;
    const int64_t count = a->channels * a->rows * a->columns;
    const double *doubles = a->type == SKG_TYPE_FLOAT64 ? from : NULL;
    const float *floats = from;
    double *to = gradient->adjoint;
    int infinite = 0;
    double most = 0;
    for (int64_t i = 0; i < count; i++) {
        uint64_t bits;
        to[i] = doubles ? doubles[i] : (double)floats[i];
        memcpy(&bits, &to[i], sizeof bits);
        infinite |= bits << 1 >= INFINITE;
        most = fabs(to[i]) > most ? fabs(to[i]) : most;
    }
    return infinite ? check_finite(gradient->call, a, to) : check_size(gradient->call, most);
}

skg_status skg_adjoint_read(skg_job *job) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    const skg_adjoint *a = &gradient->given;
    SKG_TRY(check(gradient->call, job->recipe, a));
    const int64_t count = a->channels * a->rows * a->columns;
    SKG_TRY(skg_alloc(count, sizeof *gradient->adjoint, "adjoint", &gradient->adjoint));
    if (!a->buffer) return take_values(gradient, a->data);
    return read_buffer(job, count * (int64_t)(a->type == SKG_TYPE_FLOAT64 ? sizeof(double) : sizeof(float)));
}

skg_status skg_adjoint_take(skg_job *job) {
    return skg_gradient_of(job)->raw ? take_values(skg_gradient_of(job), skg_gradient_of(job)->raw) : SKG_OK;
}

int skg_adjoint_needs_image(const skg_recipe *recipe) {
    return skg_decide_late_logarithm(recipe);
}

/* The transpose of -ln: d(-ln T) / dT = -1 / T = -exp(image). Below the smallest T that is shown the image is constant. */
static void undo_logarithm(int64_t count, const double *image, double *values) {
    const double highest = 126 * 0.69314718055994531 * (1 - 1e-6);
    for (int64_t i = 0; i < count; i++) values[i] = image[i] < highest ? -values[i] * exp(image[i]) : 0;
}

/* The transpose of the factors of the stage `detect`. */
static skg_status undo_detection(const skg_job *job, const skg_view *view, double *values) {
    const skg_recipe *recipe = job->recipe;
    const int64_t size = view->rows * view->columns;
    double factors[SKG_CHANNELS_MAX];
    int32_t wanted = 0;
    skg_detection detection;
    skg_camera camera;
    if (!job->machine->detector) return SKG_OK;
    SKG_TRY(skg_decide_detection(recipe, &detection, factors, &wanted));
    SKG_TRY(skg_camera_make(view, NULL, 0, 0, &camera));
    double frame = recipe->options.quantity == SKG_QUANTITY_FLUENCE ? 1 / skg_camera_pixel_area(&camera) : 1;
    if (skg_quantity_is_ratio(&recipe->options)) frame /= skg_recipe_exposure(recipe, view);
    for (int64_t i = 0; i < detection.channels * size; i++) values[i] *= factors[i / size] * frame;
    return SKG_OK;
}

/* The transposes of the blurs of all layers; noise, which may have a layer of its own, is left out. */
static skg_status undo_blurs(const skg_job *job, double **values) {
    const skg_recipe *recipe = job->recipe;
    const skg_layers *layers = &job->machine->layers;
    const int64_t columns = recipe->view.columns, rows = recipe->view.rows;
    const int64_t channels = recipe->model.channels, count = recipe->model.layers;
    double *spread = NULL;
    skg_status status = SKG_OK;
    if (layers->count == 0) return SKG_OK;
    SKG_TRY(skg_alloc(count * channels * rows * columns, sizeof *spread, "adjoint", &spread));
    for (int64_t l = 0; l < count && status == SKG_OK; l++)
        for (int64_t c = 0; c < channels && status == SKG_OK; c++)
            status = skg_blur_transpose(layers->blurs[l], columns, rows, *values + c * rows * columns,
                                        spread + (l * channels + c) * rows * columns);
    skg_free(values);
    *values = spread;
    return status;
}

skg_status skg_derivative_of_image(const skg_job *job, const skg_view *view, const double *image,
                                   double *values) {
    const skg_recipe *recipe = job->recipe;
    const skg_layers *layers = &job->machine->layers;
    const int64_t columns = view->columns, size = view->rows * columns, channels = recipe->model.channels;
    double *sharp = NULL;
    if (layers->count > 0) SKG_TRY(skg_alloc(size, sizeof *sharp, "derivative", &sharp));
    for (int64_t c = 0; c < channels && sharp; c++) {
        memcpy(sharp, values + c * size, (size_t)size * sizeof *sharp);
        memset(values + c * size, 0, (size_t)size * sizeof *values); /* is added to */
        skg_blur_apply(layers->blurs[0], columns, view->rows, sharp, values + c * size);
    }
    skg_free(&sharp);
    SKG_TRY(undo_detection(job, view, values));
    if (image) undo_logarithm(channels * size, image, values);
    return SKG_OK;
}

skg_status skg_adjoint_of_intensities(const skg_job *job, const skg_view *view, const double *image,
                                      double **values) {
    const int64_t count = job->recipe->model.channels * view->rows * view->columns;
    if (image) undo_logarithm(count, image, *values);
    SKG_TRY(undo_detection(job, view, *values));
    return undo_blurs(job, values);
}

skg_status skg_adjoint_send(skg_job *job, const double *adjoint) {
    const skg_recipe *recipe = job->recipe;
    skg_machine *machine = job->machine;
    const int64_t count = skg_model_sums(&recipe->model) * recipe->view.rows * recipe->view.columns;
    float **rounded = &skg_gradient_of(job)->rounded;
    if (skg_recipe_kernel_precision(recipe) == SKG_PRECISION_DOUBLE)
        return skg_buffer_write(machine->context, &skg_gradient_of(job)->memory->adjoint,
                                count * (int64_t)sizeof *adjoint, adjoint, "adjoint");
    /* The staged floats are free again: each pass ends with a read, which waits for the write before. */
    if (!*rounded) SKG_TRY(skg_staging_take(&job->staging, count, sizeof **rounded, "adjoint", rounded));
    for (int64_t i = 0; i < count; i++) (*rounded)[i] = (float)adjoint[i];
    return skg_staging_write(&job->staging, &skg_gradient_of(job)->memory->adjoint,
                             count * (int64_t)sizeof **rounded, *rounded, "adjoint");
}
