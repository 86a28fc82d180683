/* What is read from the sums of a frame: path lengths, and pixels whose signed hits do not cancel. */
#include "plan/raster_private.h"

#include <skiagraph/plan.h>

static void round_rays(const skg_ray_double *from, skg_ray_float *to) {
    for (int k = 0; k < 3; k++) {
        to->centre[k] = (float)from->centre[k];
        to->column[k] = (float)from->column[k];
        to->row[k] = (float)from->row[k];
    }
    to->middle_i = (float)from->middle_i;
    to->middle_j = (float)from->middle_j;
    to->unit = (float)from->unit;
}

static skg_status get_lengths_kernel(skg_raster *raster, int32_t output_double) {
    static const char *const files[] = {"resolve.cl"};
    cl_program program = NULL;
    if (raster->lengths[output_double]) return SKG_OK;
    SKG_TRY(skg_kernels_get(raster->context, &raster->options.kernels, 1, files,
                            output_double ? "-D SKG_OUTPUT_DOUBLE=1" : NULL, &program));
    return skg_kernel_create(program, "skg_resolve_lengths", &raster->lengths[output_double]);
}

static size_t padded(int64_t items, int64_t group) {
    return (size_t)((items + group - 1) / group * group);
}

skg_status skg_raster_lengths(skg_raster *raster, const skg_camera *camera, int64_t plane, double scale,
                              int32_t output_double, cl_mem output, int64_t offset, int64_t row_stride,
                              skg_stage_log *log) {
    output_double = output_double != 0;
    SKG_TRY(get_lengths_kernel(raster, output_double));
    cl_kernel kernel = raster->lengths[output_double];
    skg_ray_double ray;
    skg_ray_float ray_single;
    skg_camera_rays(camera, scale, &ray);
    round_rays(&ray, &ray_single);
    const int single = raster->options.kernels.precision == SKG_SINGLE;
    const cl_int plane_number = (cl_int)plane, stride = (cl_int)row_stride;
    const cl_long first = (cl_long)offset;
    SKG_TRY(skg_kernel_set(kernel, 0, sizeof raster->frame, &raster->frame));
    SKG_TRY(skg_kernel_set(kernel, 1, single ? sizeof ray_single : sizeof ray,
                           single ? (const void *)&ray_single : (const void *)&ray));
    SKG_TRY(skg_kernel_set(kernel, 2, sizeof(cl_mem), &raster->sums.memory));
    SKG_TRY(skg_kernel_set(kernel, 3, sizeof(cl_mem), &raster->used.memory));
    SKG_TRY(skg_kernel_set(kernel, 4, sizeof plane_number, &plane_number));
    SKG_TRY(skg_kernel_set(kernel, 5, sizeof(cl_mem), &output));
    SKG_TRY(skg_kernel_set(kernel, 6, sizeof first, &first));
    SKG_TRY(skg_kernel_set(kernel, 7, sizeof stride, &stride));
    const int64_t lanes = skg_kernel_lanes(raster->context, raster->options.kernels.precision);
    const size_t local[2] = {8, 16}; /* large groups: PoCL takes some 20 ns for each */
    const size_t global[2] = {padded((raster->frame.columns + lanes - 1) / lanes, 8),
                              padded(raster->frame.rows, 16)};
    return skg_kernel_run(raster->context, kernel, "resolve", 2, global, local, log);
}

static skg_status get_bad_kernels(skg_raster *raster) {
    static const char *const files[] = {"counts.cl"};
    cl_program program = NULL;
    if (raster->bad) return SKG_OK;
    SKG_TRY(skg_kernels_get(raster->context, &raster->options.kernels, 1, files, NULL, &program));
    if (!raster->bad_rows) SKG_TRY(skg_kernel_create(program, "skg_count_bad_rows", &raster->bad_rows));
    SKG_TRY(skg_kernel_create(program, "skg_count_bad", &raster->bad));
    return skg_buffer_reserve(raster->context, &raster->rows_bad,
                              raster->frame.rows * (int64_t)sizeof(cl_int), CL_MEM_READ_WRITE,
                              "bad pixels of the rows");
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
