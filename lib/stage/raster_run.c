/* One frame of a raster: which kernels run, with which arguments. */
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

#include <string.h>

enum {
    QUEUE_GROUPS_PER_UNIT = 8,
    GROUP = 64 /* local size where a work-item takes a triangle */
};

skg_status skg_raster_place_pass(skg_raster *raster, int32_t pass, const cl_int *extents,
                                 skg_stage_log *log) {
    const skg_frame_args *frame = &raster->frame;
    const size_t bytes = 4 * (size_t)frame->planes * sizeof *extents;
    cl_int *sent = raster->sent + 4 * (size_t)pass * (size_t)frame->planes;
    if (!extents) extents = raster->whole;
    if (memcmp(extents, sent, bytes) == 0) return SKG_OK;
    SKG_TRY(
        skg_stage_write(raster->context, "upload", raster->used.memory,
                        SKG_EXTENT(frame->copies, (int64_t)pass * frame->planes) * (int64_t)sizeof *extents,
                        (int64_t)bytes, extents, log));
    memcpy(sent, extents, bytes);
    return SKG_OK;
}

int64_t skg_raster_claim(int64_t triangles, int64_t workers) {
    const int64_t claim = triangles / (16 * workers);
    return claim < 32 ? 32 : claim > 1024 ? 1024 : claim;
}

/* A work-group of one work-item for each worker, and a work-item for each triangle. */
static skg_work_size by_worker(const skg_raster *raster) {
    return (skg_work_size){1, {raster->workers}, {1}};
}
static skg_work_size by_triangle(const skg_raster *raster) {
    return (skg_work_size){1, {raster->frame.triangles}, {GROUP}};
}
static skg_work_size in_groups(int64_t groups) {
    return (skg_work_size){1, {groups * GROUP}, {GROUP}};
}

#define LAUNCH(raster, which, stage, work, arguments, log)                                                   \
    SKG_LAUNCH((raster)->context, (raster)->kernels[which], stage, (const skg_work_size[]){work}, arguments, \
               log)

static int64_t plane_bytes(const skg_raster *raster) {
    return (int64_t)raster->frame.planes * raster->frame.plane * skg_raster_sum_bytes(raster);
}

/* What the launches need to know of the scene. */
static skg_status set_counts(skg_raster *raster, const skg_geometry *geometry) {
    skg_frame_args *frame = &raster->frame;
    frame->parts = (SKG_INT)geometry->parts;
    frame->vertices = (SKG_INT)geometry->vertices;
    frame->triangles = (SKG_INT)geometry->triangles;
    frame->claim = (SKG_INT)skg_raster_claim(geometry->triangles, raster->workers - 1);
    if (geometry->triangles > raster->options.triangles)
        return skg_fail(SKG_ERR_INTERNAL, "a frame of more triangles than the stage was made for");
    return SKG_OK;
}

static skg_status run_copies(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_frame_args *frame = &raster->frame;
    const int64_t of_int = sizeof(cl_int);
    const skg_argument arguments[] = {
        SKG_TRIANGLE_ARGUMENTS(RASTER_COPIES, *frame, g),
        SKG_ARGUMENT(RASTER_COPIES, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(RASTER_COPIES, copies, raster->sums.memory),
        SKG_ARGUMENT(RASTER_COPIES, used, raster->used.memory),
    };
    SKG_TRY(skg_raster_fill(raster, &raster->used, 0, 0, (frame->copies + 1) * of_int));
    if (raster->kernels[SKG_RASTER_SOURCE] || raster->options.more_sums) /* the first copy is added to */
        SKG_TRY(skg_raster_fill(raster, &raster->used, SKG_TO_ZERO, 0, of_int));
    return LAUNCH(raster, SKG_RASTER_DRAW, "raster", by_worker(raster), arguments, log);
}

skg_status skg_raster_run_passes(skg_raster *raster, const skg_geometry *g, int32_t passes,
                                 skg_stage_log *log) {
    const int64_t vertex =
        4 * (int64_t)(g->precision == SKG_PRECISION_DOUBLE ? sizeof(double) : sizeof(float));
    skg_frame_args *frame = &raster->frame;
    SKG_TRY(set_counts(raster, g));
    frame->passes = passes;
    SKG_TRY(
        skg_buffer_reserve(raster->context, &raster->scratch,
                           raster->workers * skg_raster_side(raster) * (g->vertices + SKG_CPU_RUN) * vertex,
                           CL_MEM_READ_WRITE, "projected vertices"));
    const skg_argument arguments[] = {
        SKG_ARGUMENT(RASTER_PASSES, frame, *frame),
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
    };
    SKG_TRY(skg_raster_fill(raster, &raster->used, 0, sizeof(cl_int), sizeof(cl_int)));
    return LAUNCH(raster, SKG_RASTER_DRAW, "raster", by_worker(raster), arguments, log);
}

static skg_status run_atomics(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_argument arguments[] = {
        SKG_TRIANGLE_ARGUMENTS(RASTER_ATOMICS, raster->frame, g),
        SKG_ARGUMENT(RASTER_ATOMICS, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(RASTER_ATOMICS, sums, raster->sums.memory),
        SKG_ARGUMENT(RASTER_ATOMICS, queue, raster->queue.memory),
    };
    const skg_argument large[] = {
        SKG_TRIANGLE_ARGUMENTS(RASTER_QUEUE, raster->frame, g),
        SKG_ARGUMENT(RASTER_QUEUE, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(RASTER_QUEUE, sums, raster->sums.memory),
        SKG_ARGUMENT(RASTER_QUEUE, queue, raster->queue.memory),
    };
    const int64_t groups = (int64_t)(QUEUE_GROUPS_PER_UNIT * raster->context->device->info.compute_units);
    SKG_TRY(skg_raster_fill(raster, &raster->sums, 0, 0, plane_bytes(raster)));
    SKG_TRY(skg_raster_fill(raster, &raster->queue, 0, 0, 2 * (int64_t)sizeof(cl_int)));
    SKG_TRY(LAUNCH(raster, SKG_RASTER_DRAW, "raster", by_triangle(raster), arguments, log));
    return LAUNCH(raster, SKG_RASTER_LARGE, "large triangles", in_groups(groups), large, log);
}

/* Lists the triangles of each square: counts them, gives each list its place, and fills it. */
static skg_status run_binning(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_frame_args *frame = &raster->frame;
    const skg_argument count[] = {
        SKG_TRIANGLE_ARGUMENTS(TILES_COUNT, *frame, g),
        SKG_ARGUMENT(TILES_COUNT, counts, raster->counts.memory),
    };
    const skg_argument scan[] = {
        SKG_ARGUMENT(TILES_SCAN, frame, *frame),
        SKG_ARGUMENT(TILES_SCAN, counts, raster->counts.memory),
        SKG_ARGUMENT(TILES_SCAN, starts, raster->starts.memory),
    };
    const skg_argument fill[] = {
        SKG_TRIANGLE_ARGUMENTS(TILES_FILL, *frame, g),
        SKG_ARGUMENT(TILES_FILL, counts, raster->counts.memory),
        SKG_ARGUMENT(TILES_FILL, starts, raster->starts.memory),
        SKG_ARGUMENT(TILES_FILL, list, raster->list.memory),
        SKG_ARGUMENT(TILES_FILL, for_all, raster->for_all.memory),
    };
    SKG_TRY(
        skg_raster_fill(raster, &raster->counts, 0, 0,
                        ((int64_t)frame->tiles_across * frame->tiles_down + 1) * (int64_t)sizeof(cl_int)));
    SKG_TRY(LAUNCH(raster, SKG_RASTER_COUNT, "tiles: count", by_triangle(raster), count, log));
    SKG_TRY(LAUNCH(raster, SKG_RASTER_SCAN, "tiles: scan", in_groups(1), scan, log));
    return LAUNCH(raster, SKG_RASTER_FILL, "tiles: fill", by_triangle(raster), fill, log);
}

static skg_status run_squares(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_frame_args *frame = &raster->frame;
    const skg_argument arguments[] = {
        SKG_TRIANGLE_ARGUMENTS(RASTER_SQUARES, *frame, g),
        SKG_ARGUMENT(RASTER_SQUARES, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(RASTER_SQUARES, starts, raster->starts.memory),
        SKG_ARGUMENT(RASTER_SQUARES, list, raster->list.memory),
        SKG_ARGUMENT(RASTER_SQUARES, for_all, raster->for_all.memory),
        SKG_ARGUMENT(RASTER_SQUARES, sums, raster->sums.memory),
        {SKG_RASTER_SQUARES_local_sums,
         (size_t)(frame->tile_columns * frame->tile_rows * frame->planes * skg_raster_sum_bytes(raster)),
         NULL},
    };
    SKG_TRY(run_binning(raster, g, log));
    return LAUNCH(raster, SKG_RASTER_DRAW, "raster",
                  in_groups((int64_t)frame->tiles_across * frame->tiles_down), arguments, log);
}

static skg_status run_bands(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_argument sort[] = {
        SKG_TRIANGLE_ARGUMENTS(BANDS_SORT, raster->frame, g),
        SKG_ARGUMENT(BANDS_SORT, counters, raster->counts.memory),
        SKG_ARGUMENT(BANDS_SORT, pieces, raster->starts.memory),
        SKG_ARGUMENT(BANDS_SORT, pool, raster->list.memory),
        SKG_ARGUMENT(BANDS_SORT, for_all, raster->for_all.memory),
    };
    const skg_argument arguments[] = {
        SKG_TRIANGLE_ARGUMENTS(RASTER_BANDS, raster->frame, g),
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
    SKG_TRY(LAUNCH(raster, SKG_RASTER_FILL, "tiles", by_worker(raster), sort, log));
    return LAUNCH(raster, SKG_RASTER_DRAW, "raster", by_worker(raster), arguments, log);
}

void skg_raster_set_rays(skg_raster *raster, const skg_camera *camera) {
    skg_ray_double rays;
    skg_camera_rays(camera, 1, &rays);
    skg_rays_round(&rays, &raster->rays);
}

static skg_status run_half(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_argument arguments[] = {
        SKG_TRIANGLE_ARGUMENTS(RASTER_HALF, raster->frame, g),
        SKG_ARGUMENT(RASTER_HALF, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(RASTER_HALF, sums, raster->sums.memory),
        SKG_ARGUMENT(RASTER_HALF, ray, raster->rays),
    };
    SKG_TRY(skg_raster_fill(raster, &raster->sums, 0, 0, plane_bytes(raster)));
    return LAUNCH(raster, SKG_RASTER_DRAW, "raster", by_triangle(raster), arguments, log);
}

size_t skg_raster_source_bands(const skg_raster *raster) {
    const skg_device_info *device = &raster->context->device->info;
    const size_t most = ((size_t)raster->frame.rows + SKG_SOURCE_ROWS - 1) / SKG_SOURCE_ROWS;
    const size_t enough = 2 * (size_t)device->compute_units;
    return device->is_gpu || most < enough ? most : enough;
}

static skg_status run_source(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    cl_kernel kernel = raster->kernels[SKG_RASTER_SOURCE];
    const skg_argument arguments[] = {
        SKG_TRIANGLE_ARGUMENTS(SOURCE_PLANE, raster->frame, g),
        SKG_ARGUMENT(SOURCE_PLANE, vertices, g->offsets.memory),
        SKG_ARGUMENT(SOURCE_PLANE, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(SOURCE_PLANE, sums, raster->sums.memory),
    };
    const skg_work_size work = {
        2, {raster->frame.triangles, (int64_t)skg_raster_source_bands(raster)}, {GROUP, 1}};
    return SKG_LAUNCH(raster->context, kernel, "source plane", &work, arguments, log);
}

skg_status skg_raster_run(skg_raster *raster, const skg_geometry *geometry, const cl_int *extents,
                          skg_stage_log *log) {
    SKG_TRY(set_counts(raster, geometry));
    SKG_TRY(skg_raster_place_pass(raster, 0, extents, log));
    if (raster->options.kernels.half) return run_half(raster, geometry, log);
    if (raster->options.strategy == SKG_STRATEGY_COPIES)
        SKG_TRY(run_copies(raster, geometry, log));
    else if (raster->options.strategy == SKG_STRATEGY_ATOMICS)
        SKG_TRY(run_atomics(raster, geometry, log));
    else if (skg_raster_has_squares(raster))
        SKG_TRY(run_squares(raster, geometry, log));
    else
        SKG_TRY(run_bands(raster, geometry, log));
    return raster->kernels[SKG_RASTER_SOURCE] ? run_source(raster, geometry, log) : SKG_OK;
}
