/* From sums of path parameters to what a pixel shows. Plane p of a pixel is x_p = sum / scale * |ray|, in mm times the
 * plane's weights. The exponent of node n is the sum over planes of coefficient[n][p] * x_p, and channel c shows the sum over
 * nodes of weight[n][c] * exp(-exponent_n). The host multiplies coefficients by -log2(e), because powers of two are computed. */

#if SKG_DOUBLE
#define SKG_LN2 0.693147180559945309417
#else
#define SKG_LN2 0.693147180559945309417f
#endif

#define SKG_OUT_TO_REAL_V SKG_CAT(SKG_CAT(convert_, SKG_SCALAR), SKG_WIDE)

/* Values as the image has them: of its type; with half precision rounded to binary16, in a unit of which 1 is half_unit (energies are
 * rounded in MeV). */
static void skg_of_image(skg_realv value, float half_unit, skg_out *lanes) {
    SKG_STORE_V(outv, SKG_TO_OUT_V(value), lanes);
#if SKG_HALF
    for (int k = 0; k < SKG_WIDE; k++) lanes[k] = (skg_out)(skg_to_half((float)lanes[k] * half_unit) / half_unit);
#endif
}

/* Arguments of the stores of an image: how values are rounded, and whether they are added to the values there. */
typedef struct {
    float half_unit;
    int add;
} skg_storing;

static skg_storing skg_storing_of(const skg_strip *strip) {
    const skg_storing storing = {strip->args.energies ? 0.001f : 1.0f, strip->args.add};
    return storing;
}

#if SKG_FINE > 1
/* Pixels of the image that the runs show. */
#define SKG_SHOWN (SKG_RUNS * SKG_WIDE / SKG_FINE)

/* Adds one row of rays to the pixels of the image from `place` on, in the order of passes: along the row, then down.
 * row: of the pixels' rows of rays; pixels: how many the image has from there on. */
static void skg_show_rays(const skg_realv *values, skg_storing storing, __global skg_out *place, int row, int pixels) {
    skg_out rays[SKG_RUNS * SKG_WIDE], sums[SKG_SHOWN];
    const int count = min(pixels, SKG_SHOWN);
    SKG_EACH_RUN skg_of_image(values[r], storing.half_unit, rays + r * SKG_WIDE);
    for (int k = 0; k < SKG_SHOWN; k++) sums[k] = (storing.add || row > 0) && k < count ? place[k] : (skg_out)(0);
    for (int k = 0; k < SKG_SHOWN; k++)
        for (int a = 0; a < SKG_FINE; a++) sums[k] += rays[k * SKG_FINE + a];
    for (int k = 0; k < count; k++) place[k] = sums[k];
}
#endif

/* Rare ways are functions of their own, so that there is little to compile. They take copies of vectors, because an array that
 * is reached by an address or a variable index stays in memory. */

/* Stores the end of a row for skg_show; with SKG_HALF, all of it. */
SKG_APART void skg_show_some(const skg_realv *values, const skg_storing *storing, __global skg_out *place, int pixels) {
    for (int r = 0; r * SKG_WIDE < pixels && r < SKG_RUNS; r++) {
        skg_out lanes[SKG_WIDE];
        skg_of_image(values[r], storing->half_unit, lanes);
        for (int k = 0; k < min(pixels - r * SKG_WIDE, SKG_WIDE); k++, place++)
            *place = storing->add ? *place + lanes[k] : lanes[k];
    }
}

/* Writes the pixels of all runs, as far as there are any. */
static void skg_show(const skg_realv *values, skg_storing storing, __global skg_out *place, int pixels) {
    if (!SKG_HALF && pixels >= SKG_RUNS * SKG_WIDE) {
        SKG_EACH_RUN {
            skg_outv shown = SKG_TO_OUT_V(values[r]);
            __global skg_out *to = place + r * SKG_WIDE;
            if (storing.add) shown += SKG_LOAD_GLOBAL_V(outv, to);
            SKG_STORE_GLOBAL_V(outv, shown, to);
        }
        return;
    }
    skg_realv kept[SKG_RUNS];
    SKG_EACH_RUN kept[r] = values[r];
    skg_show_some(kept, &storing, place, pixels);
}

/* The exponent of one node for each run: the sum over planes of coefficient times mm. */
static void skg_exponents(__constant const skg_real *coefficient, const skg_pixels *pixels, skg_realv *exponent) {
#if SKG_GENERAL
    SKG_EACH_RUN exponent[r] = (skg_realv)(0);
    for (int k = 0; k < pixels->filled; k++)
        SKG_EACH_RUN exponent[r] = fma((skg_realv)(coefficient[pixels->plane[k]]), pixels->mm[k][r], exponent[r]);
#else
    SKG_EACH_RUN exponent[r] = coefficient[0] * pixels->x[0][r];
    SKG_EACH_PLANE(1) SKG_EACH_RUN exponent[r] = fma((skg_realv)(coefficient[p]), pixels->x[p][r], exponent[r]);
#endif
}

SKG_APART void skg_count_some(const skg_realv *values, skg_real limit, int pixels, __global int *count) {
    int found = 0;
    for (int r = 0; r < SKG_RUNS; r++) {
        int lanes[SKG_WIDE];
        SKG_STORE_V(intv, SKG_TO_INT_V(values[r] > (skg_realv)(limit)), lanes);
        for (int k = 0; k < min(pixels - r * SKG_WIDE, SKG_WIDE); k++) found -= lanes[k];
    }
    if (found) atomic_add(count, found);
}

/* Counts the pixels of all runs that exceed the limit. */
static void skg_count(const skg_realv *values, skg_real limit, int pixels, __global int *count) {
    skg_intv above = (skg_intv)(0);
    SKG_EACH_RUN above |= SKG_TO_INT_V(values[r] > (skg_realv)(limit));
    if (!skg_any(above)) return;
    skg_realv kept[SKG_RUNS];
    SKG_EACH_RUN kept[r] = values[r];
    skg_count_some(kept, limit, pixels, count);
}

/* Counts what is not finite once it is shown: NaN, infinity, and what rounds to infinity in binary16. */
static void skg_count_infinite(const skg_realv *shown, float half_unit, int pixels, __global int *count) {
    const skg_realv most = (skg_realv)(SKG_HALF ? (skg_real)65520 / (skg_real)half_unit : (skg_real)INFINITY);
    const skg_realv zero = (skg_realv)(0), one = (skg_realv)(1);
    skg_realv infinite[SKG_RUNS];
    SKG_EACH_RUN infinite[r] = fabs(shown[r]) < most ? zero : one;
    skg_count(infinite, 0, pixels, count);
}

/* Pixels that have a plane outside range[plane]. */
static void skg_count_outside(const skg_strip *strip, const skg_pixels *pixels) {
    __constant const skg_real *range = strip->range;
    skg_realv most[SKG_RUNS]; /* mm by which a plane is outside */
    SKG_EACH_RUN most[r] = (skg_realv)(range[0]) - pixels->x[0][r];
    SKG_EACH_PLANE(0) {
        SKG_EACH_RUN {
            const skg_realv below = (skg_realv)(range[2 * p]) - pixels->x[p][r];
            const skg_realv above = pixels->x[p][r] - (skg_realv)(range[2 * p + 1]);
            most[r] = below > most[r] ? below : most[r];
            most[r] = above > most[r] ? above : most[r];
        }
    }
    skg_count(most, 0, strip->args.layout.columns - strip->column, strip->negative + 1);
}

/* Exponents of so many nodes are kept for the logarithm, which takes the greatest of all off each; a GPU computes them again, because it
 * would keep them in memory. */
#define SKG_KEPT (SKG_WIDE > 1 ? 8 : 1)

/* shown = sum over nodes of weight * 2^power. For the logarithm it is divided by 2^highest, so that nothing underflows. */
static void skg_add_nodes(const skg_strip *strip, skg_pixels *pixels) {
    skg_realv power[SKG_RUNS];
    SKG_EACH_CHANNEL SKG_EACH_RUN pixels->shown[c][r] = (skg_realv)(0);
#if SKG_GENERAL
    SKG_EACH_CHANNEL SKG_EACH_RUN pixels->spread[c][r] = (skg_realv)(0);
#endif
    const int logarithm = SKG_SHOWN_OF(strip) == SKG_SHOW_LOGARITHM;
    skg_realv kept[SKG_KEPT][SKG_RUNS]; /* exponents of nodes */
    SKG_EACH_RUN kept[0][r] = pixels->highest[r];
    for (int n = 1; logarithm && n < strip->args.nodes; n++) {
        skg_exponents(strip->coefficients + n * SKG_PLANE_COUNT, pixels, power);
        SKG_EACH_RUN pixels->highest[r] = power[r] > pixels->highest[r] ? power[r] : pixels->highest[r];
        if (n < SKG_KEPT) SKG_EACH_RUN kept[n][r] = power[r];
    }
    for (int n = 0; n < strip->args.nodes; n++) {
        if (logarithm && n < SKG_KEPT)
            SKG_EACH_RUN power[r] = kept[n][r];
        else
            skg_exponents(strip->coefficients + n * SKG_PLANE_COUNT, pixels, power);
        if (logarithm) SKG_EACH_RUN power[r] -= pixels->highest[r];
        SKG_EACH_RUN {
            const skg_realv passed = skg_exp2_v(power[r]);
            SKG_EACH_CHANNEL pixels->shown[c][r] =
                fma((skg_realv)(strip->weights[n * SKG_CHANNELS + c]), passed, pixels->shown[c][r]);
#if SKG_GENERAL
            if (strip->args.noise) SKG_EACH_CHANNEL pixels->spread[c][r] =
                fma((skg_realv)(strip->variances[n * SKG_CHANNELS + c]), passed, pixels->spread[c][r]);
#endif
        }
    }
}

/* The amounts of the shades of run r. */
static void skg_copy_shades(const skg_strip *strip, const skg_pixels *pixels, int r, skg_realv *amounts) {
    amounts[0] = (skg_realv)(0); /* there may be none */
    SKG_EACH_PLANE(SKG_SUMMED) amounts[p - SKG_SUMMED] = pixels->x[p][r];
}

/* The power of two of node n in the flat field, in which there are the world and the shades alone, less `base`. */
static skg_realv skg_open_power(const skg_strip *strip, const skg_realv *amounts, int n, int r, skg_realv base) {
    skg_realv power = -base;
#if SKG_GENERAL
    if (strip->args.shades.count > 0) power += skg_shade_power(strip, amounts, n);
#endif
    if (SKG_HAS_WORLD(strip))
        power = fma((skg_realv)(strip->coefficients[n * SKG_PLANE_COUNT + strip->args.world_plane]), skg_world_v(strip, r), power);
    return power;
}

/* The greatest power of two of the flat field. */
static skg_realv skg_highest_flat_field(const skg_strip *strip, const skg_realv *amounts, int r) {
    const skg_realv zero = (skg_realv)(0);
    skg_realv highest = skg_open_power(strip, amounts, 0, r, zero);
    for (int n = 1; n < strip->args.nodes; n++) {
        const skg_realv power = skg_open_power(strip, amounts, n, r, zero);
        highest = power > highest ? power : highest;
    }
    return highest;
}

/* The sum over nodes of weight * 2^(power - base) for one channel of the flat field. */
static skg_realv skg_flat_field(const skg_strip *strip, const skg_realv *amounts, int channel, int r, skg_realv base) {
    skg_realv flat = (skg_realv)(0);
    for (int n = 0; n < strip->args.nodes; n++)
        flat = fma((skg_realv)(strip->weights[n * SKG_CHANNELS + channel]),
                   skg_exp2_v(skg_open_power(strip, amounts, n, r, base)), flat);
    return flat;
}

/* Factor of the intensities of run r: the plan's, times the falloff with the distance. */
static skg_realv skg_factor_v(const skg_strip *strip, int r) {
    const skg_realv factor = (skg_realv)(strip->args.factor);
    if (!SKG_FALLS_OFF(strip)) return factor;
    const skg_real foot = SKG_CURVED ? SKG_LINES_FALL(strip) : strip->args.foot;
    const skg_realv near = foot / skg_lengths_of(strip, strip->column + r * SKG_WIDE);
    return near * near * near * factor;
}

/* The logarithm of a sum over nodes, whose factor cancels, or its ratio to a flat field that differs from pixel to pixel, or both.
 * value: in and out; highest: that the sum was divided by the power of two of. */
SKG_APART void skg_compare(const skg_strip *strip, const skg_realv *amounts, const skg_realv *highest, int channel, int r,
                           skg_realv *value) {
    const int logarithm = SKG_SHOWN_OF(strip) == SKG_SHOW_LOGARITHM;
    if (logarithm) *value = -fma(*highest, (skg_realv)(SKG_LN2), skg_log_v(*value));
    if (!SKG_IS_RATIO(strip)) return;
    const skg_realv top = skg_highest_flat_field(strip, amounts, r);
    const skg_realv flat = skg_flat_field(strip, amounts, channel, r, top);
    if (logarithm)
        *value += fma(top, (skg_realv)(SKG_LN2), skg_log_v(flat));
    else
        *value = *value / flat * skg_exp2_v(-top) * skg_factor_v(strip, r);
}

/* From sums over nodes to what is shown of run r. */
static void skg_finish(const skg_strip *strip, skg_pixels *pixels, int r) {
    if (SKG_SHOWN_OF(strip) == SKG_SHOW_LOGARITHM || SKG_IS_RATIO(strip)) {
        skg_realv amounts[SKG_SHADES_MAX], highest = pixels->highest[r];
        skg_copy_shades(strip, pixels, r, amounts);
        SKG_EACH_CHANNEL {
            skg_realv value = pixels->shown[c][r];
            skg_compare(strip, amounts, &highest, c, r, &value);
            pixels->shown[c][r] = value;
        }
    } else {
        const skg_realv all = skg_factor_v(strip, r);
        SKG_EACH_CHANNEL {
            pixels->shown[c][r] *= all;
#if SKG_GENERAL
            if (!strip->args.noise) continue;
            const skg_realv noisy = skg_noisy_v(strip, pixels, r, c, all);
            if (strip->args.noise == SKG_NOISE_APART)
                pixels->spread[c][r] = noisy - pixels->shown[c][r];
            else
                pixels->shown[c][r] = noisy;
#endif
        }
    }
    /* Only what the parts subtract is counted as negative, by the first node; the highest one may be another. */
    int of_first = SKG_HAS_WORLD(strip) & (SKG_SHOWN_OF(strip) == SKG_SHOW_LOGARITHM);
#if SKG_GENERAL
    of_first |= strip->args.shades.count > 0;
#endif
    if (of_first) {
        pixels->highest[r] = (skg_realv)(0);
        SKG_EACH_SUMMED
        pixels->highest[r] = fma((skg_realv)(strip->coefficients[p]), pixels->x[p][r], pixels->highest[r]);
    }
    if (SKG_HAS_WORLD(strip))
        pixels->highest[r] -= strip->coefficients[strip->args.world_plane] * skg_world_v(strip, r);
}

/* Rays outside the window do not arrive. What noise has drawn for them is dropped. */
static void skg_collimate(const skg_strip *strip, skg_pixels *pixels) {
    /* The logarithm is that of skg_logarithm. */
    const skg_realv stopped =
        (skg_realv)(SKG_SHOWN_OF(strip) == SKG_SHOW_INTENSITY ? (skg_real)(0) : 126 * (skg_real)SKG_LN2);
    const int in_rows = strip->row >= strip->args.window[2] && strip->row < strip->args.window[3];
    const int from = strip->args.window[0], to = in_rows ? strip->args.window[1] : from;
    SKG_EACH_RUN {
        const skg_intv column = strip->column + r * SKG_WIDE + SKG_TO_INT_V(SKG_LANES);
        const skg_maskv arrives = SKG_TO_MASK_V((column >= from) & (column < to));
        SKG_EACH_CHANNEL {
            pixels->shown[c][r] = arrives ? pixels->shown[c][r] : stopped;
#if SKG_GENERAL
            pixels->spread[c][r] = arrives ? pixels->spread[c][r] : (skg_realv)(0);
#endif
        }
    }
}

#if SKG_CURVED
/* Rows of the raster are columns of the image, whose pixels lie apart. */
static void skg_show_apart(const skg_realv *values, const skg_strip *strip, const skg_storing *storing, int channel) {
    const size_t step = (size_t)strip->args.image.row_stride;
    __global skg_out *place = strip->output + strip->args.image.offset + channel * strip->args.image.channel_stride +
                              strip->row + (size_t)strip->column * step;
    const int pixels = strip->args.layout.columns - strip->column;
    for (int r = 0; r * SKG_WIDE < pixels && r < SKG_RUNS; r++) {
        skg_out lanes[SKG_WIDE];
        skg_of_image(values[r], storing->half_unit, lanes);
        for (int k = 0; k < min(pixels - r * SKG_WIDE, SKG_WIDE); k++, place += step)
            *place = storing->add ? *place + lanes[k] : lanes[k];
    }
}
#endif

/* Writes the values of a channel of the runs. */
static void skg_show_channel(const skg_strip *strip, const skg_realv *values, int channel) {
    __global skg_out *place = strip->output + strip->args.image.offset + channel * strip->args.image.channel_stride +
                              strip->row / SKG_FINE * strip->args.image.row_stride + strip->column / SKG_FINE;
    const int left = strip->args.layout.columns - strip->column;
    const skg_storing storing = skg_storing_of(strip);
    skg_count_infinite(values, storing.half_unit, left, strip->negative + 2);
#if SKG_CURVED
    skg_realv kept[SKG_RUNS];
    SKG_EACH_RUN kept[r] = values[r];
    (void)place;
    skg_show_apart(kept, strip, &storing, channel);
#elif SKG_FINE > 1
    skg_show_rays(values, storing, place, strip->row % SKG_FINE, left / SKG_FINE);
#else
    skg_show(values, storing, place, left);
#endif
}

/* Counts negative exponents. Of the rays of a pixel the last one counts, as the last of several passes does. */
static void skg_count_negative(const skg_strip *strip, const skg_pixels *pixels) {
    const int left = strip->args.layout.columns - strip->column;
#if SKG_FINE > 1
    skg_realv last[SKG_RUNS];
    if (strip->row % SKG_FINE < SKG_FINE - 1) return;
    SKG_EACH_RUN {
        const skg_intv column = strip->column + r * SKG_WIDE + SKG_TO_INT_V(SKG_LANES);
        const skg_intv counts = column % SKG_FINE == SKG_FINE - 1;
        last[r] = SKG_TO_MASK_V(counts) ? pixels->highest[r] : (skg_realv)(strip->args.limit);
    }
    skg_count(last, strip->args.limit, left, strip->negative);
#else
    skg_count(pixels->highest, strip->args.limit, left, strip->negative);
#endif
}

#if SKG_BOUNDED
/* Counts rays with a sum beyond its bound. */
static void skg_count_wrapped(const skg_strip *strip, const skg_pixels *pixels) {
    skg_realv wrapped[SKG_RUNS];
    skg_intv any = 0;
    SKG_EACH_RUN any |= pixels->wrapped[r];
    if (!skg_any(any)) return;
    SKG_EACH_RUN wrapped[r] = -SKG_TO_REAL_V(pixels->wrapped[r]);
    skg_count(wrapped, 0, strip->args.layout.columns - strip->column, strip->negative + 3);
}
#endif

/* SKG_RUNS runs of SKG_WIDE pixels of a row. */
static void skg_attenuate_runs(const skg_strip *strip) {
    skg_pixels pixels;
    skg_read_planes(strip, &pixels);
    if (strip->args.ranged) skg_count_outside(strip, &pixels);
#if SKG_GENERAL
    skg_list_planes(strip, &pixels);
#endif
    skg_exponents(strip->coefficients, &pixels, pixels.highest);
    if (SKG_SHOWN_OF(strip) == SKG_SHOW_EXPONENT) {
        SKG_EACH_RUN {
            pixels.shown[0][r] = pixels.highest[r];
            pixels.highest[r] = -pixels.highest[r];
        }
    } else {
        skg_add_nodes(strip, &pixels);
        SKG_EACH_RUN skg_finish(strip, &pixels, r);
    }
    if (SKG_IS_COLLIMATED(strip)) skg_collimate(strip, &pixels);
    SKG_EACH_CHANNEL skg_show_channel(strip, pixels.shown[c], c);
#if SKG_GENERAL
    if (strip->args.noise == SKG_NOISE_APART) SKG_EACH_CHANNEL skg_show_channel(strip, pixels.spread[c], SKG_CHANNELS + c);
#endif
    skg_count_negative(strip, &pixels);
#if SKG_BOUNDED
    skg_count_wrapped(strip, &pixels);
#endif
}

/* SKG_STRIP times as many pixels, as far as the row reaches; of all rows of rays that make a row of the image. */
SKG_APART void skg_attenuate_strip(const skg_strip *whole) {
    skg_strip strip = *whole; /* a copy that stores cannot alias */
    const int end = min(strip.column + SKG_STRIP * SKG_RUNS * SKG_WIDE, strip.args.layout.columns);
    for (int row = 0; row < SKG_FINE; row++, strip.row++)
        for (strip.column = whole->column; strip.column < end; strip.column += SKG_RUNS * SKG_WIDE)
            skg_attenuate_runs(&strip);
}

/* A work-item takes a strip of a row of the image. If SKG_FINE x SKG_FINE rays make a pixel of it, the pixels of
 * `args.layout` and of this comment are those of the rays. Buffers of effects that are off are NULL.
 *
 * args           skg_shared.h says what each member is
 * coefficients   of -exponent * log2(e), or of the exponent if that is shown
 * variances      of the nodes, as weights; with noise
 * lists          [args.sums accumulators][summed planes]: a unit of accumulator s adds lists[s][p] to plane p
 * range          [planes][2] mm: negative[1] counts the pixels that have a plane outside its range; NULL unless args.ranged
 * polynomials    [shades of heel and oblique scintillator][SKG_TERMS] coefficients of 1, z, z^2, ...
 * tables         of bow-tie and grid (lib/spectral/shading.h); of a curved detector, its lines stand before them
 * negative       negative[0] counts the pixels in which the power of two of the first node exceeds `args.limit` (the exponent
 *                is below -limit): more was subtracted for children than their parent has there
 *                negative[2] counts the values that are not finite
 *                negative[3] counts the rays with a sum of 32 bits beyond its bound
 * output         the image; with SKG_NOISE_APART, deviations follow behind the means of all channels */
__kernel void skg_attenuate(skg_attenuate_args args, __global const skg_sum *copies, __global const int *used,
                            __constant const skg_real *coefficients, __constant const skg_real *weights,
                            __constant const skg_real *variances, __constant const skg_real *lists,
                            __constant const skg_real *range, __constant const skg_real *polynomials,
                            __global const skg_real *tables, __global int *negative, __global skg_out *output) {
    skg_strip strip;
    strip.column = SKG_WIDE * SKG_RUNS * SKG_STRIP * (int)get_global_id(0);
    strip.row = SKG_FINE * (int)get_global_id(1);
    if (strip.row >= args.layout.rows) return;
    strip.args = args;
    strip.copies = copies;
    strip.used = used;
    strip.coefficients = coefficients;
    strip.weights = weights;
    strip.variances = variances;
    strip.lists = lists;
    strip.range = range;
    strip.polynomials = polynomials;
    strip.tables = tables;
#if SKG_CURVED
    strip.lines = tables;
    strip.tables = tables + SKG_LINES_SIZE(args.layout.rows);
#endif
    strip.negative = negative;
    strip.output = output;
    skg_attenuate_strip(&strip);
}

/* Turns means of several passes into attenuations: -ln of the mean, or of the smallest normal float if that is greater. One
 * work-item per run. */
__kernel void skg_logarithm(skg_image_args image, __global skg_out *output) {
    const int columns = image.columns, rows = image.rows;
    const int column = SKG_WIDE * (int)get_global_id(0), row = (int)get_global_id(1);
    if (column >= columns || row >= rows) return;
    for (int c = 0; c < image.channels; c++) {
        __global skg_out *place = output + image.offset + row * image.row_stride + c * image.channel_stride + column;
        skg_out mean[SKG_WIDE];
        for (int k = 0; k < SKG_WIDE; k++) mean[k] = place[min(k, columns - column - 1)];
        const skg_realv value = SKG_OUT_TO_REAL_V(SKG_LOAD_V(outv, mean));
        const skg_realv least = (skg_realv)(0x1p-126f);
        const skg_realv result = -skg_log_v(value > least ? value : least);
        SKG_STORE_V(outv, SKG_TO_OUT_V(result), mean);
        for (int k = 0; k < min(SKG_WIDE, columns - column); k++) place[k] = mean[k];
    }
}
