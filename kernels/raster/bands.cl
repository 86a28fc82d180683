/* Strategy `tiles` on a CPU, first half: lists the triangles that meet each band of rows, in one pass. Each work-group (one
 * work-item) claims chunks of triangles, sorts a chunk by band in its own memory, and appends it to the pool in one piece;
 * pieces[chunk * bands + band] is where the band's triangles of that chunk are, and how many. Triangles that meet more than
 * SKG_TILES_MAX bands are in one list for all. */

SKG_APART void skg_sort_bands(const skg_raster_layout *layout, __global const int *corners,
                              __global const skg_real4 *projected, __global const skg_part_entry *parts,
                              __global const int *blocks, __global int *counters, __global int2 *pieces,
                              __global int *pool, __global int *for_all) {
    int count[SKG_BANDS_MAX];
    ushort first_band[SKG_CHUNK];
    uchar met[SKG_CHUNK];
    const int bands = layout->tiles_down;
    for (;;) {
        const int chunk = atomic_inc(&counters[0]), start = chunk * SKG_CHUNK;
        if (start >= layout->triangles) break;
        const int end = min(start + SKG_CHUNK, layout->triangles);
        int total = 0, triangle = start;
        for (int k = 0; k < bands; k++) count[k] = 0;
        int part = skg_part_of_triangle(parts, blocks, triangle);
        while (triangle < end) {
            skg_range range;
            skg_range_of(parts, part++, &range);
            const int4 window = skg_window(&range, 0, 0, layout->columns, layout->rows);
            for (const int last = min(end, range.end); triangle < last; triangle++) {
                skg_real4 a, b, c;
                skg_box box;
                met[triangle - start] = 0;
                if (range.contributions == 0) continue;
                skg_corners(corners, projected, &range, triangle, &a, &b, &c);
                if (!skg_bounds(&range, a, b, c, window, &box)) continue;
                const int from = (box.j0 + range.pixel_j) / layout->tile_rows;
                const int to = (box.j1 - 1 + range.pixel_j) / layout->tile_rows;
                if (to - from >= SKG_TILES_MAX) {
                    for_all[atomic_inc(&counters[2])] = triangle;
                    continue;
                }
                first_band[triangle - start] = (ushort)from;
                met[triangle - start] = (uchar)(to - from + 1);
                for (int k = from; k <= to; k++) count[k]++;
                total += to - from + 1;
            }
        }
        int place = atomic_add(&counters[1], total);
        for (int k = 0; k < bands; k++) {
            pieces[chunk * bands + k] = (int2)(place, count[k]);
            place += count[k];
            count[k] = place - count[k];
        }
        for (int k = 0; k < end - start; k++)
            for (int m = 0; m < met[k]; m++) pool[count[first_band[k] + m]++] = start + k;
    }
}

/* counters: the next chunk; entries of the pool in use; triangles in the list for all. */
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void
skg_bands_sort(skg_raster_layout layout, __global const int *corners, __global const skg_real4 *projected,
               __global const skg_part_entry *parts, __global const int *blocks, __global int *counters,
               __global int2 *pieces, __global int *pool, __global int *for_all) {
    skg_sort_bands(&layout, corners, projected, parts, blocks, counters, pieces, pool, for_all);
}
