/* Adds the cells of a volume to the sums of the raster: along each ray the integral of what the cells add to each plane.
 *
 * A ray is cut into slices along the axis that it runs along most. Within a slice it crosses at most one plane between cells along
 * each of the two other axes, so that it meets at most three cells, whose shares follow from the places of the two crossings. Places
 * are integers, which any device computes alike; a crossing is a quotient of floats, of which an error shifts a plane by 2^-23 of a
 * cell. Where other parts displace the volume (hits.cl) the integral over their interval is subtracted. A work-item takes SKG_WIDE
 * rays, a lane each. */

typedef SKG_CAT(float, SKG_WIDE) skg_lanes_float;
typedef SKG_CAT(uint, SKG_WIDE) skg_lanes_uint;
#define SKG_LANES_TO_FLOAT SKG_CAT(convert_float, SKG_WIDE)
#define SKG_LANES_AS_UINT SKG_CAT(as_uint, SKG_WIDE)
#define SKG_LANES_LOAD(type, array) (*(const type *)(array))
#define SKG_LANES_ALIGNED __attribute__((aligned(4 * SKG_WIDE)))

/* Rays in the axes of the volume. */
typedef struct {
    int axis[SKG_WIDE];                   /* of its slices */
    long base[SKG_WIDE], way[SKG_WIDE];   /* along it */
    long side[2][SKG_WIDE];               /* the base along the two others, that with the smaller stride first */
    long slope[2][SKG_WIDE];              /* 2^46 per slice */
    long from[SKG_WIDE], to[SKG_WIDE];    /* along the axis, where the ray is followed; from >= to: nowhere */
} skg_cell_rays;

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

/* From where to where along its axis a ray is followed. */
static void skg_cell_ends(const skg_volume_args *args, __global const skg_cell_line *lines, int column, int row, int lane,
                          skg_cell_rays *rays) {
    const long size = (long)args->cells[rays->axis[lane]] << args->bits, base = rays->base[lane], way = rays->way[lane];
#if SKG_CURVED
    long start = base, end = base + skg_times(way, lines[row].end, 40);
#else
    long start = base, end = base + way;
#endif
#if SKG_PARALLEL
#if SKG_CURVED
    const float t = (float)(lines[row].start + column * lines[row].start_column) * 0x1p-40f;
#else
    const float t = fma(args->start[1], (float)column, fma(args->start[2], (float)row, args->start[0]));
#endif
    start = args->whole ? (way > 0 ? 0 : size) : base + convert_long_sat(t * (float)way);
#endif
    rays->from[lane] = clamp(min(start, end), 0l, size);
    rays->to[lane] = clamp(max(start, end), 0l, size);
}

/* Sets up the ray of a lane. */
static void skg_set_cell_ray(const skg_volume_args *args, __global const skg_cell_line *lines, int column, int row, int lane,
                             skg_cell_rays *rays) {
    long base[3], way[3];
    skg_cell_ray(args, lines, column, row, base, way);
    const ulong x = abs(way[0]), y = abs(way[1]), z = abs(way[2]);
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    rays->axis[lane] = axis;
    rays->base[lane] = base[axis];
    rays->way[lane] = way[axis];
    for (int k = 0; k < 2; k++) {
        const int other = k ? (axis == 2 ? 1 : 2) : (axis == 0 ? 1 : 0);
        rays->side[k][lane] = base[other];
        rays->slope[k][lane] = skg_quotient(way[other], way[axis]);
    }
    skg_cell_ends(args, lines, column, row, lane, rays);
}

/* The place along side k at the beginning of a slice, 2^32 a cell. What is far outside stays so. */
static long skg_cell_place(const skg_cell_rays *rays, int bits, int k, int lane, int slice) {
    const long at = rays->side[k][lane] +
                    skg_times(((long)slice << bits) - rays->base[lane], rays->slope[k][lane], 46);
    const long most = 1l << (bits + 20);
    const long within = clamp(at, -most, most);
    return bits > 32 ? within >> (bits - 32) : within << (32 - bits);
}

/* The state of the walk along one side: the cell and the place within it, in 2^-32 of a cell; what a slice adds; a slice over the
 * way across a cell. */
typedef struct {
    skg_lanes_uint place, step;
    skg_intv cell, cells;
    skg_lanes_float slices;
} skg_cell_side;

static void skg_begin_side(const skg_cell_rays *rays, int bits, int k, int axis, int lane, int end, int slice, skg_cell_side *side) {
    uint place[SKG_WIDE] SKG_LANES_ALIGNED, step[SKG_WIDE] SKG_LANES_ALIGNED;
    int cell[SKG_WIDE] SKG_LANES_ALIGNED, cells[SKG_WIDE] SKG_LANES_ALIGNED;
    float slices[SKG_WIDE] SKG_LANES_ALIGNED;
    for (int l = 0; l < SKG_WIDE; l++) {
        place[l] = step[l] = 0;
        cell[l] = -1; /* outside */
        cells[l] = 0;
        slices[l] = 0;
    }
    for (int l = lane; l < end; l++) {
        if (rays->axis[l] != axis) continue;
        const long at = skg_cell_place(rays, bits, k, l, slice), slope = rays->slope[k][l] >> 14;
        place[l] = (uint)at;
        cell[l] = (int)(at >> 32);
        step[l] = (uint)slope;
        cells[l] = (int)(slope >> 32);
        slices[l] = 1.0f / (float)max(abs(slope), 1ul);
    }
    side->place = SKG_LANES_LOAD(skg_lanes_uint, place);
    side->step = SKG_LANES_LOAD(skg_lanes_uint, step);
    side->cell = SKG_LANES_LOAD(skg_intv, cell);
    side->cells = SKG_LANES_LOAD(skg_intv, cells);
    side->slices = SKG_LANES_LOAD(skg_lanes_float, slices);
}

/* Goes to the end of a slice. Returns where the ray crosses the plane between two cells, as a share of the slice; 1: nowhere. next:
 * the cell behind it */
static skg_lanes_float skg_cross_slice(skg_cell_side *side, skg_intv *next) {
    const skg_lanes_uint place = side->place + side->step;
    *next = side->cell + side->cells - (place < side->step);
    const skg_lanes_float up = SKG_LANES_TO_FLOAT(~side->place) + 1.0f, down = SKG_LANES_TO_FLOAT(side->place);
    const skg_lanes_float share = (*next > side->cell ? up : down) * side->slices, one = (skg_lanes_float)(1.0f);
    const skg_lanes_float crossed = share < one ? share : one;
    side->place = place;
    return *next == side->cell ? one : crossed;
}

/* The ends of the walks of all lanes. */
typedef struct {
    skg_intv first, last;        /* slices */
    skg_lanes_float from, to;    /* within them */
    int start, end;              /* of all lanes */
    int whole, partial;          /* slices from `whole` to before `partial` are whole in all lanes */
} skg_cell_span;

static void skg_cell_span_of(const skg_cell_rays *rays, int bits, int axis, int lane, int end, const long *from, const long *to,
                        skg_cell_span *span) {
    int first[SKG_WIDE] SKG_LANES_ALIGNED, last[SKG_WIDE] SKG_LANES_ALIGNED;
    float low[SKG_WIDE] SKG_LANES_ALIGNED, high[SKG_WIDE] SKG_LANES_ALIGNED;
    const float slice = 1.0f / (float)(1l << bits);
    span->start = INT_MAX;
    span->end = 0;
    span->whole = 0;
    span->partial = INT_MAX;
    for (int l = 0; l < SKG_WIDE; l++) {
        first[l] = INT_MAX;
        last[l] = -1;
        low[l] = high[l] = 0;
    }
    for (int l = lane; l < end; l++) {
        if (rays->axis[l] != axis || from[l] >= to[l]) continue;
        first[l] = (int)(from[l] >> bits);
        last[l] = (int)((to[l] - 1) >> bits);
        low[l] = (float)(from[l] - ((long)first[l] << bits)) * slice;
        high[l] = (float)(to[l] - ((long)last[l] << bits)) * slice;
        span->start = min(span->start, first[l]);
        span->end = max(span->end, last[l] + 1);
        span->whole = max(span->whole, first[l] + (low[l] > 0));
        span->partial = min(span->partial, last[l] + (high[l] == 1));
    }
    span->first = SKG_LANES_LOAD(skg_intv, first);
    span->last = SKG_LANES_LOAD(skg_intv, last);
    span->from = SKG_LANES_LOAD(skg_lanes_float, low);
    span->to = SKG_LANES_LOAD(skg_lanes_float, high);
}

/* The shares of a slice that a walk has: from *low to *high. */
static void skg_cut_slice(const skg_cell_span *span, int slice, skg_lanes_float *low, skg_lanes_float *high) {
    const skg_intv at = (skg_intv)(slice);
    const skg_lanes_float zero = (skg_lanes_float)(0.0f), one = (skg_lanes_float)(1.0f);
    *low = at == span->first ? span->from : at < span->first ? one : zero;
    *high = at == span->last ? span->to : at > span->last ? zero : one;
    *high = *high > *low ? *high : *low;
}

static skg_lanes_float skg_within(skg_lanes_float x, skg_lanes_float low, skg_lanes_float high) {
    const skg_lanes_float above = x > low ? x : low;
    return above < high ? above : high;
}

#if SKG_VOLUME_PLANES == 1
/* Sums of 64 bits in lanes of 32. */
typedef struct {
    skg_lanes_uint low;
    skg_intv high;
} skg_cell_sums;

static void skg_add_whole(skg_lanes_float x, skg_cell_sums *sums) {
    const skg_intv whole = SKG_TO_INT_V(x);
    sums->low += SKG_LANES_AS_UINT(whole);
    sums->high += (whole >> 31) - (sums->low < SKG_LANES_AS_UINT(whole));
}
#endif

/* Adds the integrals of the lanes from `lane` to before `end` whose slices lie along an axis. */
SKG_APART void skg_walk_cells(const skg_volume_args *args, const skg_cell_rays *rays, int axis, int lane, int end,
                              const long *from, const long *to, __global const skg_cell *cells,
                              __global const float *weights, skg_cell_sum *sums) {
    const uint strides[3] = {1, (uint)args->cells[0], (uint)args->cells[0] * (uint)args->cells[1]};
    const int first_side = axis == 0 ? 1 : 0, second_side = axis == 2 ? 1 : 2;
    const uint stride_y = strides[first_side], stride_z = strides[second_side];
    const skg_lanes_uint size_y = (skg_lanes_uint)((uint)args->cells[first_side]),
                         size_z = (skg_lanes_uint)((uint)args->cells[second_side]);
    skg_cell_span span;
    skg_cell_side y, z;
    uint place[3][SKG_WIDE] SKG_LANES_ALIGNED;
    float share[3][SKG_WIDE] SKG_LANES_ALIGNED;
    skg_cell_span_of(rays, args->bits, axis, lane, end, from, to, &span);
    if (span.start >= span.end) return;
#if SKG_VOLUME_PLANES == 1
    float own[SKG_WIDE] SKG_LANES_ALIGNED;
    skg_cell_sums all = {(skg_lanes_uint)(0u), (skg_intv)(0)};
    for (int l = 0; l < SKG_WIDE; l++) own[l] = 0;
#endif
    skg_begin_side(rays, args->bits, 0, axis, lane, end, span.start, &y);
    skg_begin_side(rays, args->bits, 1, axis, lane, end, span.start, &z);
#if SKG_VOLUME_LINEAR
    const skg_linear_grid grid = skg_linear_grid_of(args, axis, first_side, second_side);
    float steps[2][SKG_WIDE] SKG_LANES_ALIGNED;
    *(skg_lanes_float *)steps[0] = SKG_LANES_TO_FLOAT(y.cells) + SKG_LANES_TO_FLOAT(y.step) * 0x1p-32f;
    *(skg_lanes_float *)steps[1] = SKG_LANES_TO_FLOAT(z.cells) + SKG_LANES_TO_FLOAT(z.step) * 0x1p-32f;
#endif
    for (int slice = span.start; slice < span.end; slice++) {
        skg_lanes_float low = (skg_lanes_float)(0.0f), high = (skg_lanes_float)(1.0f);
        skg_intv next_y, next_z;
        const skg_intv cell_y = y.cell, cell_z = z.cell;
#if SKG_VOLUME_LINEAR
        uint enters[2][SKG_WIDE] SKG_LANES_ALIGNED;
        *(skg_lanes_uint *)enters[0] = y.place;
        *(skg_lanes_uint *)enters[1] = z.place;
#endif
        const skg_lanes_float cross_y = skg_cross_slice(&y, &next_y), cross_z = skg_cross_slice(&z, &next_z);
        const skg_intv y_first = cross_y <= cross_z;
        skg_lanes_float one = y_first ? cross_y : cross_z, two = y_first ? cross_z : cross_y;
        y.cell = next_y;
        z.cell = next_z;
        if (slice < span.whole || slice >= span.partial) {
            skg_cut_slice(&span, slice, &low, &high);
            one = skg_within(one, low, high);
            two = skg_within(two, low, high);
        }
        const skg_intv middle_y = y_first ? next_y : cell_y, middle_z = y_first ? cell_z : next_z;
        const skg_intv in[3] = {
            (SKG_LANES_AS_UINT(cell_y) < size_y) & (SKG_LANES_AS_UINT(cell_z) < size_z) & (one > low),
            (SKG_LANES_AS_UINT(middle_y) < size_y) & (SKG_LANES_AS_UINT(middle_z) < size_z) & (two > one),
            (SKG_LANES_AS_UINT(next_y) < size_y) & (SKG_LANES_AS_UINT(next_z) < size_z) & (high > two)};
        if (!skg_any(in[0] | in[1] | in[2])) continue;
        const skg_lanes_float none = (skg_lanes_float)(0.0f);
        const skg_lanes_uint zero = (skg_lanes_uint)(0u);
        *(skg_lanes_uint *)place[0] = in[0] ? SKG_LANES_AS_UINT(cell_y) * stride_y + SKG_LANES_AS_UINT(cell_z) * stride_z : zero;
        *(skg_lanes_uint *)place[1] =
            in[1] ? SKG_LANES_AS_UINT(middle_y) * stride_y + SKG_LANES_AS_UINT(middle_z) * stride_z : zero;
        *(skg_lanes_uint *)place[2] = in[2] ? SKG_LANES_AS_UINT(next_y) * stride_y + SKG_LANES_AS_UINT(next_z) * stride_z : zero;
        *(skg_lanes_float *)share[0] = in[0] ? one - low : none;
        *(skg_lanes_float *)share[1] = in[1] ? two - one : none;
        *(skg_lanes_float *)share[2] = in[2] ? high - two : none;
#if SKG_VOLUME_LINEAR
        float begin[3][SKG_WIDE] SKG_LANES_ALIGNED;
        int in_y[3][SKG_WIDE] SKG_LANES_ALIGNED, in_z[3][SKG_WIDE] SKG_LANES_ALIGNED;
        const skg_intv all_y[3] = {cell_y, middle_y, next_y}, all_z[3] = {cell_z, middle_z, next_z};
        const skg_lanes_float all_from[3] = {low, one, two};
        for (int piece = 0; piece < 3; piece++) {
            *(skg_lanes_float *)begin[piece] = all_from[piece];
            *(skg_intv *)in_y[piece] = all_y[piece];
            *(skg_intv *)in_z[piece] = all_z[piece];
        }
#else
        __global const skg_cell *at = cells + (size_t)slice * strides[axis];
#endif
        for (int l = lane; l < end; l++) {
#if SKG_VOLUME_LINEAR
            const skg_linear_ray ray = {slice, {in_y[0][l], in_z[0][l]}, {(float)enters[0][l] * 0x1p-32f, (float)enters[1][l] * 0x1p-32f},
                                        {steps[0][l], steps[1][l]}};
            skg_cell_weight sum = (skg_cell_weight)(0.0f);
            for (int piece = 0; piece < 3; piece++)
                if (share[piece][l] > 0)
                    sum += skg_linear_piece(&grid, cells, weights, &ray, begin[piece][l], share[piece][l], in_y[piece][l], in_z[piece][l]);
#else
            skg_cell_weight sum = SKG_CELL_WEIGHT(at[place[0][l]]) * share[0][l];
            sum = fma(SKG_CELL_WEIGHT(at[place[1][l]]), (skg_cell_weight)(share[1][l]), sum);
            sum = fma(SKG_CELL_WEIGHT(at[place[2][l]]), (skg_cell_weight)(share[2][l]), sum);
#endif
#if SKG_VOLUME_PLANES == 1
            own[l] = sum;
        }
        skg_add_whole(SKG_LANES_LOAD(skg_lanes_float, own), &all);
    }
    uint below[SKG_WIDE] SKG_LANES_ALIGNED;
    int above[SKG_WIDE] SKG_LANES_ALIGNED;
    *(skg_lanes_uint *)below = all.low;
    *(skg_intv *)above = all.high;
    for (int l = lane; l < end; l++) sums[l] += (long)above[l] << 32 | (long)below[l];
#else
            sums[l] += SKG_CELL_WHOLE(sum);
        }
    }
#endif
}

/* Adds to `off` the intervals of a ray in which the volume is displaced. */
SKG_APART void skg_displace_cells(const skg_volume_args *args, const skg_cell_rays *rays, int lane,
                                  __global const skg_listed *hits, int count, __global const int *table,
                                  __global const int *displacing, __global const skg_cell *cells,
                                  __global const float *weights, skg_cell_sum *off) {
    int winding[SKG_SLOTS];
    uint active[SKG_WORDS];
    long from[SKG_WIDE], to[SKG_WIDE];
    for (int k = 0; k < count; k++) winding[hits[k].code / 2] = 0;
    for (int w = 0; w < SKG_WORDS; w++) active[w] = 0;
    for (int k = 0; k + 1 < count; k++) {
        skg_pass_hit(hits[k].code, winding, active);
        if (!(hits[k + 1].depth > hits[k].depth) || !skg_is_displaced(args, table, active, displacing)) continue;
        const long a = skg_cell_depth(rays->base[lane], rays->way[lane], args->common, hits[k].depth);
        const long b = skg_cell_depth(rays->base[lane], rays->way[lane], args->common, hits[k + 1].depth);
        from[lane] = clamp(min(a, b), rays->from[lane], rays->to[lane]);
        to[lane] = clamp(max(a, b), rays->from[lane], rays->to[lane]);
        skg_walk_cells(args, rays, rays->axis[lane], lane, lane + 1, from, to, cells, weights, off);
    }
}

/* Adds the sum of a lane to its pixel. */
static void skg_put_cells(const skg_volume_args *args, long way, const skg_cell_sum *own, const skg_cell_sum *off,
                          __global const float *weights, __global skg_sum *sum) {
    const skg_cell_sum left = *own - *off;
    const skg_real per_slice = (skg_real)args->unit / (skg_real)abs(way);
    for (int p = 0; p < args->plane_count; p++) {
#if SKG_VOLUME_WIDE
        const skg_real value = (skg_real)left * (skg_real)weights[p];
#else
        const skg_real value = (skg_real)SKG_CELL_SUM_OF(left, p);
#endif
        sum[(size_t)args->planes[p] * (size_t)args->layout.plane] += (skg_sum)skg_round(value * per_slice);
    }
}

/* A work-item takes SKG_WIDE pixels of a row of the window. weights: of 16-bit cells [codes][SKG_VOLUME_PLANES], of wide ones
 * [planes]: what a slice within one cell adds. displacing: the set of slots of the parts inside the volume. lines: of a curved detector, a line
 * for each row of the raster; otherwise it is not read. */
__kernel void skg_volume_add(skg_volume_args args, __global const skg_cell *cells, __global const float *weights,
                             __global const int *counts, __global const uint *starts, __global const skg_listed *hits,
                             __global const int *table, __global const int *displacing,
                             __global const skg_cell_line *lines, __global skg_sum *sums) {
    const int column = args.window[0] + SKG_WIDE * (int)get_global_id(0);
    const int row = args.window[1] + (int)get_global_id(1), lanes = min(args.window[2] - column, SKG_WIDE);
    skg_cell_rays rays;
    skg_cell_sum own[SKG_WIDE], off[SKG_WIDE];
    if (row >= args.window[3] || lanes <= 0) return;
    weights += args.first_weight;
    for (int l = 0; l < SKG_WIDE; l++) {
        own[l] = off[l] = (skg_cell_sum)(0);
        skg_set_cell_ray(&args, lines, column + min(l, lanes - 1), row, l, &rays);
    }
    for (int axis = 0; axis < 3; axis++)
        skg_walk_cells(&args, &rays, axis, 0, lanes, rays.from, rays.to, cells, weights, own);
    __global skg_sum *sum = sums + (size_t)row * (size_t)args.layout.stride + (size_t)column;
    for (int l = 0; l < lanes; l++) {
        const int at = column + l, pixel = row * args.layout.columns + at;
        const int listed = args.slot >= 0 && at >= args.lists[0] && at < args.lists[2] && row >= args.lists[1] &&
                           row < args.lists[3] && counts[pixel] > 0;
        if (listed)
            skg_displace_cells(&args, &rays, l, hits + starts[pixel], counts[pixel], table, displacing, cells, weights, off);
        skg_put_cells(&args, rays.way[l], &own[l], &off[l], weights, sum + l);
    }
}
