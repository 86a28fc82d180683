/* From sums of path parameters to what a pixel shows. The exponent of node n is the sum over planes of
 * coefficient[n][p] * x_p, x_p = sum / scale * |ray| in mm times the plane's weights; channel c shows
 * sum over nodes of weight[n][c] * exp(-exponent_n). */

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

#define SKG_AS_REAL_V SKG_CAT(SKG_CAT(as_, SKG_SCALAR), SKG_WIDE)
#if SKG_DOUBLE
#define SKG_SCALAR double
#define SKG_AS_MASK_V SKG_CAT(as_long, SKG_WIDE)
#define SKG_TO_MASK_V SKG_CAT(convert_long, SKG_WIDE)
SKG_DEFINE_EXP_DOUBLE(skg_exp_minus_v, skg_realv, skg_maskv, SKG_AS_REAL_V, SKG_AS_MASK_V, SKG_TO_MASK_V)
SKG_DEFINE_LOG_DOUBLE(skg_log_v, skg_realv, skg_maskv, SKG_AS_REAL_V, SKG_AS_MASK_V, SKG_TO_REAL_V)
#else
#define SKG_SCALAR float
#define SKG_AS_MASK_V SKG_CAT(as_int, SKG_WIDE)
#define SKG_TO_MASK_V SKG_CAT(convert_int, SKG_WIDE)
SKG_DEFINE_EXP_FLOAT(skg_exp_minus_v, skg_realv, skg_maskv, SKG_AS_REAL_V, SKG_AS_MASK_V, SKG_TO_MASK_V)
SKG_DEFINE_LOG_FLOAT(skg_log_v, skg_realv, skg_maskv, SKG_AS_REAL_V, SKG_AS_MASK_V, SKG_TO_REAL_V)
#endif

/* mm of the rays to pixels column... of a row. */
static skg_realv skg_ray_lengths_v(const skg_ray_args *ray, int column, int row) {
    const skg_realv i = (skg_real)column + SKG_LANES - ray->middle_i;
    const skg_real j = (skg_real)row - ray->middle_j;
    const skg_realv x = fma((skg_realv)(ray->column[0]), i, (skg_realv)(fma(ray->row[0], j, ray->centre[0])));
    const skg_realv y = fma((skg_realv)(ray->column[1]), i, (skg_realv)(fma(ray->row[1], j, ray->centre[1])));
    const skg_realv z = fma((skg_realv)(ray->column[2]), i, (skg_realv)(fma(ray->row[2], j, ray->centre[2])));
    return sqrt(fma(x, x, fma(y, y, z * z)));
}

static skg_realv skg_exponent_v(__constant const skg_real *coefficient, const skg_realv *x) {
    skg_realv exponent = coefficient[0] * x[0];
    for (int p = 1; p < SKG_PLANES; p++) exponent = fma((skg_realv)(coefficient[p]), x[p], exponent);
    return exponent;
}

static void skg_show(skg_realv value, __global skg_out *place, int pixels) {
    if (pixels >= SKG_WIDE) {
        SKG_STORE_V(SKG_TO_OUT_V(value), 0, place);
        return;
    }
    skg_out rest[SKG_WIDE];
    SKG_STORE_V(SKG_TO_OUT_V(value), 0, rest);
    for (int k = 0; k < pixels; k++) place[k] = rest[k];
}

/* One work-item a run of SKG_WIDE pixels of a row. Strides and offset of the output in elements.
 * factor: of intensities. negative: counts the
 * pixels whose least exponent lies below `least`, where more was subtracted for children than their parent has. */
__kernel void skg_attenuate(skg_frame_args frame, skg_ray_args ray, __global const skg_sum *copies,
                            __global const int *used, int nodes, __constant const skg_real *coefficients,
                            __constant const skg_real *weights, skg_real factor, skg_real least,
                            __global int *negative, __global skg_out *output, long offset, long row_stride, long channel_stride) {
    const int column = SKG_WIDE * (int)get_global_id(0), row = (int)get_global_id(1);
    if (column >= frame.columns || row >= frame.rows) return;
    const int pixels = min(SKG_WIDE, frame.columns - column);
    __global skg_out *place = output + offset + row * row_stride + column;
    const skg_realv length = skg_ray_lengths_v(&ray, column, row) * ray.unit;
    skg_realv x[SKG_PLANES], shown[SKG_CHANNELS];
    for (int p = 0; p < SKG_PLANES; p++)
        x[p] = skg_real_sums_v(skg_sums_v(&frame, copies, used, p, row, column)) * length;
    skg_realv lowest = skg_exponent_v(coefficients, x);
#if SKG_SHOW == SKG_SHOW_EXPONENT
    shown[0] = lowest;
#else
    for (int c = 0; c < SKG_CHANNELS; c++) shown[c] = (skg_realv)(0);
#if SKG_SHOW == SKG_SHOW_LOGARITHM
    /* -ln sum w exp(-e) = e0 - ln sum w exp(-(e - e0)) with e0 the least exponent: nothing underflows. */
    for (int n = 1; n < nodes; n++) lowest = fmin(lowest, skg_exponent_v(coefficients + n * SKG_PLANES, x));
    const skg_realv base = lowest;
#else
    const skg_realv base = (skg_realv)(0);
#endif
    for (int n = 0; n < nodes; n++) {
        const skg_realv exponent = skg_exponent_v(coefficients + n * SKG_PLANES, x);
        lowest = fmin(lowest, exponent);
        const skg_realv passed = skg_exp_minus_v(exponent - base);
        for (int c = 0; c < SKG_CHANNELS; c++)
            shown[c] = fma((skg_realv)(weights[n * SKG_CHANNELS + c]), passed, shown[c]);
    }
    for (int c = 0; c < SKG_CHANNELS; c++)
        shown[c] = SKG_SHOW == SKG_SHOW_LOGARITHM ? base - skg_log_v(shown[c]) : shown[c] * factor;
#endif
    for (int c = 0; c < SKG_CHANNELS; c++) skg_show(shown[c], place + c * channel_stride, pixels);
    const skg_maskv below = lowest < least;
    if (skg_any(SKG_TO_INT_V(below))) {
        int lanes[SKG_WIDE], count = 0;
        SKG_STORE_V(SKG_TO_INT_V(below), 0, lanes);
        for (int k = 0; k < pixels; k++) count -= lanes[k];
        atomic_add(negative, count);
    }
}
