#include "core/maths.h"
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

#include <string.h>

/* Planes fill only parts of a band, and a triangle is set up in each band that it meets: of the thorax with 17 accumulators,
 * bands of 8, 16, 24, 32 and 64 rows took 3.0, 2.4, 2.3, 2.2 and 2.2 ms at 1024^2, 11.1, 7.0, 6.7, 6.4 and 6.3 ms at 2048^2
 * (EPYC, 2 cores). */
enum {
    CACHE_BYTES = 256 * 1024, /* of a band: half of the level 2 cache of common CPUs */
    HIGH_BAND = 32,           /* rows that a band may have even so */
    MOST_BAND_ROWS = 256,
    SQUARE = 32,            /* side of a tile on a GPU */
    QUEUE_ENTRIES = 1 << 20 /* strips of large triangles; more are drawn without the queue */
};

int64_t skg_raster_sum_bytes(const skg_raster *raster) {
    return raster->options.kernels.bits / 8;
}

int skg_raster_has_squares(const skg_raster *raster) {
    const int32_t shape = raster->options.shape;
    return shape == SKG_TILE_SQUARES || (shape == SKG_TILE_AUTO && raster->context->device->info.is_gpu);
}

int64_t skg_raster_band_rows(int64_t rows_of_detector, int64_t row_bytes, int64_t groups) {
    const int64_t fit = CACHE_BYTES / row_bytes, even = rows_of_detector / (4 * groups);
    int64_t rows = fit > HIGH_BAND ? fit : HIGH_BAND;
    rows = rows < even ? rows : even; /* some bands for each worker */
    rows = rows < MOST_BAND_ROWS ? rows : MOST_BAND_ROWS;
    const int64_t least = (rows_of_detector + SKG_MOST_BANDS - 1) / SKG_MOST_BANDS;
    rows = rows > 8 ? rows : 8;
    return rows > least ? rows : least;
}

static SKG_INT band_rows(const skg_raster *raster) {
    const skg_frame_args *frame = &raster->frame;
    return (SKG_INT)skg_raster_band_rows(
        frame->rows, frame->stride * frame->planes * skg_raster_sum_bytes(raster), raster->workers);
}

static skg_status square_side(const skg_raster *raster, SKG_INT *side) {
    const int64_t capacity = raster->context->device->info.local_memory,
                  pixel = raster->frame.planes * skg_raster_sum_bytes(raster);
    if (!raster->options.tile)
        while (*side > 8 && *side * *side * pixel > capacity / 2) *side /= 2;
    if (*side * *side * pixel > capacity)
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
    /* PoCL gives two work-groups unevenly to two threads, but not one work-group more than there are threads. */
    raster->workers = raster->context->device->info.compute_units + 1;
    frame->columns = (SKG_INT)o->columns;
    frame->rows = (SKG_INT)o->rows;
    frame->stride = (SKG_INT)skg_round_up(o->columns + SKG_SPARE_COLUMNS, 16);
    const int64_t plane = frame->stride * (o->rows + SKG_SPARE_ROWS);
    if (skg_raster_side(raster) * plane * o->planes > INT32_MAX)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%d planes of this detector are more than 2^31 accumulators",
                        (int)o->planes);
    frame->plane = (SKG_INT)plane;
    frame->planes = (SKG_INT)o->planes;
    frame->copies =
        o->strategy == SKG_STRATEGY_COPIES && skg_raster_passes(raster) == 1 ? raster->workers : 1;
    frame->tile_columns = frame->columns;
    frame->tile_rows = frame->rows;
    if (o->strategy == SKG_STRATEGY_TILES) {
        SKG_INT side = o->tile ? o->tile : skg_raster_has_squares(raster) ? SQUARE : band_rows(raster);
        if (skg_raster_has_squares(raster)) {
            SKG_TRY(square_side(raster, &side));
            frame->tile_columns = side;
        }
        frame->tile_rows = side;
        if (!skg_raster_has_squares(raster) && (frame->rows + side - 1) / side > SKG_MOST_BANDS)
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

static int64_t bytes_of_sums(const skg_raster *raster) {
    const skg_frame_args *frame = &raster->frame;
    return (int64_t)frame->copies * skg_raster_passes(raster) * frame->planes * frame->plane *
           skg_raster_sum_bytes(raster);
}

static skg_status allocate(skg_raster *raster) {
    const skg_frame_args *frame = &raster->frame;
    const int64_t of_int = sizeof(cl_int), tiles = (int64_t)frame->tiles_across * frame->tiles_down;
    const int64_t planes = (int64_t)skg_raster_passes(raster) * frame->planes;
    SKG_TRY(reserve(raster, &raster->sums, bytes_of_sums(raster), "accumulators"));
    SKG_TRY(
        reserve(raster, &raster->used, SKG_EXTENT(frame->copies, planes) * of_int, "accumulators in use"));
    if (raster->options.strategy == SKG_STRATEGY_ATOMICS)
        SKG_TRY(reserve(raster, &raster->queue, (2 * (int64_t)frame->queue + 2) * of_int,
                        "queue of large triangles"));
    if (raster->options.strategy != SKG_STRATEGY_TILES) return SKG_OK;
    const int64_t chunks = (raster->options.triangles + SKG_CHUNK - 1) / SKG_CHUNK;
    SKG_TRY(
        reserve(raster, &raster->counts, (skg_raster_has_squares(raster) ? tiles + 1 : 3) * of_int, "tiles"));
    SKG_TRY(reserve(raster, &raster->starts,
                    (skg_raster_has_squares(raster) ? tiles + 2 : 2 * chunks * tiles) * of_int, "tiles"));
    SKG_TRY(reserve(raster, &raster->list, raster->options.triangles * SKG_MOST_TILES * of_int,
                    "lists of the tiles"));
    SKG_TRY(reserve(raster, &raster->for_all, raster->options.triangles * of_int, "list for all tiles"));
    if (skg_raster_has_squares(raster)) return SKG_OK;
    return reserve(raster, &raster->scratch,
                   (int64_t)raster->workers * frame->planes * frame->stride *
                       (frame->tile_rows + (int64_t)SKG_SPARE_ROWS) * skg_raster_sum_bytes(raster),
                   "bands");
}

skg_status skg_raster_fill(const skg_raster *raster, const skg_buffer *buffer, cl_int value, int64_t from,
                           int64_t bytes) {
    SKG_CL_TRY(clEnqueueFillBuffer(raster->context->device->queue, buffer->memory, &value, sizeof value,
                                   (size_t)from, (size_t)bytes, 0, NULL, NULL));
    return SKG_OK;
}

/* On the host the whole detector for each plane; on the device any extent, until a frame sends its own. */
static skg_status make_extents(skg_raster *raster) {
    const skg_frame_args *frame = &raster->frame;
    SKG_TRY(skg_alloc(4 * (1 + (int64_t)skg_raster_passes(raster)) * frame->planes, sizeof *raster->whole,
                      "extents", &raster->whole));
    raster->sent = raster->whole + 4 * frame->planes;
    for (int32_t p = 0; p < frame->planes; p++)
        raster->whole[4 * p + 1] = frame->rows, raster->whole[4 * p + 3] = frame->stride;
    return skg_raster_fill(raster, &raster->used, 1, 0, raster->used.bytes);
}

/* A kernel of a raster, by its name. */
typedef struct {
    int which;
    const char *name;
} named_kernel;

/* Compiles these files, the projection before them, and makes its kernel and these. */
static skg_status compile_files(skg_raster *raster, int32_t files, const char *const *names, int kernels,
                                const named_kernel *kernel) {
    const skg_define side[] = {{"SKG_SIDE", skg_raster_side(raster)}};
    enum { MOST = 6 };
    const char *all[MOST] = {"fine.clh", "project.cl"};
    cl_program program = NULL;
    for (int32_t i = 0; i < files; i++) all[i + 2] = names[i];
    SKG_TRY(skg_kernels_get(raster->context, &raster->options.kernels, files + 2, all, SKG_DEFINES(side),
                            raster->expected ? NULL : &program));
    if (raster->expected) return SKG_OK;
    SKG_TRY(skg_kernel_create(program, "skg_project", &raster->kernels[SKG_RASTER_PROJECT]));
    for (int k = 0; k < kernels; k++)
        SKG_TRY(skg_kernel_create(program, kernel[k].name, &raster->kernels[kernel[k].which]));
    return SKG_OK;
}

static skg_status compile_copies(skg_raster *raster) {
    cl_program program = NULL;
    SKG_TRY(skg_kernels_get_first(raster->context, raster->expected ? NULL : &program));
    if (raster->expected) return SKG_OK;
    SKG_TRY(skg_kernel_create(program, "skg_project", &raster->kernels[SKG_RASTER_PROJECT]));
    return skg_kernel_create(program, "skg_raster_copies", &raster->kernels[SKG_RASTER_DRAW]);
}

static skg_status compile_strategy(skg_raster *raster) {
    static const char *const half[] = {"pixel.clh", "half.cl"};
    static const char *const copies[] = {"batch.clh", "draw.clh", "raster_copies.cl"};
    static const char *const passes[] = {"batch.clh", "draw.clh", "raster_passes.cl"};
    static const char *const atomics[] = {"pixel.clh", "raster_atomics.cl"};
    static const char *const squares[] = {"pixel.clh", "tiles.cl", "raster_squares.cl"};
    static const char *const bands[] = {"bands.cl", "batch.clh", "draw.clh", "raster_bands.cl"};
    static const named_kernel of_half[] = {{SKG_RASTER_DRAW, "skg_raster_half"}};
    static const named_kernel of_copies[] = {{SKG_RASTER_DRAW, "skg_raster_copies"}};
    static const named_kernel of_passes[] = {{SKG_RASTER_DRAW, "skg_raster_passes"}};
    static const named_kernel of_atomics[] = {{SKG_RASTER_DRAW, "skg_raster_atomics"},
                                              {SKG_RASTER_LARGE, "skg_raster_queue"}};
    static const named_kernel of_squares[] = {{SKG_RASTER_COUNT, "skg_tiles_count"},
                                              {SKG_RASTER_SCAN, "skg_tiles_scan"},
                                              {SKG_RASTER_FILL, "skg_tiles_fill"},
                                              {SKG_RASTER_DRAW, "skg_raster_squares"}};
    static const named_kernel of_bands[] = {{SKG_RASTER_FILL, "skg_bands_sort"},
                                            {SKG_RASTER_DRAW, "skg_raster_bands"}};
    if (raster->options.kernels.half) return compile_files(raster, 2, half, 1, of_half);
    if (skg_raster_passes(raster) > 1) return compile_files(raster, 3, passes, 1, of_passes);
    if (raster->options.strategy == SKG_STRATEGY_COPIES)
        return skg_kernels_are_first(raster->context, &raster->options.kernels)
                   ? compile_copies(raster)
                   : compile_files(raster, 3, copies, 1, of_copies);
    if (raster->options.strategy == SKG_STRATEGY_ATOMICS)
        return compile_files(raster, 2, atomics, 2, of_atomics);
    return skg_raster_has_squares(raster) ? compile_files(raster, 3, squares, 4, of_squares)
                                          : compile_files(raster, 4, bands, 2, of_bands);
}

static skg_status compile(skg_raster *raster) {
    static const char *const source[] = {"pixel.clh", "source_plane.cl"};
    const skg_kernel_options *options = &raster->options.kernels;
    cl_program program = NULL;
    SKG_TRY(compile_strategy(raster));
    if (!options->source_plane || options->parallel || options->half) return SKG_OK;
    SKG_TRY(skg_kernels_get(raster->context, options, 2, source, NULL, raster->expected ? NULL : &program));
    if (raster->expected) return SKG_OK;
    return skg_kernel_create(program, "skg_source_plane", &raster->kernels[SKG_RASTER_SOURCE]);
}

/* Expects the accumulators, of which a frame writes the rows of the extents. Of more copies than threads, the last finds
 * no triangles left. */
static skg_status expect_sums(const skg_raster *raster, const cl_int *extents) {
    const skg_frame_args *frame = &raster->frame;
    const int64_t threads = raster->context->device->info.compute_units, bytes = skg_raster_sum_bytes(raster);
    const int64_t images = (int64_t)frame->copies * skg_raster_passes(raster); /* one of the two is 1 */
    const int64_t count = (frame->copies > 1 && images > threads ? threads : images) * frame->planes;
    skg_byte_range *rows = NULL;
    SKG_TRY(skg_alloc(count, sizeof *rows, "accumulators", &rows));
    for (int64_t k = 0; k < count; k++) {
        const cl_int *extent = extents + 4 * (k % frame->planes);
        const int64_t end = extent[1] < frame->rows ? extent[1] : frame->rows; /* extents are rounded up */
        rows[k] = (skg_byte_range){(k * frame->plane + (int64_t)extent[0] * frame->stride) * bytes,
                                   (k * frame->plane + end * frame->stride) * bytes};
    }
    skg_buffer_expect(raster->context, bytes_of_sums(raster), count, rows);
    skg_free(&rows);
    return SKG_OK;
}

skg_status skg_raster_expect(skg_context *context, const skg_raster_options *options, const cl_int *extents) {
    skg_raster none = {.context = context, .options = *options, .expected = 1};
    SKG_TRY(lay_out(&none));
    SKG_TRY(expect_sums(&none, extents));
    return compile(&none);
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
    SKG_TRY_CLEANUP(make_extents(made));
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

cl_kernel skg_raster_projection(const skg_raster *raster) {
    return raster->kernels[SKG_RASTER_PROJECT];
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

int32_t skg_raster_passes(const skg_raster *raster) {
    return raster->options.passes > 1 ? raster->options.passes : 1;
}

int32_t skg_raster_side(const skg_raster *raster) {
    return raster->options.side > 1 ? raster->options.side : 1;
}

int64_t skg_raster_plane_count(const skg_raster *raster) {
    return raster->options.planes;
}
