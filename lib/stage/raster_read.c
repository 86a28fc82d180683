/* Reads from a raster: pixels whose signed hits do not cancel, and how full the tiles are. */
#include "core/maths.h"
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

static skg_status get_bad_kernels(skg_raster *raster) {
    static const char *const files[] = {"counts.cl"};
    cl_program program = NULL;
    if (raster->bad) return SKG_OK;
    /* Options that define the type of sums. Others change no word of these kernels; without them scenes share the program. */
    const skg_kernel_options *all = &raster->options.kernels,
                             sums = {.precision = all->precision, .bits = all->bits, .half = all->half};
    SKG_TRY(skg_kernels_get(raster->context, &sums, 1, files, NULL, &program));
    if (!raster->bad_rows) SKG_TRY(skg_kernel_create(program, "skg_count_bad_rows", &raster->bad_rows));
    return skg_kernel_create(program, "skg_count_bad",
                             &raster->bad); /* last: its presence means that both are made */
}

skg_status skg_raster_bad_pixels(skg_raster *raster, int64_t count, cl_mem planes, int64_t first,
                                 cl_mem verdicts, skg_stage_log *log) {
    const int64_t row_bytes = 3 * raster->layout.rows * (int64_t)sizeof(cl_int);
    const cl_int first_verdict = (cl_int)first;
    SKG_TRY(get_bad_kernels(raster));
    SKG_TRY(skg_buffer_reserve(raster->context, &raster->rows_bad, count * row_bytes, CL_MEM_READ_WRITE,
                               "bad pixels of the rows"));
    const skg_argument rows_arguments[] = {
        SKG_ARGUMENT(COUNT_BAD_ROWS, layout, raster->layout),
        SKG_ARGUMENT(COUNT_BAD_ROWS, copies, raster->sums.memory),
        SKG_ARGUMENT(COUNT_BAD_ROWS, used, raster->used.memory),
        SKG_ARGUMENT(COUNT_BAD_ROWS, planes, planes),
        SKG_ARGUMENT(COUNT_BAD_ROWS, rows_bad, raster->rows_bad.memory),
    };
    const skg_argument arguments[] = {
        SKG_ARGUMENT(COUNT_BAD, layout, raster->layout),
        SKG_ARGUMENT(COUNT_BAD, copies, raster->sums.memory),
        SKG_ARGUMENT(COUNT_BAD, used, raster->used.memory),
        SKG_ARGUMENT(COUNT_BAD, planes, planes),
        SKG_ARGUMENT(COUNT_BAD, rows_bad, raster->rows_bad.memory),
        SKG_ARGUMENT(COUNT_BAD, first, first_verdict),
        SKG_ARGUMENT(COUNT_BAD, verdicts, verdicts),
    };
    const skg_work_size rows = {2, {raster->layout.rows, count}, {16, 1}}, planes_each = {1, {count}, {1}};
    SKG_TRY(SKG_LAUNCH(raster->context, raster->bad_rows, "bad pixels", &rows, rows_arguments, log));
    return SKG_LAUNCH(raster->context, raster->bad, "bad pixels", &planes_each, arguments, log);
}

skg_status skg_raster_read_listed(const skg_raster *raster, int32_t *listed) {
    int64_t first = 0;
    if (!raster->strategy->find_listed) return SKG_OK;
    const skg_buffer *from = raster->strategy->find_listed(raster, &first);
    SKG_CL_TRY(clEnqueueReadBuffer(raster->context->device->queue, from->memory, CL_FALSE,
                                   (size_t)first * sizeof(cl_int), 2 * sizeof(cl_int), listed, 0, NULL,
                                   NULL));
    return SKG_OK;
}
