/* Derivative by the depth of a hit through the cells of a volume (slopes.cl): at a hit where other parts begin or end to displace the
 * volume, a move by a unit of depth changes the sums by the contribution of the cell there for a unit of length. */

/* The number of the cell at a place of a ray, or -1. */
static long skg_cell_at(const skg_volume_args *args, const long *base, const long *way, skg_real depth) {
    long at = 0;
    for (int k = 2; k >= 0; k--) {
        const long cell = skg_cell_depth(base[k], way[k], args->common, depth) >> args->bits;
        if (cell < 0 || cell >= args->cells[k]) return -1;
        at = at * args->cells[k] + cell;
    }
    return at;
}

/* d loss / d length of what a cell adds. losses: of the planes, at the pixel */
static skg_real skg_cell_worth(const skg_volume_args *args, skg_cell cell, __global const float *weights,
                               __global const skg_real *losses, int plane) {
    skg_real sum = 0;
    for (int p = 0; p < args->plane_count; p++) {
#if SKG_VOLUME_WIDE
        const skg_real weight = (skg_real)cell * (skg_real)weights[p];
#else
        const skg_real weight = (skg_real)weights[(long)cell * SKG_VOLUME_PLANES + p];
#endif
        sum = fma(weight, losses[(long)args->planes[p] * plane], sum);
    }
    return sum * (skg_real)args->unit;
}

/* Behind skg_hits_slopes, one work-item per pixel of its window. args: of skg_volume_add, but for `unit`: what the sums of a raster are over the
 * weights. losses: the weights of skg_hits_slopes; slopes: of the hits, to which is added. */
__kernel void skg_volume_slopes(skg_volume_args args, skg_gradient_args of, __global const skg_cell *cells,
                                __global const float *weights, __global const int *counts, __global const uint *starts,
                                __global const skg_listed *hits, __global const int *table, __global const int *displacing,
                                __global const skg_real *losses, __global skg_real *slopes) {
    const int column = of.window[0] + (int)get_global_id(0), row = of.window[1] + (int)get_global_id(1);
    if (column >= of.window[2] || row >= of.window[3]) return;
    const int count = counts[row * of.layout.columns + column];
    if (count == 0) return;
    int winding[SKG_SLOTS], before = 0;
    uint active[SKG_WORDS];
    long base[3], way[3];
    const uint start = starts[row * of.layout.columns + column];
    hits += start, slopes += start, weights += args.first_weight;
    losses += (long)row * of.stride + column;
    skg_cell_ray(&args, 0, column, row, base, way);
    for (int k = 0; k < count; k++) winding[hits[k].code / 2] = 0;
    for (int w = 0; w < SKG_WORDS; w++) active[w] = 0;
    for (int k = 0; k < count; k++) {
        skg_pass_hit(hits[k].code, winding, active);
        const int displaced = skg_is_displaced(&args, table, active, displacing);
        if (displaced == before) continue;
        const long at = skg_cell_at(&args, base, way, hits[k].depth);
        if (at >= 0)
            slopes[k] += (skg_real)(displaced - before) * skg_cell_worth(&args, cells[at], weights, losses, of.plane);
        before = displaced;
    }
}
