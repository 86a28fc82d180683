#include "stage/raster_private.h"

#include <skiagraph/plan.h>

#include <string.h>

enum {
    CACHE_BYTES = 256 * 1024, /* of a band: half of the level 2 cache of common CPUs */
    MOST_BAND_ROWS = 256,
    SQUARE = 32,             /* side of a tile on a GPU */
    QUEUE_ENTRIES = 1 << 20, /* strips of large triangles; more are drawn without it */
    QUEUE_GROUPS_PER_UNIT = 8,
    GROUP = 64 /* local size of one item per triangle */
};

static int64_t round_up(int64_t value, int64_t to) {
    return (value + to - 1) / to * to;
}

static int64_t sum_bytes(const skg_raster *raster) {
    return raster->options.kernels.bits / 8;
}

static int squares(const skg_raster *raster) {
    const int32_t shape = raster->options.shape;
    return shape == SKG_TILE_SQUARES || (shape == SKG_TILE_AUTO && raster->context->device->info.is_gpu);
}

static SKG_INT band_rows(const skg_raster *raster) {
    const int64_t row = raster->frame.stride * raster->frame.planes * sum_bytes(raster);
    const int64_t fit = CACHE_BYTES / row, even = raster->frame.rows / (4 * (int64_t)raster->workers);
    int64_t rows = fit < even ? fit : even; /* some bands for each worker */
    rows = rows < MOST_BAND_ROWS ? rows : MOST_BAND_ROWS;
    const int64_t least = (raster->frame.rows + SKG_MOST_BANDS - 1) / SKG_MOST_BANDS;
    rows = rows > 8 ? rows : 8;
    return (SKG_INT)(rows > least ? rows : least);
}

static skg_status square_side(const skg_raster *raster, SKG_INT *side) {
    const int64_t room = raster->context->device->info.local_memory,
                  pixel = raster->frame.planes * sum_bytes(raster);
    if (!raster->options.tile)
        while (*side > 8 && *side * *side * pixel > room / 2) *side /= 2;
    if (*side * *side * pixel > room)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "tiles of %d x %d pixels with %d planes do not fit the local memory of %s; choose smaller "
            "tiles or strategy atomics",
            (int)*side, (int)*side, (int)raster->frame.planes, raster->context->device->info.name);
    return SKG_OK;
}

static skg_status lay_out(skg_raster *raster) {
    const skg_raster_options *o = &raster->options;
    skg_frame_args *frame = &raster->frame;
    /* Two work-groups on two threads are dealt out unevenly by PoCL; one more than there are threads is not.
     */
    raster->workers = raster->context->device->info.compute_units + 1;
    frame->columns = (SKG_INT)o->columns;
    frame->rows = (SKG_INT)o->rows;
    frame->stride = (SKG_INT)round_up(o->columns + SKG_SPARE_COLUMNS, 16);
    const int64_t plane = frame->stride * (o->rows + SKG_SPARE_ROWS);
    if (plane * o->planes > INT32_MAX)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%d planes of this detector are more than 2^31 accumulators",
                        (int)o->planes);
    frame->plane = (SKG_INT)plane;
    frame->planes = (SKG_INT)o->planes;
    frame->copies = o->strategy == SKG_STRATEGY_COPIES ? raster->workers : 1;
    frame->tile_columns = frame->columns;
    frame->tile_rows = frame->rows;
    if (o->strategy == SKG_STRATEGY_TILES) {
        SKG_INT side = o->tile ? o->tile : squares(raster) ? SQUARE : band_rows(raster);
        if (squares(raster)) {
            SKG_TRY(square_side(raster, &side));
            frame->tile_columns = side;
        }
        frame->tile_rows = side;
        if (!squares(raster) && (frame->rows + side - 1) / side > SKG_MOST_BANDS)
            return skg_fail(SKG_ERR_ARGUMENT, "bands of %d rows are more than %d; make them higher",
                            (int)side, SKG_MOST_BANDS);
    }
    frame->tiles_across = (frame->columns + frame->tile_columns - 1) / frame->tile_columns;
    frame->tiles_down = (frame->rows + frame->tile_rows - 1) / frame->tile_rows;
    frame->queue = o->strategy == SKG_STRATEGY_ATOMICS ? QUEUE_ENTRIES : 0;
    return SKG_OK;
}

static skg_status reserve(skg_raster *raster, skg_buffer *buffer, int64_t bytes, const char *what) {
    return skg_buffer_reserve(raster->context, buffer, bytes, CL_MEM_READ_WRITE, what);
}

static skg_status allocate(skg_raster *raster) {
    const skg_frame_args *frame = &raster->frame;
    const int64_t of_int = sizeof(cl_int), tiles = (int64_t)frame->tiles_across * frame->tiles_down;
    SKG_TRY(reserve(raster, &raster->sums,
                    (int64_t)frame->copies * frame->planes * frame->plane * sum_bytes(raster),
                    "accumulators"));
    SKG_TRY(reserve(raster, &raster->used, SKG_FIELD(frame->copies, frame->planes) * of_int,
                    "accumulators in use"));
    if (raster->options.strategy == SKG_STRATEGY_ATOMICS)
        SKG_TRY(reserve(raster, &raster->queue, (2 * (int64_t)frame->queue + 2) * of_int,
                        "queue of large triangles"));
    if (raster->options.strategy != SKG_STRATEGY_TILES) return SKG_OK;
    const int64_t chunks = (raster->options.triangles + SKG_CHUNK - 1) / SKG_CHUNK;
    SKG_TRY(reserve(raster, &raster->counts, (squares(raster) ? tiles + 1 : 3) * of_int, "tiles"));
    SKG_TRY(reserve(raster, &raster->starts, (squares(raster) ? tiles + 2 : 2 * chunks * tiles) * of_int,
                    "tiles"));
    SKG_TRY(reserve(raster, &raster->list, raster->options.triangles * SKG_MOST_TILES * of_int,
                    "lists of the tiles"));
    SKG_TRY(reserve(raster, &raster->for_all, raster->options.triangles * of_int, "list for all tiles"));
    if (squares(raster)) return SKG_OK;
    return reserve(raster, &raster->scratch,
                   (int64_t)raster->workers * frame->planes * frame->stride *
                       (frame->tile_rows + (int64_t)SKG_SPARE_ROWS) * sum_bytes(raster),
                   "bands");
}

static skg_status fill(const skg_raster *raster, const skg_buffer *buffer, cl_int value, int64_t from,
                       int64_t bytes) {
    SKG_CL_TRY(clEnqueueFillBuffer(raster->context->device->queue, buffer->memory, &value, sizeof value,
                                   (size_t)from, (size_t)bytes, 0, NULL, NULL));
    return SKG_OK;
}

/* Fields of the whole detector; on the device, where nothing is known of a frame. */
static skg_status make_fields(skg_raster *raster) {
    const skg_frame_args *frame = &raster->frame;
    SKG_TRY(skg_alloc(8 * (int64_t)frame->planes, sizeof *raster->whole, "fields", &raster->whole));
    raster->sent = raster->whole + 4 * frame->planes;
    for (int32_t p = 0; p < frame->planes; p++)
        raster->whole[4 * p + 1] = frame->rows, raster->whole[4 * p + 3] = frame->stride;
    return fill(raster, &raster->used, 1, 0, raster->used.bytes);
}

static skg_status send_fields(skg_raster *raster, const cl_int *fields, skg_stage_log *log) {
    const skg_frame_args *frame = &raster->frame;
    const size_t bytes = 4 * (size_t)frame->planes * sizeof *fields;
    if (!fields) fields = raster->whole;
    if (memcmp(fields, raster->sent, bytes) == 0) return SKG_OK;
    SKG_TRY(skg_stage_write(raster->context, "upload", raster->used.memory,
                            SKG_FIELD(frame->copies, 0) * (int64_t)sizeof *fields, (int64_t)bytes, fields,
                            log));
    memcpy(raster->sent, fields, bytes);
    return SKG_OK;
}

static skg_status compile(skg_raster *raster) {
    static const char *const copies[] = {"batch.clh", "draw.clh", "raster_copies.cl"};
    static const char *const atomics[] = {"pixel.clh", "raster_atomics.cl"};
    static const char *const bands[] = {"bands.cl", "batch.clh", "draw.clh", "raster_bands.cl"};
    static const char *const square_files[] = {"pixel.clh", "tiles.cl", "raster_squares.cl"};
    static const char *const source[] = {"pixel.clh", "source_plane.cl"};
    static const char *const half[] = {"pixel.clh", "half.cl"};
    const skg_kernel_options *options = &raster->options.kernels;
    skg_context *context = raster->context;
    cl_program program = NULL;
    if (options->half) {
        SKG_TRY(skg_kernels_get(context, options, 2, half, NULL, &program));
        return skg_kernel_create(program, "skg_raster_half", &raster->kernels[SKG_RASTER_DRAW]);
    }
    if (raster->options.strategy == SKG_STRATEGY_COPIES) {
        SKG_TRY(skg_kernels_get(context, options, 3, copies, NULL, &program));
        SKG_TRY(skg_kernel_create(program, "skg_raster_copies", &raster->kernels[SKG_RASTER_DRAW]));
    } else if (raster->options.strategy == SKG_STRATEGY_ATOMICS) {
        SKG_TRY(skg_kernels_get(context, options, 2, atomics, NULL, &program));
        SKG_TRY(skg_kernel_create(program, "skg_raster_atomics", &raster->kernels[SKG_RASTER_DRAW]));
        SKG_TRY(skg_kernel_create(program, "skg_raster_queue", &raster->kernels[SKG_RASTER_QUEUE]));
    } else {
        SKG_TRY(skg_kernels_get(context, options, squares(raster) ? 3 : 4,
                                squares(raster) ? square_files : bands, NULL, &program));
        if (squares(raster)) {
            SKG_TRY(skg_kernel_create(program, "skg_tiles_count", &raster->kernels[SKG_RASTER_COUNT]));
            SKG_TRY(skg_kernel_create(program, "skg_tiles_scan", &raster->kernels[SKG_RASTER_SCAN]));
        }
        SKG_TRY(skg_kernel_create(program, squares(raster) ? "skg_tiles_fill" : "skg_bands_sort",
                                  &raster->kernels[SKG_RASTER_FILL]));
        SKG_TRY(skg_kernel_create(program, squares(raster) ? "skg_raster_squares" : "skg_raster_bands",
                                  &raster->kernels[SKG_RASTER_DRAW]));
    }
    if (!options->source_plane || options->parallel) return SKG_OK;
    SKG_TRY(skg_kernels_get(context, options, 2, source, NULL, &program));
    return skg_kernel_create(program, "skg_source_plane", &raster->kernels[SKG_RASTER_SOURCE]);
}

skg_status skg_raster_create(skg_context *context, const skg_raster_options *options, skg_raster **raster) {
    skg_raster *made = NULL;
    skg_status status = SKG_OK;
    *raster = NULL;
    SKG_TRY(skg_alloc(1, sizeof *made, "raster", &made));
    made->context = context;
    made->options = *options;
    SKG_TRY_CLEANUP(lay_out(made));
    SKG_TRY_CLEANUP(allocate(made));
    SKG_TRY_CLEANUP(compile(made));
    SKG_TRY_CLEANUP(make_fields(made));
    *raster = made;
    return SKG_OK;
cleanup:
    skg_raster_release(&made);
    return status;
}

static void release_kernel(cl_kernel kernel) {
    if (kernel) clReleaseKernel(kernel);
}

void skg_raster_release(skg_raster **raster) {
    if (!raster || !*raster) return;
    skg_raster *r = *raster;
    skg_buffer *const buffers[] = {&r->sums, &r->used,    &r->scratch, &r->counts,  &r->starts,
                                   &r->list, &r->for_all, &r->queue,   &r->rows_bad};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++) skg_buffer_release(buffers[i]);
    for (int i = 0; i < SKG_RASTER_KERNELS; i++) release_kernel(r->kernels[i]);
    skg_free(&r->whole);
    release_kernel(r->bad_rows);
    release_kernel(r->bad);
    skg_free(raster);
}

/* --- a frame
 * ------------------------------------------------------------------------------------------------------ */

/* So many triangles at once that the last claims even out; few enough that a thousand still use every worker.
 */
static SKG_INT claim_size(int64_t triangles, int32_t workers) {
    const int64_t claim = triangles / (16 * (int64_t)workers);
    return (SKG_INT)(claim < 32 ? 32 : claim > 1024 ? 1024 : claim);
}

/* A kernel's frame and buffers, then one work-item a triangle, or `groups` work-groups. */
static skg_status run(skg_raster *raster, int which, const char *stage, int32_t count, const cl_mem *memory,
                      size_t groups, size_t local, skg_stage_log *log) {
    cl_kernel kernel = raster->kernels[which];
    const size_t global = groups * local;
    SKG_TRY(skg_kernel_set(kernel, 0, sizeof raster->frame, &raster->frame));
    SKG_TRY(skg_kernel_set_memory(kernel, 1, count, memory));
    return skg_kernel_run(raster->context, kernel, stage, 1, &global, &local, log);
}

static size_t triangle_groups(const skg_raster *raster) {
    return ((size_t)raster->frame.triangles + GROUP - 1) / GROUP;
}

static skg_status run_copies(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_frame_args *frame = &raster->frame;
    const cl_mem memory[] = {g->corners.memory,     g->projected.memory,       g->part_table.memory,
                             g->write_table.memory, g->triangle_blocks.memory, raster->sums.memory,
                             raster->used.memory};
    const int64_t of_int = sizeof(cl_int);
    SKG_TRY(fill(raster, &raster->used, 0, 0, (frame->copies + 1) * of_int));
    if (raster->kernels[SKG_RASTER_SOURCE] || raster->options.more_sums) { /* the first copy is added to */
        SKG_TRY(fill(raster, &raster->sums, 0, 0, (int64_t)frame->planes * frame->plane * sum_bytes(raster)));
        SKG_TRY(fill(raster, &raster->used, 1, 0, of_int));
    }
    return run(raster, SKG_RASTER_DRAW, "raster", 7, memory, (size_t)raster->workers, 1, log);
}

static skg_status run_atomics(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const cl_mem memory[] = {g->corners.memory,     g->projected.memory,       g->part_table.memory,
                             g->write_table.memory, g->triangle_blocks.memory, raster->sums.memory,
                             raster->queue.memory};
    const size_t groups = (size_t)(QUEUE_GROUPS_PER_UNIT * raster->context->device->info.compute_units);
    SKG_TRY(fill(raster, &raster->sums, 0, 0,
                 (int64_t)raster->frame.planes * raster->frame.plane * sum_bytes(raster)));
    SKG_TRY(fill(raster, &raster->queue, 0, 0, 2 * (int64_t)sizeof(cl_int)));
    SKG_TRY(run(raster, SKG_RASTER_DRAW, "raster", 7, memory, triangle_groups(raster), GROUP, log));
    return run(raster, SKG_RASTER_QUEUE, "large triangles", 7, memory, groups, GROUP, log);
}

static skg_status run_binning(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_frame_args *frame = &raster->frame;
    const cl_mem memory[] = {g->corners.memory,         g->projected.memory,   g->part_table.memory,
                             g->triangle_blocks.memory, raster->counts.memory, raster->starts.memory,
                             raster->list.memory,       raster->for_all.memory};
    const cl_mem scan[] = {raster->counts.memory, raster->starts.memory};
    SKG_TRY(fill(raster, &raster->counts, 0, 0,
                 ((int64_t)frame->tiles_across * frame->tiles_down + 1) * (int64_t)sizeof(cl_int)));
    SKG_TRY(run(raster, SKG_RASTER_COUNT, "tiles: count", 5, memory, triangle_groups(raster), GROUP, log));
    SKG_TRY(run(raster, SKG_RASTER_SCAN, "tiles: scan", 2, scan, 1, GROUP, log));
    return run(raster, SKG_RASTER_FILL, "tiles: fill", 8, memory, triangle_groups(raster), GROUP, log);
}

static skg_status run_squares(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_frame_args *frame = &raster->frame;
    const cl_mem memory[] = {g->corners.memory,     g->projected.memory,       g->part_table.memory,
                             g->write_table.memory, g->triangle_blocks.memory, raster->starts.memory,
                             raster->list.memory,   raster->for_all.memory,    raster->sums.memory};
    const size_t local = (size_t)(frame->tile_columns * frame->tile_rows * frame->planes * sum_bytes(raster));
    SKG_TRY(run_binning(raster, g, log));
    SKG_TRY(skg_kernel_set(raster->kernels[SKG_RASTER_DRAW], 10, local, NULL));
    return run(raster, SKG_RASTER_DRAW, "raster", 9, memory,
               (size_t)(frame->tiles_across * frame->tiles_down), GROUP, log);
}

static skg_status run_bands(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const cl_mem sort[] = {g->corners.memory,         g->projected.memory,   g->part_table.memory,
                           g->triangle_blocks.memory, raster->counts.memory, raster->starts.memory,
                           raster->list.memory,       raster->for_all.memory};
    const cl_mem memory[] = {g->corners.memory,     g->projected.memory,       g->part_table.memory,
                             g->write_table.memory, g->triangle_blocks.memory, raster->counts.memory,
                             raster->starts.memory, raster->list.memory,       raster->for_all.memory,
                             raster->sums.memory,   raster->scratch.memory,    raster->used.memory};
    SKG_TRY(fill(raster, &raster->counts, 0, 0, 3 * (int64_t)sizeof(cl_int)));
    SKG_TRY(fill(raster, &raster->used, 0, sizeof(cl_int), sizeof(cl_int)));
    SKG_TRY(run(raster, SKG_RASTER_FILL, "tiles", 8, sort, (size_t)raster->workers, 1, log));
    return run(raster, SKG_RASTER_DRAW, "raster", 12, memory, (size_t)raster->workers, 1, log);
}

void skg_raster_set_rays(skg_raster *raster, const skg_camera *camera) {
    skg_ray_double rays;
    skg_camera_rays(camera, 1, &rays);
    skg_rays_round(&rays, &raster->rays);
}

static skg_status run_half(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const cl_mem memory[] = {g->corners.memory,     g->projected.memory,       g->part_table.memory,
                             g->write_table.memory, g->triangle_blocks.memory, raster->sums.memory};
    SKG_TRY(fill(raster, &raster->sums, 0, 0,
                 (int64_t)raster->frame.planes * raster->frame.plane * sum_bytes(raster)));
    SKG_TRY(skg_kernel_set(raster->kernels[SKG_RASTER_DRAW], 7, sizeof raster->rays, &raster->rays));
    return run(raster, SKG_RASTER_DRAW, "raster", 6, memory, triangle_groups(raster), GROUP, log);
}

static skg_status run_source(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const cl_mem memory[] = {g->corners.memory,         g->projected.memory, g->part_table.memory,
                             g->triangle_blocks.memory, g->offsets.memory,   g->write_table.memory,
                             raster->sums.memory};
    cl_kernel kernel = raster->kernels[SKG_RASTER_SOURCE];
    const size_t local[2] = {GROUP, 1};
    const size_t global[2] = {triangle_groups(raster) * GROUP,
                              ((size_t)raster->frame.rows + SKG_SOURCE_ROWS - 1) / SKG_SOURCE_ROWS};
    SKG_TRY(skg_kernel_set(kernel, 0, sizeof raster->frame, &raster->frame));
    SKG_TRY(skg_kernel_set_memory(kernel, 1, 7, memory));
    return skg_kernel_run(raster->context, kernel, "source plane", 2, global, local, log);
}

skg_status skg_raster_run(skg_raster *raster, const skg_geometry *geometry, const cl_int *fields,
                          skg_stage_log *log) {
    skg_frame_args *frame = &raster->frame;
    frame->parts = (SKG_INT)geometry->parts;
    frame->vertices = (SKG_INT)geometry->vertices;
    frame->triangles = (SKG_INT)geometry->triangles;
    frame->claim = claim_size(geometry->triangles, raster->workers - 1);
    if (geometry->triangles > raster->options.triangles)
        return skg_fail(SKG_ERR_INTERNAL, "a frame of more triangles than the stage was made for");
    SKG_TRY(send_fields(raster, fields, log));
    if (raster->options.kernels.half) return run_half(raster, geometry, log);
    if (raster->options.strategy == SKG_STRATEGY_COPIES)
        SKG_TRY(run_copies(raster, geometry, log));
    else if (raster->options.strategy == SKG_STRATEGY_ATOMICS)
        SKG_TRY(run_atomics(raster, geometry, log));
    else if (squares(raster))
        SKG_TRY(run_squares(raster, geometry, log));
    else
        SKG_TRY(run_bands(raster, geometry, log));
    return raster->kernels[SKG_RASTER_SOURCE] ? run_source(raster, geometry, log) : SKG_OK;
}

/* --- what was decided and made
 * ------------------------------------------------------------------------------------ */

skg_status skg_raster_read_listed(const skg_raster *raster, int32_t *listed) {
    if (raster->options.strategy != SKG_STRATEGY_TILES) return SKG_OK;
    const int64_t tiles = (int64_t)raster->frame.tiles_across * raster->frame.tiles_down;
    const skg_buffer *from = squares(raster) ? &raster->starts : &raster->counts;
    const size_t first =
        squares(raster) ? (size_t)tiles : 1; /* as the kernels of tiles.cl and bands.cl leave it */
    SKG_CL_TRY(clEnqueueReadBuffer(raster->context->device->queue, from->memory, CL_FALSE,
                                   first * sizeof(cl_int), 2 * sizeof(cl_int), listed, 0, NULL, NULL));
    return SKG_OK;
}

void skg_raster_tiles(const skg_raster *raster, int64_t *columns, int64_t *rows, int64_t *tiles) {
    *columns = raster->frame.tile_columns;
    *rows = raster->frame.tile_rows;
    *tiles = (int64_t)raster->frame.tiles_across * raster->frame.tiles_down;
}

int64_t skg_raster_bytes(const skg_raster *raster) {
    return raster->sums.bytes + raster->used.bytes + raster->scratch.bytes + raster->counts.bytes +
           raster->starts.bytes + raster->list.bytes + raster->for_all.bytes + raster->queue.bytes +
           raster->rows_bad.bytes;
}
