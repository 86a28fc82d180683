/* Derivative by the depth of a hit through priorities. Over interval k, from depth_k to depth_k+1, the parts that lose it
 * are taken off the sums: T_k for a unit of length. Lengths are continuous where the winner changes, so a hit that moves
 * changes the sums by T_k - T_k-1 for a unit of its depth. So do hits at one place, in the order in which they are taken. */

/* d loss / d length of what is taken off over an interval. */
static skg_real skg_taken_off(__global const skg_part_entry *part, __global const skg_contribution *contributions,
                              __global const skg_real *weights, int plane) {
    skg_real sum = 0;
    for (int w = part->first_contribution; w < part->first_contribution + part->contributions; w++)
        sum = fma(contributions[w].weight, weights[(long)contributions[w].plane * plane], sum);
    return SKG_PARALLEL ? sum : sum / part->reference;
}

/* Faces of parts that touch differ by their rounding alone. There the sums have a kink if one part displaces another, and rounding would
 * choose its side pixel by pixel. So hits within `touch` of each other are taken in one order. Two parts that touch are taken to be apart, as
 * they are where their bounds do not meet, and none competes. Of more, all are the least bit larger, so that parts which meet over
 * another one leave no gap. Of faces that look one way, that of the part which displaces the other, or which the other is inside, is the
 * farther out: several that displace another one from the same place have the derivatives that each has alone. Hits of one part keep
 * their order. */
#define SKG_TOUCHING 16

static int skg_is_listed_in(__global const int *set, int slot) {
    return (int)((uint)set[slot / 32] >> (slot % 32) & 1);
}

/* Whether a slot displaces another one or what that is inside, or that is inside it. */
static int skg_is_larger(__global const int *table, int slot, int than) {
    __global const int *over = table + than * SKG_ENTRY + 2, *around = over + SKG_WORDS;
    if (skg_is_listed_in(over, slot) || skg_is_listed_in(around, slot)) return 1;
    for (int w = 0; w < SKG_WORDS; w++)
        for (uint rest = (uint)around[w]; rest; rest &= rest - 1) {
            const int up = 32 * w + 31 - (int)clz(rest & (~rest + 1));
            if (skg_is_listed_in(table + up * SKG_ENTRY + 2, slot)) return 1;
        }
    return 0;
}

/* Order of a hit: entering parts stand before leaving ones, or if they are apart behind them, and parts that do both between them. */
static int skg_phase(__global const skg_listed *hits, int count, int apart, int k) {
    for (int m = 0; m < count; m++)
        if (hits[m].code == (hits[k].code ^ 1)) return 1;
    return (hits[k].code & 1) == apart ? 2 : 0;
}

SKG_APART int skg_precedes(__global const skg_listed *hits, int count, int apart, __global const int *table, int k, int other) {
    const int a = hits[k].code / 2, b = hits[other].code / 2;
    const int phase = skg_phase(hits, count, apart, k), behind = skg_phase(hits, count, apart, other);
    if (phase != behind) return phase < behind;
    if (a == b || phase == 1) return k < other;
    return hits[k].code & 1 ? skg_is_larger(table, a, b) : skg_is_larger(table, b, a);
}

/* The order of a few hits that are all at one place. */
SKG_APART void skg_order_hits(__global const skg_listed *hits, int count, __global const int *table, uchar *order) {
    uint left = (1u << count) - 1;
    int apart = 1, second = -1;
    for (int k = 0; k < count; k++) {
        const int slot = hits[k].code / 2;
        if (slot == hits[0].code / 2 || slot == second) continue;
        apart &= second < 0;
        second = slot;
    }
    for (int place = 0; place < count; place++) {
        int next = -1;
        for (int k = 0; k < count && next < 0; k++) {
            int is_first = (int)(left >> k & 1);
            for (int other = 0; other < count && is_first; other++)
                if (other != k && (left >> other & 1)) is_first = !skg_precedes(hits, count, apart, table, other, k);
            if (is_first) next = k;
        }
        if (next < 0) next = 31 - (int)clz(left & (~left + 1));
        order[place] = (uchar)next;
        left &= ~(1u << next);
    }
}

/* Losses of a pixel: its parts, contributions and weights. */
typedef struct {
    __global const skg_part_entry *parts;
    __global const skg_contribution *contributions;
    __global const int *table;
    __global const skg_real *weights; /* at the pixel */
    int plane;
} skg_losing;

/* Sum over all parts that lose the interval, for a unit of length. */
SKG_APART skg_real skg_all_off(const skg_losing *l, const int *winding, const uint *active) {
    uint dropped[SKG_WORDS];
    skg_real off = 0;
    skg_drop(l->table, active, dropped);
    for (int w = 0; w < SKG_WORDS; w++)
        for (uint rest = dropped[w]; rest; rest &= rest - 1) {
            const int slot = 32 * w + 31 - (int)clz(rest & (~rest + 1));
            off += (skg_real)winding[slot] *
                   skg_taken_off(&l->parts[l->table[slot * SKG_ENTRY]], l->contributions, l->weights, l->plane);
        }
    return off;
}

/* Behind skg_hits_settle, which has sorted the hits; one work-item per pixel of the window. slopes: of the hits. touch: the depths of hits at
 * one place differ by no more */
__kernel void skg_hits_slopes(skg_gradient_args args, skg_real touch, __global const skg_part_entry *parts,
                              __global const skg_contribution *contributions, __global const int *counts,
                              __global const uint *starts, __global const skg_listed *hits, __global const int *table,
                              __global const skg_real *weights, __global skg_real *slopes) {
    const int column = args.window[0] + (int)get_global_id(0), row = args.window[1] + (int)get_global_id(1);
    if (column >= args.window[2] || row >= args.window[3]) return;
    const int count = counts[row * args.layout.columns + column];
    if (count == 0) return;
    const uint start = starts[row * args.layout.columns + column];
    const skg_losing losing = {parts, contributions, table, weights + (long)row * args.stride + column, args.plane};
    int winding[SKG_SLOTS];
    uint active[SKG_WORDS];
    uchar order[SKG_TOUCHING];
    skg_real before = 0;
    hits += start, slopes += start;
    for (int k = 0; k < count; k++) winding[hits[k].code / 2] = 0;
    for (int w = 0; w < SKG_WORDS; w++) active[w] = 0;
    for (int first = 0, end; first < count; first = end) {
        end = first + 1;
        while (end < count && end < first + SKG_TOUCHING && hits[end].depth - hits[first].depth <= touch) end++;
        if (end > first + 1) skg_order_hits(hits + first, end - first, table, order);
        for (int i = 0; i < end - first; i++) {
            const int k = first + (end > first + 1 ? order[i] : 0);
            skg_pass_hit(hits[k].code, winding, active);
            const skg_real off = first + i + 1 < count ? skg_all_off(&losing, winding, active) : 0;
            slopes[k] = off - before;
            before = off;
        }
    }
}
