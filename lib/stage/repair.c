/* Repair of open parts: what their bad pixels get, added to the shared sums as integers, so that every
 * strategy leaves the same bits. */
#include "frame/frame.h"
#include "geometry/recast.h"
#include "stage/raster_private.h"

#include <math.h>
#include <string.h>

static size_t padded(int64_t items, int64_t group) {
    return (size_t)((items + group - 1) / group * group);
}

static skg_status find_gaps(skg_plan *plan, skg_job *job, const skg_open_batch *batch) {
    const skg_frame_args *frame = &batch->raster->frame;
    const size_t local[2] = {16, 1}, global[2] = {padded(frame->rows, 16), (size_t)batch->parts};
    cl_kernel kernel = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_buffer_reserve(plan->context, &plan->gaps,
                               batch->parts * frame->rows * frame->columns * (int64_t)sizeof(cl_int),
                               CL_MEM_READ_WRITE, "bad pixels"));
    SKG_TRY(skg_open_kernel(plan, batch, "skg_open_gaps", &kernel));
    SKG_TRY_CLEANUP(
        skg_kernel_set_memory(kernel, 5, 2, (cl_mem[]){batch->raster->rows_bad.memory, plan->gaps.memory}));
    SKG_TRY_CLEANUP(skg_kernel_run(plan->context, kernel, "repair", 2, global, local, &job->log));
cleanup:
    clReleaseKernel(kernel);
    return status;
}

static skg_status take_neighbours(skg_plan *plan, skg_job *job, const skg_open_batch *batch) {
    const skg_frame_args *frame = &batch->raster->frame;
    const int on_gpu = plan->context->device->info.is_gpu;
    const size_t local[2] = {on_gpu ? 16 : 1, 8};
    const size_t global[2] = {on_gpu ? padded(frame->columns, 16) : 1, padded(frame->rows, 8)};
    cl_kernel kernel = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_open_kernel(plan, batch, "skg_open_repair", &kernel));
    SKG_TRY_CLEANUP(skg_kernel_set_memory(
        kernel, 5, 3,
        (cl_mem[]){batch->raster->rows_bad.memory, plan->gaps.memory, batch->shared->sums.memory}));
    SKG_TRY_CLEANUP(skg_kernel_run(plan->context, kernel, "repair", 2, global, local, &job->log));
cleanup:
    clReleaseKernel(kernel);
    return status;
}

/* --- rays cast anew
 * ---------------------------------------------------------------------------------------------- */

/* A batch whose rays are cast. */
typedef struct {
    skg_plan *plan;
    skg_job *job;
    const skg_frame_parts *frame;
    const skg_open_batch *batch;
    cl_int *rows_bad; /* [parts][rows][3] as counts.cl leaves it */
    cl_int *marks;    /* [rows][columns] pixels of the part at hand that are cast anew; else 0 */
    cl_kernel put;
} casting;

static skg_status read_now(const casting *c, cl_mem memory, int64_t first, int64_t count, cl_int *to) {
    SKG_CL_TRY(clEnqueueReadBuffer(c->plan->context->device->queue, memory, CL_TRUE,
                                   (size_t)first * sizeof *to, (size_t)count * sizeof *to, to, 0, NULL,
                                   NULL));
    return SKG_OK;
}

/* Marks the bad pixels of a part. */
static skg_status mark_bad(const casting *c, int64_t part) {
    const skg_frame_args *layout = &c->batch->raster->frame;
    const cl_int *rows_bad = c->rows_bad + 3 * part * layout->rows;
    const int64_t columns = layout->columns;
    int64_t first = 0, end = layout->rows;
    while (first < end && !rows_bad[3 * first]) first++;
    while (first < end && !rows_bad[3 * (end - 1)]) end--;
    if (first == end) return SKG_OK;
    SKG_TRY(read_now(c, c->plan->gaps.memory, (part * layout->rows + first) * columns,
                     (end - first) * columns, c->marks + first * columns));
    for (int64_t r = first; r < end; r++) /* what skg_open_gaps leaves as it is */
        for (int64_t k = 0; k < columns; k++)
            if (k < rows_bad[3 * r + 1] || k >= rows_bad[3 * r + 2]) c->marks[r * columns + k] = 0;
    return SKG_OK;
}

static skg_status get_caps(skg_plan *plan, int64_t open, const skg_caps **caps) {
    if (!plan->caps) SKG_TRY(skg_alloc(plan->open_count, sizeof *plan->caps, "caps", &plan->caps));
    if (!plan->caps[open].first)
        SKG_TRY(skg_caps_find(plan->scene->parts[plan->open[open]].mesh, &plan->caps[open]));
    *caps = &plan->caps[open];
    return SKG_OK;
}

/* Pixels, and what they get: path parameters in units of the planes, within what the scale has room for. */
static void list_sums(const casting *c, int64_t number, const skg_pixel_list *list, const double *paths,
                      cl_int *pixels, cl_long *values) {
    const skg_frame_parts *frame = c->frame;
    const skg_scale_part *room = &frame->extents[number].scale;
    const double most = (room->high_depth - room->low_depth) * room->multiplicity;
    for (int64_t r = 0; r < frame->camera.rows; r++)
        for (int64_t k = list->first[r]; k < list->first[r + 1]; k++) {
            const double path = fmin(fmax(paths[k], -most), most) * frame->scale.scale;
            *pixels++ = (cl_int)(r * frame->camera.columns + list->columns[k]);
            for (int64_t w = frame->firsts[number]; w < frame->firsts[number + 1]; w++)
                *values++ = llrint(path * frame->all_writes[w].weight);
        }
}

static skg_status put_sums(const casting *c, int64_t part, int64_t count, int64_t writes,
                           const cl_int *pixels, const cl_long *values) {
    skg_plan *plan = c->plan;
    const cl_int numbers[2] = {(cl_int)part, (cl_int)count};
    const size_t local = 64, global = padded(count, 64);
    const int64_t bytes[2] = {count * (int64_t)sizeof *pixels, count * writes * (int64_t)sizeof *values};
    const void *const from[2] = {pixels, values};
    skg_buffer on_device[2] = {{0}, {0}};
    skg_status status = SKG_OK;
    for (int k = 0; k < 2; k++) {
        SKG_TRY_CLEANUP(
            skg_buffer_reserve(plan->context, &on_device[k], bytes[k], CL_MEM_READ_ONLY, "repaired pixels"));
        SKG_TRY_CLEANUP(skg_stage_write(plan->context, "repair", on_device[k].memory, 0, bytes[k], from[k],
                                        &c->job->log));
        SKG_TRY_CLEANUP(skg_kernel_set(c->put, (cl_uint)(5 + k), sizeof numbers[k], &numbers[k]));
    }
    SKG_TRY_CLEANUP(skg_kernel_set_memory(
        c->put, 7, 3, (cl_mem[]){on_device[0].memory, on_device[1].memory, c->batch->shared->sums.memory}));
    SKG_TRY_CLEANUP(skg_kernel_run(plan->context, c->put, "repair", 1, &global, &local, &c->job->log));
cleanup:
    for (int k = 0; k < 2; k++) skg_buffer_release(&on_device[k]); /* kept until what is enqueued is done */
    return status;
}

/* The marked rays of a part. */
static skg_status cast_marked(const casting *c, int64_t part, int64_t first, int64_t end,
                              const skg_caps *caps) {
    const skg_frame_parts *frame = c->frame;
    const int64_t number = c->plan->open[c->batch->open[part]];
    const int64_t writes = frame->firsts[number + 1] - frame->firsts[number];
    skg_pixel_list list = {0};
    double *paths = NULL;
    cl_int *pixels = NULL;
    cl_long *values = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_pixel_list_make(frame->camera.columns, frame->camera.rows, first, end, c->marks, &list));
    if (list.count == 0) goto cleanup;
    SKG_TRY_CLEANUP(skg_alloc(list.count, sizeof *paths, "repair", &paths));
    SKG_TRY_CLEANUP(skg_recast(&frame->camera, c->plan->scene->parts[number].mesh, caps,
                               frame->parts[number].pose, &list, paths));
    SKG_TRY_CLEANUP(skg_job_stage(c->job, list.count, sizeof *pixels, "repair", &pixels));
    SKG_TRY_CLEANUP(skg_job_stage(c->job, list.count * writes, sizeof *values, "repair", &values));
    list_sums(c, number, &list, paths, pixels, values);
    SKG_TRY_CLEANUP(put_sums(c, part, list.count, writes, pixels, values));
cleanup:
    skg_pixel_list_release(&list);
    skg_free(&paths);
    return status;
}

/* Bad pixels and those whose ray passes a cap: in through one hole and out through another hits balance. */
static skg_status cast_part(const casting *c, int64_t part) {
    const skg_frame_args *layout = &c->batch->raster->frame;
    const int64_t open = c->batch->open[part], number = c->plan->open[open];
    const skg_caps *caps = NULL;
    cl_int field[4];
    SKG_TRY(get_caps(c->plan, open, &caps));
    skg_extent_pixels(&c->frame->camera, &c->frame->extents[number], field);
    const int64_t first = field[0], end = field[1] < layout->rows ? field[1] : layout->rows;
    if (first >= end) return SKG_OK;
    memset(c->marks + first * layout->columns, 0,
           (size_t)(end - first) * (size_t)layout->columns * sizeof *c->marks);
    SKG_TRY(mark_bad(c, part));
    skg_recast_mark(&c->frame->camera, c->plan->scene->parts[number].mesh, caps, c->frame->parts[number].pose,
                    c->marks);
    return cast_marked(c, part, first, end, caps);
}

static skg_status cast_anew(skg_plan *plan, skg_job *job, const skg_frame_parts *frame,
                            const skg_open_batch *batch) {
    const skg_frame_args *layout = &batch->raster->frame;
    const int64_t rows = batch->parts * layout->rows;
    casting c = {.plan = plan, .job = job, .frame = frame, .batch = batch};
    int any = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_open_kernel(plan, batch, "skg_open_put", &c.put));
    SKG_TRY_CLEANUP(skg_alloc(rows, 3 * sizeof *c.rows_bad, "bad pixels", &c.rows_bad));
    SKG_TRY_CLEANUP(
        skg_alloc((int64_t)layout->rows * layout->columns, sizeof *c.marks, "bad pixels", &c.marks));
    SKG_TRY_CLEANUP(read_now(&c, batch->raster->rows_bad.memory, 0, 3 * rows, c.rows_bad));
    for (int64_t k = 0; k < rows; k++) any |= c.rows_bad[3 * k] != 0;
    if (any) SKG_TRY_CLEANUP(find_gaps(plan, job, batch));
    for (int64_t part = 0; part < batch->parts; part++) SKG_TRY_CLEANUP(cast_part(&c, part));
cleanup:
    if (c.put) clReleaseKernel(c.put);
    skg_free(&c.rows_bad);
    skg_free(&c.marks);
    return status;
}

skg_status skg_open_repair(skg_plan *plan, skg_job *job, const skg_frame_parts *frame,
                           const skg_open_batch *batch) {
    if (plan->options.repair == SKG_REPAIR_NONE) return SKG_OK;
    if (plan->options.repair == SKG_REPAIR_EXACT) return cast_anew(plan, job, frame, batch);
    SKG_TRY(find_gaps(plan, job, batch));
    return take_neighbours(plan, job, batch);
}
