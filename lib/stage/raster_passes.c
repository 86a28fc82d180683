/* Several passes of a frame, or frames, together: each worker claims whole passes, projection included. */
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

static int takes(const skg_context *context, const skg_raster_options *options) {
    (void)context;
    return options->passes > 1;
}

static skg_status run(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const int64_t vertex =
        4 * (int64_t)(g->precision == SKG_PRECISION_DOUBLE ? sizeof(double) : sizeof(float));
    SKG_TRY(
        skg_buffer_reserve(raster->context, &raster->scratch,
                           raster->workers * skg_raster_side(raster) * (g->vertices + SKG_CPU_RUN) * vertex,
                           CL_MEM_READ_WRITE, "projected vertices"));
    const skg_argument arguments[] = {
        SKG_ARGUMENT(RASTER_PASSES, layout, raster->layout),
        SKG_ARGUMENT(RASTER_PASSES, corners, g->corners.memory),
        SKG_ARGUMENT(RASTER_PASSES, vertices, g->offsets.memory),
        SKG_ARGUMENT(RASTER_PASSES, tables, g->part_table.memory),
        SKG_ARGUMENT(RASTER_PASSES, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(RASTER_PASSES, blocks, g->triangle_blocks.memory),
        SKG_ARGUMENT(RASTER_PASSES, vertex_blocks, g->vertex_blocks.memory),
        SKG_ARGUMENT(RASTER_PASSES, projected, raster->scratch.memory),
        SKG_ARGUMENT(RASTER_PASSES, sums, raster->sums.memory),
        SKG_ARGUMENT(RASTER_PASSES, used, raster->used.memory),
        SKG_ARGUMENT(RASTER_PASSES, bad_vertex, g->bad.memory),
        SKG_ARGUMENT(RASTER_PASSES, frame, g->frame),
        SKG_ARGUMENT(RASTER_PASSES, each, g->each),
    };
    return SKG_RASTER_LAUNCH(raster, 0, "raster", skg_raster_by_worker(raster), arguments, log);
}

const skg_raster_strategy skg_raster_passes_together = {
    .takes = takes,
    .files = {"batch.clh", "deposit.clh", "draw.clh", "collect.clh", "raster_passes.cl"},
    .kernels = {"skg_raster_passes"},
    .run = run,
};
