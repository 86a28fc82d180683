/* Carries the variances of pixels behind the blur through electronic noise, steps and the quantity that is shown, in place. One work-item
 * per pixel.
 *
 * factor       [channels] times `args.scale`: from keV or photons per pixel to what is shown
 * flat_field   [channels][rows][columns] that values are divided by; NULL without SKG_FLAT_FIELD
 * mean         [channels][rows][columns] of the transmission, whose -ln is shown; NULL without SKG_OF_LOGARITHM */
__kernel void skg_detect_variance(skg_detect_args args, __constant const skg_real *factor,
                                  __global const skg_real *flat_field, __global const skg_real *mean,
                                  __global skg_real *variance) {
    const int columns = args.image.columns, rows = args.image.rows;
    const int column = (int)get_global_id(0), row = (int)get_global_id(1), channel = (int)get_global_id(2);
    if (column >= columns || row >= rows) return;
    const long pixel = ((long)channel * rows + row) * columns + column;
    skg_real scale = factor[channel] * args.scale;
    variance += args.image.offset + channel * args.image.channel_stride + row * args.image.row_stride + column;
    /* The error of rounding to steps is spread evenly over one of them. */
    skg_real value = fma(args.electronic, args.electronic, args.spacing * args.spacing / (skg_real)(12)) + *variance;
#if SKG_FLAT_FIELD
    scale /= flat_field[pixel];
#endif
    value = value * scale * scale;
#if SKG_OF_LOGARITHM
    /* By first order. The logarithm is that of skg_logarithm. */
    const skg_real transmission = max(mean[pixel], (skg_real)(0x1p-126f));
    value = value / transmission / transmission;
#endif
    *variance = value;
}
