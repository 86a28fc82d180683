/* What is read from count planes: pixels whose signed hits do not cancel. */
#include "stage/raster_private.h"

static size_t padded(int64_t items, int64_t group) {
    return (size_t)((items + group - 1) / group * group);
}

static skg_status get_bad_kernels(skg_raster *raster) {
    static const char *const files[] = {"counts.cl"};
    cl_program program = NULL;
    if (raster->bad) return SKG_OK;
    SKG_TRY(skg_kernels_get(raster->context, &raster->options.kernels, 1, files, NULL, &program));
    if (!raster->bad_rows) SKG_TRY(skg_kernel_create(program, "skg_count_bad_rows", &raster->bad_rows));
    return skg_kernel_create(program, "skg_count_bad", &raster->bad); /* last: it says that all is there */
}

skg_status skg_raster_bad_pixels(skg_raster *raster, int64_t count, cl_mem planes, int64_t first,
                                 cl_mem verdicts, skg_stage_log *log) {
    const int64_t row_bytes = 3 * raster->frame.rows * (int64_t)sizeof(cl_int);
    const cl_int first_verdict = (cl_int)first;
    SKG_TRY(get_bad_kernels(raster));
    SKG_TRY(skg_buffer_reserve(raster->context, &raster->rows_bad, count * row_bytes, CL_MEM_READ_WRITE,
                               "bad pixels of the rows"));
    const cl_kernel kernels[2] = {raster->bad_rows, raster->bad};
    const cl_mem memory[] = {raster->sums.memory, raster->used.memory, planes, raster->rows_bad.memory};
    for (int k = 0; k < 2; k++) {
        SKG_TRY(skg_kernel_set(kernels[k], 0, sizeof raster->frame, &raster->frame));
        SKG_TRY(skg_kernel_set_memory(kernels[k], 1, 4, memory));
    }
    SKG_TRY(skg_kernel_set(raster->bad, 5, sizeof first_verdict, &first_verdict));
    SKG_TRY(skg_kernel_set_memory(raster->bad, 6, 1, &verdicts));
    const size_t group[2] = {16, 1}, rows[2] = {padded(raster->frame.rows, 16), (size_t)count};
    const size_t one = 1;
    SKG_TRY(skg_kernel_run(raster->context, raster->bad_rows, "bad pixels", 2, rows, group, log));
    return skg_kernel_run(raster->context, raster->bad, "bad pixels", 1, &rows[1], &one, log);
}
