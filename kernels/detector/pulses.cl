/* Turns the counts of independent pixels into those of a counting detector: photons that count beside the pixel that they enter, noise that
 * neighbours and windows share, and dead time. A pixel beyond the border has the value of the nearest one. One work-item per pixel.
 *
 * from      images of all channels and, with args.noise, those of their deviations behind them
 * weights   first the share of the exposure that a dead time is; then [channels][square] of the means, and [channel][from which][square] of
 *           the deviations, with squares of 2 args.reach + 1 pixels; with SKG_MOVES, then [channels][SKG_PULSE_STEPS] of pile_up.clh, and
 *           [channels][SKG_PULSE_STEPS] heights of the pulses of each window, as the open beam has them */
#if SKG_DOUBLE
SKG_DEFINE_EXP2_DOUBLE(skg_exp2_of, double, long, as_double, as_long)
#define SKG_LOG2_E 1.44269504088896340736
#else
SKG_DEFINE_EXP2_FLOAT(skg_exp2_of, float, int, as_float, as_int)
#define SKG_LOG2_E 1.44269504088896340736f
#endif
SKG_DEFINE_ROOT(skg_root_of, float, uint, as_float, as_uint)
#if SKG_MOVES
SKG_DEFINE_LOG_FLOAT(skg_log_of, float, int, as_float, as_int, convert_float)
SKG_DEFINE_PHILOX(skg_philox_of, uint, mul_hi)
SKG_DEFINE_NORMAL(skg_normal_of, float, uint, convert_float, as_float, as_uint, skg_log_of)
SKG_DEFINE_PILE_UP(skg_pile_up, skg_real, __global)
#endif

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

/* Recorded share of n pulses for each dead time, and the variance of their number over its mean. */
static skg_real skg_dead(int pile_up, skg_real n, skg_real *fano) {
    const skg_real shorter = (skg_real)(1) / ((skg_real)(1) + n);
    const skg_real longer = skg_exp2_of(-n * SKG_LOG2_E);
    const skg_real left = pile_up == SKG_PILE_UP_PULSES_END ? longer : shorter;
    *fano = pile_up == SKG_PILE_UP_PULSES_END ? (skg_real)(1) - (skg_real)(2) * n * longer : shorter * shorter;
    return left;
}

#if SKG_MOVES
/* The shares of all pulses that each window records if pulses overlap. table: behind the weights */
static void skg_move(const skg_pulses_args *args, __global const skg_real *table, skg_real n, skg_real *shares) {
    const int channels = args->to.channels;
    __global const skg_real *alone = table + channels * SKG_PULSE_STEPS;
    const skg_real few = min(n, (skg_real)(SKG_PULSES_MOST));
    skg_real heights[SKG_PULSE_STEPS];
    for (int j = args->first - 1; j < SKG_PULSE_STEPS; j++) {
        heights[j] = (skg_real)(0);
        for (int c = 0; c < channels; c++) heights[j] = fma(shares[c], alone[c * SKG_PULSE_STEPS + j], heights[j]);
    }
    skg_pile_up(args->pile_up == SKG_PILE_UP_PULSES_END, channels, args->first, few, skg_exp2_of(-few * SKG_LOG2_E), heights, table,
                shares);
}

/* A normal deviate of a pixel for each window. */
static void skg_draw_moved(const skg_pulses_args *args, int pixel, float *deviates) {
    for (int c = 0; c < args->to.channels; c += 4) {
        uint draw[4] = {(uint)pixel, SKG_DRAW_WORD(SKG_DRAW_ELECTRONIC, c, 1), (uint)args->key.frame[0], (uint)args->key.frame[1]};
        skg_philox_of(draw, (uint)args->key.seed[0], (uint)args->key.seed[1]);
        for (int k = 0; k < 4; k++) deviates[c + k] = skg_normal_of(draw[k]);
    }
}
#endif

/* Dead time: some pulses are lost, and with SKG_MOVES some are recorded in another window. Of the noise of their number what is left
 * follows from its variance; which window each that is left falls into is as random as before. What a window records beyond its own
 * pulses has noise of its own. */
static void skg_lose(const skg_pulses_args *args, __global const skg_real *weights, int pixel, const skg_real *mean,
                     const skg_real *noise, skg_real *shown) {
    const int channels = args->to.channels;
    skg_real all = (skg_real)(0), moved = (skg_real)(0), fano, off[SKG_CHANNELS_COUNTED];
    for (int c = 0; c < channels; c++) all += max(mean[c], (skg_real)(0));
    const skg_real n = all * weights[0], left = skg_dead(args->pile_up, n, &fano);
#if SKG_MOVES
    skg_real share[SKG_CHANNELS_COUNTED];
    float deviates[SKG_CHANNELS_COUNTED];
    const int square = (2 * args->reach + 1) * (2 * args->reach + 1);
    for (int c = 0; c < channels; c++) share[c] = all > 0 ? max(mean[c], (skg_real)(0)) / all : (skg_real)(0);
    skg_move(args, weights + 1 + channels * (1 + channels) * square, n, share);
    if (args->noise) skg_draw_moved(args, pixel, deviates);
#endif
    for (int c = 0; c < channels; c++) {
#if SKG_MOVES
        const skg_real own = min(max(all * share[c], (skg_real)(0)), left * mean[c]);
        off[c] = mean[c] > 0 ? noise[c] * skg_root_of((float)(own / mean[c])) : (skg_real)(0);
        if (args->noise) off[c] += skg_root_of((float)max(all * share[c] - own, (skg_real)(0))) * deviates[c];
        shown[c] = all * share[c];
#else
        off[c] = noise[c] * skg_root_of((float)left);
        shown[c] = left * mean[c];
#endif
        moved += off[c];
    }
    const skg_real together = skg_root_of((float)fano), counted = left * all;
    const skg_real each = counted > 0 ? (skg_real)(1) / counted : (skg_real)(0);
    for (int c = 0; c < channels; c++) {
        const skg_real part = shown[c] * each;
        shown[c] += fma(together, part * moved, off[c] - part * moved);
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
    if (args.pile_up) skg_lose(&args, weights, row * args.to.columns + column, mean, noise, shown);
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
