/* The derivative of a loss by the vertices of every triangle, gathered from the weights of weights.cl.
 *
 * When corner k of a face moves by dv_k, the path parameter of a hit moves by dt = (t / h) n . sum of b_k dv_k, with the face's
 * normal n, the distance h = n . (v_0 - source) and the barycentric coordinates b_k of the hit. In the picture the coordinates
 * are lambda_k, affine in the pixel, and b_k = lambda_k t / t_k. So the derivative by v_k is
 * n / (h t_k) times the sum over hits of (d loss / d t) lambda_k t^2, and three sums for each face are enough, of which the host
 * makes those with lambda_k: the same with 1, the column and the row. They are 64-bit integers, whose order does not matter. A
 * parallel beam has b_k = lambda_k and dt = n . sum of b_k dv_k / n . d. */

/* Adds to a 64-bit sum in memory: a pair of 32-bit words, low word first. */
static void skg_add_moment(__global ulong *place, long value) {
    volatile __global uint *word = (volatile __global uint *)place;
    const uint low = (uint)value;
    const uint old = low ? atomic_add(word, low) : 0;
    const uint high = (uint)((ulong)value >> 32) + (uint)(old + low < old);
    if (high) atomic_add(word + 1, high);
}

/* lambda_1 and lambda_2 of a face: each is at_0 + along_i i + along_j j. */
typedef struct {
    skg_real x, y, i1, j1, i2, j2;
} skg_shares;

static void skg_shares_of(skg_real4 a, skg_real4 b, skg_real4 c, skg_shares *out) {
    const skg_real area = skg_less(b.x - a.x, c.y - a.y, c.x - a.x, b.y - a.y);
    const skg_real inverse = fabs(area) < SKG_THIN ? 0 : 1 / area;
    out->x = a.x, out->y = a.y;
    out->i1 = (c.y - a.y) * inverse, out->j1 = -(c.x - a.x) * inverse;
    out->i2 = -(b.y - a.y) * inverse, out->j2 = (b.x - a.x) * inverse;
}

typedef struct {
    __global const skg_contribution *contributions;
    __global const skg_real *weights;
#if SKG_AROUND
    __global const skg_contribution *around;
    int first_around, last_around;
    skg_real around_scale;
#endif
    const skg_gradient_args *args;
    skg_real reference; /* of the part */
#if SKG_FORWARD
    __global ulong *pixels;
    skg_real slopes_of_face[3]; /* at corner 0, and by how much they differ from it at the others */
#endif
#if SKG_PRIORITY
    skg_real shift; /* of its depths in the lists of hits */
    int slot;       /* -1: it does not compete */
    __global const int *counts;
    __global const uint *starts;
    __global const skg_listed *hits;
    __global const skg_real *slopes;
#endif
} skg_gathering;

#if SKG_PRIORITY
/* Contribution of priorities to d loss / d q of a hit: the mean over the pixel's hits that are like it. */
static skg_real skg_slope_of(const skg_gathering *g, int column, int row, skg_real q, int enters) {
    const int4 window = vload4(0, g->args->window);
    if (column < window.x || row < window.y || column >= window.z || row >= window.w) return 0;
    const int pixel = row * g->args->layout.columns + column, count = g->counts[pixel];
    if (count == 0) return 0;
    const uint start = g->starts[pixel];
#if SKG_PARALLEL
    const skg_real depth = q + g->shift;
#else
    const skg_real depth = fma(q, g->reference, g->shift);
#endif
    skg_real sum = 0;
    int alike = 0;
    for (int k = 0; k < count; k++)
        if (g->hits[start + k].depth == depth && g->hits[start + k].code == 2 * g->slot + enters)
            sum += g->slopes[start + k], alike++;
    const skg_real slope = alike ? sum / alike : 0;
    return SKG_PARALLEL ? slope : slope * g->reference;
}
#endif

/* d loss / d q of a hit of a part but for priorities. */
static skg_real skg_weight_of(const skg_gathering *g, const skg_range *range, int column, int row, int negative) {
    if (SKG_SLOPES_ALONE) return 0;
    __global const skg_real *at = g->weights + (long)row * g->args->stride + column;
    skg_real weight = 0;
    for (int w = 0; w < (!SKG_LISTED ? 1 : range->contributions); w++) {
        __global const skg_contribution *contribution = &g->contributions[range->first_contribution + w];
        weight = fma(contribution->weight, at[(long)contribution->plane * g->args->plane], weight);
    }
    return negative ? -weight : weight;
}

#if SKG_AROUND
/* The weight of a hit by what stands around the part, for a unit of depth. */
static skg_real skg_around_of(const skg_gathering *g, const skg_range *range, int column, int row, int negative) {
    __global const skg_real *at = g->weights + (long)row * g->args->stride + column;
    skg_real weight = 0;
    for (int w = g->first_around; w < g->last_around; w++)
        weight = fma(g->around[w].weight, at[(long)g->around[w].plane * g->args->plane], weight);
    const skg_real factor = SKG_LISTED ? 1 : g->contributions[range->first_contribution].weight;
    return weight * (negative ? -factor : factor);
}
#endif

/* Adds the hits of a row of a face to its moments; with SKG_FORWARD to the sums of their pixels instead. */
static void skg_gather_row(const skg_gathering *g, const skg_range *range, const skg_face *f, const skg_shares *shares,
                           const skg_box *box, int row, skg_real scale, long *moments) {
    skg_line line;
    (void)shares, (void)moments; /* of one of the two */
    skg_row(f, (skg_real)row, &line);
    const int negative = skg_negative(f, &line);
    const int2 columns = skg_columns_of(&line, box);
    const skg_real end = SKG_PARALLEL ? range->highest : range->highest / (1 - range->highest);
#if SKG_FORWARD
    const skg_real above = (skg_real)row - shares->y;
    const skg_real first1 = shares->j1 * above, first2 = shares->j2 * above;
#endif
    for (int column = columns.x; column < columns.y; column++) {
        if (!skg_hit(&line, (skg_real)column)) continue;
        const skg_real q = skg_depth(f, &line, (skg_real)column);
#if SKG_AROUND
        moments[3] += convert_long_rte(
            skg_around_of(g, range, range->pixel_i + column, range->pixel_j + row, negative) * q * g->around_scale);
#endif
        if (q >= end) continue; /* the path ends at the pixel, wherever the face is */
        /* t / reference = 1 + q. A unit is far below the last bit of a hit, so that it does not matter how it is rounded. */
        const skg_real deep = SKG_PARALLEL ? 1 : (1 + q) * (1 + q);
        const skg_real weight = skg_weight_of(g, range, range->pixel_i + column, range->pixel_j + row, negative);
#if SKG_PRIORITY
        const skg_real lost =
            g->slot < 0 ? 0 : skg_slope_of(g, range->pixel_i + column, range->pixel_j + row, q, negative != 0);
#else
        const skg_real lost = 0;
#endif
#if SKG_FORWARD
        const skg_real past = (skg_real)column - shares->x;
        const skg_real share1 = clamp(fma(shares->i1, past, first1), (skg_real)0, (skg_real)1);
        const skg_real share2 = clamp(fma(shares->i2, past, first2), (skg_real)0, (skg_real)1);
        const skg_real slope = fma(share1, g->slopes_of_face[1], fma(share2, g->slopes_of_face[2], g->slopes_of_face[0]));
        const long pixel = (long)(range->pixel_j + row) * g->args->stride + range->pixel_i + column;
        skg_add_moment(g->pixels + pixel, convert_long_rte((weight + lost) * deep * scale * slope));
#else
        const long worth = convert_long_rte(weight * deep * scale) + convert_long_rte(lost * deep * scale);
        moments[0] += worth;
        moments[1] += worth * column;
        moments[2] += worth * row;
#endif
    }
}

/* Whether a face is seen as a line: narrower than SKG_LINE pixels, or than what rounding makes of the places of its corners. A ray that hits it
 * is an accident, and its slope has no bound. The host integrates such faces over the pixels (lib/gradient/steep.h). */
static int skg_is_edge_on(skg_real4 a, skg_real4 b, skg_real4 c) {
    const skg_real4 ab = fabs(b - a), ac = fabs(c - a), bc = fabs(c - b);
    const skg_real longest = fmax(fmax(fmax(ab.x, ab.y), fmax(ac.x, ac.y)), fmax(bc.x, bc.y));
    const skg_real4 most = fmax(fmax(fabs(a), fabs(b)), fabs(c));
    const skg_real width = fmax((skg_real)SKG_LINE, SKG_LINE_ROUNDING * fmax(most.x, most.y));
    return fabs(skg_less(b.x - a.x, c.y - a.y, c.x - a.x, b.y - a.y)) <= width * longest;
}

/* The moments of a face from its rows `first`, first + step, ... */
SKG_APART void skg_gather_face(skg_gathering *g, const skg_range *range, skg_real4 a, skg_real4 b, skg_real4 c,
                               const skg_box *box, int first, int step, skg_real scale, long *moments) {
    skg_face f;
    skg_shares shares;
    skg_face_of(range, a, b, c, &f);
    skg_shares_of(a, b, c, &shares);
    for (int row = box->j0 + first; row < box->j1; row += step)
        skg_gather_row(g, range, &f, &shares, box, row, scale, moments);
}

/* Each work-item takes every get_global_size(1)-th row of one triangle.
 *
 * weights   [planes][plane] of skg_weights
 * scales    [2][parts] units of a moment for 1; 0: the part has no moments; and the units of the fourth
 * first_around, around   what stands around part p: around[first_around[p]] to around[first_around[p + 1] - 1]; SKG_AROUND.
 *           Weights as of contributions, without SKG_LISTED over that of the part's own contribution
 * moments   [triangles + 1][4] 0 before: the sum of weights of the hits, times t^2 over the square of the part's reference; and the
 *           same times column and row from the part's own pixel; SKG_EDGE_ON first of a face that is seen as a line.
 *           Fourth the sum of q times weights by what stands around the part; SKG_AROUND. Behind those of all faces: 1: some
 *           are seen as lines
 *           With SKG_SLOPES_ALONE they are added to
 *           With SKG_FORWARD: [rows][stride] the sums over the hits of a pixel of weight times the slope of the hit
 * slots, shifts, counts, starts, hits, slopes: of skg_hits_slopes; SKG_PRIORITY
 * face_slopes   [triangles][3] slopes at the corners; SKG_FORWARD
 * lines         [triangles + 1] SKG_FORWARD, without SKG_SLOPES_ALONE: set to 1 of faces that are seen as lines, and behind all if there are any */
__kernel void skg_gradient_faces(skg_gradient_args args, __global const int *corners,
                                 __global const skg_real4 *projected, __global const skg_part_entry *parts,
                                 __global const int *blocks, __global const skg_contribution *contributions,
                                 __global const skg_real *weights, __global const skg_real *scales,
                                 __global const int *first_around, __global const skg_contribution *around,
                                 __global ulong *moments, __global const int *slots,
                                 __global const skg_real *shifts, __global const int *counts,
                                 __global const uint *starts, __global const skg_listed *hits,
                                 __global const skg_real *slopes, __global const skg_real *face_slopes,
                                 __global uchar *lines) {
    const int triangle = (int)get_global_id(0);
    if (triangle >= args.layout.triangles) return;
    skg_range range;
    skg_range_of(parts, skg_part_of_triangle(parts, blocks, triangle), &range);
    const skg_real scale = scales[range.number];
    skg_real4 a, b, c;
    skg_box box;
    skg_corners(corners, projected, &range, triangle, &a, &b, &c);
    if (range.contributions == 0 || (scale == 0 && !SKG_AROUND)) return;
    if (skg_is_edge_on(a, b, c)) {
        if (!SKG_FORWARD && !SKG_SLOPES_ALONE && get_global_id(1) == 0)
            moments[4 * (long)triangle] = SKG_EDGE_ON, moments[4 * (long)args.layout.triangles] = 1;
        if (SKG_FORWARD && !SKG_SLOPES_ALONE && get_global_id(1) == 0) lines[triangle] = lines[args.layout.triangles] = 1;
        return;
    }
#if SKG_SLOPES_ALONE
    if (slots[range.number] < 0) return;
    const int4 window = skg_window(&range, args.window[0], args.window[1], args.window[2], args.window[3]);
#else
    const int4 window = skg_window(&range, 0, 0, args.layout.columns, args.layout.rows);
#endif
    if (!skg_bounds(&range, a, b, c, window, &box)) return;
    skg_gathering g;
    g.contributions = contributions;
    g.weights = weights;
    g.args = &args;
    g.reference = parts[range.number].reference;
#if SKG_AROUND
    g.around = around;
    g.first_around = first_around[range.number], g.last_around = first_around[range.number + 1];
    g.around_scale = scales[args.layout.parts + range.number];
#endif
#if SKG_PRIORITY
    g.slot = slots[range.number] % SKG_HITS_BACKGROUND;
    g.shift = g.slot < 0 ? 0 : shifts[g.slot];
    g.counts = counts, g.starts = starts, g.hits = hits, g.slopes = slopes;
#endif
    long own[4] = {0, 0, 0, 0};
#if SKG_FORWARD
    __global const skg_real *slope = face_slopes + 3 * (long)triangle;
    g.pixels = moments;
    g.slopes_of_face[0] = slope[0];
    g.slopes_of_face[1] = slope[1] - slope[0];
    g.slopes_of_face[2] = slope[2] - slope[0];
#endif
    skg_gather_face(&g, &range, a, b, c, &box, (int)get_global_id(1), (int)get_global_size(1), scale, own);
#if !SKG_FORWARD
    for (int k = 0; k < 3 + SKG_AROUND; k++) skg_add_moment(moments + 4 * (long)triangle + k, own[k]);
#endif
}
