/* What is read from count planes: pixels whose signed hits do not cancel. */
#include "plan/raster_private.h"

static size_t padded(int64_t items, int64_t group) {
    return (size_t)((items + group - 1) / group * group);
}

static skg_status get_bad_kernels(skg_raster *raster) {
    static const char *const files[] = {"counts.cl"};
    cl_program program = NULL;
    if (raster->bad) return SKG_OK;
    SKG_TRY(skg_kernels_get(raster->context, &raster->options.kernels, 1, files, NULL, &program));
    SKG_TRY(skg_buffer_reserve(raster->context, &raster->rows_bad,
                               raster->frame.rows * (int64_t)sizeof(cl_int), CL_MEM_READ_WRITE,
                               "bad pixels of the rows"));
    if (!raster->bad_rows) SKG_TRY(skg_kernel_create(program, "skg_count_bad_rows", &raster->bad_rows));
    return skg_kernel_create(program, "skg_count_bad", &raster->bad); /* last: it says that all is there */
}

skg_status skg_raster_bad_pixels(skg_raster *raster, int64_t plane, cl_mem result, skg_stage_log *log) {
    SKG_TRY(get_bad_kernels(raster));
    const cl_kernel kernels[2] = {raster->bad_rows, raster->bad};
    const cl_mem sums[] = {raster->sums.memory, raster->used.memory};
    const cl_int plane_number = (cl_int)plane;
    for (int k = 0; k < 2; k++) {
        SKG_TRY(skg_kernel_set(kernels[k], 0, sizeof raster->frame, &raster->frame));
        SKG_TRY(skg_kernel_set_memory(kernels[k], 1, 2, sums));
        SKG_TRY(skg_kernel_set(kernels[k], 3, sizeof plane_number, &plane_number));
        SKG_TRY(skg_kernel_set_memory(kernels[k], 4, 1, &raster->rows_bad.memory));
    }
    SKG_TRY(skg_kernel_set_memory(raster->bad, 5, 1, &result));
    const size_t group = 16, one = 1, rows = padded(raster->frame.rows, 16);
    SKG_TRY(skg_kernel_run(raster->context, raster->bad_rows, "bad pixels", 1, &rows, &group, log));
    return skg_kernel_run(raster->context, raster->bad, "bad pixels", 1, &one, &one, log);
}
