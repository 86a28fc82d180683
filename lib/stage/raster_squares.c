/* Strategy `tiles` with squares, for GPUs: triangles are listed by tile, which a work-group sums in local memory. */
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

enum { COUNT, SCAN, FILL, DRAW };
enum { SQUARE = 32 /* side of a tile */ };

static int takes(const skg_context *context, const skg_raster_options *options) {
    if (options->strategy != SKG_STRATEGY_TILES) return 0;
    return options->shape == SKG_TILE_SQUARES ||
           (options->shape == SKG_TILE_AUTO && context->device->info.gpu);
}

static skg_status square_side(const skg_raster *raster, SKG_INT *side) {
    const int64_t capacity = raster->context->device->info.local_memory,
                  pixel = raster->layout.planes * skg_raster_sum_bytes(raster);
    if (!raster->options.tile)
        while (*side > 8 && *side * *side * pixel > capacity / 2) *side /= 2;
    if (*side * *side * pixel > capacity)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "tiles of %d x %d pixels with %d planes do not fit the local memory of %s; choose smaller "
            "tiles or strategy atomics",
            (int)*side, (int)*side, (int)raster->layout.planes, raster->context->device->info.name);
    return SKG_OK;
}

static skg_status lay_out(skg_raster *raster) {
    SKG_INT side = raster->options.tile ? raster->options.tile : SQUARE;
    SKG_TRY(square_side(raster, &side));
    raster->layout.tile_columns = side;
    raster->layout.tile_rows = side;
    return SKG_OK;
}

static int64_t count_tiles(const skg_raster *raster) {
    return (int64_t)raster->layout.tiles_across * raster->layout.tiles_down;
}

static skg_status allocate(skg_raster *raster) {
    const int64_t of_int = sizeof(cl_int), tiles = count_tiles(raster);
    SKG_TRY(skg_raster_reserve(raster, &raster->counts, (tiles + 1) * of_int, "tiles"));
    SKG_TRY(skg_raster_reserve(raster, &raster->starts, (tiles + 2) * of_int, "tiles"));
    return skg_raster_reserve_lists(raster);
}

/* Lists the triangles of each square: counts them, gives each list its place, and fills it. */
static skg_status run_binning(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_raster_layout *layout = &raster->layout;
    const skg_argument count[] = {
        SKG_TRIANGLE_ARGUMENTS(TILES_COUNT, *layout, g),
        SKG_ARGUMENT(TILES_COUNT, counts, raster->counts.memory),
    };
    const skg_argument scan[] = {
        SKG_ARGUMENT(TILES_SCAN, layout, *layout),
        SKG_ARGUMENT(TILES_SCAN, counts, raster->counts.memory),
        SKG_ARGUMENT(TILES_SCAN, starts, raster->starts.memory),
    };
    const skg_argument fill[] = {
        SKG_TRIANGLE_ARGUMENTS(TILES_FILL, *layout, g),
        SKG_ARGUMENT(TILES_FILL, counts, raster->counts.memory),
        SKG_ARGUMENT(TILES_FILL, starts, raster->starts.memory),
        SKG_ARGUMENT(TILES_FILL, list, raster->list.memory),
        SKG_ARGUMENT(TILES_FILL, for_all, raster->for_all.memory),
    };
    SKG_TRY(
        skg_raster_fill(raster, &raster->counts, 0, 0,
                        ((int64_t)layout->tiles_across * layout->tiles_down + 1) * (int64_t)sizeof(cl_int)));
    SKG_TRY(SKG_RASTER_LAUNCH(raster, COUNT, "tiles: count", skg_raster_by_triangle(raster), count, log));
    SKG_TRY(SKG_RASTER_LAUNCH(raster, SCAN, "tiles: scan", skg_raster_in_groups(1), scan, log));
    return SKG_RASTER_LAUNCH(raster, FILL, "tiles: fill", skg_raster_by_triangle(raster), fill, log);
}

static skg_status run(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_raster_layout *layout = &raster->layout;
    const skg_argument arguments[] = {
        SKG_TRIANGLE_ARGUMENTS(RASTER_SQUARES, *layout, g),
        SKG_ARGUMENT(RASTER_SQUARES, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(RASTER_SQUARES, starts, raster->starts.memory),
        SKG_ARGUMENT(RASTER_SQUARES, list, raster->list.memory),
        SKG_ARGUMENT(RASTER_SQUARES, for_all, raster->for_all.memory),
        SKG_ARGUMENT(RASTER_SQUARES, sums, raster->sums.memory),
        {SKG_RASTER_SQUARES_local_sums,
         (size_t)(layout->tile_columns * layout->tile_rows * layout->planes * skg_raster_sum_bytes(raster)),
         NULL},
    };
    SKG_TRY(run_binning(raster, g, log));
    return SKG_RASTER_LAUNCH(raster, DRAW, "raster",
                             skg_raster_in_groups((int64_t)layout->tiles_across * layout->tiles_down),
                             arguments, log);
}

/* As tiles.cl leaves it. */
static const skg_buffer *find_listed(const skg_raster *raster, int64_t *first) {
    *first = count_tiles(raster);
    return &raster->starts;
}

const skg_raster_strategy skg_raster_squares = {
    .takes = takes,
    .files = {"pixel.clh", "tiles.cl", "raster_squares.cl"},
    .kernels = {"skg_tiles_count", "skg_tiles_scan", "skg_tiles_fill", "skg_raster_squares"},
    .lay_out = lay_out,
    .allocate = allocate,
    .run = run,
    .find_listed = find_listed,
};
