/* Leaky meshes have planes and a count plane of their own. In a pixel whose count is 0 the signed hits cancel, and the sums
 * are added to the planes that all parts share. In other pixels they are left out, or repaired.
 *
 * A batch is `parts` leaky parts in one raster. The planes of a part's sums stand before its count plane, and parts stand
 * one after another. table: [parts] the count plane of each part; then for each plane of the raster the shared plane that
 * its sums are added to. shared: the first copy of the other raster, whose planes have the same layout. */

/* The first plane of the sums of a part. */
static int skg_first_plane(__global const int *table, int part) {
    return part > 0 ? table[part - 1] + 1 : 0;
}

static size_t skg_place(const skg_raster_layout *layout, int plane, int row, int column) {
    return (size_t)plane * (size_t)layout->plane + (size_t)row * (size_t)layout->stride + (size_t)column;
}

/* The first of own, own + step, own + 2 step, ... that is not before a column. */
static int skg_first_column(int column, int own, int step) {
    return own + max(column - own + step - 1, 0) / step * step;
}

/* Adds the sums of valid pixels to the shared planes. The work-items of a row take its vectors alternately, and each takes the
 * parts one after another, so that no two add to one pixel at the same time. */
__kernel void skg_leaky_add(skg_leaky_args args, __global const skg_sum *copies, __global const int *used,
                           __global const int *table, __global skg_sum *shared) {
    const int row = (int)get_global_id(1), step = SKG_WIDE * (int)get_global_size(0);
    if (row >= args.layout.rows) return;
    for (int part = 0; part < args.parts; part++) {
        const int first = skg_first_plane(table, part), counts = table[part];
        const int4 extent = vload4(0, used + SKG_EXTENT(args.layout.copies, counts));
        if (row < extent.x || row >= extent.y) continue;
        const int own = SKG_WIDE * (int)get_global_id(0);
        for (int column = skg_first_column(extent.z, own, step); column < extent.w; column += step) {
            const skg_sumv hits = skg_extent_sums_v(&args.layout, copies, used, counts, row, column);
            const skg_sumv valid = SKG_AS_SUM_V(hits == (skg_sumv)(0));
            for (int plane = first; plane < counts; plane++) {
                const skg_sumv sums = skg_extent_sums_v(&args.layout, copies, used, plane, row, column);
                if (!skg_any(SKG_TO_INT_V((sums & valid) != (skg_sumv)(0)))) continue; /* true of most of an extent */
                __global skg_sum *place = shared + skg_place(&args.layout, table[args.parts + plane], row, column);
                *(__global skg_loose_sumv *)place += sums & valid;
            }
        }
    }
}

/* The distance if there is no valid pixel. */
#define SKG_FAR 0x40000000

/* gaps: [part][row][column] distance in pixels to the nearest valid pixel of the row, 0 for a valid pixel. It is written only
 * in the columns of a row that rows_bad (counts.cl) names. One work-item per row and part. */
__kernel void skg_leaky_gaps(skg_leaky_args args, __global const skg_sum *copies, __global const int *used,
                            __global const int *table, __global const int *rows_bad, __global int *gaps) {
    const int row = (int)get_global_id(0), part = (int)get_global_id(1);
    if (row >= args.layout.rows || part >= args.parts) return;
    const int3 bad = vload3((size_t)(part * args.layout.rows + row), rows_bad);
    __global int *gap = gaps + ((size_t)part * (size_t)args.layout.rows + (size_t)row) * (size_t)args.layout.columns;
    int near = bad.y > 0 ? 0 : SKG_FAR; /* all pixels beside the bad ones are valid */
    for (int column = bad.y; column < bad.z; column++) {
        near = skg_sum_of(&args.layout, copies, used, table[part], row, column) != 0 ? min(near + 1, SKG_FAR) : 0;
        gap[column] = near;
    }
    near = bad.z < args.layout.columns ? 0 : SKG_FAR;
    for (int column = bad.z - 1; column >= bad.y; column--) {
        near = gap[column] ? min(near + 1, SKG_FAR) : 0;
        gap[column] = min(gap[column], near);
    }
}

/* rows_bad and gaps of one part. */
typedef struct {
    __global const int *rows_bad, *gaps;
} skg_marks;

static int skg_gap(const skg_raster_layout *layout, const skg_marks *marks, int row, int column) {
    const int3 bad = vload3((size_t)row, marks->rows_bad);
    if (column < bad.y || column >= bad.z) return 0;
    return marks->gaps[(size_t)row * (size_t)layout->columns + (size_t)column];
}

/* The distance to the nearest valid pixel in steps along rows or columns: half the side of the smallest square about the
 * pixel that holds a valid one. */
static int skg_reach(const skg_raster_layout *layout, const skg_marks *marks, int row, int column) {
    int reach = skg_gap(layout, marks, row, column);
    for (int d = 1; d < reach && d < layout->rows; d++) {
        if (row >= d) reach = min(reach, max(d, skg_gap(layout, marks, row - d, column)));
        if (row + d < layout->rows) reach = min(reach, max(d, skg_gap(layout, marks, row + d, column)));
    }
    return reach;
}

/* The mean over the valid pixels on the border of a square, rounded to nearest. Inside it no pixel is valid. Quotients and
 * remainders are summed separately, so that nothing overflows. */
static skg_sum skg_border_mean(const skg_raster_layout *layout, __global const skg_sum *copies, __global const int *used,
                               const skg_marks *marks, int plane, int row, int column, int reach) {
    long valid = 0, whole = 0, rest = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int j = max(row - reach, 0); j <= min(row + reach, layout->rows - 1); j++) {
            const int step = (int)abs(j - row) == reach ? 1 : 2 * reach;
            for (int i = column - reach; i <= column + reach; i += step) {
                if (i < 0 || i >= layout->columns || skg_gap(layout, marks, j, i)) continue;
                if (pass == 0) {
                    valid++;
                    continue;
                }
                const long value = (skg_term)skg_sum_of(layout, copies, used, plane, j, i);
                whole += value / valid;
                rest += value % valid;
            }
        }
    const long twice = 2 * rest + valid;
    return (skg_sum)(whole + twice / (2 * valid) - (twice % (2 * valid) < 0));
}

/* Gives the bad pixels of each part the mean over their neighbourhood, which is grown until it holds valid pixels (Vidal and
 * Villard 2016, 3.2.7). Work-items are those of skg_leaky_add, with pixels instead of vectors. */
__kernel void skg_leaky_repair(skg_leaky_args args, __global const skg_sum *copies, __global const int *used,
                              __global const int *table, __global const int *rows_bad, __global const int *gaps,
                              __global skg_sum *shared) {
    const int own = (int)get_global_id(0), row = (int)get_global_id(1), step = (int)get_global_size(0);
    if (row >= args.layout.rows) return;
    for (int part = 0; part < args.parts; part++) {
        const int3 bad = vload3((size_t)(part * args.layout.rows + row), rows_bad);
        skg_marks marks;
        marks.rows_bad = rows_bad + 3 * part * args.layout.rows;
        marks.gaps = gaps + (size_t)part * (size_t)args.layout.rows * (size_t)args.layout.columns;
        for (int column = skg_first_column(bad.y, own, step); column < bad.z; column += step) {
            if (skg_gap(&args.layout, &marks, row, column) == 0) continue;
            const int reach = skg_reach(&args.layout, &marks, row, column);
            if (reach >= SKG_FAR) continue;
            for (int plane = skg_first_plane(table, part); plane < table[part]; plane++)
                shared[skg_place(&args.layout, table[args.parts + plane], row, column)] +=
                    skg_border_mean(&args.layout, copies, used, &marks, plane, row, column, reach);
        }
    }
}

/* Gives args.count pixels of a part new sums, instead of those that skg_leaky_add has added. pixels: [item] row * columns +
 * column, none twice; values: [item][planes of the part]. */
__kernel void skg_leaky_put(skg_leaky_args args, __global const skg_sum *copies, __global const int *used,
                           __global const int *table, __global const int *pixels,
                           __global const long *values, __global skg_sum *shared) {
    const int item = (int)get_global_id(0), first = skg_first_plane(table, args.part), counts = table[args.part];
    if (item >= args.count) return;
    const int row = pixels[item] / args.layout.columns, column = pixels[item] % args.layout.columns;
    const int added = skg_sum_of(&args.layout, copies, used, counts, row, column) == 0;
    for (int plane = first; plane < counts; plane++) {
        const skg_sum own = added ? skg_sum_of(&args.layout, copies, used, plane, row, column) : 0;
        const skg_sum value = (skg_sum)values[(size_t)item * (size_t)(counts - first) + (size_t)(plane - first)];
        shared[skg_place(&args.layout, table[args.parts + plane], row, column)] += value - own;
    }
}
