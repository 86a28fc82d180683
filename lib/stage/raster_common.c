/* Functions that the strategies of a raster have in common. */
#include "stage/raster_private.h"

int64_t skg_raster_sum_bytes(const skg_raster *raster) {
    return raster->options.kernels.bits / 8;
}

skg_status skg_raster_reserve(skg_raster *raster, skg_buffer *buffer, int64_t bytes, const char *what) {
    return skg_buffer_reserve(raster->context, buffer, bytes, CL_MEM_READ_WRITE, what);
}

int64_t skg_raster_plane_bytes(const skg_raster *raster) {
    return (int64_t)raster->layout.planes * raster->layout.plane * skg_raster_sum_bytes(raster);
}

skg_status skg_raster_reserve_lists(skg_raster *raster) {
    const int64_t of_int = sizeof(cl_int), triangles = raster->options.triangles;
    SKG_TRY(
        skg_raster_reserve(raster, &raster->list, triangles * SKG_TILES_MAX * of_int, "lists of the tiles"));
    return skg_raster_reserve(raster, &raster->for_all, triangles * of_int, "list for all tiles");
}

skg_status skg_raster_fill(const skg_raster *raster, const skg_buffer *buffer, cl_int value, int64_t from,
                           int64_t bytes) {
    SKG_CL_TRY(clEnqueueFillBuffer(raster->context->device->queue, buffer->memory, &value, sizeof value,
                                   (size_t)from, (size_t)bytes, 0, NULL, NULL));
    return SKG_OK;
}

skg_status skg_raster_get_program(const skg_raster *raster, cl_program *program) {
    const char *files[2 + SKG_STRATEGY_FILES] = {"fine.clh", "project.cl"};
    const skg_define side[] = {{"SKG_SIDE", skg_raster_side(raster)}};
    int32_t count = 2;
    for (int32_t f = 0; f < SKG_STRATEGY_FILES && raster->strategy->files[f]; f++)
        files[count++] = raster->strategy->files[f];
    return skg_kernels_get(raster->context, &raster->options.kernels, count, files, SKG_DEFINES(side),
                           program);
}

int32_t skg_raster_passes(const skg_raster *raster) {
    return raster->options.passes > 1 ? raster->options.passes : 1;
}

int32_t skg_raster_side(const skg_raster *raster) {
    return raster->options.side > 1 ? raster->options.side : 1;
}
