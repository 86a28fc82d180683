/* Blur with line spread functions or a point spread function, in two passes over an image in the type of skg_real. The first
 * pass works down the columns, from the image into a workspace that is wider (and for a point spread function higher) than the
 * image by half the function on either side. The second works along the rows, from the workspace into the image. A pixel beyond
 * the border has the value of the nearest pixel on it. The terms of a pixel are added in the same order on all devices. */

/* Rows and vectors of a work-item of the first pass: each row that is read is used for SKG_BLUR_ROWS rows that are written. */
#define SKG_BLUR_ROWS 4
#define SKG_BLUR_VECTORS 2
/* Vectors of a work-item of the second pass. */
#define SKG_BLUR_RUN 4

static skg_realv skg_border_v(__global const skg_real *row, int column, int columns) {
    if (column >= 0 && column + SKG_WIDE <= columns) return SKG_LOAD_GLOBAL_V(realv, row + column);
    skg_real lanes[SKG_WIDE];
    for (int k = 0; k < SKG_WIDE; k++) lanes[k] = row[clamp(column + k, 0, columns - 1)];
    return SKG_LOAD_V(realv, lanes);
}

/* First pass. weights: [SKG_BLUR_ROWS - 1 + taps + SKG_BLUR_ROWS - 1], with zeros before and behind the taps. */
__kernel void skg_blur_down(skg_blur_args args, __global const skg_real *image, __global const skg_real *weights,
                            __global skg_real *workspace) {
    const int stride = args.stride, high = args.high, taps = args.taps;
    const int to = SKG_BLUR_VECTORS * SKG_WIDE * (int)get_global_id(0);
    const int row = SKG_BLUR_ROWS * (int)get_global_id(1), channel = (int)get_global_id(2);
    if (to >= stride || row >= high) return;
    skg_realv sum[SKG_BLUR_ROWS][SKG_BLUR_VECTORS];
    SKG_UNROLL for (int r = 0; r < SKG_BLUR_ROWS; r++)
        SKG_UNROLL for (int v = 0; v < SKG_BLUR_VECTORS; v++) sum[r][v] = (skg_realv)(0);
    const int first = row - args.above - taps / 2;
    image += args.image.offset + channel * args.image.channel_stride;
    for (int k = 0; k < taps + SKG_BLUR_ROWS - 1; k++) {
        __global const skg_real *from = image + clamp(first + k, 0, args.image.rows - 1) * args.image.row_stride;
        SKG_UNROLL for (int v = 0; v < SKG_BLUR_VECTORS; v++) {
            const skg_realv value = skg_border_v(from, to + v * SKG_WIDE - args.left, args.image.columns);
            SKG_UNROLL for (int r = 0; r < SKG_BLUR_ROWS; r++)
                sum[r][v] = fma((skg_realv)(weights[SKG_BLUR_ROWS - 1 + k - r]), value, sum[r][v]);
        }
    }
    SKG_UNROLL for (int r = 0; r < SKG_BLUR_ROWS; r++) {
        __global skg_real *place = workspace + ((long)channel * high + row + r) * stride + to;
        if (row + r < high) /* not a break, which would keep the loop from being unrolled; PoCL would warn the user */
            SKG_UNROLL for (int v = 0; v < SKG_BLUR_VECTORS; v++) SKG_STORE_GLOBAL_V(realv, sum[r][v], place + v * SKG_WIDE);
    }
}

/* Second pass. weights: [down][across]. Pixel (row, column) of the image is the sum over the weights times the workspace from
 * its pixel (row, column) on; if `args.add` is 1, this is added to what is there. */
__kernel void skg_blur_across(skg_blur_args args, __global const skg_real *workspace, __global const skg_real *weights,
                              __global skg_real *image) {
    const int columns = args.image.columns, rows = args.image.rows, add = args.add;
    const int column = SKG_BLUR_RUN * SKG_WIDE * (int)get_global_id(0), row = (int)get_global_id(1);
    const int channel = (int)get_global_id(2);
    if (column >= columns || row >= rows) return;
    skg_realv sum[SKG_BLUR_RUN];
    SKG_UNROLL for (int v = 0; v < SKG_BLUR_RUN; v++) sum[v] = (skg_realv)(0);
    for (int j = 0; j < args.down; j++) {
        __global const skg_real *from = workspace + ((long)channel * args.high + row + j) * args.stride + column;
        for (int i = 0; i < args.across; i++)
            SKG_UNROLL for (int v = 0; v < SKG_BLUR_RUN; v++)
                sum[v] = fma((skg_realv)(weights[j * args.across + i]), SKG_LOAD_GLOBAL_V(realv, from + i + v * SKG_WIDE), sum[v]);
    }
    image += args.image.offset + channel * args.image.channel_stride + row * args.image.row_stride + column;
    SKG_UNROLL for (int v = 0; v < SKG_BLUR_RUN; v++) {
        const int pixels = columns - column - v * SKG_WIDE;
        __global skg_real *place = image + v * SKG_WIDE;
        if (pixels >= SKG_WIDE)
            SKG_STORE_GLOBAL_V(realv, add ? SKG_LOAD_GLOBAL_V(realv, place) + sum[v] : sum[v], place);
        else {
            skg_real rest[SKG_WIDE];
            SKG_STORE_V(realv, sum[v], rest);
            for (int k = 0; k < pixels; k++) place[k] = add ? place[k] + rest[k] : rest[k];
        }
    }
}
