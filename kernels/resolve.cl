/* Path lengths of one plane: sum / scale * |ray|, mm (times the plane's weights). */

#if SKG_OUTPUT_DOUBLE
#if !SKG_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif
typedef double skg_out;
#define SKG_TO_OUT_V SKG_CAT(convert_double, SKG_WIDE)
#else
typedef float skg_out;
#define SKG_TO_OUT_V SKG_CAT(convert_float, SKG_WIDE)
#endif

/* One work-item a run of SKG_WIDE pixels of a row; row_stride of the output in elements. */
__kernel void skg_resolve_lengths(skg_frame_args frame, skg_ray_args ray, __global const skg_sum *copies,
                                  __global const int *used, int plane, __global skg_out *output, long offset,
                                  int row_stride) {
    const int column = SKG_WIDE * (int)get_global_id(0), row = (int)get_global_id(1);
    if (column >= frame.columns || row >= frame.rows) return;
    const skg_realv i = (skg_real)column + SKG_LANES - ray.middle_i;
    const skg_real j = (skg_real)row - ray.middle_j;
    const skg_realv x = fma((skg_realv)(ray.column[0]), i, (skg_realv)(fma(ray.row[0], j, ray.centre[0])));
    const skg_realv y = fma((skg_realv)(ray.column[1]), i, (skg_realv)(fma(ray.row[1], j, ray.centre[1])));
    const skg_realv z = fma((skg_realv)(ray.column[2]), i, (skg_realv)(fma(ray.row[2], j, ray.centre[2])));
    const skg_realv length = sqrt(fma(x, x, fma(y, y, z * z)));
    const skg_realv sum = skg_real_sums_v(skg_sums_v(&frame, copies, used, plane, row, column));
    const skg_realv value = sum * (length * ray.unit);
    __global skg_out *place = output + offset + (long)row * row_stride + column;
    if (column + SKG_WIDE <= frame.columns) {
        SKG_STORE_V(SKG_TO_OUT_V(value), 0, place);
        return;
    }
    skg_out rest[SKG_WIDE];
    SKG_STORE_V(SKG_TO_OUT_V(value), 0, rest);
    for (int k = 0; k < frame.columns - column; k++) place[k] = rest[k];
}
