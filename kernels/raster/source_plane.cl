/* Triangles that reach the source's plane or lie behind it, whose projection is no triangle.
 *
 * The source and a row j of pixels span a plane. It divides the corners of a triangle into two classes and cuts two edges,
 * each at a point P. The line from the source through pixel (i, j) passes each P on one side or the other, and hits the
 * triangle if the two sides differ. Hits on both sides of the source are counted, and depths are clamped to the path, so that
 * signed counts still cancel. A corner in front of the source gets the class that triangle.clh gives it, and an edge between
 * two such corners the same crossing: neighbours that are drawn there fit without a seam.
 *
 * With SKG_SEAMS, other corners and points P are moved as well, by more than their rounding: a corner that is within it
 * of the row's plane belongs to the lower class, and a line that is within it of P passes P on the right. */

/* The share of its terms by which a distance from the row's plane or from a line is taken for 0. */
#if SKG_DOUBLE
#define SKG_TOUCH 0x1p-44
#else
#define SKG_TOUCH 0x1p-22f
#endif

/* A corner: x, y of its projection if it is in front of the source, and h = (t i, t j, t) relative to the part's own pixel. */
typedef struct {
    skg_real x, y, hx, hy, t, r;
    int front;
} skg_corner;

static void skg_corner_of(__global const skg_part_entry *p, __global const skg_real *vertices, int corner,
                                skg_real4 projected, skg_corner *out) {
    __global const skg_real *v = vertices + 3 * (p->mesh_vertex + corner);
    skg_corner k;
    k.x = projected.x;
    k.y = projected.y;
    k.t = projected.w;
    k.front = k.t > (skg_real)SKG_NEAR;
    k.r = p->offset_r + fma(p->row2[0], v[0], fma(p->row2[1], v[1], p->row2[2] * v[2]));
    k.hx = fma(p->anchor_x, k.t, p->offset_x + fma(p->row0[0], v[0], fma(p->row0[1], v[1], p->row0[2] * v[2])));
    k.hy = fma(p->anchor_y, k.t, p->offset_y + fma(p->row1[0], v[0], fma(p->row1[1], v[1], p->row1[2] * v[2])));
    *out = k;
}

static int skg_below(const skg_corner *k, skg_real j) {
    return k->front ? k->y <= j : fma(-j, k->t, k->hy) <= SKG_SEAMS * SKG_TOUCH * (fabs(k->hy) + fabs(j * k->t));
}

/* The point where the row's plane cuts an edge. */
typedef struct {
    skg_real x;          /* its column, if both ends are in front */
    skg_real px, pt, pr; /* hx, t and r of the point */
    skg_real touch;      /* the distance from it that is 0 */
    int front;
} skg_cut;

static void skg_cut_of(const skg_corner *low, const skg_corner *high, skg_real j, skg_real shift, skg_cut *out) {
    skg_cut cut;
    const skg_real s = fma(-j, low->t, low->hy), e = fma(-j, high->t, high->hy);
    skg_real part = s / (s - e);
    part = part > 0 ? part : 0;
    part = part < 1 ? part : 1;
    cut.px = fma(part, high->hx - low->hx, low->hx);
    cut.pt = fma(part, high->t - low->t, low->t);
    cut.pr = fma(part, high->r - low->r, low->r);
    cut.touch = SKG_SEAMS * SKG_TOUCH * (fabs(low->hx) + fabs(high->hx));
    cut.front = low->front && high->front;
    const skg_real slope = (high->x - low->x) / (high->y - low->y);
    cut.x = fma(j - low->y, slope, skg_moved(low->x, slope, shift));
    *out = cut;
}

static skg_real skg_beside(const skg_cut *cut, skg_real i) {
    return fma(i, cut->pt, -cut->px);
}

static int skg_passed(const skg_cut *cut, skg_real i) {
    return cut->front ? i >= cut->x : skg_beside(cut, i) >= (cut->pt < 0 ? cut->touch : -cut->touch);
}

/* Whether no row from first to last separates the corners: each corner changes its class at one row at most. */
static int skg_is_aside(const skg_corner *k, int first, int last) {
    const int below = skg_below(&k[0], (skg_real)first);
    int same = 1;
    for (int c = 0; c < 3; c++)
        same &= below == skg_below(&k[c], (skg_real)first) && below == skg_below(&k[c], (skg_real)last);
    return same;
}

/* The cuts of row j: of the edges that go up and down in the order of the corners. 0 if there are none. */
static int skg_cut_row(const skg_corner *k, skg_real j, skg_real shift, skg_cut *up, skg_cut *down) {
    const int below[3] = {skg_below(&k[0], j), skg_below(&k[1], j), skg_below(&k[2], j)};
    for (int e = 0; e < 3; e++) {
        const int next = e == 2 ? 0 : e + 1;
        if (below[e] && !below[next]) skg_cut_of(&k[e], &k[next], j, shift, up);
        if (!below[e] && below[next]) skg_cut_of(&k[next], &k[e], j, shift, down);
    }
    return below[0] != below[1] || below[1] != below[2];
}

/* Columns x to y - 1. Every line outside passes both cuts on the same side; if z is 1, because one cut is behind the source,
 * every line from x to y - 2 does. They have a margin, and if in doubt, no column is left out. */
static int4 skg_columns_between(const skg_cut *a, const skg_cut *b, int left, int right) {
    const skg_real first = (skg_real)left, end = (skg_real)right, sides = a->pt * b->pt;
    if (!(sides > 0 || sides < 0)) return (int4)(left, right, 0, 0);
    const skg_real xa = a->front ? a->x : a->px / a->pt, xb = b->front ? b->x : b->px / b->pt;
    skg_real low = xa < xb ? xa : xb, high = xa < xb ? xb : xa;
    const skg_real touch = SKG_SEAMS ? fabs(a->touch / a->pt) + fabs(b->touch / b->pt) : 0;
    const skg_real margin = 2 + (fabs(low) + fabs(high)) * (skg_real)0x1p-12f + touch;
    low += sides > 0 ? -margin : margin;
    high += sides > 0 ? margin : -margin;
    if (sides < 0 && !(low < high)) return (int4)(left, right, 0, 0);
    low = low > first ? low : first;
    low = low < end ? low : end;
    high = high > first ? high : first;
    high = high < end ? high : end;
    return (int4)((int)low, (int)high == right ? right : (int)high + 1, sides < 0, 0);
}

/* r of the hit between the cuts, clamped to the path. */
static skg_real skg_depth_between(const skg_cut *a, const skg_cut *b, skg_real i, skg_real reference) {
    const skg_real s = skg_beside(a, i), e = skg_beside(b, i);
    skg_real part = s / (s - e);
    part = part > 0 ? part : 0;
    part = part < 1 ? part : 1;
    const skg_real r = fma(part, b->pr - a->pr, a->pr);
    const skg_real end = 1 - reference;
    return r < -reference ? -reference : r > end ? end : r;
}

/* Handling of a hit: it is added to the sums, unless a file before this one (hits.cl) defines otherwise. */
#ifndef SKG_SOURCE_HIT
#define SKG_SOURCE_KERNEL skg_source_plane
#define SKG_SOURCE_ARGS skg_raster_layout layout
#define SKG_SOURCE_LAYOUT layout
#define SKG_SOURCE_BUFFERS __global const skg_contribution *contributions, __global skg_sum *sums
#define SKG_SOURCE_BEGIN(range) if (range.contributions == 0) return
#define SKG_SOURCE_HIT(row, column, q, factor)                                                                \
    skg_deposit_global(sums + ((row) * layout.stride + (column)), layout.plane, contributions, &range, q, factor)
#endif

/* Each work-item takes every get_global_size(1)-th block of SKG_SOURCE_ROWS rows of one triangle. */
__kernel void SKG_SOURCE_KERNEL(SKG_SOURCE_ARGS, __global const int *corners,
                               __global const skg_real4 *projected, __global const skg_part_entry *parts,
                               __global const int *blocks, __global const skg_real *vertices,
                               SKG_SOURCE_BUFFERS) {
    const int triangle = (int)get_global_id(0), rows = SKG_SOURCE_LAYOUT.rows;
    if (triangle >= SKG_SOURCE_LAYOUT.triangles) return;
    skg_range range;
    skg_range_of(parts, skg_part_of_triangle(parts, blocks, triangle), &range);
    SKG_SOURCE_BEGIN(range);
    __global const skg_part_entry *p = &parts[range.number];
    __global const int *corner = corners + 3 * (triangle + range.corner_shift);
    skg_real4 a, b, c;
    skg_corners(corners, projected, &range, triangle, &a, &b, &c);
    if (a.w > (skg_real)SKG_NEAR && b.w > (skg_real)SKG_NEAR && c.w > (skg_real)SKG_NEAR) return;
    skg_corner k[3];
    skg_corner_of(p, vertices, corner[0], a, &k[0]);
    skg_corner_of(p, vertices, corner[1], b, &k[1]);
    skg_corner_of(p, vertices, corner[2], c, &k[2]);
    const int left = -range.pixel_i, right = SKG_SOURCE_LAYOUT.columns + left;
    if (skg_is_aside(k, -range.pixel_j, rows - 1 - range.pixel_j)) return;
    for (int block = (int)get_global_id(1); SKG_SOURCE_ROWS * block < rows; block += (int)get_global_size(1)) {
        const int first = SKG_SOURCE_ROWS * block, end = min(first + SKG_SOURCE_ROWS, rows);
        if (skg_is_aside(k, first - range.pixel_j, end - 1 - range.pixel_j)) continue;
        for (int row = first; row < end; row++) {
            skg_cut up, down;
            if (!skg_cut_row(k, (skg_real)(row - range.pixel_j), range.shift, &up, &down)) continue;
            const int4 columns = skg_columns_between(&up, &down, left, right);
            const int last = columns.z ? right : columns.y;
            for (int column = columns.z ? left : columns.x; column < last; column++) {
                if (columns.z && column == columns.x) column = max(column, columns.y - 1);
                const skg_real i = (skg_real)column;
                const int passed = skg_passed(&down, i);
                if (passed == skg_passed(&up, i)) continue;
                const skg_real r = skg_depth_between(&down, &up, i, p->reference);
                SKG_SOURCE_HIT(row, range.pixel_i + column, r / p->reference,
                               (passed != 0) == (range.turned == 0) ? 1 : -1);
            }
        }
    }
}
