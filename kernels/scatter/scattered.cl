/* Adds scatter, given on a coarse grid, to the intensities of an image. */
typedef skg_floatv skg_loose_floatv __attribute__((aligned(sizeof(float))));

/* The noise of one channel: photons that arrive by different ways are independent. pixel: the first one's number. */
static skg_floatv skg_scattered_noise(const skg_scattered_args *args, skg_floatv value, __global const float *variance, int pixel,
                                      int pixels, int channel) {
    float variances[SKG_WIDE];
    for (int k = 0; k < SKG_WIDE; k++) variances[k] = variance[min(k, pixels - 1)];
    const skg_floatv spread = SKG_LOAD_V(floatv, variances) * (skg_floatv)((float)args->key.parts);
    const skg_floatv expected = value * value / max(spread, (skg_floatv)(1e-30f));
    const skg_intv many = expected > (skg_floatv)(SKG_FEW), some = spread > (skg_floatv)(1e-30f);
    skg_uintv draw[4];
    skg_draw_v(&args->key, pixel, SKG_DRAW_WORD(SKG_DRAW_SCATTER, channel, 0), draw);
    const skg_floatv normal = fma(skg_root_v(max(spread, (skg_floatv)(1e-30f))), skg_normal_v(draw[0]), value);
    /* Few photons, each of the size that gives the mean and the variance. */
    const skg_floatv counted = skg_poisson_v(some & ~many ? expected : (skg_floatv)(0.0f), draw[1]);
    return some ? (many ? normal : counted * (spread / max(value, (skg_floatv)(1e-30f)))) : value;
}

/* Writes values to the pixels of a channel. */
static void skg_show_scattered(const skg_scattered_args *args, skg_floatv value, int channel, int pixels, __global skg_real *image) {
    float values[SKG_WIDE];
    image += channel * args->image.channel_stride;
    SKG_STORE_V(floatv, value, values);
    for (int k = 0; k < pixels && k < SKG_WIDE; k++) image[k] = (args->add ? image[k] : (skg_real)(0)) + (skg_real)values[k];
}

/* Adds scattered photons to an image, with their own quantum noise. One work-item per SKG_WIDE pixels of a row. Behind
 * exponential.clh, random.clh and noise.clh.
 *
 * mean      [channels][rows][columns] what is added on average
 * variance  [channels][rows][columns] with args.noise; else NULL
 * image     with SKG_NOISE_APART, deviations follow behind the means of all channels */
__kernel void skg_scattered(skg_scattered_args args, __global const float *mean, __global const float *variance,
                            __global skg_real *image) {
    const int columns = args.image.columns, row = (int)get_global_id(1), all = args.image.rows * columns;
    const int column = SKG_WIDE * (int)get_global_id(0), pixels = columns - column, pixel = row * columns + column;
    if (pixels <= 0 || row >= args.image.rows) return;
    image += args.image.offset + row * args.image.row_stride + column;
    for (int channel = 0; channel < args.image.channels; channel++) {
        float means[SKG_WIDE];
        for (int k = 0; k < SKG_WIDE; k++) means[k] = mean[channel * all + pixel + min(k, pixels - 1)];
        const skg_floatv value = SKG_LOAD_V(floatv, means) * (skg_floatv)(args.scale);
        skg_floatv noisy = value;
        if (args.noise)
            noisy = skg_scattered_noise(&args, value, variance + channel * all + pixel, pixel, pixels, channel);
        const int apart = args.noise == SKG_NOISE_APART;
        skg_show_scattered(&args, apart ? value : noisy, channel, pixels, image);
        if (apart) skg_show_scattered(&args, noisy - value, args.image.channels + channel, pixels, image);
    }
}
