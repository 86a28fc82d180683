/* Count planes of open meshes: a pixel is bad where the signed hits do not cancel. */

/* rows_bad[row]: bad pixels of the row. */
__kernel void skg_count_bad_rows(skg_frame_args frame, __global const skg_sum *copies, __global const int *used,
                                 int plane, __global int *rows_bad) {
    const int row = (int)get_global_id(0);
    if (row >= frame.rows) return;
    int bad = 0;
    for (int column = 0; column < frame.columns; column++)
        bad += skg_sum_of(&frame, copies, used, plane, row, column) != 0;
    rows_bad[row] = bad;
}

/* result[0]: bad pixels; then the first SKG_FIRST_BAD of them, row * columns + column, in this order. One item. */
__kernel void skg_count_bad(skg_frame_args frame, __global const skg_sum *copies, __global const int *used, int plane,
                            __global const int *rows_bad, __global int *result) {
    int total = 0;
    for (int row = 0; row < frame.rows; row++) {
        for (int column = 0, found = 0; found < rows_bad[row] && total + found < SKG_FIRST_BAD; column++)
            if (skg_sum_of(&frame, copies, used, plane, row, column) != 0)
                result[1 + total + found++] = row * frame.columns + column;
        total += rows_bad[row];
    }
    result[0] = total;
}
