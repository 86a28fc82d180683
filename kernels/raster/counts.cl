/* Count planes of leaky meshes: a pixel whose signed hits do not cancel is bad. planes: the numbers of the count planes. */

/* Finds the bad pixels of each row. rows_bad: [count planes][rows][3] how many there are, and the first and the end column
 * between which they lie. One work-item per row and plane. */
__kernel void skg_count_bad_rows(skg_raster_layout layout, __global const skg_sum *copies, __global const int *used,
                                 __global const int *planes, __global int *rows_bad) {
    const int row = (int)get_global_id(0), k = (int)get_global_id(1);
    if (row >= layout.rows) return;
    const int4 extent = vload4(0, used + SKG_EXTENT(layout.copies, planes[k]));
    skg_sumv bad = (skg_sumv)(0);
    int from = 0, to = 0;
    if (row >= extent.x && row < extent.y) /* the spare columns at the end of a row are 0 */
        for (int column = extent.z; column < extent.w; column += SKG_WIDE) {
            const skg_sumv hits = skg_extent_sums_v(&layout, copies, used, planes[k], row, column);
            if (!skg_any(SKG_TO_INT_V(hits != (skg_sumv)(0)))) continue;
            bad -= SKG_AS_SUM_V(hits != (skg_sumv)(0));
            from = to > 0 ? from : column;
            to = min(column + SKG_WIDE, layout.columns);
        }
    skg_sum lanes[SKG_WIDE];
    int total = 0;
    SKG_STORE_V(sumv, bad, lanes);
    for (int lane = 0; lane < SKG_WIDE; lane++) total += (int)lanes[lane];
    vstore3((int3)(total, from, to), (size_t)(k * layout.rows + row), rows_bad);
}

/* Adds up the rows. verdicts: [first...][1 + SKG_FIRST_BAD] how many pixels are bad, then the first of them as
 * row * columns + column, ascending. One work-item per plane. */
__kernel void skg_count_bad(skg_raster_layout layout, __global const skg_sum *copies, __global const int *used,
                            __global const int *planes, __global const int *rows_bad, int first,
                            __global int *verdicts) {
    const int k = (int)get_global_id(0);
    __global int *verdict = verdicts + (first + k) * (1 + SKG_FIRST_BAD);
    int total = 0;
    for (int row = 0; row < layout.rows; row++) {
        const int3 bad = vload3((size_t)(k * layout.rows + row), rows_bad);
        for (int column = bad.y, found = 0; found < bad.x && total + found < SKG_FIRST_BAD; column++)
            if (skg_sum_of(&layout, copies, used, planes[k], row, column) != 0)
                verdict[1 + total + found++] = row * layout.columns + column;
        total += bad.x;
    }
    verdict[0] = total;
}
