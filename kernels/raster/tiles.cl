/* Strategy `tiles` on a GPU, first half: lists the triangles that meet each square, by counting, adding up and filling. The
 * order within a list is arbitrary, since sums do not depend on it. Triangles that meet more than SKG_TILES_MAX squares are in
 * one list for all. */

/* How many tiles the box of a triangle meets, and which: columns x to z - 1 and rows y to w - 1 of tiles. */
static int skg_tiles_of(const skg_raster_layout *layout, __global const int *corners,
                        __global const skg_real4 *projected, __global const skg_part_entry *parts,
                        __global const int *blocks, int triangle, int4 *tiles) {
    skg_range range;
    skg_range_of(parts, skg_part_of_triangle(parts, blocks, triangle), &range);
    skg_real4 a, b, c;
    skg_box box;
    skg_corners(corners, projected, &range, triangle, &a, &b, &c);
    if (range.contributions == 0 || !skg_bounds(&range, a, b, c, skg_window(&range, 0, 0, layout->columns, layout->rows), &box))
        return 0;
    tiles->x = (box.i0 + range.pixel_i) / layout->tile_columns;
    tiles->y = (box.j0 + range.pixel_j) / layout->tile_rows;
    tiles->z = (box.i1 - 1 + range.pixel_i) / layout->tile_columns + 1;
    tiles->w = (box.j1 - 1 + range.pixel_j) / layout->tile_rows + 1;
    return (tiles->z - tiles->x) * (tiles->w - tiles->y);
}

/* counts: [tile] triangles of each tile; [tiles] those in the list for all. */
__kernel void skg_tiles_count(skg_raster_layout layout, __global const int *corners, __global const skg_real4 *projected,
                              __global const skg_part_entry *parts, __global const int *blocks,
                              __global int *counts) {
    const int triangle = (int)get_global_id(0);
    if (triangle >= layout.triangles) return;
    int4 tiles;
    const int count = skg_tiles_of(&layout, corners, projected, parts, blocks, triangle, &tiles);
    if (count == 0) return;
    if (count > SKG_TILES_MAX) {
        atomic_inc(&counts[layout.tiles_across * layout.tiles_down]);
        return;
    }
    for (int y = tiles.y; y < tiles.w; y++)
        for (int x = tiles.x; x < tiles.z; x++) atomic_inc(&counts[y * layout.tiles_across + x]);
}

/* starts[tile] = sum of the counts before it, starts[tiles] = all; the counts become 0 and serve as cursors, except
 * that of the list for all, which is kept in starts[tiles + 1]. One work-group. */
#define SKG_SCAN 64
__kernel __attribute__((reqd_work_group_size(SKG_SCAN, 1, 1))) void skg_tiles_scan(skg_raster_layout layout,
                                                                                   __global int *counts,
                                                                                   __global int *starts) {
    __local int sums[SKG_SCAN];
    const int item = (int)get_local_id(0), tiles = layout.tiles_across * layout.tiles_down;
    const int run = (tiles + SKG_SCAN - 1) / SKG_SCAN, from = min(item * run, tiles), to = min(from + run, tiles);
    int sum = 0;
    for (int t = from; t < to; t++) sum += counts[t];
    sums[item] = sum;
    barrier(CLK_LOCAL_MEM_FENCE);
    sum = 0;
    for (int k = 0; k < item; k++) sum += sums[k];
    for (int t = from; t < to; t++) {
        starts[t] = sum;
        sum += counts[t];
        counts[t] = 0;
    }
    if (item == SKG_SCAN - 1) {
        starts[tiles] = sum;
        starts[tiles + 1] = counts[tiles];
        counts[tiles] = 0;
    }
}

__kernel void skg_tiles_fill(skg_raster_layout layout, __global const int *corners, __global const skg_real4 *projected,
                             __global const skg_part_entry *parts, __global const int *blocks, __global int *counts,
                             __global const int *starts, __global int *list, __global int *for_all) {
    const int triangle = (int)get_global_id(0);
    if (triangle >= layout.triangles) return;
    int4 tiles;
    const int count = skg_tiles_of(&layout, corners, projected, parts, blocks, triangle, &tiles);
    if (count == 0) return;
    if (count > SKG_TILES_MAX) {
        for_all[atomic_inc(&counts[layout.tiles_across * layout.tiles_down])] = triangle;
        return;
    }
    for (int y = tiles.y; y < tiles.w; y++)
        for (int x = tiles.x; x < tiles.z; x++) {
            const int tile = y * layout.tiles_across + x;
            list[starts[tile] + atomic_inc(&counts[tile])] = triangle;
        }
}
