/* The rays of a curved detector in the axes of a volume: a line of the raster each, uploaded where they differ from those that the device
 * has. */
#include "stage/volume_lines.h"

#include <string.h>

/* A row of the raster of a curved detector: pixel i stands on the touching plane at x = column + i step, y. */
static void fill_line(const skg_camera *camera, const skg_cell_rays *rays, int32_t bits, int64_t row,
                      skg_cell_line *line) {
    skg_bent_line bent;
    skg_bends_row(camera, (double)row, &bent);
    const double step = 1 + bent.more, column = bent.moved - bent.more * skg_bends_middle(camera);
    const double *start = camera->start;
    for (int k = 0; k < 3; k++) {
        line->base[k] =
            skg_cell_fixed(rays->base[0][k] + column * rays->base[1][k] + bent.y * rays->base[2][k], bits);
        line->way[k] =
            skg_cell_fixed(rays->way[0][k] + column * rays->way[1][k] + bent.y * rays->way[2][k], bits);
        line->base_column[k] = skg_cell_fixed(step * rays->base[1][k], bits);
        line->way_column[k] = skg_cell_fixed(step * rays->way[1][k], bits);
    }
    line->end = skg_cell_fixed(bent.t, SKG_PATH_BITS);
    line->start = line->start_column = 0;
    if (!camera->parallel || skg_starts_nowhere(camera)) return;
    line->start = skg_cell_fixed(start[0] + column * start[1] + bent.y * start[2], SKG_PATH_BITS);
    line->start_column = skg_cell_fixed(step * start[1], SKG_PATH_BITS);
}

/* Waits until the device has read a slot: only then may it be filled again. */
static skg_status wait_for(skg_cell_lines *lines, int32_t slot) {
    if (!lines->read[slot]) return SKG_OK;
    SKG_CL_TRY(clWaitForEvents(1, &lines->read[slot]));
    clReleaseEvent(lines->read[slot]);
    lines->read[slot] = NULL;
    return SKG_OK;
}

skg_status skg_cell_lines_write(skg_cell_lines *lines, skg_context *context, const skg_camera *camera,
                                const skg_cell_rays *rays, int32_t bits) {
    const int32_t next = (lines->slot + 1) % SKG_LINE_SLOTS;
    const int64_t rows = camera->rows;
    const size_t bytes = (size_t)rows * sizeof **lines->slots;
    if (!skg_camera_is_curved(camera)) return SKG_OK;
    SKG_TRY(wait_for(lines, next));
    SKG_TRY(skg_realloc(rows, sizeof **lines->slots, "lines of a curved detector", &lines->slots[next]));
    lines->rows[next] = rows;
    for (int64_t r = 0; r < rows; r++) fill_line(camera, rays, bits, r, &lines->slots[next][r]);
    if (lines->is_there && lines->rows[lines->slot] == rows &&
        memcmp(lines->slots[next], lines->slots[lines->slot], bytes) == 0)
        return SKG_OK;
    lines->is_there = 0; /* if the write fails, the device has none */
    SKG_TRY(skg_buffer_reserve(context, &lines->memory, (int64_t)bytes, CL_MEM_READ_ONLY,
                               "lines of a curved detector"));
    SKG_CL_TRY(clEnqueueWriteBuffer(context->device->queue, lines->memory.memory, CL_FALSE, 0, bytes,
                                    lines->slots[next], 0, NULL, &lines->read[next]));
    lines->slot = next, lines->is_there = 1;
    return SKG_OK;
}

void skg_cell_lines_release(skg_cell_lines *lines) {
    for (int32_t s = 0; s < SKG_LINE_SLOTS; s++) {
        if (wait_for(lines, s) != SKG_OK) clReleaseEvent(lines->read[s]);
        skg_free(&lines->slots[s]);
    }
    skg_buffer_release(&lines->memory);
    *lines = (skg_cell_lines){.slot = 0};
}
