/* From sums of path parameters to what a pixel shows. The exponent of node n is the sum over planes of
 * coefficient[n][p] * x_p, x_p = sum / scale * |ray| in mm times the plane's weights; channel c shows
 * sum over nodes of weight[n][c] * exp(-exponent_n). Coefficients come times -log2(e): powers of two are at hand. */

/* Compilers that do not know the pragma skip it; bits do not depend on it. */
#define SKG_UNROLL _Pragma("unroll")
#ifndef SKG_HALF_UNIT
#define SKG_HALF_UNIT 1.0f
#endif
#define SKG_LN2 0.693147180559945309417

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

#define SKG_OUT_TO_REAL_V SKG_CAT(SKG_CAT(convert_, SKG_SCALAR), SKG_WIDE)
#define SKG_AS_REAL_V SKG_CAT(SKG_CAT(as_, SKG_SCALAR), SKG_WIDE)
#if SKG_DOUBLE
#define SKG_SCALAR double
#define SKG_AS_MASK_V SKG_CAT(as_long, SKG_WIDE)
#define SKG_TO_MASK_V SKG_CAT(convert_long, SKG_WIDE)
SKG_DEFINE_EXP2_DOUBLE(skg_exp2_v, skg_realv, skg_maskv, SKG_AS_REAL_V, SKG_AS_MASK_V)
SKG_DEFINE_LOG_DOUBLE(skg_log_v, skg_realv, skg_maskv, SKG_AS_REAL_V, SKG_AS_MASK_V, SKG_TO_REAL_V)
#else
#define SKG_SCALAR float
#define SKG_AS_MASK_V SKG_CAT(as_int, SKG_WIDE)
#define SKG_TO_MASK_V SKG_CAT(convert_int, SKG_WIDE)
SKG_DEFINE_EXP2_FLOAT(skg_exp2_v, skg_realv, skg_maskv, SKG_AS_REAL_V, SKG_AS_MASK_V)
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

static void skg_show(skg_realv value, __global skg_out *place, int pixels) {
#if SKG_HALF
    /* The image, too, is kept in binary16; energies in MeV. */
    float lanes[SKG_WIDE];
    SKG_STORE_V(value, 0, lanes);
    for (int k = 0; k < min(pixels, SKG_WIDE); k++) {
        const float rounded = skg_to_half(lanes[k] * SKG_HALF_UNIT) / SKG_HALF_UNIT;
        place[k] = (skg_out)rounded + (SKG_ADD ? place[k] : (skg_out)(0));
    }
    return;
#endif
    if (pixels >= SKG_WIDE) {
#if SKG_ADD
        SKG_STORE_V(SKG_LOAD_V(0, place) + SKG_TO_OUT_V(value), 0, place);
#else
        SKG_STORE_V(SKG_TO_OUT_V(value), 0, place);
#endif
        return;
    }
    skg_out rest[SKG_WIDE];
    SKG_STORE_V(SKG_TO_OUT_V(value), 0, rest);
    for (int k = 0; k < pixels; k++) place[k] = SKG_ADD ? place[k] + rest[k] : rest[k];
}

/* Sums of coefficient times mm over the planes, for each run. */
static void skg_exponents(__constant const skg_real *coefficient, skg_realv x[SKG_PLANES][SKG_RUNS],
                          skg_realv *exponent) {
    SKG_UNROLL for (int r = 0; r < SKG_RUNS; r++) exponent[r] = coefficient[0] * x[0][r];
    SKG_UNROLL for (int p = 1; p < SKG_PLANES; p++)
        SKG_UNROLL for (int r = 0; r < SKG_RUNS; r++)
            exponent[r] = fma((skg_realv)(coefficient[p]), x[p][r], exponent[r]);
}

/* How many of these pixels' lanes exceed the limit. */
static void skg_count(skg_realv value, skg_real limit, int pixels, __global int *count) {
    const skg_intv above = SKG_TO_INT_V(value > (skg_realv)(limit));
    if (!skg_any(above)) return;
    int lanes[SKG_WIDE], found = 0;
    SKG_STORE_V(above, 0, lanes);
    for (int k = 0; k < min(pixels, SKG_WIDE); k++) found -= lanes[k];
    if (found) atomic_add(count, found);
}

/* Sum over nodes of weight * 2^(power - base) of one channel of the open beam, power = coefficient of the world's plane
 * times mm there. */
#if SKG_RATIO
static skg_realv skg_open_beam(int nodes, __constant const skg_real *coefficients, __constant const skg_real *weights,
                               int world_plane, skg_realv world, skg_realv base) {
    skg_realv open = (skg_realv)(0);
    for (int n = 0; n < nodes; n++)
        open = fma((skg_realv)(weights[n * SKG_CHANNELS]),
                   skg_exp2_v(fma((skg_realv)(coefficients[n * SKG_PLANES + world_plane]), world, -base)), open);
    return open;
}

static skg_realv skg_highest_open(int nodes, __constant const skg_real *coefficients, int world_plane,
                                  skg_realv world) {
    skg_realv highest = (skg_realv)(coefficients[world_plane]) * world;
    for (int n = 1; n < nodes; n++) {
        const skg_realv power = (skg_realv)(coefficients[n * SKG_PLANES + world_plane]) * world;
        highest = power > highest ? power : highest;
    }
    return highest;
}
#endif

#if SKG_NOISE
/* A draw for the pixels of run r that are `few`; each node by itself. */
static skg_realv skg_photons_v(int nodes, __constant const skg_real *coefficients, __constant const skg_real *weights,
                               __constant const skg_real *variances, skg_realv x[SKG_PLANES][SKG_RUNS], int r,
                               skg_realv all, skg_intv few, const skg_noise_args *key, int pixel, int channel) {
    skg_realv value = (skg_realv)(0);
    skg_uintv draw[4];
    for (int n = 0; n < nodes; n++) {
        const skg_real weight = weights[n * SKG_CHANNELS], variance = variances[n * SKG_CHANNELS];
        if ((n & 3) == 0)
            skg_draw_v(key, pixel, SKG_DRAW_WORD(SKG_DRAW_PHOTONS, channel, n >> 2), draw);
        if (!(weight > 0)) continue;
        skg_realv power = coefficients[n * SKG_PLANES] * x[0][r];
        SKG_UNROLL for (int p = 1; p < SKG_PLANES; p++)
            power = fma((skg_realv)(coefficients[n * SKG_PLANES + p]), x[p][r], power);
        const skg_floatv expected = SKG_TO_FLOAT_V(weight * weight / variance * all * skg_exp2_v(power));
        const skg_intv many = expected > (skg_floatv)(SKG_FEW);
        const skg_floatv counted =
            skg_poisson_v(few & ~many ? expected : (skg_floatv)(0.0f), draw[n & 3]);
        const skg_floatv spread = fma(skg_root_v(expected), skg_normal_v(draw[n & 3]), expected);
        value = fma((skg_realv)(variance / weight), SKG_TO_REAL_V(many ? spread : counted), value);
    }
    return value;
}
#endif

/* One work-item SKG_RUNS runs of SKG_WIDE pixels of a row. coefficients: of -exponent * log2(e), or of the exponent
 * where that is shown. Strides and offset of the output in elements. factor: of intensities. negative: counts the pixels
 * that exceed `limit` by the power of two of their first node (fall below -limit by its exponent), where more was
 * subtracted for children than their parent has. World: a plane gets `world` for each mm of path, which is |ray| times
 * path[0] + path[1] i + path[2] j. Falloff: cube of nearest / |ray|. Noise: variances of the nodes as weights; by photons
 * where fewer than `photons` of them are detected, as far as mean and variance tell: mean^2 / variance is never more. */
__kernel void skg_attenuate(skg_frame_args frame, skg_ray_args ray, __global const skg_sum *copies,
                            __global const int *used, int nodes, __constant const skg_real *coefficients,
                            __constant const skg_real *weights, skg_real factor, skg_real limit,
                            __global int *negative, __global skg_out *output, long offset, long row_stride,
                            long channel_stride
#if SKG_WORLD
                            ,
                            int world_plane, skg_real4 world
#endif
#if SKG_FALLOFF
                            ,
                            skg_real nearest
#endif
#if SKG_NOISE
                            ,
                            __constant const skg_real *variances, skg_noise_args key, skg_real photons
#endif
) {
    const int column = SKG_WIDE * SKG_RUNS * (int)get_global_id(0), row = (int)get_global_id(1);
    if (column >= frame.columns || row >= frame.rows) return;
    skg_realv x[SKG_PLANES][SKG_RUNS], shown[SKG_CHANNELS][SKG_RUNS], power[SKG_RUNS], highest[SKG_RUNS];
#if SKG_WORLD
    skg_realv surroundings[SKG_RUNS];
#endif
#if SKG_NOISE
    skg_realv spread[SKG_CHANNELS][SKG_RUNS];
    SKG_UNROLL for (int c = 0; c < SKG_CHANNELS; c++)
        SKG_UNROLL for (int r = 0; r < SKG_RUNS; r++) spread[c][r] = (skg_realv)(0);
#endif
    SKG_UNROLL for (int r = 0; r < SKG_RUNS; r++) {
        const int at = min(column + r * SKG_WIDE, frame.columns - 1); /* runs past the end stay in the row */
        const skg_realv length = skg_ray_lengths_v(&ray, at, row);
        const skg_realv scaled = SKG_HALF ? (skg_realv)(0x1p-24f * 1000) : length * ray.unit;
        SKG_UNROLL for (int p = 0; p < SKG_PLANES; p++)
            x[p][r] = skg_real_sums_v(skg_sums_v(&frame, copies, used, p, row, at)) * scaled;
#if SKG_WORLD
        const skg_realv path = fma((skg_realv)(world.z), (skg_real)at + SKG_LANES,
                                   (skg_realv)(fma(world.w, (skg_real)row, world.y)));
        surroundings[r] = world.x * length * path;
        SKG_UNROLL for (int p = 0; p < SKG_PLANES; p++) if (p == world_plane) x[p][r] += surroundings[r];
#endif
    }
    skg_exponents(coefficients, x, highest);
#if SKG_SHOW == SKG_SHOW_EXPONENT
    SKG_UNROLL for (int r = 0; r < SKG_RUNS; r++) {
        shown[0][r] = highest[r];
        highest[r] = -highest[r];
    }
#else
    SKG_UNROLL for (int c = 0; c < SKG_CHANNELS; c++)
        SKG_UNROLL for (int r = 0; r < SKG_RUNS; r++) shown[c][r] = (skg_realv)(0);
#if SKG_SHOW == SKG_SHOW_LOGARITHM
    /* -ln sum w 2^z = -(z0 ln 2 + ln sum w 2^(z - z0)) with z0 the greatest: nothing underflows. */
    for (int n = 1; n < nodes; n++) {
        skg_exponents(coefficients + n * SKG_PLANES, x, power);
        SKG_UNROLL for (int r = 0; r < SKG_RUNS; r++) highest[r] = power[r] > highest[r] ? power[r] : highest[r];
    }
#endif
    for (int n = 0; n < nodes; n++) {
        skg_exponents(coefficients + n * SKG_PLANES, x, power);
        SKG_UNROLL for (int r = 0; r < SKG_RUNS; r++) {
#if SKG_SHOW == SKG_SHOW_LOGARITHM
            const skg_realv passed = skg_exp2_v(power[r] - highest[r]);
#else
            const skg_realv passed = skg_exp2_v(power[r]);
#endif
            SKG_UNROLL for (int c = 0; c < SKG_CHANNELS; c++)
                shown[c][r] = fma((skg_realv)(weights[n * SKG_CHANNELS + c]), passed, shown[c][r]);
#if SKG_NOISE
            SKG_UNROLL for (int c = 0; c < SKG_CHANNELS; c++)
                spread[c][r] = fma((skg_realv)(variances[n * SKG_CHANNELS + c]), passed, spread[c][r]);
#endif
        }
    }
    SKG_UNROLL for (int r = 0; r < SKG_RUNS; r++) {
#if SKG_FALLOFF
        const skg_realv near = nearest / skg_ray_lengths_v(&ray, column + r * SKG_WIDE, row);
        const skg_realv all = near * near * near * factor;
#else
        const skg_realv all = (skg_realv)(factor);
#endif
#if SKG_RATIO
        const skg_realv top = skg_highest_open(nodes, coefficients, world_plane, surroundings[r]);
#endif
        SKG_UNROLL for (int c = 0; c < SKG_CHANNELS; c++) {
#if SKG_RATIO
            const skg_realv open =
                skg_open_beam(nodes, coefficients, weights + c, world_plane, surroundings[r], top);
#endif
#if SKG_SHOW == SKG_SHOW_LOGARITHM
            shown[c][r] = -fma(highest[r], (skg_realv)(SKG_LN2), skg_log_v(shown[c][r]));
#if SKG_RATIO
            shown[c][r] += fma(top, (skg_realv)(SKG_LN2), skg_log_v(open));
#endif
#elif SKG_RATIO
            shown[c][r] = shown[c][r] / open * skg_exp2_v(-top);
#else
            shown[c][r] *= all;
#endif
#if SKG_NOISE
            const skg_realv mean = shown[c][r], variance = spread[c][r] * all;
            const int at = column + r * SKG_WIDE, pixel = row * frame.columns + at;
            const skg_intv few = SKG_TO_INT_V(mean * mean < photons * variance);
            skg_uintv draw[4];
            skg_draw_v(&key, pixel, SKG_DRAW_WORD(SKG_DRAW_QUANTUM, c, 0), draw);
            const skg_floatv deviate = skg_root_v(SKG_TO_FLOAT_V(variance)) * skg_normal_v(draw[0]);
            shown[c][r] += SKG_TO_REAL_V(deviate);
            if (skg_any(few)) {
                const skg_realv counted = skg_photons_v(nodes, coefficients, weights + c, variances + c, x, r, all, few,
                                                        &key, pixel, c);
                shown[c][r] = SKG_TO_MASK_V(few) ? counted : shown[c][r];
            }
#endif
        }
#if SKG_WORLD
        highest[r] -= coefficients[world_plane] * surroundings[r]; /* what the parts alone subtract is told */
#endif
    }
#endif
    SKG_UNROLL for (int r = 0; r < SKG_RUNS; r++) {
        const int at = column + r * SKG_WIDE, pixels = frame.columns - at;
        if (pixels <= 0) break;
        SKG_UNROLL for (int c = 0; c < SKG_CHANNELS; c++)
            skg_show(shown[c][r], output + offset + row * row_stride + c * channel_stride + at, pixels);
        skg_count(highest[r], limit, pixels, negative);
    }
}

/* Means of several passes as attenuation: -ln, of at least the smallest normal float. One work-item a run. */
__kernel void skg_logarithm(int columns, int rows, int channels, __global skg_out *output, long offset,
                            long row_stride, long channel_stride) {
    const int column = SKG_WIDE * (int)get_global_id(0), row = (int)get_global_id(1);
    if (column >= columns || row >= rows) return;
    for (int c = 0; c < channels; c++) {
        __global skg_out *place = output + offset + row * row_stride + c * channel_stride + column;
        skg_out mean[SKG_WIDE];
        for (int k = 0; k < SKG_WIDE; k++) mean[k] = place[min(k, columns - column - 1)];
        const skg_realv value = SKG_OUT_TO_REAL_V(SKG_LOAD_V(0, mean));
        const skg_realv least = (skg_realv)(0x1p-126f);
        const skg_realv result = -skg_log_v(value > least ? value : least);
        SKG_STORE_V(SKG_TO_OUT_V(result), 0, mean);
        for (int k = 0; k < min(SKG_WIDE, columns - column); k++) place[k] = mean[k];
    }
}
