/* The derivatives of pixels along a direction: the forward counterpart of gather.c. */
#include "gradient/gather.h"

#include "core/threads.h"
#include "gradient/scales.h"

#include <skiagraph/plan.h>

#include <string.h>

static const int64_t COPIES_BYTES = 64 << 20; /* that sums of pixels may take */

/* Sums of pixels are rows as long as those of weights, and what lanes without a hit touch behind them. */
static int64_t sums_of(const skg_gather_run *run) {
    return run->args.plane + SKG_SPARE_ROWS * (int64_t)run->args.stride + SKG_SPARE_COLUMNS;
}

/* Processors have sums for each of their cores, unless these are many and the image is large. */
static int64_t count_workers(const skg_gather_run *run, const skg_weight_layout *layout) {
    const skg_device_info *info = &run->context->device->info;
    const int64_t bytes = (int64_t)sizeof(int64_t) * layout->plane, most = COPIES_BYTES / bytes;
    const int64_t units = info->compute_units < most ? info->compute_units : most;
    return info->gpu || 4 * units < info->compute_units ? 0 : units;
}

skg_status skg_gradient_reserve_slopes(const skg_geometry *geometry, skg_gradient_memory *memory,
                                       skg_reals *slopes) {
    slopes->is_double = geometry->precision == SKG_PRECISION_DOUBLE;
    const size_t row = 3 * (size_t)skg_gradient_real_size(geometry->precision);
    if (!memory->reals) SKG_TRY(skg_alloc(geometry->triangles, row, "derivative", &memory->reals));
    slopes->memory = memory->reals;
    return SKG_OK;
}

/* Enqueues the upload of the slopes of the parts that move, those of neighbours together, from memory that stays. */
static skg_status upload_slopes(const skg_gather_run *run, const uint8_t *moves) {
    const skg_geometry *geometry = run->geometry;
    skg_gradient_memory *m = run->memory;
    const size_t row = 3 * (size_t)skg_gradient_real_size(geometry->precision);
    SKG_TRY(skg_gather_reserve(run, &m->faces, geometry->triangles * (int64_t)row));
    for (int64_t p = 0, first = 0, end; p < geometry->parts; p++, first = end) {
        end = skg_gradient_part_end(geometry, p, first);
        if (!moves[p]) continue;
        for (; p + 1 < geometry->parts && moves[p + 1]; p++)
            end = skg_gradient_part_end(geometry, p + 1, end);
        if (end == first) continue;
        SKG_CL_TRY(clEnqueueWriteBuffer(run->context->device->queue, m->faces.memory, CL_FALSE,
                                        (size_t)first * row, (size_t)(end - first) * row,
                                        (const char *)m->reals + (size_t)first * row, 0, NULL, NULL));
    }
    return SKG_OK;
}

/* No face is seen as a line so far. */
static skg_status clear_lines(const skg_gather_run *run) {
    const cl_uchar none = 0;
    const int64_t bytes = run->geometry->triangles + 1;
    SKG_TRY(skg_gather_reserve(run, &run->memory->lines, bytes));
    SKG_CL_TRY(clEnqueueFillBuffer(run->context->device->queue, run->memory->lines.memory, &none, sizeof none,
                                   0, (size_t)bytes, 0, NULL, NULL));
    return SKG_OK;
}

/* Reads which faces are, and waits. */
static skg_status read_lines(const skg_gather_run *run, skg_seen_lines *lines) {
    const int64_t triangles = run->geometry->triangles;
    skg_host_view *view = &run->memory->sums;
    SKG_TRY(skg_host_view_open(run->context, run->memory->lines.memory, 0, triangles + 1, view));
    const uint8_t *flags = view->bytes;
    lines->any = flags[triangles];
    if (lines->any) memcpy(lines->faces, flags, (size_t)triangles);
    skg_host_view_close(run->context, view);
    return SKG_OK;
}

/* Adds up the hits of every pixel: in batches, which zero their own sums, or by atomic operations. */
static skg_status run_hits(const skg_gather_run *run, int64_t copies) {
    const int64_t sums = copies * sums_of(run);
    SKG_TRY(skg_gather_clear(run, run->workers > 0 ? sums : 0, sums));
    SKG_TRY(clear_lines(run));
    SKG_TRY(skg_gather_slopes(run));
    SKG_TRY(skg_gather_batches(run));
    return skg_gather_faces(run);
}

/* The sums of all copies, on the host. */
typedef struct {
    const skg_gather_run *run;
    int64_t copies;
    double unit;
    const int64_t *sums;
    double *values;
} pixel_sums;

static skg_status add_row(void *user, int64_t row) {
    const pixel_sums *s = user;
    const int64_t columns = s->run->pass->camera.columns, size = sums_of(s->run);
    const int64_t *from = s->sums + row * s->run->args.stride;
    double *to = s->values + row * columns;
    for (int64_t c = 0; c < columns; c++) {
        int64_t sum = from[c];
        for (int64_t k = 1; k < s->copies; k++) sum += from[k * size + c];
        to[c] += (double)sum * s->unit;
    }
    return SKG_OK;
}

/* Adds the sums of all copies as derivatives. */
static skg_status read_pixels(const skg_gather_run *run, int64_t copies, double scale, double *values) {
    const int64_t bytes = copies * sums_of(run) * (int64_t)sizeof(int64_t);
    skg_host_view *view = &run->memory->sums;
    SKG_TRY(skg_host_view_open(run->context, run->memory->moments.memory, 0, bytes, view));
    pixel_sums sums = {
        .run = run, .copies = copies, .unit = 1 / scale, .sums = view->bytes, .values = values};
    const skg_status status = skg_parallel(run->pass->camera.rows, add_row, &sums);
    skg_host_view_close(run->context, view);
    return status;
}

skg_status skg_gradient_scatter(const skg_pass *pass, const skg_geometry *geometry,
                                const skg_hits_memory *hits, skg_gradient_memory *memory,
                                skg_staging *staging, const uint8_t *moves, double largest,
                                skg_seen_lines *lines, double *values) {
    skg_gather_run run = skg_gather_of(pass, geometry, hits, memory, staging);
    const skg_weight_layout layout = skg_attenuate_weight_layout(pass->main.raster, pass->fine);
    double *most = NULL, *scales = NULL;
    run.forward = 1;
    lines->any = 0;
    run.workers = count_workers(&run, &layout);
    SKG_TRY(skg_gather_begin(&run));
    SKG_TRY(skg_staging_take(staging, run.args.planes, sizeof *most, "derivative", &most));
    SKG_TRY(skg_staging_take(staging, pass->scene->count, sizeof *scales, "derivative", &scales));
    SKG_TRY(skg_gather_find_max(&run, most));
    /* Faces that are seen as lines have to be found where no other one moves, too. */
    const double scale = skg_gradient_find_scale(&run, most, moves, largest > 0 ? largest : 1, scales);
    if (scale == 0) return SKG_OK;
    const int64_t copies = run.workers > 0 ? run.workers : 1;
    SKG_TRY(skg_gather_upload_scales(&run, pass->scene->count, scales));
    SKG_TRY(upload_slopes(&run, moves));
    SKG_TRY(run_hits(&run, copies));
    SKG_TRY(read_pixels(&run, copies, scale, values));
    return read_lines(&run, lines);
}
