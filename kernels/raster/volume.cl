/* Adds the cells of a volume to the sums of the raster: along each ray the integral of what the cells add to each plane.
 *
 * The ray is cut into slices along the axis that it runs along most. Within a slice it crosses at most one plane between cells along
 * each of the two other axes, so that it meets at most three cells, whose shares follow from the places of the two crossings. Places
 * are integers, which any device computes alike; a crossing is a quotient of floats, of which an error shifts a plane by 2^-24 of a
 * cell. Where other parts displace the volume (hits.cl) the integral over their interval is subtracted. */

#define SKG_SHARE_ONE (1 << SKG_SHARE_BITS)
#define SKG_PLACE_BITS 40 /* of a place within the walk */
#define SKG_VOLUME_RUN (SKG_CPU ? SKG_VOLUME_CPU_RUN : 1)

#if SKG_VOLUME_WIDE
typedef int skg_cell;
#define SKG_CELL_SUMS 1
#else
typedef ushort skg_cell;
#define SKG_CELL_SUMS SKG_VOLUME_PLANES
#endif

/* A ray in the axes of the volume: `first` is that of its slices. */
typedef struct {
    int axis[3];
    long base[3], way[3]; /* along these axes */
    long slope[3];        /* [1], [2]: per slice, SKG_PLACE_BITS */
    long exact[3];        /* the same with 46 bits */
    float steepness[3];   /* 2^30 / |slope| */
    int size[3];
    long stride[3];
} skg_cell_ray;

/* x q / 2^bits, rounded down; the result fits. */
static long skg_times(long x, long q, int bits) {
    return (long)((ulong)mul_hi(x, q) << (64 - bits) | (ulong)(x * q) >> bits);
}

/* 2^46 part / whole, where |part| <= |whole| and whole is not 0. */
static long skg_quotient(long part, long whole) {
    ulong n = abs(part), d = abs(whole);
    const int drop = max(17 - (int)clz(d), 0);
    n >>= drop;
    d >>= drop;
    ulong q = (n << 16) / d, r = (n << 16) - q * d;
    for (int k = 0; k < 2; k++) {
        const int bits = k ? 14 : 16;
        const ulong more = (r << bits) / d;
        r = (r << bits) - more * d;
        q = q << bits | more;
    }
    return (part < 0) != (whole < 0) ? -(long)q : (long)q;
}

static void skg_cell_ray_of(const skg_volume_args *args, int column, int row, skg_cell_ray *ray) {
    long base[3], way[3];
    const long stride[3] = {1, args->cells[0], (long)args->cells[0] * (long)args->cells[1]};
    for (int k = 0; k < 3; k++) {
        base[k] = args->base[k] + column * args->base_column[k] + row * args->base_row[k];
        way[k] = args->way[k] + column * args->way_column[k] + row * args->way_row[k];
    }
    const ulong x = abs(way[0]), y = abs(way[1]), z = abs(way[2]);
    ray->axis[0] = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    /* Of the two others that with the smaller stride comes first. */
    ray->axis[1] = ray->axis[0] == 0 ? 1 : 0;
    ray->axis[2] = ray->axis[0] == 2 ? 1 : 2;
    for (int k = 0; k < 3; k++) {
        ray->base[k] = base[ray->axis[k]];
        ray->way[k] = way[ray->axis[k]];
        ray->size[k] = args->cells[ray->axis[k]];
        ray->stride[k] = stride[ray->axis[k]];
    }
    for (int k = 1; k < 3; k++) {
        ray->exact[k] = skg_quotient(ray->way[k], ray->way[0]);
        ray->slope[k] = ray->exact[k] >> (46 - SKG_PLACE_BITS);
        ray->steepness[k] = 0x1p30f / (float)max(abs(ray->slope[k]), 1ul);
    }
}

/* The place along axis k at the beginning of slice `slice`, SKG_PLACE_BITS. What is far outside stays so. */
static long skg_cell_place(const skg_cell_ray *ray, int bits, int k, int slice) {
    const long at = ray->base[k] + skg_times(((long)slice << bits) - ray->base[0], ray->exact[k], 46);
    const long most = 1l << (bits + 20);
    return clamp(at, -most, most) << (SKG_PLACE_BITS - bits);
}

/* Where the ray crosses the plane between two cells within a slice. from, to: its places at both ends */
static int skg_plane_crossing(long from, long to, float steepness) {
    const long first = from >> SKG_PLACE_BITS, last = to >> SKG_PLACE_BITS;
    if (first == last) return SKG_SHARE_ONE;
    const long way = last > first ? (last << SKG_PLACE_BITS) - from : from - (first << SKG_PLACE_BITS);
    return min(convert_int_rte((float)way * steepness), SKG_SHARE_ONE);
}

/* Adds share times the weights of a cell. */
static void skg_add_cell(__global const skg_cell *cells, __global const int *weights, long at, int inside, int share, long *sums) {
    const skg_cell cell = cells[inside ? at : 0];
    const long part = inside ? share : 0;
#if SKG_VOLUME_WIDE
    sums[0] += (long)cell * part;
#else
    __global const int *weight = weights + (int)cell * SKG_VOLUME_PLANES;
    SKG_UNROLL for (int p = 0; p < SKG_VOLUME_PLANES; p++) sums[p] += (long)weight[p] * part;
#endif
}

/* Adds the integral from one place along the first axis to another, with `bits` bits. */
SKG_APART void skg_walk_cells(const skg_cell_ray *ray, int bits, long from, long to, __global const skg_cell *cells,
                              __global const int *weights, long *sums) {
    const int first = (int)(from >> bits), last = (int)((to - 1) >> bits);
    long y = skg_cell_place(ray, bits, 1, first), z = skg_cell_place(ray, bits, 2, first);
    const long slope_y = ray->slope[1], slope_z = ray->slope[2];
    const float steep_y = ray->steepness[1], steep_z = ray->steepness[2];
    const uint rows = (uint)ray->size[1], planes = (uint)ray->size[2];
    const long stride_y = ray->stride[1], stride_z = ray->stride[2];
    for (int slice = first; slice <= last; slice++) {
        const long next_y = y + slope_y, next_z = z + slope_z, begin = (long)slice << bits;
        const int low = slice == first ? (int)((from - begin) >> (bits - SKG_SHARE_BITS)) : 0;
        const int high = slice == last ? (int)((to - begin) >> (bits - SKG_SHARE_BITS)) : SKG_SHARE_ONE;
        const int cross_y = skg_plane_crossing(y, next_y, steep_y), cross_z = skg_plane_crossing(z, next_z, steep_z);
        const int y_first = cross_y <= cross_z;
        const int one = clamp(min(cross_y, cross_z), low, high), two = clamp(max(cross_y, cross_z), low, high);
        const uint y0 = (uint)(y >> SKG_PLACE_BITS), y1 = (uint)(next_y >> SKG_PLACE_BITS);
        const uint z0 = (uint)(z >> SKG_PLACE_BITS), z1 = (uint)(next_z >> SKG_PLACE_BITS);
        const uint ym = y_first ? y1 : y0, zm = y_first ? z0 : z1;
        const long at = slice * ray->stride[0];
        long own[SKG_CELL_SUMS];
        SKG_UNROLL for (int p = 0; p < SKG_CELL_SUMS; p++) own[p] = 0;
        skg_add_cell(cells, weights, at + y0 * stride_y + z0 * stride_z, y0 < rows && z0 < planes, one - low, own);
        if (two > one)
            skg_add_cell(cells, weights, at + ym * stride_y + zm * stride_z, ym < rows && zm < planes, two - one, own);
        if (high > two)
            skg_add_cell(cells, weights, at + y1 * stride_y + z1 * stride_z, y1 < rows && z1 < planes, high - two, own);
        SKG_UNROLL for (int p = 0; p < SKG_CELL_SUMS; p++) sums[p] += own[p] >> SKG_DROPPED_BITS;
        y = next_y;
        z = next_z;
    }
}

/* The place along the first axis where the path parameter is common + depth. */
static long skg_cell_depth(const skg_cell_ray *ray, long common, skg_real depth) {
    return ray->base[0] + skg_times(ray->way[0], common, 40) + convert_long_rte(depth * (skg_real)ray->way[0]);
}

/* Subtracts the intervals in which parts inside the volume, or those that win over it, stand. displacing: the set of slots that do
 * so by being inside. ends: of the whole integral */
SKG_APART void skg_displace_cells(const skg_volume_args *args, const skg_cell_ray *ray, const long *ends,
                                  __global const skg_listed *hits, int count, __global const int *table,
                                  __global const int *displacing, __global const skg_cell *cells,
                                  __global const int *weights, long *sums) {
    int winding[SKG_SLOTS];
    uint active[SKG_WORDS];
    long off[SKG_CELL_SUMS];
    for (int p = 0; p < SKG_CELL_SUMS; p++) off[p] = 0;
    for (int k = 0; k < count; k++) winding[hits[k].code / 2] = 0;
    for (int w = 0; w < SKG_WORDS; w++) active[w] = 0;
    for (int k = 0; k + 1 < count; k++) {
        uint dropped[SKG_WORDS];
        int displaced = 0;
        skg_pass_hit(hits[k].code, winding, active);
        if (!(hits[k + 1].depth > hits[k].depth)) continue;
        skg_drop(table, active, dropped);
        displaced = skg_is_in(dropped, args->slot);
        for (int w = 0; w < SKG_WORDS; w++) displaced |= (active[w] & (uint)displacing[w]) != 0;
        if (!displaced) continue;
        const long a = skg_cell_depth(ray, args->common, hits[k].depth), b = skg_cell_depth(ray, args->common, hits[k + 1].depth);
        const long from = clamp(min(a, b), ends[0], ends[1]), to = clamp(max(a, b), ends[0], ends[1]);
        if (from < to) skg_walk_cells(ray, args->bits, from, to, cells, weights, off);
    }
    for (int p = 0; p < SKG_CELL_SUMS; p++) sums[p] -= off[p];
}

/* From where to where along the first axis the ray is followed. Returns 0 if it misses the volume. */
static int skg_cell_ends(const skg_volume_args *args, const skg_cell_ray *ray, int column, int row, long *ends) {
    const long size = (long)ray->size[0] << args->bits;
    long start = ray->base[0], end = ray->base[0] + ray->way[0];
#if SKG_PARALLEL
    const float t = fma(args->start[1], (float)column, fma(args->start[2], (float)row, args->start[0]));
    start = args->whole ? (ray->way[0] > 0 ? 0 : size) : start + convert_long_sat(t * (float)ray->way[0]);
#endif
    ends[0] = clamp(min(start, end), 0l, size);
    ends[1] = clamp(max(start, end), 0l, size);
    return ends[0] < ends[1];
}

/* Adds the volume to one pixel. */
SKG_APART void skg_volume_pixel(const skg_volume_args *args, int column, int row, __global const skg_cell *cells,
                                __global const int *weights, __global const int *counts, __global const uint *starts,
                                __global const skg_listed *hits, __global const int *table, __global const int *displacing,
                                __global skg_sum *sums) {
    skg_cell_ray ray;
    long own[SKG_CELL_SUMS], ends[2];
    skg_cell_ray_of(args, column, row, &ray);
    if (!skg_cell_ends(args, &ray, column, row, ends)) return;
    for (int p = 0; p < SKG_CELL_SUMS; p++) own[p] = 0;
    skg_walk_cells(&ray, args->bits, ends[0], ends[1], cells, weights, own);
    if (args->slot >= 0 && column >= args->lists[0] && column < args->lists[2] && row >= args->lists[1] &&
        row < args->lists[3]) {
        const int pixel = row * args->layout.columns + column, count = counts[pixel];
        if (count > 0)
            skg_displace_cells(args, &ray, ends, hits + starts[pixel], count, table, displacing, cells, weights, own);
    }
    const skg_real per_slice = (skg_real)args->unit / (skg_real)abs(ray.way[0]);
    __global skg_sum *sum = sums + (size_t)row * (size_t)args->layout.stride + (size_t)column;
    for (int p = 0; p < args->plane_count; p++) {
#if SKG_VOLUME_WIDE
        const skg_real value = (skg_real)own[0] * (skg_real)weights[p];
#else
        const skg_real value = (skg_real)own[p];
#endif
        sum[(size_t)args->planes[p] * (size_t)args->layout.plane] += (skg_sum)skg_round(value * per_slice);
    }
}

/* A work-item takes SKG_VOLUME_RUN pixels of a row of the window. weights: of 16-bit cells [codes][SKG_VOLUME_PLANES], of wide ones
 * [planes]: what a slice within one cell adds. displacing: the set of slots of the parts inside the volume. */
__kernel void skg_volume_add(skg_volume_args args, __global const skg_cell *cells, __global const int *weights,
                             __global const int *counts, __global const uint *starts, __global const skg_listed *hits,
                             __global const int *table, __global const int *displacing, __global skg_sum *sums) {
    const int first = args.window[0] + SKG_VOLUME_RUN * (int)get_global_id(0);
    const int row = args.window[1] + (int)get_global_id(1), end = min(first + SKG_VOLUME_RUN, args.window[2]);
    if (row >= args.window[3]) return;
    weights += args.first_weight;
    for (int column = first; column < end; column++)
        skg_volume_pixel(&args, column, row, cells, weights, counts, starts, hits, table, displacing, sums);
}
