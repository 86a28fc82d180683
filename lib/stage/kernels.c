#include "stage/kernels.h"

#include <skiagraph/plan.h>

#include <stdio.h>

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
    enum { HEADERS = sizeof headers / sizeof *headers, MOST = 7 };
    const char *all[HEADERS + MOST];
    char text[768];
    if (files > MOST) return skg_fail(SKG_ERR_INTERNAL, "%s: too many kernel files", names[0]);
    for (int32_t i = 0; i < HEADERS; i++) all[i] = headers[i];
    for (int32_t i = 0; i < files; i++) all[HEADERS + i] = names[i];
    snprintf(text, sizeof text,
             "-D SKG_DOUBLE=%d -D SKG_BITS=%d -D SKG_WIDE=%d -D SKG_PARALLEL=%d -D SKG_SOURCE_PLANE=%d "
             "-D SKG_WRITES=%d -D SKG_HALF=%d %s",
             options->precision == SKG_PRECISION_DOUBLE, options->bits,
             skg_kernel_lanes(context, options->precision), options->parallel != 0,
             options->source_plane != 0, options->listed_writes ? 0 : 1, options->half != 0,
             more_options ? more_options : "");
    return skg_program_get(context, HEADERS + files, all, text, program);
}

skg_status skg_kernel_set_memory(cl_kernel kernel, cl_uint first, int32_t count, const cl_mem *memory) {
    for (int32_t i = 0; i < count; i++)
        SKG_TRY(skg_kernel_set(kernel, first + (cl_uint)i, sizeof *memory, &memory[i]));
    return SKG_OK;
}

void skg_stage_log_clear(skg_stage_log *log) {
    for (int64_t i = 0; i < log->count; i++) clReleaseEvent(log->events[i]);
    skg_free(&log->names);
    skg_free(&log->events);
    log->count = log->room = 0;
}

cl_event *skg_stage_event(const skg_stage_log *log, cl_event *event) {
    return log && log->on ? event : NULL;
}

static skg_status make_room(skg_stage_log *log) {
    const int64_t room = 2 * log->room + 16;
    if (log->count < log->room) return SKG_OK;
    SKG_TRY(skg_realloc(room, sizeof *log->names, "stage log", &log->names));
    SKG_TRY(skg_realloc(room, sizeof *log->events, "stage log", &log->events));
    log->room = room;
    return SKG_OK;
}

skg_status skg_stage_log_add(skg_stage_log *log, const char *stage, cl_event event) {
    if (!event) return SKG_OK;
    skg_status status = log && log->on ? make_room(log) : SKG_STALE;
    if (status != SKG_OK) {
        clReleaseEvent(event);
        return status == SKG_STALE ? SKG_OK : status;
    }
    log->names[log->count] = stage;
    log->events[log->count++] = event;
    return SKG_OK;
}

skg_status skg_kernel_run(skg_context *context, cl_kernel kernel, const char *stage, cl_uint dimensions,
                          const size_t *global, const size_t *local, skg_stage_log *log) {
    cl_event event = NULL;
    cl_int code = clEnqueueNDRangeKernel(context->device->queue, kernel, dimensions, NULL, global, local, 0,
                                         NULL, skg_stage_event(log, &event));
    if (code != CL_SUCCESS) {
        skg_cl_fail(code, "clEnqueueNDRangeKernel", __FILE__, __LINE__);
        return skg_fail(code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_RESOURCES
                            ? SKG_ERR_DEVICE_MEMORY
                            : SKG_ERR_DEVICE,
                        "stage %s: %s", stage, skg_cl_name(code));
    }
    return skg_stage_log_add(log, stage, event);
}

skg_status skg_stage_write(skg_context *context, const char *stage, cl_mem buffer, int64_t offset,
                           int64_t bytes, const void *data, skg_stage_log *log) {
    cl_event event = NULL;
    if (bytes == 0) return SKG_OK;
    SKG_CL_TRY(clEnqueueWriteBuffer(context->device->queue, buffer, CL_FALSE, (size_t)offset, (size_t)bytes,
                                    data, 0, NULL, skg_stage_event(log, &event)));
    return skg_stage_log_add(log, stage, event);
}
