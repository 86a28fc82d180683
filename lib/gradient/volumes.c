/* The cells of volumes in the weights of hits that displace them. */
#include "gradient/volumes.h"

#include "stage/volumes.h"

#include <math.h>

static skg_status launch(const skg_gather_run *run, const skg_placed_volume *placed,
                         const skg_volume_args *filled, cl_program program) {
    const skg_volume_args args = *filled;
    const skg_hits_memory *h = run->hits;
    const skg_gradient_args *of = &run->args;
    const skg_work_size work = {2, {of->window[2] - of->window[0], of->window[3] - of->window[1]}, {16, 16}};
    const skg_argument arguments[] = {
        SKG_ARGUMENT(VOLUME_SLOPES, args, args),
        SKG_ARGUMENT(VOLUME_SLOPES, of, *of),
        SKG_ARGUMENT(VOLUME_SLOPES, cells, placed->cells.memory),
        SKG_ARGUMENT(VOLUME_SLOPES, weights, placed->weights.memory),
        SKG_ARGUMENT(VOLUME_SLOPES, counts, h->counts.memory),
        SKG_ARGUMENT(VOLUME_SLOPES, starts, h->starts.memory),
        SKG_ARGUMENT(VOLUME_SLOPES, hits, h->hits.memory),
        SKG_ARGUMENT(VOLUME_SLOPES, table, h->table.memory),
        SKG_ARGUMENT(VOLUME_SLOPES, displacing, placed->displacing.memory),
        SKG_ARGUMENT(VOLUME_SLOPES, losses, run->memory->weights.memory),
        SKG_ARGUMENT(VOLUME_SLOPES, slopes, run->memory->slopes.memory),
    };
    return SKG_LAUNCH_ONCE(run->context, program, "skg_volume_slopes", "gradient", &work, arguments,
                           &run->staging->log);
}

static skg_status add(const skg_gather_run *run, skg_placed_volume *placed) {
    static const char *const files[] = {"intervals.clh", "cell_rays.clh", "volume_slopes.cl"};
    skg_volume_args args;
    cl_program program = NULL;
    if (!run->pass->extents[placed->part].on_detector || placed->plane_count == 0) return SKG_OK;
    SKG_TRY(skg_volume_args_fill(placed, run->pass, run->hits, run->staging, &args));
    if (args.slot < 0) return SKG_OK;
    args.unit = (float)ldexp(run->pass->scale.scale, -placed->exponent);
    SKG_TRY(skg_volume_program(placed, run->pass, run->context, 3, files, &program));
    for (int64_t first = 0; first < placed->plane_count; first += placed->lanes) {
        skg_volume_args_planes(placed, first, &args);
        SKG_TRY(launch(run, placed, &args, program));
    }
    return SKG_OK;
}

skg_status skg_gather_volumes(const skg_gather_run *run) {
    const skg_volumes *volumes = run->pass->volumes;
    for (int64_t v = 0; v < volumes->count; v++) SKG_TRY(add(run, &volumes->volumes[v]));
    return SKG_OK;
}

double skg_gather_volumes_bound(const skg_gather_run *run, const double *most) {
    const skg_volumes *volumes = run->pass->volumes;
    double bound = 0;
    for (int64_t v = 0; v < volumes->count; v++) {
        const skg_placed_volume *placed = &volumes->volumes[v];
        for (int64_t p = 0; p < placed->plane_count; p++) bound += placed->most * most[placed->planes[p]];
    }
    return bound * run->pass->scale.scale;
}

void skg_volumes_mark(const skg_volumes *volumes, const uint8_t *parts, int32_t *planes) {
    for (int64_t v = 0; v < volumes->count; v++) {
        const skg_placed_volume *placed = &volumes->volumes[v];
        for (int64_t p = 0; (!parts || parts[placed->part]) && p < placed->plane_count; p++)
            planes[placed->planes[p]] = 1;
    }
}
