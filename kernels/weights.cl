/* The transpose of attenuate.cl: from the derivative of a loss by the image to those by the sums. With x_p the mm of plane p,
 * the intensity of a channel is sum over n of weight_n 2^(power_n), and d 2^(power_n) / d x_p = ln 2 coefficient_np 2^(power_n). */

/* The derivatives of the runs by what their channels show; 0 behind the end of a row. */
static void skg_read_adjoint(const skg_strip *strip, __global const skg_real *adjoint,
                             skg_realv slope[SKG_CHANNELS][SKG_RUNS]) {
    const int columns = strip->args.layout.columns, across = columns / SKG_FINE, down = strip->args.layout.rows / SKG_FINE;
    SKG_EACH_CHANNEL {
        __global const skg_real *from = adjoint + ((long)c * down + strip->row / SKG_FINE) * across;
        SKG_EACH_RUN {
            skg_real lanes[SKG_WIDE];
            for (int k = 0; k < SKG_WIDE; k++) {
                const int column = strip->column + r * SKG_WIDE + k;
                lanes[k] = column < columns ? from[column / SKG_FINE] : 0;
            }
            slope[c][r] = SKG_LOAD_V(realv, lanes);
        }
    }
}

#if SKG_COLLIMATED
/* Rays that jaws stop do not depend on the parts. */
static void skg_collimate_adjoint(const skg_strip *strip, skg_realv slope[SKG_CHANNELS][SKG_RUNS]) {
    const int in_rows = strip->row >= strip->args.window[2] && strip->row < strip->args.window[3];
    const int from = strip->args.window[0], to = in_rows ? strip->args.window[1] : from;
    SKG_EACH_RUN {
        const skg_intv column = strip->column + r * SKG_WIDE + SKG_TO_INT_V(SKG_LANES);
        const skg_maskv arrives = SKG_TO_MASK_V((column >= from) & (column < to));
        SKG_EACH_CHANNEL slope[c][r] = arrives ? slope[c][r] : (skg_realv)(0);
    }
}
#endif

#if SKG_SHOW != SKG_SHOW_EXPONENT
/* From derivatives by what is shown to those by the sums over nodes, of run r. */
static void skg_unfinish(const skg_strip *strip, const skg_pixels *pixels, skg_realv slope[SKG_CHANNELS][SKG_RUNS], int r) {
#if SKG_SHOW == SKG_SHOW_LOGARITHM
    SKG_EACH_CHANNEL slope[c][r] = pixels->shown[c][r] > (skg_realv)(0) ? -slope[c][r] / pixels->shown[c][r] : (skg_realv)(0);
#else
#if SKG_FALLOFF
    const skg_realv near =
        strip->args.foot / skg_ray_lengths_v(&strip->args.ray, strip->column + r * SKG_WIDE, strip->row);
    const skg_realv all = near * near * near * strip->args.factor;
#else
    const skg_realv all = (skg_realv)(strip->args.factor);
#endif
#if SKG_RATIO
    const skg_realv top = skg_highest_flat_field(strip, pixels, r);
    SKG_EACH_CHANNEL slope[c][r] *= skg_exp2_v(-top) / skg_flat_field(strip, pixels, c, r, top);
#endif
    SKG_EACH_CHANNEL slope[c][r] *= all;
#endif
}

/* Adds up the derivatives by the mm of the planes, and by the logarithm of the intensity. */
static void skg_add_slopes(const skg_strip *strip, const skg_pixels *pixels, skg_realv slope[SKG_CHANNELS][SKG_RUNS],
                           skg_realv total[SKG_SUMMED][SKG_RUNS], skg_realv *shown) {
    for (int n = 0; n < strip->args.nodes; n++) {
        __constant const skg_real *coefficient = strip->coefficients + n * SKG_PLANES;
        skg_realv power[SKG_RUNS];
        skg_exponents(coefficient, pixels, power);
        SKG_EACH_RUN {
#if SKG_SHOW == SKG_SHOW_LOGARITHM
            power[r] -= pixels->highest[r];
#endif
            skg_realv weight = (skg_realv)(0);
            SKG_EACH_CHANNEL weight = fma((skg_realv)(strip->weights[n * SKG_CHANNELS + c]), slope[c][r], weight);
            weight *= skg_exp2_v(power[r]);
            shown[r] += weight;
            power[r] = weight * (skg_real)SKG_LN2;
        }
        SKG_EACH_SUMMED SKG_EACH_RUN total[p][r] = fma((skg_realv)(coefficient[p]), power[r], total[p][r]);
    }
}
#endif

/* Writes a plane of the runs. Rows of weights are as long as whole runs. */
static void skg_put_weights(const skg_strip *strip, int plane, const skg_realv *values, __global skg_real *weights) {
    __global skg_real *place = weights + (long)plane * strip->args.image.channel_stride +
                               (long)strip->row * strip->args.image.row_stride + strip->column;
    SKG_EACH_RUN SKG_STORE_GLOBAL_V(realv, values[r], place + r * SKG_WIDE);
}

static void skg_weigh_runs(const skg_strip *strip, __global const skg_real *adjoint, __global skg_real *weights, int planes) {
    skg_pixels pixels;
    skg_realv slope[SKG_CHANNELS][SKG_RUNS], total[SKG_SUMMED][SKG_RUNS], unit[SKG_RUNS], path[SKG_RUNS], shown[SKG_RUNS];
    skg_read_planes(strip, &pixels);
    skg_read_adjoint(strip, adjoint, slope);
#if SKG_COLLIMATED
    skg_collimate_adjoint(strip, slope);
#endif
    SKG_EACH_RUN shown[r] = path[r] = (skg_realv)(0);
    SKG_EACH_SUMMED SKG_EACH_RUN total[p][r] = (skg_realv)(0);
#if SKG_SHOW == SKG_SHOW_EXPONENT
    SKG_EACH_SUMMED SKG_EACH_RUN total[p][r] = strip->coefficients[p] * slope[0][r];
#else
#if SKG_SPARSE
    skg_list_planes(&pixels);
#endif
#if SKG_SHOW == SKG_SHOW_LOGARITHM
    skg_exponents(strip->coefficients, &pixels, pixels.highest);
    skg_add_nodes(strip, &pixels);
#endif
    SKG_EACH_RUN skg_unfinish(strip, &pixels, slope, r);
    skg_add_slopes(strip, &pixels, slope, total, shown);
#endif
    SKG_EACH_SUMMED SKG_EACH_RUN path[r] = fma(total[p][r], pixels.x[p][r], path[r]);
#if SKG_WEIGH_PLANES
    SKG_EACH_SUMMED skg_put_weights(strip, p, total[p], weights);
    return;
#endif
    SKG_EACH_RUN {
        const int at = min(strip->column + r * SKG_WIDE, strip->args.layout.columns - 1);
        unit[r] = skg_ray_lengths_v(&strip->args.ray, at, strip->row) * strip->args.ray.unit;
    }
#if SKG_SUMS
    for (int s = 0; s < SKG_SUMS; s++) {
        skg_realv sum[SKG_RUNS];
        SKG_EACH_RUN sum[r] = (skg_realv)(0);
        SKG_EACH_SUMMED SKG_EACH_RUN sum[r] = fma((skg_realv)(strip->lists[s * SKG_SUMMED + p]), total[p][r], sum[r]);
        SKG_EACH_RUN sum[r] *= unit[r];
        skg_put_weights(strip, s, sum, weights);
    }
#else
    SKG_EACH_SUMMED {
        SKG_EACH_RUN total[p][r] *= unit[r];
        skg_put_weights(strip, p, total[p], weights);
    }
#endif
    skg_put_weights(strip, planes, path, weights);
    skg_put_weights(strip, planes + 1, shown, weights);
}

SKG_APART void skg_weigh_strip(const skg_strip *whole, __global const skg_real *adjoint, __global skg_real *weights, int planes) {
    skg_strip strip = *whole; /* a copy that stores cannot alias */
    const int end = min(strip.column + SKG_STRIP * SKG_RUNS * SKG_WIDE, strip.args.layout.columns);
    for (int row = 0; row < SKG_FINE; row++, strip.row++)
        for (strip.column = whole->column; strip.column < end; strip.column += SKG_RUNS * SKG_WIDE)
            skg_weigh_runs(&strip, adjoint, weights, planes);
}

/* Arguments and work-items as of skg_attenuate, but for the last two buffers; `args.image` is the layout of the weights.
 *
 * adjoint   [channels][rows][columns] of the image: d loss / d what a pixel shows
 * weights   [planes + 2][rows of rays][row_stride]: d loss / d a unit of each plane of accumulators; then the sum over planes
 *           of mm times d loss / d mm; then d loss / d logarithm of the intensity. With SKG_WEIGH_PLANES instead: d loss / d mm
 *           of each plane that is mixed from accumulators */
__kernel void skg_weights(skg_attenuate_args args, __global const skg_sum *copies, __global const int *used,
                          __constant const skg_real *coefficients, __constant const skg_real *weights_of_nodes,
                          __constant const skg_real *lists, __constant const skg_real *polynomials,
                          __global const skg_real *tables, __global const skg_real *adjoint, __global skg_real *weights) {
    skg_strip strip;
    strip.column = SKG_WIDE * SKG_RUNS * SKG_STRIP * (int)get_global_id(0);
    strip.row = SKG_FINE * (int)get_global_id(1);
    if (strip.row >= args.layout.rows) return;
    strip.args = args;
    strip.copies = copies;
    strip.used = used;
    strip.coefficients = coefficients;
    strip.weights = weights_of_nodes;
    strip.lists = lists;
    strip.polynomials = polynomials;
    strip.tables = tables;
    skg_weigh_strip(&strip, adjoint, weights, SKG_SUMS ? SKG_SUMS : SKG_SUMMED);
}
