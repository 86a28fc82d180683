/* Reads out an image after quantum noise and blur: electronic noise, quantisation, and the quantity that is shown. The image is changed in
 * place, in the type of skg_real. One work-item per SKG_WIDE pixels of a row of a channel.
 *
 * factor       [channels] times `args.scale`: from keV or photons per pixel to what is shown
 * flat_field   [channels][rows][columns] that values are divided by; NULL without SKG_FLAT_FIELD */
__kernel void skg_detect(skg_detect_args args, __constant const skg_real *factor,
                         __global const skg_real *flat_field, __global skg_real *image) {
    const int columns = args.image.columns, rows = args.image.rows;
    const int column = SKG_WIDE * (int)get_global_id(0), row = (int)get_global_id(1);
    const int channel = (int)get_global_id(2), pixels = columns - column;
    if (pixels <= 0 || row >= rows) return;
    skg_real rest[SKG_WIDE];
    skg_realv value;
    image += args.image.offset + channel * args.image.channel_stride + row * args.image.row_stride + column;
    if (pixels >= SKG_WIDE)
        value = SKG_LOAD_GLOBAL_V(realv, image);
    else {
        for (int k = 0; k < SKG_WIDE; k++) rest[k] = image[min(k, pixels - 1)];
        value = SKG_LOAD_V(realv, rest);
    }
#if SKG_ELECTRONIC
    skg_uintv draw[4];
    skg_draw_v(&args.key, row * columns + column, SKG_DRAW_WORD(SKG_DRAW_ELECTRONIC, channel, 0), draw);
    value = fma((skg_realv)(args.electronic), SKG_TO_REAL_V(skg_normal_v(draw[0])), value);
#endif
#if SKG_QUANTISED
    value = rint(value / args.spacing) * args.spacing;
#endif
    value *= factor[channel] * args.scale;
#if SKG_FLAT_FIELD
    skg_real flat[SKG_WIDE];
    flat_field += ((long)channel * rows + row) * columns + column;
    for (int k = 0; k < SKG_WIDE; k++) flat[k] = flat_field[min(k, pixels - 1)];
    value /= SKG_LOAD_V(realv, flat);
#endif
    if (pixels >= SKG_WIDE) {
        SKG_STORE_GLOBAL_V(realv, value, image);
        return;
    }
    SKG_STORE_V(realv, value, rest);
    for (int k = 0; k < pixels; k++) image[k] = rest[k];
}
