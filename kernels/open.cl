/* Open meshes have planes and a count of their own; where the count is 0 their signed hits cancel, and their sums go
 * into the planes that all parts share. Elsewhere they are left out. */

/* moves: [count][3] plane of the open part, its count plane, and the shared plane. Both rasters have the same
 * layout of a plane; shared: the first copy of the other. One work-item a run of SKG_WIDE pixels of a row. */
__kernel void skg_open_add(skg_frame_args frame, __global const skg_sum *copies, __global const int *used, int count,
                           __constant const int *moves, __global skg_sum *shared) {
    const int column = SKG_WIDE * (int)get_global_id(0), row = (int)get_global_id(1);
    if (column >= frame.columns || row >= frame.rows) return;
    for (int k = 0; k < count; k++) {
        const skg_sumv hits = skg_sums_v(&frame, copies, used, moves[3 * k + 1], row, column);
        const skg_sumv sums = skg_sums_v(&frame, copies, used, moves[3 * k], row, column);
        __global skg_sum *place = shared + (size_t)moves[3 * k + 2] * (size_t)frame.plane +
                                  (size_t)row * (size_t)frame.stride + (size_t)column;
        const skg_sumv valid = SKG_AS_SUM_V(hits == (skg_sumv)(0));
        SKG_STORE_V(SKG_LOAD_V(0, place) + (sums & valid), 0, place);
    }
}
