/* Variances of pixels that are independent of each other, through one direction of a blur, or through both: the sum of the squares
 * of their weights times their variances. A pixel on the border stands for those beyond it, whose weights add up before they are
 * squared. One work-item per pixel.
 *
 * weights   [args.down][args.across] from element args.first on, in reverse order, as blur.cl reads them */
__kernel void skg_blur_variance(skg_blur_variance_args args, __global const skg_real *from, __global const skg_real *weights,
                                __global skg_real *to) {
    const int columns = args.to.columns, rows = args.to.rows;
    const int column = (int)get_global_id(0), row = (int)get_global_id(1), channel = (int)get_global_id(2);
    if (column >= columns || row >= rows) return;
    const int left = column - args.across / 2, above = row - args.down / 2;
    skg_real sum = (skg_real)(0);
    from += args.from.offset + channel * args.from.channel_stride;
    weights += args.first;
    for (int j = max(above, 0); j <= min(above + args.down - 1, rows - 1); j++) {
        const int top = j == 0 ? 0 : j - above, bottom = j == rows - 1 ? args.down - 1 : j - above;
        for (int i = max(left, 0); i <= min(left + args.across - 1, columns - 1); i++) {
            const int first = i == 0 ? 0 : i - left, last = i == columns - 1 ? args.across - 1 : i - left;
            skg_real weight = (skg_real)(0);
            for (int y = top; y <= bottom; y++)
                for (int x = first; x <= last; x++) weight += weights[y * args.across + x];
            sum = fma(weight * weight, from[j * args.from.row_stride + i], sum);
        }
    }
    to += args.to.offset + channel * args.to.channel_stride + row * args.to.row_stride + column;
    *to = args.add ? *to + sum : sum;
}
