/* One frame of a raster. */
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

#include <string.h>

/* Enqueues the upload of a frame's extents, unless the device has them. */
static skg_status place(skg_raster *raster, const cl_int *extents, skg_stage_log *log) {
    const skg_raster_layout *layout = &raster->layout;
    const size_t bytes = 4 * (size_t)layout->planes * sizeof *extents;
    if (!extents) extents = raster->whole;
    if (memcmp(extents, raster->sent, bytes) == 0) return SKG_OK;
    SKG_TRY(skg_stage_write(raster->context, "upload", raster->used.memory,
                            SKG_EXTENT(layout->copies, 0) * (int64_t)sizeof *extents, (int64_t)bytes, extents,
                            log));
    memcpy(raster->sent, extents, bytes);
    return SKG_OK;
}

int64_t skg_raster_claim(int64_t triangles, int64_t workers) {
    const int64_t claim = triangles / (16 * workers);
    return claim < 32 ? 32 : claim > 1024 ? 1024 : claim;
}

skg_status skg_raster_set_scene(skg_raster *raster, const skg_geometry *geometry) {
    skg_raster_layout *layout = &raster->layout;
    layout->parts = (SKG_INT)geometry->parts;
    layout->vertices = (SKG_INT)geometry->vertices;
    layout->triangles = (SKG_INT)geometry->triangles;
    layout->claim = (SKG_INT)skg_raster_claim(geometry->triangles, raster->workers - 1);
    if (geometry->triangles > raster->options.triangles)
        return skg_fail(SKG_ERR_INTERNAL, "a frame of more triangles than the stage was made for");
    return SKG_OK;
}

void skg_raster_set_rays(skg_raster *raster, const skg_camera *camera) {
    skg_ray_double rays;
    skg_camera_rays(camera, 1, &rays);
    skg_rays_round(&rays, &raster->rays);
}

size_t skg_raster_source_bands(const skg_raster *raster) {
    const skg_device_info *device = &raster->context->device->info;
    const size_t most = ((size_t)raster->layout.rows + SKG_SOURCE_ROWS - 1) / SKG_SOURCE_ROWS;
    const size_t enough = 2 * (size_t)device->compute_units;
    return device->gpu || most < enough ? most : enough;
}

static skg_status run_source(skg_raster *raster, const skg_geometry *g, skg_stage_log *log) {
    const skg_argument arguments[] = {
        SKG_TRIANGLE_ARGUMENTS(SOURCE_PLANE, raster->layout, g),
        SKG_ARGUMENT(SOURCE_PLANE, vertices, g->offsets.memory),
        SKG_ARGUMENT(SOURCE_PLANE, contributions, g->contribution_table.memory),
        SKG_ARGUMENT(SOURCE_PLANE, sums, raster->sums.memory),
    };
    const skg_work_size work = {
        2, {raster->layout.triangles, (int64_t)skg_raster_source_bands(raster)}, {SKG_RASTER_GROUP, 1}};
    return SKG_LAUNCH(raster->context, raster->source, "source plane", &work, arguments, log);
}

skg_status skg_raster_run(skg_raster *raster, const skg_geometry *geometry, const cl_int *extents,
                          skg_stage_log *log) {
    raster->state = 0;
    SKG_TRY(skg_raster_set_scene(raster, geometry));
    SKG_TRY(place(raster, extents, log));
    SKG_TRY(raster->strategy->run(raster, geometry, log));
    return raster->source ? run_source(raster, geometry, log) : SKG_OK;
}

void skg_raster_keep(skg_raster *raster, const skg_geometry *geometry) {
    raster->state = geometry->state;
}

int skg_raster_keeps(const skg_raster *raster, const skg_geometry *geometry) {
    return raster->state != 0 && raster->state == geometry->state;
}

skg_status skg_raster_run_passes(skg_raster *raster, const skg_geometry *geometry, int32_t passes,
                                 const cl_int *placed, cl_event *read, skg_stage_log *log) {
    const size_t first = sizeof *placed; /* behind the set of planes: the pass that is claimed next */
    raster->state = 0;
    SKG_TRY(skg_raster_set_scene(raster, geometry));
    raster->layout.passes = passes;
    const size_t count = 1 + 4 * (size_t)passes * (size_t)raster->layout.planes;
    cl_event event = NULL, *wanted = read ? read : skg_stage_event(log, &event);
    SKG_CL_TRY(clEnqueueWriteBuffer(raster->context->device->queue, raster->used.memory, CL_FALSE, first,
                                    count * sizeof *placed, placed, 0, NULL, wanted));
    SKG_TRY(skg_stage_log_add(log, "upload", event));
    return raster->strategy->run(raster, geometry, log);
}
