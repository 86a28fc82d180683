#include "stage/kernels.h"

#include "core/maths.h"
#include "device/signals.h"

#include <skiagraph/plan.h>

#include <stdio.h>
#include <string.h>

int32_t skg_kernel_lanes(skg_context *context, int32_t precision) {
    const int32_t width = context->device->info.float_width;
    if (precision == SKG_PRECISION_DOUBLE) return width >= 16 ? 8 : 4;
    return width >= 16 ? 16 : width >= 8 ? 8 : 4;
}

skg_status skg_kernels_get(skg_context *context, const skg_kernel_options *options, int32_t files,
                           const char *const *names, const char *more_options, cl_program *program) {
    static const char *const headers[] = {"config.clh",   "types.clh",    "skg_shared.h",
                                          "scalar.clh",   "triangle.clh", "wide.clh",
                                          "triangle.clh", "parts.clh",    "sums.clh"};
    enum { HEADERS = sizeof headers / sizeof *headers, MOST = 8 };
    const char *all[HEADERS + MOST];
    char text[768];
    if (files > MOST) return skg_fail(SKG_ERR_INTERNAL, "%s: too many kernel files", names[0]);
    for (int32_t i = 0; i < HEADERS; i++) all[i] = headers[i];
    for (int32_t i = 0; i < files; i++) all[HEADERS + i] = names[i];
    snprintf(text, sizeof text,
             "-D SKG_DOUBLE=%d -D SKG_BITS=%d -D SKG_WIDE=%d -D SKG_PARALLEL=%d -D SKG_SOURCE_PLANE=%d "
             "-D SKG_SEAMS=%d -D SKG_LISTED=%d -D SKG_HALF=%d -D SKG_CPU=%d %s",
             options->precision == SKG_PRECISION_DOUBLE, options->bits,
             skg_kernel_lanes(context, options->precision), options->parallel != 0,
             options->source_plane != 0, options->seams != 0, options->listed != 0, options->half != 0,
             !context->device->info.is_gpu, more_options ? more_options : "");
    return skg_program_get(context, HEADERS + files, all, text, program);
}

static const skg_kernel_options first_options = {.precision = SKG_PRECISION_SINGLE, .bits = 32};

int skg_kernels_are_first(const skg_context *context, const skg_kernel_options *options) {
    return !context->device->info.is_gpu && memcmp(options, &first_options, sizeof first_options) == 0;
}

skg_status skg_kernels_get_first(skg_context *context, cl_program *program) {
    static const char *const files[] = {"fine.clh",         "project.cl",      "batch.clh",  "draw.clh",
                                        "raster_copies.cl", "exponential.clh", "planes.clh", "attenuate.cl"};
    char more[64];
    snprintf(more, sizeof more, "-D SKG_RUNS=%d -D SKG_STRIP=%d", SKG_CPU_RUNS, SKG_CPU_STRIP);
    return skg_kernels_get(context, &first_options, (int32_t)(sizeof files / sizeof *files), files, more,
                           program);
}

void skg_arguments_round(const void *twice, size_t reals, size_t size, void *single) {
    const double *from = twice;
    float *to = single;
    const size_t count = reals / sizeof *from;
    for (size_t i = 0; i < count; i++) to[i] = (float)from[i];
    memcpy(to + count, from + count, size - reals);
}

static skg_status enqueue(skg_context *context, cl_kernel kernel, const char *stage,
                          const skg_work_size *work, skg_stage_log *log) {
    size_t global[3], local[3];
    cl_event event = NULL;
    for (cl_uint d = 0; d < work->dimensions; d++) {
        global[d] = (size_t)skg_round_up(work->items[d], work->group[d]);
        local[d] = (size_t)work->group[d];
    }
    const int first = context->device->launched < context->device->builds; /* it may compile now */
    if (first) skg_signals_keep();
    cl_int code = clEnqueueNDRangeKernel(context->device->queue, kernel, work->dimensions, NULL, global,
                                         local, 0, NULL, skg_stage_event(log, &event));
    if (first) skg_signals_restore();
    if (code != CL_SUCCESS) {
        skg_cl_fail(code, "clEnqueueNDRangeKernel", __FILE__, __LINE__);
        return skg_fail(code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_RESOURCES
                            ? SKG_ERR_DEVICE_MEMORY
                            : SKG_ERR_DEVICE,
                        "stage %s: %s", stage, skg_cl_name(code));
    }
    return skg_stage_log_add(log, stage, event);
}

skg_status skg_kernel_launch(skg_context *context, cl_kernel kernel, const char *stage,
                             const skg_work_size *work, int32_t count, const skg_argument *arguments,
                             skg_stage_log *log) {
    for (int32_t i = 0; i < count; i++)
        SKG_TRY(skg_kernel_set(kernel, arguments[i].position, arguments[i].size, arguments[i].value));
    return enqueue(context, kernel, stage, work, log);
}

skg_status skg_program_launch(skg_context *context, cl_program program, const char *function,
                              const char *stage, const skg_work_size *work, int32_t count,
                              const skg_argument *arguments, skg_stage_log *log) {
    cl_kernel kernel = NULL;
    SKG_TRY(skg_kernel_create(program, function, &kernel));
    const skg_status status = skg_kernel_launch(context, kernel, stage, work, count, arguments, log);
    clReleaseKernel(kernel);
    return status;
}

skg_status skg_stage_write(skg_context *context, const char *stage, cl_mem buffer, int64_t offset,
                           int64_t bytes, const void *data, skg_stage_log *log) {
    cl_event event = NULL;
    if (bytes == 0) return SKG_OK;
    SKG_CL_TRY(clEnqueueWriteBuffer(context->device->queue, buffer, CL_FALSE, (size_t)offset, (size_t)bytes,
                                    data, 0, NULL, skg_stage_event(log, &event)));
    return skg_stage_log_add(log, stage, event);
}
