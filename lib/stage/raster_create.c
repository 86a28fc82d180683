/* Creates rasters: layout, memory, programs, by their strategy. */
#include "core/maths.h"
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

#include <string.h>

/* The strategies. The first that takes the options draws. */
static const skg_raster_strategy *const strategies[] = {&skg_raster_half,    &skg_raster_passes_together,
                                                        &skg_raster_copies,  &skg_raster_atomics,
                                                        &skg_raster_squares, &skg_raster_bands};

static skg_status choose_strategy(skg_raster *raster) {
    for (size_t k = 0; k < sizeof strategies / sizeof *strategies; k++)
        if (strategies[k]->takes(raster->context, &raster->options)) {
            raster->strategy = strategies[k];
            return SKG_OK;
        }
    return skg_fail(SKG_ERR_INTERNAL, "no strategy %d", (int)raster->options.strategy);
}

static skg_status lay_out(skg_raster *raster) {
    const skg_raster_options *o = &raster->options;
    skg_raster_layout *layout = &raster->layout;
    /* PoCL gives two work-groups unevenly to two threads, but not one work-group more than there are threads. */
    raster->workers = raster->context->device->info.compute_units + 1;
    layout->columns = (SKG_INT)o->columns;
    layout->rows = (SKG_INT)o->rows;
    layout->stride = (SKG_INT)skg_round_up(o->columns + SKG_SPARE_COLUMNS, 16);
    const int64_t plane = layout->stride * (o->rows + SKG_SPARE_ROWS);
    if (skg_raster_side(raster) * plane * o->planes > INT32_MAX)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%d planes of this detector are more than 2^31 accumulators",
                        (int)o->planes);
    layout->plane = (SKG_INT)plane;
    layout->planes = (SKG_INT)o->planes;
    layout->copies = 1;
    layout->tile_columns = layout->columns;
    layout->tile_rows = layout->rows;
    SKG_TRY(choose_strategy(raster));
    if (raster->strategy->lay_out) SKG_TRY(raster->strategy->lay_out(raster));
    layout->tiles_across = (layout->columns + layout->tile_columns - 1) / layout->tile_columns;
    layout->tiles_down = (layout->rows + layout->tile_rows - 1) / layout->tile_rows;
    return SKG_OK;
}

static int64_t bytes_of_sums(const skg_raster *raster) {
    const skg_raster_layout *layout = &raster->layout;
    return (int64_t)layout->copies * skg_raster_passes(raster) * layout->planes * layout->plane *
           skg_raster_sum_bytes(raster);
}

static skg_status allocate(skg_raster *raster) {
    const skg_raster_layout *layout = &raster->layout;
    const int64_t planes = (int64_t)skg_raster_passes(raster) * layout->planes;
    SKG_TRY(skg_raster_reserve(raster, &raster->sums, bytes_of_sums(raster), "accumulators"));
    SKG_TRY(skg_raster_reserve(raster, &raster->used,
                               SKG_EXTENT(layout->copies, planes) * (int64_t)sizeof(cl_int),
                               "accumulators in use"));
    return raster->strategy->allocate ? raster->strategy->allocate(raster) : SKG_OK;
}

/* On the host the whole detector for each plane; on the device any extent, until a frame sends its own. */
static skg_status make_extents(skg_raster *raster) {
    const skg_raster_layout *layout = &raster->layout;
    SKG_TRY(skg_alloc(8 * (int64_t)layout->planes, sizeof *raster->whole, "extents", &raster->whole));
    raster->sent = raster->whole + 4 * layout->planes;
    for (int32_t p = 0; p < layout->planes; p++)
        raster->whole[4 * p + 1] = layout->rows, raster->whole[4 * p + 3] = layout->stride;
    return skg_raster_fill(raster, &raster->used, -1, 0, raster->used.bytes);
}

static skg_status compile_strategy(skg_raster *raster) {
    const skg_raster_strategy *strategy = raster->strategy;
    cl_program program = NULL, *wanted = raster->only_prefetch ? NULL : &program;
    SKG_TRY((strategy->get_program ? strategy->get_program : skg_raster_get_program)(raster, wanted));
    if (raster->only_prefetch) return SKG_OK;
    SKG_TRY(skg_kernel_create(program, "skg_project", &raster->project));
    for (int k = 0; k < SKG_STRATEGY_KERNELS && strategy->kernels[k]; k++)
        SKG_TRY(skg_kernel_create(program, strategy->kernels[k], &raster->kernels[k]));
    return SKG_OK;
}

static skg_status compile(skg_raster *raster) {
    static const char *const source[] = {"pixel.clh", "source_plane.cl"};
    const skg_kernel_options *options = &raster->options.kernels;
    cl_program program = NULL;
    SKG_TRY(compile_strategy(raster));
    if (!options->source_plane || options->parallel || options->half) return SKG_OK;
    SKG_TRY(
        skg_kernels_get(raster->context, options, 2, source, NULL, raster->only_prefetch ? NULL : &program));
    if (raster->only_prefetch) return SKG_OK;
    return skg_kernel_create(program, "skg_source_plane", &raster->source);
}

/* Expects the accumulators, of which a frame writes the rows of the extents. Of more copies than threads, the last finds
 * no triangles left. */
static skg_status expect_sums(const skg_raster *raster, const cl_int *extents) {
    const skg_raster_layout *layout = &raster->layout;
    const int64_t threads = raster->context->device->info.compute_units, bytes = skg_raster_sum_bytes(raster);
    const int64_t images = (int64_t)layout->copies * skg_raster_passes(raster); /* one of the two is 1 */
    const int64_t count = (layout->copies > 1 && images > threads ? threads : images) * layout->planes;
    skg_byte_range *rows = NULL;
    SKG_TRY(skg_alloc(count, sizeof *rows, "accumulators", &rows));
    for (int64_t k = 0; k < count; k++) {
        const cl_int *extent = extents + 4 * (k % layout->planes);
        const int64_t end = extent[1] < layout->rows ? extent[1] : layout->rows; /* extents are rounded up */
        rows[k] = (skg_byte_range){(k * layout->plane + (int64_t)extent[0] * layout->stride) * bytes,
                                   (k * layout->plane + end * layout->stride) * bytes};
    }
    skg_buffer_prefetch(raster->context, bytes_of_sums(raster), count, rows);
    skg_free(&rows);
    return SKG_OK;
}

skg_status skg_raster_prefetch(skg_context *context, const skg_raster_options *options,
                               const cl_int *extents) {
    skg_raster none = {.context = context, .options = *options, .only_prefetch = 1};
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
    for (int i = 0; i < SKG_STRATEGY_KERNELS; i++) release_kernel(r->kernels[i]);
    release_kernel(r->project);
    release_kernel(r->source);
    skg_free(&r->whole);
    release_kernel(r->bad_rows);
    release_kernel(r->bad);
    skg_free(raster);
}

cl_kernel skg_raster_projection(const skg_raster *raster) {
    return raster->project;
}

void skg_raster_tiles(const skg_raster *raster, int64_t *columns, int64_t *rows, int64_t *tiles) {
    *columns = raster->layout.tile_columns;
    *rows = raster->layout.tile_rows;
    *tiles = (int64_t)raster->layout.tiles_across * raster->layout.tiles_down;
}

int64_t skg_raster_bytes(const skg_raster *raster) {
    return raster->sums.bytes + raster->used.bytes + raster->scratch.bytes + raster->counts.bytes +
           raster->starts.bytes + raster->list.bytes + raster->for_all.bytes + raster->queue.bytes +
           raster->rows_bad.bytes;
}

int64_t skg_raster_plane_count(const skg_raster *raster) {
    return raster->options.planes;
}
