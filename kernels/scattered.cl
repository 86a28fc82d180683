typedef skg_floatv skg_loose_floatv __attribute__((aligned(sizeof(float))));

/* Adds scattered photons to an image, with their own quantum noise: photons that arrive by different ways are independent. One
 * work-item per SKG_WIDE pixels of a row. Behind exponential.clh, random.clh and noise.clh.
 *
 * mean      [rows][columns] what is added on average
 * variance  [rows][columns] with SKG_NOISE; else NULL */
__kernel void skg_scattered(skg_scattered_args args, __global const float *mean, __global const float *variance,
                            __global skg_real *image) {
    const int columns = args.image.columns, row = (int)get_global_id(1);
    const int column = SKG_WIDE * (int)get_global_id(0), pixels = columns - column;
    if (pixels <= 0 || row >= args.image.rows) return;
    float means[SKG_WIDE], values[SKG_WIDE];
    mean += row * columns + column;
    image += args.image.offset + row * args.image.row_stride + column;
    for (int k = 0; k < SKG_WIDE; k++) means[k] = mean[min(k, pixels - 1)];
    skg_floatv value = SKG_LOAD_V(floatv, means);
#if SKG_NOISE
    float variances[SKG_WIDE];
    variance += row * columns + column;
    for (int k = 0; k < SKG_WIDE; k++) variances[k] = variance[min(k, pixels - 1)];
    const skg_floatv spread = SKG_LOAD_V(floatv, variances) * (skg_floatv)((float)args.key.parts);
    const skg_floatv expected = value * value / max(spread, (skg_floatv)(1e-30f));
    const skg_intv many = expected > (skg_floatv)(SKG_FEW), some = spread > (skg_floatv)(1e-30f);
    skg_uintv draw[4];
    skg_draw_v(&args.key, row * columns + column, SKG_DRAW_WORD(SKG_DRAW_SCATTER, 0, 0), draw);
    const skg_floatv normal = fma(skg_root_v(max(spread, (skg_floatv)(1e-30f))), skg_normal_v(draw[0]), value);
    /* Few photons, each of the size that gives the mean and the variance. */
    const skg_floatv counted = skg_poisson_v(some & ~many ? expected : (skg_floatv)(0.0f), draw[1]);
    value = some ? (many ? normal : counted * (spread / max(value, (skg_floatv)(1e-30f)))) : value;
#endif
    SKG_STORE_V(floatv, value, values);
    for (int k = 0; k < pixels && k < SKG_WIDE; k++) image[k] = (args.add ? image[k] : (skg_real)(0)) + (skg_real)values[k];
}
