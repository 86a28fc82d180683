/* Strategy `tiles` on a CPU: tiles are bands of rows. Each work-group (one work-item, wide vectors) claims bands,
 * accumulates each in a small image of its own, which stays in the cache, and writes it out. */

static void skg_draw_list(const skg_target *target, skg_batch *batch, __global const int *blocks,
                          __global const int *list, int count, skg_range *range) {
    for (int k = 0; k < count; k++) {
        const int triangle = list[k];
        if (triangle >= range->end || triangle < range->first)
            skg_range_of(target->parts, skg_part_of_triangle(target->parts, blocks, triangle), range);
        skg_submit(target, batch, range, triangle, triangle + 1);
    }
}

SKG_APART void skg_draw_bands(size_t group, const skg_raster_layout *layout, __global const int *corners,
                              __global const skg_real4 *projected, __global const skg_part_entry *parts,
                              __global const skg_contribution *contributions, __global const int *blocks,
                              __global const int *counters, __global const int2 *pieces, __global const int *pool,
                              __global const int *for_all, __global skg_sum *sums, __global skg_sum *scratch,
                              __global int *used) {
    skg_target target;
    target.stride = layout->stride;
    target.plane = layout->stride * (layout->tile_rows + SKG_SPARE_ROWS);
    target.image = scratch + group * (size_t)(layout->planes * target.plane);
    target.columns = layout->columns;
    target.corners = corners;
    target.projected = projected;
    target.parts = parts;
    target.contributions = contributions;
    skg_batch batch;
    skg_begin(&batch);
    skg_range range;
    skg_range_of(parts, 0, &range);
    for (;;) {
        const int band = atomic_inc(&used[layout->copies]);
        if (band >= layout->tiles_down) break;
        target.first_row = band * layout->tile_rows;
        target.last_row = min(target.first_row + layout->tile_rows, layout->rows);
        __global const int *extents = used + SKG_EXTENT(layout->copies, 0);
        skg_zero(&target, extents, layout->planes, target.first_row, target.last_row);
        for (int chunk = 0; chunk * SKG_CHUNK < layout->triangles; chunk++) {
            const int2 piece = pieces[chunk * layout->tiles_down + band];
            skg_draw_list(&target, &batch, blocks, pool + piece.x, piece.y, &range);
        }
        skg_draw_list(&target, &batch, blocks, for_all, counters[2], &range);
        skg_flush(&target, &batch);
        for (int p = 0; p < layout->planes; p++) {
            const int4 extent = vload4(p, extents);
            const int end = min(target.last_row, extent.y);
            for (int row = max(target.first_row, extent.x); row < end; row++) {
                __global const skg_sum *from = target.image + p * target.plane + (row - target.first_row) * layout->stride;
                __global skg_sum *to = sums + (size_t)p * (size_t)layout->plane + (size_t)row * (size_t)layout->stride;
                for (int k = extent.z; k < extent.w; k++) to[k] = from[k];
            }
        }
    }
}

/* scratch: an image of tile_rows + SKG_SPARE_ROWS rows for each plane of each work-group. used[copies]: the band that is
 * claimed next; then the extents (skg_shared.h). */
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void
skg_raster_bands(skg_raster_layout layout, __global const int *corners, __global const skg_real4 *projected,
                 __global const skg_part_entry *parts, __global const skg_contribution *contributions, __global const int *blocks,
                 __global const int *counters, __global const int2 *pieces, __global const int *pool,
                 __global const int *for_all, __global skg_sum *sums, __global skg_sum *scratch,
                 __global int *used) {
    skg_draw_bands(get_group_id(0), &layout, corners, projected, parts, contributions, blocks, counters, pieces, pool, for_all,
                   sums, scratch, used);
}
