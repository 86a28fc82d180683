/* Strategy `tiles` with bands, for CPUs: triangles are sorted into bands of rows that fit the cache. */
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

enum { SORT, DRAW };

/* Planes fill only parts of a band, and a triangle is set up in each band that it meets: of the thorax with 17 accumulators,
 * bands of 8, 16, 24, 32 and 64 rows took 3.0, 2.4, 2.3, 2.2 and 2.2 ms at 1024^2, 11.1, 7.0, 6.7, 6.4 and 6.3 ms at 2048^2
 * (EPYC, 2 cores). */
enum {
    CACHE_BYTES = 256 * 1024, /* of a band: half of the level 2 cache of common CPUs */
    HIGH_BAND = 32,           /* rows that a band may have even so */
    BAND_ROWS_MAX = 256
};

int64_t skg_raster_band_rows(int64_t rows_of_detector, int64_t row_bytes, int64_t groups) {
    const int64_t fit = CACHE_BYTES / row_bytes, even = rows_of_detector / (4 * groups);
    int64_t rows = fit > HIGH_BAND ? fit : HIGH_BAND;
    rows = rows < even ? rows : even; /* some bands for each worker */
    rows = rows < BAND_ROWS_MAX ? rows : BAND_ROWS_MAX;
    const int64_t least = (rows_of_detector + SKG_BANDS_MAX - 1) / SKG_BANDS_MAX;
    rows = rows > 8 ? rows : 8;
    return rows > least ? rows : least;
}

static SKG_INT band_rows(const skg_raster *raster) {
    const skg_raster_layout *layout = &raster->layout;
    return (SKG_INT)skg_raster_band_rows(
        layout->rows, layout->stride * layout->planes * skg_raster_sum_bytes(raster), raster->workers);
}

static int takes(const skg_context *context, const skg_raster_options *options) {
    (void)context;
    return options->strategy == SKG_STRATEGY_TILES;
}

static skg_status lay_out(skg_raster *raster) {
    skg_raster_layout *layout = &raster->layout;
    layout->tile_rows = raster->options.tile ? raster->options.tile : band_rows(raster);
    if ((layout->rows + layout->tile_rows - 1) / layout->tile_rows > SKG_BANDS_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "bands of %d rows are more than %d; make them higher",
                        (int)layout->tile_rows, SKG_BANDS_MAX);
    return SKG_OK;
}

static skg_status allocate(skg_raster *raster) {
    const skg_raster_layout *layout = &raster->layout;
    const int64_t of_int = sizeof(cl_int), tiles = (int64_t)layout->tiles_across * layout->tiles_down;
    const int64_t chunks = (raster->options.triangles + SKG_CHUNK - 1) / SKG_CHUNK;
    SKG_TRY(skg_raster_reserve(raster, &raster->counts, 3 * of_int, "tiles"));
    SKG_TRY(skg_raster_reserve(raster, &raster->starts, 2 * chunks * tiles * of_int, "tiles"));
    SKG_TRY(skg_raster_reserve_lists(raster));
    return skg_raster_reserve(raster, &raster->scratch,
                              (int64_t)raster->workers * layout->planes * layout->stride *
                                  (layout->tile_rows + (int64_t)SKG_SPARE_ROWS) *
                                  skg_raster_sum_bytes(raster),
                              "bands");
}

static skg_status run(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_argument sort[] = {
        SKG_TRIANGLE_ARGUMENTS(BANDS_SORT, raster->layout, g),
        SKG_ARGUMENT(BANDS_SORT, counters, raster->counts.memory),
        SKG_ARGUMENT(BANDS_SORT, pieces, raster->starts.memory),
        SKG_ARGUMENT(BANDS_SORT, pool, raster->list.memory),
        SKG_ARGUMENT(BANDS_SORT, for_all, raster->for_all.memory),
    };
    const skg_argument arguments[] = {
        SKG_TRIANGLE_ARGUMENTS(RASTER_BANDS, raster->layout, g),
        SKG_ARGUMENT(RASTER_BANDS, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(RASTER_BANDS, counters, raster->counts.memory),
        SKG_ARGUMENT(RASTER_BANDS, pieces, raster->starts.memory),
        SKG_ARGUMENT(RASTER_BANDS, pool, raster->list.memory),
        SKG_ARGUMENT(RASTER_BANDS, for_all, raster->for_all.memory),
        SKG_ARGUMENT(RASTER_BANDS, sums, raster->sums.memory),
        SKG_ARGUMENT(RASTER_BANDS, scratch, raster->scratch.memory),
        SKG_ARGUMENT(RASTER_BANDS, used, raster->used.memory),
    };
    SKG_TRY(skg_raster_fill(raster, &raster->counts, 0, 0, 3 * (int64_t)sizeof(cl_int)));
    SKG_TRY(skg_raster_fill(raster, &raster->used, 0, sizeof(cl_int), sizeof(cl_int)));
    SKG_TRY(SKG_RASTER_LAUNCH(raster, SORT, "tiles", skg_raster_by_worker(raster), sort, log));
    return SKG_RASTER_LAUNCH(raster, DRAW, "raster", skg_raster_by_worker(raster), arguments, log);
}

/* As bands.cl leaves it. */
static const skg_buffer *find_listed(const skg_raster *raster, int64_t *first) {
    *first = 1;
    return &raster->counts;
}

const skg_raster_strategy skg_raster_bands = {
    .takes = takes,
    .files = {"bands.cl", "batch.clh", "deposit.clh", "draw.clh", "collect.clh", "raster_bands.cl"},
    .kernels = {"skg_bands_sort", "skg_raster_bands"},
    .lay_out = lay_out,
    .allocate = allocate,
    .run = run,
    .find_listed = find_listed,
};
