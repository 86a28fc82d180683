/* Sums in half precision: distances in units of 2^-24 m, drawn triangle by triangle. */
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

static int takes(const skg_context *context, const skg_raster_options *options) {
    (void)context;
    return options->kernels.half;
}

static skg_status run(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_argument arguments[] = {
        SKG_TRIANGLE_ARGUMENTS(RASTER_HALF, raster->layout, g),
        SKG_ARGUMENT(RASTER_HALF, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(RASTER_HALF, sums, raster->sums.memory),
        SKG_ARGUMENT(RASTER_HALF, ray, raster->rays),
    };
    SKG_TRY(skg_raster_fill(raster, &raster->sums, 0, 0, skg_raster_plane_bytes(raster)));
    return SKG_RASTER_LAUNCH(raster, 0, "raster", skg_raster_by_triangle(raster), arguments, log);
}

const skg_raster_strategy skg_raster_half = {
    .takes = takes,
    .files = {"pixel.clh", "raster_half.cl"},
    .kernels = {"skg_raster_half"},
    .run = run,
};
