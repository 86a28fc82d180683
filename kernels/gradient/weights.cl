/* The transpose of attenuate.cl: from the derivative of a loss by the image to those by the sums. With x_p the mm of plane p,
 * the intensity of a channel is sum over n of weight_n 2^(power_n), and d 2^(power_n) / d x_p = ln 2 coefficient_np 2^(power_n). */

/* Planes of accumulators: SKG_WEIGHED of them, from which args.sums are mixed if that is not 0. */

/* Arguments of the weights, by the kernel's names. */
typedef struct {
    __global const skg_real *adjoint;
    __global const int *wanted;
    __global skg_real *weights;
    int channel, rays, of_planes, relative;
} skg_weighing;

/* Planes of accumulators that weights are made for. */
static int skg_weighed(const skg_strip *strip) {
    return strip->args.sums == 0 ? SKG_SUMMED : strip->args.sums;
}

/* Results of a work-item for its rays: see `most` and `of_rays` of the kernel. */
typedef struct {
    skg_realv most[SKG_WEIGHED];
    skg_realv lengths, across, down, intensity;
} skg_found;

/* The derivative of one channel by itself, of the runs. */
static void skg_choose_channel(const skg_strip *strip, int channel, skg_realv slope[SKG_CHANNELS][SKG_RUNS]) {
    SKG_EACH_RUN {
        const skg_maskv inside =
            SKG_TO_MASK_V(strip->column + r * SKG_WIDE + SKG_TO_INT_V(SKG_LANES) < strip->args.layout.columns);
        SKG_EACH_CHANNEL slope[c][r] = inside ? (skg_realv)(c == channel) : (skg_realv)(0);
    }
}

/* The derivatives of the runs by what their channels show; 0 behind the end of a row. */
static void skg_read_adjoint(const skg_strip *strip, __global const skg_real *adjoint,
                             skg_realv slope[SKG_CHANNELS][SKG_RUNS]) {
    const int columns = strip->args.layout.columns, across = columns / SKG_FINE, down = strip->args.layout.rows / SKG_FINE;
    SKG_EACH_CHANNEL {
        __global const skg_real *from = adjoint + ((long)c * down + strip->row / SKG_FINE) * across;
        SKG_EACH_RUN {
            if (SKG_FINE == 1 && strip->column + (r + 1) * SKG_WIDE <= columns) {
                slope[c][r] = SKG_LOAD_GLOBAL_V(realv, from + strip->column + r * SKG_WIDE);
                continue;
            }
            skg_real lanes[SKG_WIDE];
            for (int k = 0; k < SKG_WIDE; k++) {
                const int column = strip->column + r * SKG_WIDE + k;
                lanes[k] = column < columns ? from[column / SKG_FINE] : 0;
            }
            slope[c][r] = SKG_LOAD_V(realv, lanes);
        }
    }
}

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

/* Divides a derivative by the flat field, which differs from pixel to pixel. */
SKG_APART void skg_uncompare(const skg_strip *strip, const skg_realv *amounts, int channel, int r, skg_realv *value) {
    const skg_realv top = skg_highest_flat_field(strip, amounts, r);
    *value *= skg_exp2_v(-top) / skg_flat_field(strip, amounts, channel, r, top);
}

/* From derivatives by what is shown to those by the sums over nodes, of run r. */
static void skg_unfinish(const skg_strip *strip, const skg_pixels *pixels, skg_realv slope[SKG_CHANNELS][SKG_RUNS], int r) {
    if (SKG_SHOWN_OF(strip) == SKG_SHOW_LOGARITHM) {
        SKG_EACH_CHANNEL slope[c][r] =
            pixels->shown[c][r] > (skg_realv)(0) ? -slope[c][r] / pixels->shown[c][r] : (skg_realv)(0);
        return;
    }
    if (SKG_IS_RATIO(strip)) {
        skg_realv amounts[SKG_SHADES_MAX];
        skg_copy_shades(strip, pixels, r, amounts);
        SKG_EACH_CHANNEL {
            skg_realv value = slope[c][r];
            skg_uncompare(strip, amounts, c, r, &value);
            slope[c][r] = value;
        }
    }
    const skg_realv all = skg_factor_v(strip, r);
    SKG_EACH_CHANNEL slope[c][r] *= all;
}

/* Nodes that are added to the planes together, so that sums of many planes are loaded and stored more seldom. */
#define SKG_TOGETHER 8

/* The derivatives by the logarithm of the intensity of nodes first to first + count - 1, times ln 2; they are added to `shown`.
 * lifted: the intensities are divided by 2^highest. */
static void skg_slopes_of_nodes(const skg_strip *strip, const skg_pixels *pixels, skg_realv slope[SKG_CHANNELS][SKG_RUNS],
                                int lifted, int first, int count, skg_realv node[SKG_TOGETHER][SKG_RUNS], skg_realv *shown) {
    for (int n = 0; n < count; n++) {
        skg_realv power[SKG_RUNS];
        skg_exponents(strip->coefficients + (first + n) * SKG_PLANE_COUNT, pixels, power);
        if (lifted) SKG_EACH_RUN power[r] -= pixels->highest[r];
        SKG_EACH_RUN {
            skg_realv weight = (skg_realv)(0);
            SKG_EACH_CHANNEL
            weight = fma((skg_realv)(strip->weights[(first + n) * SKG_CHANNELS + c]), slope[c][r], weight);
            weight *= skg_exp2_v(power[r]);
            shown[r] += weight;
            node[n][r] = weight * (skg_real)SKG_LN2;
        }
    }
}

/* Adds up the derivatives by the mm of the planes that are needed, and by the logarithm of the intensity. */
static void skg_add_slopes(const skg_strip *strip, const skg_pixels *pixels, skg_realv slope[SKG_CHANNELS][SKG_RUNS],
                           int lifted, const uchar *needed, skg_realv total[SKG_PLANES][SKG_RUNS], skg_realv *shown) {
    for (int first = 0; first < strip->args.nodes; first += SKG_TOGETHER) {
        const int count = min(SKG_TOGETHER, strip->args.nodes - first);
        skg_realv node[SKG_TOGETHER][SKG_RUNS];
        skg_slopes_of_nodes(strip, pixels, slope, lifted, first, count, node, shown);
        SKG_EACH_SUMMED {
            if (!needed[p]) continue;
            __constant const skg_real *coefficient = strip->coefficients + first * SKG_PLANE_COUNT + p;
            skg_realv sum[SKG_RUNS];
            SKG_EACH_RUN sum[r] = total[p][r];
            for (int n = 0; n < count; n++)
                SKG_EACH_RUN sum[r] = fma((skg_realv)(coefficient[n * SKG_PLANE_COUNT]), node[n][r], sum[r]);
            SKG_EACH_RUN total[p][r] = sum[r];
        }
    }
}

/* Writes a plane of the runs. Rows of weights are as long as whole runs. */
static void skg_put_weights(const skg_strip *strip, int plane, const skg_realv *values, __global skg_real *weights) {
    __global skg_real *place = weights + (long)plane * strip->args.image.channel_stride +
                               (long)strip->row * strip->args.image.row_stride + strip->column;
    SKG_EACH_RUN {
        SKG_PREFETCH_STORE(place + (SKG_RUNS + r) * SKG_WIDE); /* of the next runs: too many planes for the machine's own */
        SKG_STORE_GLOBAL_V(realv, values[r], place + r * SKG_WIDE);
    }
}

/* Whether the runs meet the extent of a plane of accumulators. Elsewhere it has no hits, and its weights are not written. */
static int skg_meets(const skg_strip *strip, int plane) {
    const int4 extent =
        vload4(0, strip->used + SKG_EXTENT(strip->args.layout.copies, strip->args.layout.first_plane + plane));
    return strip->row >= extent.x && strip->row < extent.y && strip->column < extent.w &&
           strip->column + SKG_RUNS * SKG_WIDE > extent.z;
}

/* Writes a plane of accumulators, for a unit of which a mm has `values`, and keeps the largest magnitude; NaN stays. */
static void skg_put_sums(const skg_strip *strip, int plane, const skg_realv *values, const skg_realv *unit,
                         __global skg_real *weights, skg_realv *most) {
    skg_realv scaled[SKG_RUNS];
    SKG_EACH_RUN {
        scaled[r] = values[r] * unit[r];
        const skg_realv here = fabs(scaled[r]);
        most[plane] = here <= most[plane] ? most[plane] : here;
    }
    skg_put_weights(strip, plane, scaled, weights);
}

/* Which planes accumulators make whose weights are wanted and that have hits in the runs. In the others no length changes, but for the
 * world's. Returns 0 if there are none. */
static int skg_find_needed(const skg_strip *strip, const skg_weighing *weighing, uchar *needed) {
    int any = 0;
    for (int p = 0; p < SKG_SUMMED; p++) needed[p] = weighing->of_planes || p == strip->args.world_plane;
    for (int s = 0; s < skg_weighed(strip); s++) {
        if ((weighing->rays == SKG_RAYS_NONE && !weighing->wanted[s]) || !skg_meets(strip, s)) continue;
        any = 1;
        if (strip->args.sums == 0)
            needed[s] = 1;
        else
            for (int p = 0; p < SKG_SUMMED; p++) needed[p] |= strip->lists[s * SKG_SUMMED + p] != 0;
    }
    return any;
}

/* The two planes of rays, or their sums. length: of the rays; path, shown: of the planes. */
static void skg_put_rays(const skg_strip *strip, const skg_weighing *weighing, const skg_realv *length, const skg_realv *path,
                         const skg_realv *shown, skg_found *found) {
    if (weighing->rays == SKG_RAYS_PLANES) {
        skg_put_weights(strip, skg_weighed(strip), path, weighing->weights);
        skg_put_weights(strip, skg_weighed(strip) + 1, shown, weighing->weights);
    } else if (weighing->rays == SKG_RAYS_SUMS) {
        SKG_EACH_RUN {
            const skg_realv falls = SKG_FALLS_OFF(strip) ? 3 * shown[r] : (skg_realv)(0);
            const skg_realv share = (path[r] - falls) / (length[r] * length[r]);
            found->lengths += share;
            found->across = fma(share, (skg_real)(strip->column + r * SKG_WIDE) + SKG_LANES, found->across);
            found->down = fma(share, (skg_realv)((skg_real)strip->row), found->down);
            found->intensity += shown[r];
        }
    }
}

/* The whole power of two that is next to the intensity of a channel: that of each ray by itself, so that what is behind much has its
 * digits still where weights are integers of one scale for the image. It stands in `highest`, and is written. */
static void skg_lift(const skg_strip *strip, const skg_weighing *weighing, skg_pixels *pixels) {
    skg_strip other = *strip;
    other.args.shown = SKG_SHOW_LOGARITHM;
    skg_exponents(strip->coefficients, pixels, pixels->highest);
    skg_add_nodes(&other, pixels);
    SKG_EACH_RUN {
        const skg_realv shown = pixels->shown[weighing->channel][r];
        const skg_realv power = shown > (skg_realv)(0) ? skg_log_v(shown) * (skg_real)(1 / SKG_LN2) : (skg_realv)(0);
        pixels->highest[r] = floor(pixels->highest[r] + power);
    }
    skg_put_weights(strip, skg_weighed(strip) + 2, pixels->highest, weighing->weights);
}

static void skg_weigh_runs(const skg_strip *strip, const skg_weighing *weighing, skg_found *found) {
    skg_pixels pixels;
    skg_realv slope[SKG_CHANNELS][SKG_RUNS], total[SKG_PLANES][SKG_RUNS], unit[SKG_RUNS], length[SKG_RUNS];
    skg_realv path[SKG_RUNS], shown[SKG_RUNS];
    uchar needed[SKG_PLANES];
    if (!skg_find_needed(strip, weighing, needed) && !weighing->of_planes && weighing->rays == SKG_RAYS_NONE &&
        !weighing->relative)
        return;
    skg_read_planes(strip, &pixels);
    if (weighing->channel < 0)
        skg_read_adjoint(strip, weighing->adjoint, slope);
    else
        skg_choose_channel(strip, weighing->channel, slope);
    if (SKG_IS_COLLIMATED(strip)) skg_collimate_adjoint(strip, slope);
    SKG_EACH_RUN shown[r] = path[r] = (skg_realv)(0);
    SKG_EACH_SUMMED SKG_EACH_RUN total[p][r] = (skg_realv)(0);
    if (SKG_SHOWN_OF(strip) == SKG_SHOW_EXPONENT) {
        SKG_EACH_SUMMED SKG_EACH_RUN total[p][r] = strip->coefficients[p] * slope[0][r];
    } else {
#if SKG_GENERAL
        skg_list_planes(strip, &pixels);
#endif
        if (SKG_SHOWN_OF(strip) == SKG_SHOW_LOGARITHM) {
            skg_exponents(strip->coefficients, &pixels, pixels.highest);
            skg_add_nodes(strip, &pixels);
        } else if (weighing->relative) {
            skg_lift(strip, weighing, &pixels);
        }
        SKG_EACH_RUN skg_unfinish(strip, &pixels, slope, r);
        const int lifted = SKG_SHOWN_OF(strip) == SKG_SHOW_LOGARITHM || weighing->relative;
        skg_add_slopes(strip, &pixels, slope, lifted, needed, total, shown);
    }
    SKG_EACH_SUMMED SKG_EACH_RUN path[r] = fma(total[p][r], pixels.x[p][r], path[r]);
    if (weighing->of_planes) {
        SKG_EACH_SUMMED skg_put_weights(strip, p, total[p], weighing->weights);
        return;
    }
    SKG_EACH_RUN {
        const int at = min(strip->column + r * SKG_WIDE, strip->args.layout.columns - 1);
        length[r] = skg_lengths_of(strip, at);
        unit[r] = length[r] * strip->args.ray.unit;
    }
    skg_put_rays(strip, weighing, length, path, shown, found);
    if (strip->args.sums == 0) {
        SKG_EACH_SUMMED {
            if (!weighing->wanted[p] || !skg_meets(strip, p)) continue;
            skg_put_sums(strip, p, total[p], unit, weighing->weights, found->most);
        }
        return;
    }
    for (int s = 0; s < strip->args.sums; s++) {
        if (!weighing->wanted[s] || !skg_meets(strip, s)) continue;
        skg_realv sum[SKG_RUNS];
        SKG_EACH_RUN sum[r] = (skg_realv)(0);
        SKG_EACH_SUMMED {
            const skg_real share = strip->lists[s * SKG_SUMMED + p];
            if (share == 0) continue; /* true of most */
            SKG_EACH_RUN sum[r] = fma((skg_realv)(share), total[p][r], sum[r]);
        }
        skg_put_sums(strip, s, sum, unit, weighing->weights, found->most);
    }
}

static skg_real skg_sum_lanes(skg_realv v) {
    skg_real lanes[SKG_WIDE], sum = 0;
    SKG_STORE_V(realv, v, lanes);
    for (int k = 0; k < SKG_WIDE; k++) sum += lanes[k];
    return sum;
}

/* most, of_rays: a plane's, and a sum's, being `step` behind that before */
SKG_APART void skg_weigh_strip(const skg_strip *whole, const skg_weighing *weighing, __global skg_real *most,
                               __global skg_real *of_rays, int step) {
    skg_strip strip = *whole; /* copies that stores cannot alias */
    const skg_weighing own = *weighing;
    skg_found found;
    for (int p = 0; p < SKG_WEIGHED; p++) found.most[p] = (skg_realv)(0);
    found.lengths = found.across = found.down = found.intensity = (skg_realv)(0);
    const int end = min(strip.column + SKG_STRIP * SKG_RUNS * SKG_WIDE, strip.args.layout.columns);
    for (int row = 0; row < SKG_FINE; row++, strip.row++)
        for (strip.column = whole->column; strip.column < end; strip.column += SKG_RUNS * SKG_WIDE)
            skg_weigh_runs(&strip, &own, &found);
    if (own.rays == SKG_RAYS_SUMS) {
        of_rays[0] = skg_sum_lanes(found.lengths);
        of_rays[step] = skg_sum_lanes(found.across);
        of_rays[2 * (long)step] = skg_sum_lanes(found.down);
        of_rays[3 * (long)step] = skg_sum_lanes(found.intensity);
    }
    for (int p = 0; p < skg_weighed(&strip) && !own.of_planes; p++) {
        skg_real lanes[SKG_WIDE], result = 0;
        SKG_STORE_V(realv, found.most[p], lanes);
        for (int k = 0; k < SKG_WIDE; k++) result = lanes[k] <= result ? result : lanes[k];
        most[(long)p * step] = result;
    }
}

/* Arguments and work-items as of skg_attenuate, but for the last two buffers; `args.image` is the layout of the weights.
 *
 * adjoint   [channels][rows][columns] of the image: d loss / d what a pixel shows; used if channel < 0
 * channel   else: the loss is this channel of each pixel by itself
 * wanted    [planes] 0: the weights of this plane of accumulators are not written
 * rays      SKG_RAYS_...: what is made of the rays. NONE: nothing
 * weights   [planes + 3][rows of rays][row_stride]: d loss / d a unit of each plane of accumulators that is wanted, within its extent;
 *           with SKG_RAYS_PLANES then the sum over planes of mm times d loss / d mm; then d loss / d logarithm of the
 *           intensity. With of_planes instead: d loss / d mm of each plane that is mixed from accumulators, and nothing else
 * relative  1: all that is written of a ray is divided by a power of two near its intensity, whose exponent is written as the third plane
 *           behind those of accumulators; with channel >= 0, where intensities are shown
 * most      [planes][work-items] the largest magnitudes of the weights of accumulators
 * of_rays   [SKG_RAY_SUMS][work-items] SKG_RAYS_SUMS: sums over rays of what changes with their length, over its square: of what those two
 *           planes would have, the first less three times the second if intensities fall with the distance; of that times
 *           the column; and the row; and of the second */
__kernel void skg_weights(skg_attenuate_args args, __global const skg_sum *copies, __global const int *used,
                          __constant const skg_real *coefficients, __constant const skg_real *weights_of_nodes,
                          __constant const skg_real *lists, __constant const skg_real *polynomials,
                          __global const skg_real *tables, __global const skg_real *adjoint, int channel,
                          __global const int *wanted, int rays, int of_planes, int relative, __global skg_real *weights,
                          __global skg_real *most, __global skg_real *of_rays) {
    const int strips = (args.layout.columns + SKG_WIDE * SKG_RUNS * SKG_STRIP - 1) / (SKG_WIDE * SKG_RUNS * SKG_STRIP);
    skg_strip strip;
    strip.column = SKG_WIDE * SKG_RUNS * SKG_STRIP * (int)get_global_id(0);
    strip.row = SKG_FINE * (int)get_global_id(1);
    if (strip.row >= args.layout.rows || (int)get_global_id(0) >= strips) return;
    strip.args = args;
    strip.copies = copies;
    strip.used = used;
    strip.coefficients = coefficients;
    strip.weights = weights_of_nodes;
    strip.lists = lists;
    strip.polynomials = polynomials;
    strip.tables = tables;
    const long item = (long)get_global_id(1) * strips + get_global_id(0);
    const skg_weighing weighing = {adjoint, wanted, weights, channel, rays, of_planes, relative};
    skg_weigh_strip(&strip, &weighing, most + item, of_rays + item, strips * (args.layout.rows / SKG_FINE));
}
