/* Strategy `atomics`: all work-items add to the same accumulators. Large triangles are queued and drawn in strips. */
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

enum { DRAW, LARGE };
enum {
    QUEUE_ENTRIES = 1 << 20, /* strips of large triangles; more are drawn without the queue */
    QUEUE_GROUPS_PER_UNIT = 8
};

static int takes(const skg_context *context, const skg_raster_options *options) {
    (void)context;
    return options->strategy == SKG_STRATEGY_ATOMICS;
}

static skg_status lay_out(skg_raster *raster) {
    raster->layout.queue = QUEUE_ENTRIES;
    return SKG_OK;
}

static skg_status allocate(skg_raster *raster) {
    return skg_raster_reserve(raster, &raster->queue,
                              (2 * (int64_t)raster->layout.queue + 2) * (int64_t)sizeof(cl_int),
                              "queue of large triangles");
}

static skg_status run(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_argument arguments[] = {
        SKG_TRIANGLE_ARGUMENTS(RASTER_ATOMICS, raster->layout, g),
        SKG_ARGUMENT(RASTER_ATOMICS, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(RASTER_ATOMICS, sums, raster->sums.memory),
        SKG_ARGUMENT(RASTER_ATOMICS, queue, raster->queue.memory),
    };
    const skg_argument large[] = {
        SKG_TRIANGLE_ARGUMENTS(RASTER_QUEUE, raster->layout, g),
        SKG_ARGUMENT(RASTER_QUEUE, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(RASTER_QUEUE, sums, raster->sums.memory),
        SKG_ARGUMENT(RASTER_QUEUE, queue, raster->queue.memory),
    };
    const int64_t groups = (int64_t)(QUEUE_GROUPS_PER_UNIT * raster->context->device->info.compute_units);
    SKG_TRY(skg_raster_fill(raster, &raster->sums, 0, 0, skg_raster_plane_bytes(raster)));
    SKG_TRY(skg_raster_fill(raster, &raster->queue, 0, 0, 2 * (int64_t)sizeof(cl_int)));
    SKG_TRY(SKG_RASTER_LAUNCH(raster, DRAW, "raster", skg_raster_by_triangle(raster), arguments, log));
    return SKG_RASTER_LAUNCH(raster, LARGE, "large triangles", skg_raster_in_groups(groups), large, log);
}

const skg_raster_strategy skg_raster_atomics = {
    .takes = takes,
    .files = {"pixel.clh", "raster_atomics.cl"},
    .kernels = {"skg_raster_atomics", "skg_raster_queue"},
    .lay_out = lay_out,
    .allocate = allocate,
    .run = run,
};
