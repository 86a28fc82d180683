/* Strategy `copies`: each worker adds triangles up in accumulators of its own. */
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

static int takes(const skg_context *context, const skg_raster_options *options) {
    (void)context;
    return options->strategy == SKG_STRATEGY_COPIES;
}

static skg_status lay_out(skg_raster *raster) {
    const skg_raster_options *o = &raster->options;
    raster->layout.copies = raster->workers;
    raster->layout.whole_first = o->more_sums || (o->kernels.source_plane && !o->kernels.parallel);
    return SKG_OK;
}

/* On a CPU this is in the program that a first image needs. */
static skg_status get_program(const skg_raster *raster, cl_program *program) {
    return skg_kernels_are_first(raster->context, &raster->options.kernels)
               ? skg_kernels_get_first(raster->context, program)
               : skg_raster_get_program(raster, program);
}

static skg_status run(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_raster_layout *layout = &raster->layout;
    const int64_t of_int = sizeof(cl_int);
    const skg_argument arguments[] = {
        SKG_TRIANGLE_ARGUMENTS(RASTER_COPIES, *layout, g),
        SKG_ARGUMENT(RASTER_COPIES, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(RASTER_COPIES, copies, raster->sums.memory),
        SKG_ARGUMENT(RASTER_COPIES, used, raster->used.memory),
    };
    SKG_TRY(skg_raster_fill(raster, &raster->used, 0, 0, 2 * layout->copies * of_int));
    return SKG_RASTER_LAUNCH(raster, 0, "raster", skg_raster_by_worker(raster), arguments, log);
}

const skg_raster_strategy skg_raster_copies = {
    .takes = takes,
    .files = {"batch.clh", "deposit.clh", "draw.clh", "collect.clh", "raster_copies.cl"},
    .kernels = {"skg_raster_copies"},
    .lay_out = lay_out,
    .get_program = get_program,
    .run = run,
};
