/* Open meshes have planes and a count of their own; where the count is 0 their signed hits cancel, and their sums go
 * into the planes that all parts share. Elsewhere they are left out, or repaired. */

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

/* No valid pixel: far from any. */
#define SKG_FAR 0x40000000

/* gaps[row][column]: pixels to the nearest valid one of the row, 0 where the pixel itself is. One item a row. */
__kernel void skg_open_gaps(skg_frame_args frame, __global const skg_sum *copies, __global const int *used, int plane,
                            __global int *gaps) {
    const int row = (int)get_global_id(0);
    if (row >= frame.rows) return;
    __global int *gap = gaps + (size_t)row * (size_t)frame.columns;
    int near = SKG_FAR;
    for (int column = 0; column < frame.columns; column++) {
        near = skg_sum_of(&frame, copies, used, plane, row, column) != 0 ? min(near + 1, SKG_FAR) : 0;
        gap[column] = near;
    }
    near = SKG_FAR;
    for (int column = frame.columns - 1; column >= 0; column--) {
        near = gap[column] ? min(near + 1, SKG_FAR) : 0;
        gap[column] = min(gap[column], near);
    }
}

/* Side steps to the nearest valid pixel: half the side of the smallest square about the pixel that holds one. */
static int skg_reach(const skg_frame_args *frame, __global const int *gaps, int row, int column) {
    __global const int *gap = gaps + column;
    int reach = gap[row * frame->columns];
    for (int d = 1; d < reach && d < frame->rows; d++) {
        if (row >= d) reach = min(reach, max(d, gap[(row - d) * frame->columns]));
        if (row + d < frame->rows) reach = min(reach, max(d, gap[(row + d) * frame->columns]));
    }
    return reach;
}

/* Mean over the valid pixels of a square's border, rounded to nearest; inside it none is valid. Quotients and
 * remainders are summed each for themselves, so that nothing overflows. */
static skg_sum skg_border_mean(const skg_frame_args *frame, __global const skg_sum *copies, __global const int *used,
                               __global const int *gaps, int plane, int row, int column, int reach) {
    long valid = 0, whole = 0, rest = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int j = max(row - reach, 0); j <= min(row + reach, frame->rows - 1); j++) {
            const int step = abs(j - row) == reach ? 1 : 2 * reach;
            for (int i = column - reach; i <= column + reach; i += step) {
                if (i < 0 || i >= frame->columns || gaps[j * frame->columns + i]) continue;
                if (pass == 0) {
                    valid++;
                    continue;
                }
                const long value = (skg_term)skg_sum_of(frame, copies, used, plane, j, i);
                whole += value / valid;
                rest += value % valid;
            }
        }
    const long twice = 2 * rest + valid;
    return (skg_sum)(whole + twice / (2 * valid) - (twice % (2 * valid) < 0));
}

/* Bad pixels of one part get the mean of their neighbourhood, which is grown until it holds valid ones (Vidal and
 * Villard 2016, 3.2.7). moves: as above, all of the one part. */
__kernel void skg_open_repair(skg_frame_args frame, __global const skg_sum *copies, __global const int *used,
                              int first, int count, __constant const int *moves, __global const int *gaps,
                              __global skg_sum *shared) {
    const int column = (int)get_global_id(0), row = (int)get_global_id(1);
    if (column >= frame.columns || row >= frame.rows || gaps[row * frame.columns + column] == 0) return;
    const int reach = skg_reach(&frame, gaps, row, column);
    if (reach >= SKG_FAR) return;
    for (int k = first; k < first + count; k++)
        shared[(size_t)moves[3 * k + 2] * (size_t)frame.plane + (size_t)row * (size_t)frame.stride + (size_t)column] +=
            skg_border_mean(&frame, copies, used, gaps, moves[3 * k], row, column, reach);
}

/* Adds values[item] to the accumulator places[item]; no place comes twice. */
__kernel void skg_open_put(int count, __global const int *places, __global const long *values,
                           __global skg_sum *shared) {
    const int item = (int)get_global_id(0);
    if (item < count) shared[places[item]] += (skg_sum)values[item];
}
