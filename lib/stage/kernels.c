/* Programs and kernels for the stages: the one place that writes -D options, sets arguments and enqueues. */
#include "stage/kernels.h"

#include "core/maths.h"
#include "device/programs.h"
#include "driver/driver.h"

#include <skiagraph/plan.h>

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

int32_t skg_kernel_lanes(skg_context *context, int32_t precision) {
    const int32_t width = context->device->info.float_width;
    if (precision == SKG_PRECISION_DOUBLE) return width >= 16 ? 8 : 4;
    return width >= 16 ? 16 : width >= 8 ? 8 : 4;
}

skg_status skg_defines_text(int32_t count, const skg_define *defines, size_t size, char *text) {
    size_t length = 0;
    text[0] = 0;
    for (int32_t d = 0; d < count; d++) {
        const int written = snprintf(text + length, size - length, "%s-D %s=%" PRId64, d > 0 ? " " : "",
                                     defines[d].name, defines[d].value);
        if (written < 0 || (size_t)written >= size - length)
            return skg_fail(SKG_ERR_INTERNAL, "%s: too many -D names", defines[d].name);
        length += (size_t)written;
    }
    return SKG_OK;
}

skg_status skg_kernels_get(skg_context *context, const skg_kernel_options *options, int32_t files,
                           const char *const *names, const skg_program_options *more, cl_program *program) {
    static const char *const headers[] = {"config.clh",   "types.clh",    "skg_shared.h",
                                          "scalar.clh",   "triangle.clh", "wide.clh",
                                          "triangle.clh", "parts.clh",    "sums.clh"};
    static const skg_program_options none = {.flags = ""};
    enum { HEADERS = sizeof headers / sizeof *headers, LIMIT = SKG_PROGRAM_FILES - HEADERS, TEXT = 1024 };
    const skg_define common[] = {
        {"SKG_DOUBLE", options->precision == SKG_PRECISION_DOUBLE},
        {"SKG_BITS", options->bits},
        {"SKG_WIDE", skg_kernel_lanes(context, options->precision)},
        {"SKG_PARALLEL", options->parallel != 0},
        {"SKG_SOURCE_PLANE", options->source_plane != 0},
        {"SKG_SEAMS", options->seams != 0},
        {"SKG_LISTED", options->listed != 0},
        {"SKG_HALF", options->half != 0},
        {"SKG_CURVED", options->curved != 0},
        {"SKG_CPU", !context->device->info.gpu},
    };
    const char *all[HEADERS + LIMIT];
    char of_options[TEXT], of_program[TEXT], text[2 * TEXT + 64];
    if (files > LIMIT) return skg_fail(SKG_ERR_INTERNAL, "%s: too many kernel files", names[0]);
    if (!more) more = &none;
    for (int32_t i = 0; i < HEADERS; i++) all[i] = headers[i];
    for (int32_t i = 0; i < files; i++) all[HEADERS + i] = names[i];
    SKG_TRY(skg_defines_text(sizeof common / sizeof *common, common, TEXT, of_options));
    SKG_TRY(skg_defines_text(more->count, more->defines, TEXT, of_program));
    snprintf(text, sizeof text, "%s %s %s", of_options, of_program, more->flags ? more->flags : "");
    return skg_program_get(context, HEADERS + files, all, text, program);
}

static const skg_kernel_options first_options = {.precision = SKG_PRECISION_SINGLE, .bits = 32};

int skg_kernels_are_first(const skg_context *context, const skg_kernel_options *options) {
    return !context->device->info.gpu && memcmp(options, &first_options, sizeof first_options) == 0;
}

skg_status skg_kernels_get_first(skg_context *context, cl_program *program) {
    static const char *const files[] = {"fine.clh",   "project.cl",  "batch.clh",        "deposit.clh",
                                        "draw.clh",   "collect.clh", "raster_copies.cl", "exponential.clh",
                                        "planes.clh", "attenuate.cl"};
    static const skg_define shape[] = {{"SKG_RUNS", SKG_CPU_RUNS}, {"SKG_STRIP", SKG_CPU_STRIP}};
    return skg_kernels_get(context, &first_options, (int32_t)(sizeof files / sizeof *files), files,
                           SKG_DEFINES(shape), program);
}

void skg_arguments_round(const void *twice, size_t reals, size_t size, void *single) {
    const double *from = twice;
    float *to = single;
    const size_t count = reals / sizeof *from;
    for (size_t i = 0; i < count; i++) to[i] = (float)from[i];
    memcpy(to + count, from + count, size - reals);
}

skg_status skg_kernel_launch(skg_context *context, cl_kernel kernel, const char *stage,
                             const skg_work_size *work, int32_t count, const skg_argument *arguments,
                             skg_stage_log *log) {
    size_t global[3], local[3];
    cl_event event = NULL;
    SKG_ASSERT(1 <= work->dimensions && work->dimensions <= 3);
    for (int32_t i = 0; i < count; i++)
        SKG_TRY(skg_kernel_set(kernel, arguments[i].position, arguments[i].size, arguments[i].value));
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
