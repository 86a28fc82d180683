/* Repairs the bad pixels of leaky parts. */
#include "core/maths.h"
#include "geometry/retrace.h"
#include "stage/leaks.h"
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

#include <math.h>
#include <string.h>

static skg_status find_gaps(const skg_leaky_batch *batch) {
    const skg_raster_layout *layout = &batch->raster->layout;
    const skg_leaky_args args = skg_leaky_scalars(batch);
    skg_buffer *gaps = &batch->memory->gaps;
    skg_context *context = batch->raster->context;
    const skg_work_size work = {2, {layout->rows, batch->parts}, {16, 1}};
    cl_program program = NULL;
    SKG_TRY(skg_buffer_reserve(context, gaps,
                               batch->parts * layout->rows * layout->columns * (int64_t)sizeof(cl_int),
                               CL_MEM_READ_WRITE, "bad pixels"));
    SKG_TRY(skg_leaky_program(batch, &program));
    const skg_argument arguments[] = {
        SKG_LEAKY_ARGUMENTS(LEAKY_GAPS, args, batch),
        SKG_ARGUMENT(LEAKY_GAPS, rows_bad, batch->raster->rows_bad.memory),
        SKG_ARGUMENT(LEAKY_GAPS, gaps, gaps->memory),
    };
    return SKG_LAUNCH_ONCE(context, program, "skg_leaky_gaps", "repair", &work, arguments,
                           &batch->staging->log);
}

static skg_status take_neighbours(const skg_leaky_batch *batch) {
    const skg_raster_layout *layout = &batch->raster->layout;
    const skg_leaky_args args = skg_leaky_scalars(batch);
    skg_context *context = batch->raster->context;
    const int on_gpu = context->device->info.gpu;
    const skg_work_size work = {2, {on_gpu ? layout->columns : 1, layout->rows}, {on_gpu ? 16 : 1, 8}};
    const skg_argument arguments[] = {
        SKG_LEAKY_ARGUMENTS(LEAKY_REPAIR, args, batch),
        SKG_ARGUMENT(LEAKY_REPAIR, rows_bad, batch->raster->rows_bad.memory),
        SKG_ARGUMENT(LEAKY_REPAIR, gaps, batch->memory->gaps.memory),
        SKG_ARGUMENT(LEAKY_REPAIR, shared, batch->shared->sums.memory),
    };
    cl_program program = NULL;
    SKG_TRY(skg_leaky_program(batch, &program));
    return SKG_LAUNCH_ONCE(context, program, "skg_leaky_repair", "repair", &work, arguments,
                           &batch->staging->log);
}

/* --- rays traced again on the host */

/* A batch whose rays are traced. */
typedef struct {
    const skg_leaky_batch *batch;
    cl_int *rows_bad; /* [parts][rows][3] as counts.cl leaves it */
    cl_int *marks;    /* [rows][columns] 1: a pixel of the part at hand that is traced again; else 0 */
    cl_program program;
} tracing;

static skg_status read_now(const tracing *t, cl_mem memory, int64_t first, int64_t count, cl_int *to) {
    SKG_CL_TRY(clEnqueueReadBuffer(t->batch->raster->context->device->queue, memory, CL_TRUE,
                                   (size_t)first * sizeof *to, (size_t)count * sizeof *to, to, 0, NULL,
                                   NULL));
    return SKG_OK;
}

/* Marks the bad pixels of a part. */
static skg_status mark_bad(const tracing *t, int64_t part) {
    const skg_raster_layout *layout = &t->batch->raster->layout;
    const cl_int *rows_bad = t->rows_bad + 3 * part * layout->rows;
    const int64_t columns = layout->columns;
    int64_t first = 0, end = layout->rows;
    while (first < end && !rows_bad[3 * first]) first++;
    while (first < end && !rows_bad[3 * (end - 1)]) end--;
    if (first == end) return SKG_OK;
    SKG_TRY(read_now(t, t->batch->memory->gaps.memory, (part * layout->rows + first) * columns,
                     (end - first) * columns, t->marks + first * columns));
    for (int64_t r = first; r < end;
         r++) /* skg_leaky_gaps leaves the columns without bad pixels as they were */
        for (int64_t k = 0; k < columns; k++)
            if (k < rows_bad[3 * r + 1] || k >= rows_bad[3 * r + 2]) t->marks[r * columns + k] = 0;
    return SKG_OK;
}

/* Lists pixels and what they get: path parameters in units of the planes, bounded so that the accumulators cannot wrap. */
static void list_sums(const skg_pass *pass, int64_t number, const skg_pixel_list *list, const double *paths,
                      cl_int *pixels, cl_long *values) {
    const skg_scale_part *reach = &pass->extents[number].scale;
    const double most = (reach->high_depth - reach->low_depth) * reach->multiplicity;
    for (int64_t r = 0; r < pass->camera.rows; r++)
        for (int64_t k = list->first[r]; k < list->first[r + 1]; k++) {
            const double path = fmin(fmax(paths[k], -most), most) * pass->scale.scale;
            *pixels++ = (cl_int)(r * pass->camera.columns + list->columns[k]);
            for (int64_t c = pass->first[number]; c < pass->first[number + 1]; c++)
                *values++ = llrint(path * pass->contributions[c].weight);
        }
}

/* Enqueues new sums for `count` pixels of a part. pixels and values stay until the device has read them. */
static skg_status put_sums(const tracing *t, int64_t part, int64_t count, int64_t contributions,
                           const cl_int *pixels, const cl_long *values) {
    skg_context *context = t->batch->raster->context;
    skg_stage_log *log = &t->batch->staging->log;
    skg_leaky_args args = skg_leaky_scalars(t->batch);
    const skg_work_size work = {1, {count}, {64}};
    const int64_t bytes[2] = {count * (int64_t)sizeof *pixels,
                              count * contributions * (int64_t)sizeof *values};
    const void *const from[2] = {pixels, values};
    skg_buffer on_device[2] = {{0}, {0}};
    skg_status status = SKG_OK;
    for (int k = 0; k < 2; k++) {
        SKG_TRY_CLEANUP(
            skg_buffer_reserve(context, &on_device[k], bytes[k], CL_MEM_READ_ONLY, "repaired pixels"));
        SKG_TRY_CLEANUP(skg_stage_write(context, "repair", on_device[k].memory, 0, bytes[k], from[k], log));
    }
    args.part = (SKG_INT)part;
    args.count = (SKG_INT)count;
    const skg_argument arguments[] = {
        SKG_LEAKY_ARGUMENTS(LEAKY_PUT, args, t->batch),
        SKG_ARGUMENT(LEAKY_PUT, pixels, on_device[0].memory),
        SKG_ARGUMENT(LEAKY_PUT, values, on_device[1].memory),
        SKG_ARGUMENT(LEAKY_PUT, shared, t->batch->shared->sums.memory),
    };
    SKG_TRY_CLEANUP(SKG_LAUNCH_ONCE(context, t->program, "skg_leaky_put", "repair", &work, arguments, log));
cleanup:
    for (int k = 0; k < 2; k++)
        skg_buffer_release(&on_device[k]); /* OpenCL keeps them for what is enqueued */
    return status;
}

/* Traces the marked rays of a part, in rows first to end - 1. */
static skg_status trace_marked(const tracing *t, int64_t part, int64_t first, int64_t end,
                               const skg_caps *caps) {
    const skg_pass *pass = t->batch->pass;
    const int64_t number = skg_leaky_part(t->batch, part);
    const int64_t contributions = pass->first[number + 1] - pass->first[number];
    skg_pixel_list list = {0};
    double *paths = NULL;
    cl_int *pixels = NULL;
    cl_long *values = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_pixel_list_make(pass->camera.columns, pass->camera.rows, first, end, t->marks, &list));
    if (list.count == 0) goto cleanup;
    SKG_TRY_CLEANUP(skg_alloc(list.count, sizeof *paths, "repair", &paths));
    SKG_TRY_CLEANUP(skg_recast(&pass->camera, pass->scene->parts[number].mesh, caps, pass->parts[number].pose,
                               &list, paths));
    SKG_TRY_CLEANUP(skg_staging_take(t->batch->staging, list.count, sizeof *pixels, "repair", &pixels));
    SKG_TRY_CLEANUP(
        skg_staging_take(t->batch->staging, list.count * contributions, sizeof *values, "repair", &values));
    list_sums(pass, number, &list, paths, pixels, values);
    SKG_TRY_CLEANUP(put_sums(t, part, list.count, contributions, pixels, values));
cleanup:
    skg_pixel_list_release(&list);
    skg_free(&paths);
    return status;
}

/* Traces the bad pixels of a part, and those whose ray passes a cap: the hits of a ray that goes in through one hole and
 * out through another cancel, although the ray is wrong. */
static skg_status trace_part(const tracing *t, int64_t part) {
    const skg_raster_layout *layout = &t->batch->raster->layout;
    const skg_pass *pass = t->batch->pass;
    const int64_t number = skg_leaky_part(t->batch, part);
    const skg_mesh *mesh = pass->scene->parts[number].mesh;
    const skg_caps *caps = NULL;
    cl_int extent[4];
    SKG_TRY(skg_leaky_caps(t->batch, t->batch->indices[part], mesh, &caps));
    skg_extent_pixels(&pass->camera, &pass->extents[number], extent);
    const int64_t first = extent[0], end = extent[1] < layout->rows ? extent[1] : layout->rows;
    if (first >= end) return SKG_OK;
    memset(t->marks + first * layout->columns, 0,
           (size_t)(end - first) * (size_t)layout->columns * sizeof *t->marks);
    SKG_TRY(mark_bad(t, part));
    skg_recast_mark(&pass->camera, mesh, caps, pass->parts[number].pose, t->marks);
    return trace_marked(t, part, first, end, caps);
}

static skg_status trace_again(const skg_leaky_batch *batch) {
    const skg_raster_layout *layout = &batch->raster->layout;
    const int64_t rows = batch->parts * layout->rows;
    tracing t = {.batch = batch};
    int any = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_leaky_program(batch, &t.program));
    SKG_TRY_CLEANUP(skg_alloc(rows, 3 * sizeof *t.rows_bad, "bad pixels", &t.rows_bad));
    SKG_TRY_CLEANUP(
        skg_alloc((int64_t)layout->rows * layout->columns, sizeof *t.marks, "bad pixels", &t.marks));
    SKG_TRY_CLEANUP(read_now(&t, batch->raster->rows_bad.memory, 0, 3 * rows, t.rows_bad));
    for (int64_t k = 0; k < rows; k++) any |= t.rows_bad[3 * k] != 0;
    if (any) SKG_TRY_CLEANUP(find_gaps(batch));
    for (int64_t part = 0; part < batch->parts; part++) SKG_TRY_CLEANUP(trace_part(&t, part));
cleanup:
    skg_free(&t.rows_bad);
    skg_free(&t.marks);
    return status;
}

skg_status skg_repair_run(const skg_leaky_batch *batch, int32_t repair) {
    if (repair == SKG_REPAIR_NONE) return SKG_OK;
    if (repair == SKG_REPAIR_EXACT) return trace_again(batch);
    SKG_TRY(find_gaps(batch));
    return take_neighbours(batch);
}
