#include "plan/raster.h"

#include <skiagraph/plan.h>

#include <string.h>

struct skg_raster {
    skg_context *context;
    skg_raster_options options;
    skg_frame_args frame;
    skg_buffer sums, used, state;
    cl_kernel kernel;
    cl_kernel lengths[2]; /* to float, to double; made on demand */
};

static int64_t round_up(int64_t value, int64_t to) {
    return (value + to - 1) / to * to;
}

/* Two work-groups for one thread are dealt out unevenly by PoCL; one more than there are threads is not. */
static int32_t worker_count(const skg_context *context) {
    return context->device->info.compute_units + 1;
}

static void lay_out(skg_raster *raster) {
    const skg_raster_options *o = &raster->options;
    skg_frame_args *frame = &raster->frame;
    frame->columns = (SKG_INT)o->columns;
    frame->rows = (SKG_INT)o->rows;
    frame->stride = (SKG_INT)round_up(o->columns + SKG_SPARE_COLUMNS, 16);
    frame->plane = (SKG_INT)(frame->stride * (o->rows + SKG_SPARE_ROWS));
    frame->planes = (SKG_INT)o->planes;
    frame->copies = o->strategy == SKG_STRATEGY_COPIES ? worker_count(raster->context) : 1;
}

static skg_status allocate(skg_raster *raster) {
    const skg_frame_args *frame = &raster->frame;
    const int64_t size =
        (int64_t)frame->copies * frame->planes * frame->plane * (raster->options.kernels.bits / 8);
    SKG_TRY(skg_buffer_reserve(raster->context, &raster->sums, size, CL_MEM_READ_WRITE, "accumulators"));
    SKG_TRY(skg_buffer_reserve(raster->context, &raster->used, frame->copies * (int64_t)sizeof(cl_int),
                               CL_MEM_READ_WRITE, "accumulators in use"));
    return skg_buffer_reserve(raster->context, &raster->state, 64, CL_MEM_READ_WRITE, "counters");
}

skg_status skg_raster_create(skg_context *context, const skg_raster_options *options, skg_raster **raster) {
    static const char *const files[] = {"batch.clh", "raster_copies.cl"};
    skg_raster *made = NULL;
    cl_program program = NULL;
    skg_status status = SKG_OK;
    *raster = NULL;
    SKG_TRY(skg_alloc(1, sizeof *made, "raster", &made));
    made->context = context;
    made->options = *options;
    lay_out(made);
    SKG_TRY_CLEANUP(allocate(made));
    SKG_TRY_CLEANUP(skg_kernels_get(context, &options->kernels, 2, files, NULL, &program));
    SKG_TRY_CLEANUP(skg_kernel_create(program, "skg_raster_copies", &made->kernel));
    *raster = made;
    return SKG_OK;
cleanup:
    skg_raster_release(&made);
    return status;
}

void skg_raster_release(skg_raster **raster) {
    if (!raster || !*raster) return;
    skg_raster *r = *raster;
    skg_buffer_release(&r->sums);
    skg_buffer_release(&r->used);
    skg_buffer_release(&r->state);
    if (r->kernel) clReleaseKernel(r->kernel);
    for (int i = 0; i < 2; i++)
        if (r->lengths[i]) clReleaseKernel(r->lengths[i]);
    skg_free(raster);
}

static skg_status fill(const skg_raster *raster, const skg_buffer *buffer, size_t bytes) {
    const cl_int zero = 0;
    SKG_CL_TRY(clEnqueueFillBuffer(raster->context->device->queue, buffer->memory, &zero, sizeof zero, 0,
                                   bytes, 0, NULL, NULL));
    return SKG_OK;
}

/* So many triangles at once that the last claims even out; few enough scenes of a thousand still use every
 * worker. */
static SKG_INT claim_size(int64_t triangles, int32_t workers) {
    const int64_t claim = triangles / (16 * (int64_t)workers);
    return (SKG_INT)(claim < 32 ? 32 : claim > 1024 ? 1024 : claim);
}

skg_status skg_raster_run(skg_raster *raster, const skg_geometry *geometry, skg_stage_log *log) {
    skg_frame_args *frame = &raster->frame;
    const size_t one = 1, groups = (size_t)frame->copies;
    frame->parts = (SKG_INT)geometry->parts;
    frame->vertices = (SKG_INT)geometry->vertices;
    frame->triangles = (SKG_INT)geometry->triangles;
    frame->claim = claim_size(geometry->triangles, frame->copies - 1);
    SKG_TRY(fill(raster, &raster->state, sizeof(cl_int)));
    SKG_TRY(fill(raster, &raster->used, (size_t)frame->copies * sizeof(cl_int)));
    const cl_mem memory[] = {geometry->corners.memory,
                             geometry->projected.memory,
                             geometry->part_table.memory,
                             geometry->write_table.memory,
                             geometry->triangle_blocks.memory,
                             raster->sums.memory,
                             raster->used.memory,
                             raster->state.memory};
    SKG_TRY(skg_kernel_set(raster->kernel, 0, sizeof *frame, frame));
    for (cl_uint i = 0; i < 8; i++)
        SKG_TRY(skg_kernel_set(raster->kernel, i + 1, sizeof(cl_mem), &memory[i]));
    return skg_kernel_run(raster->context, raster->kernel, "raster", 1, &groups, &one, log);
}

void skg_raster_get_sums(const skg_raster *raster, skg_raster_sums *sums) {
    *sums =
        (skg_raster_sums){.frame = raster->frame, .sums = raster->sums.memory, .used = raster->used.memory};
}

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
    const int32_t lanes = skg_kernel_lanes(raster->context, raster->options.kernels.precision);
    const size_t local[2] = {8, 16}; /* as large as PoCL deals out cheaply */
    const size_t global[2] = {(size_t)round_up((raster->frame.columns + lanes - 1) / lanes, 8),
                              (size_t)round_up(raster->frame.rows, 16)};
    return skg_kernel_run(raster->context, kernel, "resolve", 2, global, local, log);
}

void skg_raster_tiles(const skg_raster *raster, int64_t *columns, int64_t *rows, int64_t *tiles) {
    *columns = raster->frame.columns;
    *rows = raster->frame.rows;
    *tiles = 1;
}

int64_t skg_raster_bytes(const skg_raster *raster) {
    return raster->sums.bytes + raster->used.bytes + raster->state.bytes;
}
