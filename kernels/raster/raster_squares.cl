/* Strategy `tiles` on a GPU: each work-group accumulates one square tile in local memory and writes it out. */

/* local_sums: [planes][tile_rows][tile_columns] */
__kernel __attribute__((reqd_work_group_size(64, 1, 1))) void
skg_raster_squares(skg_raster_layout layout, __global const int *corners, __global const skg_real4 *projected,
                   __global const skg_part_entry *parts, __global const skg_contribution *contributions,
                   __global const int *blocks, __global const int *starts, __global const int *list,
                   __global const int *for_all, __global skg_sum *sums, __local skg_sum *local_sums) {
    const int tile = (int)get_group_id(0), item = (int)get_local_id(0);
    const int left = tile % layout.tiles_across * layout.tile_columns;
    const int top = tile / layout.tiles_across * layout.tile_rows;
    const int right = min(left + layout.tile_columns, layout.columns), bottom = min(top + layout.tile_rows, layout.rows);
    const int plane = layout.tile_columns * layout.tile_rows;
    for (int k = item; k < plane * layout.planes; k += 64) local_sums[k] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    const int own = starts[tile + 1] - starts[tile];
    const int all = starts[layout.tiles_across * layout.tiles_down + 1];
    for (int k = item; k < own + all; k += 64) {
        const int triangle = k < own ? list[starts[tile] + k] : for_all[k - own];
        skg_range range;
        skg_range_of(parts, skg_part_of_triangle(parts, blocks, triangle), &range);
        skg_real4 a, b, c;
        skg_box box;
        skg_corners(corners, projected, &range, triangle, &a, &b, &c);
        if (skg_bounds(&range, a, b, c, skg_window(&range, left, top, right, bottom), &box)) {
            skg_face f;
            skg_face_of(&range, a, b, c, &f);
            skg_draw_local(local_sums, layout.tile_columns, plane,
                           (range.pixel_j - top) * layout.tile_columns + range.pixel_i - left, contributions, &range, &f,
                           &box);
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const int columns = right - left, pixels = columns * (bottom - top);
    for (int p = 0; p < layout.planes; p++)
        for (int k = item; k < pixels; k += 64)
            sums[(size_t)p * (size_t)layout.plane + (size_t)((top + k / columns) * layout.stride + left + k % columns)] =
                local_sums[p * plane + k / columns * layout.tile_columns + k % columns];
}
