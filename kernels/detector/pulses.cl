/* What a detector that counts makes of the counts of independent pixels: photons that count beside the pixel that they enter, noise that
 * neighbours and windows share, and dead time. A pixel beyond the border has the value of the nearest one. One work-item per pixel.
 *
 * from      images of all channels and, with args.noise, those of their deviations behind them
 * weights   first the share of the exposure that a dead time is; then [channels][square] of the means, and [channel][from which][square] of
 *           the deviations, with squares of 2 args.reach + 1 pixels */
#if SKG_DOUBLE
SKG_DEFINE_EXP2_DOUBLE(skg_exp2_of, double, long, as_double, as_long)
#define SKG_LOG2_E 1.44269504088896340736
#else
SKG_DEFINE_EXP2_FLOAT(skg_exp2_of, float, int, as_float, as_int)
#define SKG_LOG2_E 1.44269504088896340736f
#endif
SKG_DEFINE_ROOT(skg_root_of, float, uint, as_float, as_uint)

/* The sum of a square about a pixel, weighted. */
static skg_real skg_square(const skg_pulses_args *args, __global const skg_real *from, __global const skg_real *weights, int column,
                           int row) {
    const int reach = args->reach, side = 2 * reach + 1;
    skg_real sum = (skg_real)(0);
    for (int j = -reach; j <= reach; j++) {
        __global const skg_real *line = from + clamp(row - j, 0, args->to.rows - 1) * args->from.row_stride;
        for (int i = -reach; i <= reach; i++)
            sum = fma(weights[(j + reach) * side + i + reach], line[clamp(column - i, 0, args->to.columns - 1)], sum);
    }
    return sum;
}

/* What dead time leaves of n pulses for each: their share, and the variance of their number over its mean. */
static skg_real skg_dead(int pile_up, skg_real n, skg_real *fano) {
    const skg_real shorter = (skg_real)(1) / ((skg_real)(1) + n);
    const skg_real longer = skg_exp2_of(-n * SKG_LOG2_E);
    const skg_real left = pile_up == SKG_PILE_UP_PULSES_END ? longer : shorter;
    *fano = pile_up == SKG_PILE_UP_PULSES_END ? (skg_real)(1) - (skg_real)(2) * n * longer : shorter * shorter;
    return left;
}

/* Dead time: pulses are lost whatever their window. Of the noise of their number what is left follows from its variance; which window each
 * that is left falls into is as random as before. */
static void skg_lose(int pile_up, int channels, skg_real share, const skg_real *mean, skg_real *noise, skg_real *shown) {
    skg_real all = (skg_real)(0), moved = (skg_real)(0), fano;
    for (int c = 0; c < channels; c++) all += mean[c], moved += noise[c];
    const skg_real left = skg_dead(pile_up, max(all, (skg_real)(0)) * share, &fano);
    const skg_real together = skg_root_of((float)(left * fano)), alone = skg_root_of((float)left);
    for (int c = 0; c < channels; c++) {
        const skg_real part = all > 0 ? mean[c] / all : (skg_real)(0);
        shown[c] = fma(left, mean[c], fma(together, part * moved, alone * (noise[c] - part * moved)));
    }
}

__kernel void skg_pulses(skg_pulses_args args, __global const skg_real *from, __global const skg_real *weights,
                         __global skg_real *to) {
    const int column = (int)get_global_id(0), row = (int)get_global_id(1), channels = args.to.channels;
    const int square = (2 * args.reach + 1) * (2 * args.reach + 1);
    if (column >= args.to.columns || row >= args.to.rows) return;
    skg_real mean[SKG_CHANNELS_COUNTED], noise[SKG_CHANNELS_COUNTED], shown[SKG_CHANNELS_COUNTED];
    from += args.from.offset;
    to += args.to.offset + row * args.to.row_stride + column;
    for (int c = 0; c < channels; c++) {
        __global const skg_real *own = weights + 1 + (channels + c * channels) * square;
        mean[c] = skg_square(&args, from + c * args.from.channel_stride, weights + 1 + c * square, column, row);
        noise[c] = (skg_real)(0);
        for (int k = 0; args.noise && k < channels; k++)
            noise[c] += skg_square(&args, from + (channels + k) * args.from.channel_stride, own + k * square, column, row);
        shown[c] = mean[c] + noise[c];
    }
    if (args.pile_up) skg_lose(args.pile_up, channels, weights[0], mean, noise, shown);
    for (int c = 0; c < channels; c++) to[c * args.to.channel_stride] = shown[c];
}

/* The variances of pixels whose deviations are independent, through the weights of the deviations. A pixel on the border stands for those
 * beyond it, whose weights add up before they are squared. */
__kernel void skg_pulses_variance(skg_pulses_args args, __global const skg_real *from, __global const skg_real *weights,
                                  __global skg_real *to) {
    const int column = (int)get_global_id(0), row = (int)get_global_id(1), channel = (int)get_global_id(2);
    const int columns = args.to.columns, rows = args.to.rows, channels = args.to.channels;
    const int reach = args.reach, side = 2 * reach + 1;
    if (column >= columns || row >= rows) return;
    skg_real sum = (skg_real)(0);
    weights += 1 + (channels + channel * channels) * side * side + reach * side + reach;
    from += args.from.offset;
    for (int k = 0; k < channels; k++, weights += side * side, from += args.from.channel_stride)
        for (int j = max(row - reach, 0); j <= min(row + reach, rows - 1); j++) {
            const int top = j == 0 ? row - reach : j, bottom = j == rows - 1 ? row + reach : j;
            for (int i = max(column - reach, 0); i <= min(column + reach, columns - 1); i++) {
                const int left = i == 0 ? column - reach : i, right = i == columns - 1 ? column + reach : i;
                skg_real weight = (skg_real)(0);
                for (int y = min(top, j); y <= max(bottom, j); y++)
                    for (int x = min(left, i); x <= max(right, i); x++)
                        weight += weights[(row - y) * side + column - x];
                sum = fma(weight * weight, from[j * args.from.row_stride + i], sum);
            }
        }
    to[args.to.offset + channel * args.to.channel_stride + row * args.to.row_stride + column] = sum;
}
