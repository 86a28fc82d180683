/* Repair of open parts: what their bad pixels get, added to the shared sums as integers, so that every
 * strategy leaves the same bits. */
#include "plan/frame.h"
#include "plan/raster_private.h"
#include "plan/recast.h"

#include <math.h>

static skg_status get_kernel(skg_plan *plan, const skg_open_part *part, const char *name, cl_kernel *kernel) {
    static const char *const files[] = {"open.cl"};
    const skg_kernel_options *sums = &part->raster->options.kernels;
    const skg_kernel_options options = {.precision = sums->precision, .bits = sums->bits};
    cl_program program = NULL;
    SKG_TRY(skg_kernels_get(plan->context, &options, 1, files, NULL, &program));
    return skg_kernel_create(program, name, kernel);
}

static size_t padded(int64_t items, int64_t group) {
    return (size_t)((items + group - 1) / group * group);
}

static skg_status find_gaps(skg_plan *plan, skg_job *job, const skg_open_part *part) {
    const skg_frame_args *frame = &part->raster->frame;
    const cl_int plane = (cl_int)part->count_plane;
    const size_t local = 16, global = padded(frame->rows, 16);
    cl_kernel kernel = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_buffer_reserve(plan->context, &plan->gaps,
                               (int64_t)frame->rows * frame->columns * (int64_t)sizeof(cl_int),
                               CL_MEM_READ_WRITE, "bad pixels"));
    SKG_TRY(get_kernel(plan, part, "skg_open_gaps", &kernel));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 0, sizeof *frame, frame));
    SKG_TRY_CLEANUP(skg_kernel_set_memory(kernel, 1, 2,
                                          (cl_mem[]){part->raster->sums.memory, part->raster->used.memory}));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 3, sizeof plane, &plane));
    SKG_TRY_CLEANUP(skg_kernel_set_memory(kernel, 4, 1, &plan->gaps.memory));
    SKG_TRY_CLEANUP(skg_kernel_run(plan->context, kernel, "repair", 1, &global, &local, &job->log));
cleanup:
    clReleaseKernel(kernel);
    return status;
}

static skg_status take_neighbours(skg_plan *plan, skg_job *job, const skg_open_part *part) {
    const skg_frame_args *frame = &part->raster->frame;
    const cl_int moves[2] = {(cl_int)part->first_move, (cl_int)part->move_count};
    const size_t local[2] = {16, 16}, global[2] = {padded(frame->columns, 16), padded(frame->rows, 16)};
    cl_kernel kernel = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(get_kernel(plan, part, "skg_open_repair", &kernel));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 0, sizeof *frame, frame));
    SKG_TRY_CLEANUP(skg_kernel_set_memory(kernel, 1, 2,
                                          (cl_mem[]){part->raster->sums.memory, part->raster->used.memory}));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 3, sizeof moves[0], &moves[0]));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 4, sizeof moves[1], &moves[1]));
    SKG_TRY_CLEANUP(skg_kernel_set_memory(
        kernel, 5, 3, (cl_mem[]){part->moves, plan->gaps.memory, part->shared->sums.memory}));
    SKG_TRY_CLEANUP(skg_kernel_run(plan->context, kernel, "repair", 2, global, local, &job->log));
cleanup:
    clReleaseKernel(kernel);
    return status;
}

/* The bad pixels, once the device has found them. */
static skg_status read_pixels(skg_plan *plan, const skg_open_part *part, skg_pixel_list *pixels) {
    const int64_t rows = part->raster->frame.rows, columns = part->raster->frame.columns;
    cl_int *gaps = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(rows * columns, sizeof *gaps, "bad pixels", &gaps));
    const cl_int code = clEnqueueReadBuffer(plan->context->device->queue, plan->gaps.memory, CL_TRUE, 0,
                                            (size_t)(rows * columns) * sizeof *gaps, gaps, 0, NULL, NULL);
    if (code != CL_SUCCESS) status = skg_cl_fail(code, "clEnqueueReadBuffer", __FILE__, __LINE__);
    if (status == SKG_OK) status = skg_pixel_list_make(columns, rows, gaps, pixels);
    skg_free(&gaps);
    return status;
}

static skg_status get_caps(skg_plan *plan, int64_t open, const skg_caps **caps) {
    if (!plan->caps) SKG_TRY(skg_alloc(plan->open_count, sizeof *plan->caps, "caps", &plan->caps));
    if (!plan->caps[open].first)
        SKG_TRY(skg_caps_find(plan->scene->parts[plan->open[open]].mesh, &plan->caps[open]));
    *caps = &plan->caps[open];
    return SKG_OK;
}

/* Accumulators and what they get: path parameters in units of the planes, within what the scale has room for.
 */
static void list_sums(const skg_plan *plan, const skg_frame_parts *frame, const skg_open_part *part,
                      const skg_pixel_list *pixels, const double *paths, cl_int *places, cl_long *values) {
    const int64_t number = plan->open[part->open];
    const skg_frame_args *layout = &part->shared->frame;
    const skg_scale_part *room = &frame->extents[number].scale;
    const double most = (room->high_depth - room->low_depth) * room->multiplicity;
    for (int64_t r = 0; r < layout->rows; r++)
        for (int64_t k = pixels->first[r]; k < pixels->first[r + 1]; k++) {
            const double path = fmin(fmax(paths[k], -most), most) * frame->scale.scale;
            for (int64_t w = 0; w < part->move_count; w++) {
                const skg_plane_weight *weight = &frame->all_writes[frame->firsts[number] + w];
                *places++ = (cl_int)(weight->plane * layout->plane + r * layout->stride + pixels->columns[k]);
                *values++ = llrint(path * weight->weight);
            }
        }
}

static skg_status put_sums(skg_plan *plan, skg_job *job, const skg_open_part *part, int64_t count,
                           const cl_int *places, const cl_long *values) {
    const cl_int items = (cl_int)count;
    const size_t local = 64, global = padded(count, 64);
    const int64_t place_bytes = count * (int64_t)sizeof *places,
                  value_bytes = count * (int64_t)sizeof *values;
    skg_buffer on_device[2] = {{0}, {0}};
    cl_kernel kernel = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(get_kernel(plan, part, "skg_open_put", &kernel));
    SKG_TRY_CLEANUP(
        skg_buffer_reserve(plan->context, &on_device[0], place_bytes, CL_MEM_READ_ONLY, "repaired pixels"));
    SKG_TRY_CLEANUP(
        skg_buffer_reserve(plan->context, &on_device[1], value_bytes, CL_MEM_READ_ONLY, "repaired pixels"));
    SKG_TRY_CLEANUP(
        skg_stage_write(plan->context, "repair", on_device[0].memory, 0, place_bytes, places, &job->log));
    SKG_TRY_CLEANUP(
        skg_stage_write(plan->context, "repair", on_device[1].memory, 0, value_bytes, values, &job->log));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 0, sizeof items, &items));
    SKG_TRY_CLEANUP(skg_kernel_set_memory(
        kernel, 1, 3, (cl_mem[]){on_device[0].memory, on_device[1].memory, part->shared->sums.memory}));
    SKG_TRY_CLEANUP(skg_kernel_run(plan->context, kernel, "repair", 1, &global, &local, &job->log));
cleanup:
    for (int k = 0; k < 2; k++) skg_buffer_release(&on_device[k]); /* kept until what is enqueued is done */
    clReleaseKernel(kernel);
    return status;
}

static skg_status cast_anew(skg_plan *plan, skg_job *job, const skg_frame_parts *frame,
                            const skg_open_part *part) {
    const int64_t number = plan->open[part->open];
    const skg_caps *caps = NULL;
    skg_pixel_list pixels = {0};
    double *paths = NULL;
    cl_int *places = NULL;
    cl_long *values = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(read_pixels(plan, part, &pixels));
    if (pixels.count == 0) goto cleanup;
    const int64_t count = pixels.count * part->move_count;
    SKG_TRY_CLEANUP(get_caps(plan, part->open, &caps));
    SKG_TRY_CLEANUP(skg_alloc(pixels.count, sizeof *paths, "repair", &paths));
    SKG_TRY_CLEANUP(skg_recast(&frame->camera, plan->scene->parts[number].mesh, caps,
                               frame->parts[number].pose, &pixels, paths));
    SKG_TRY_CLEANUP(skg_job_stage(job, count, sizeof *places, "repair", &places));
    SKG_TRY_CLEANUP(skg_job_stage(job, count, sizeof *values, "repair", &values));
    list_sums(plan, frame, part, &pixels, paths, places, values);
    SKG_TRY_CLEANUP(put_sums(plan, job, part, count, places, values));
cleanup:
    skg_pixel_list_release(&pixels);
    skg_free(&paths);
    return status;
}

skg_status skg_open_part_repair(skg_plan *plan, skg_job *job, const skg_frame_parts *frame,
                                const skg_open_part *part) {
    cl_int bad = 0;
    if (plan->options.repair == SKG_REPAIR_NONE) return SKG_OK;
    if (plan->options.repair == SKG_REPAIR_NEIGHBOURS) {
        SKG_TRY(find_gaps(plan, job, part));
        return take_neighbours(plan, job, part);
    }
    SKG_CL_TRY(clEnqueueReadBuffer(plan->context->device->queue, part->bad, CL_TRUE, 0, sizeof bad, &bad, 0,
                                   NULL, NULL));
    if (bad == 0) return SKG_OK;
    SKG_TRY(find_gaps(plan, job, part));
    return cast_anew(plan, job, frame, part);
}
