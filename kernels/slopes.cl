/* What priorities add to the derivative by the depth of a hit. Over interval k, from depth_k to depth_k+1, the parts that lose it
 * are taken off the sums: T_k for a unit of length. Lengths are continuous where the winner changes, so a hit that moves
 * changes the sums by T_k - T_k-1 for a unit of its depth. */

/* d loss / d length of what is taken off over an interval. */
static skg_real skg_taken_off(__global const skg_part_entry *part, __global const skg_contribution *contributions,
                              __global const skg_real *weights, int plane) {
    skg_real sum = 0;
    for (int w = part->first_contribution; w < part->first_contribution + part->contributions; w++)
        sum = fma(contributions[w].weight, weights[(long)contributions[w].plane * plane], sum);
    return SKG_PARALLEL ? sum : sum / part->reference;
}

/* Behind skg_hits_settle, which has sorted the hits; one work-item per pixel of the window. slopes: of the hits. */
__kernel void skg_hits_slopes(skg_gradient_args args, __global const skg_part_entry *parts,
                              __global const skg_contribution *contributions, __global const int *counts,
                              __global const uint *starts, __global const skg_listed *hits, __global const int *table,
                              __global const skg_real *weights, __global skg_real *slopes) {
    const int column = args.window[0] + (int)get_global_id(0), row = args.window[1] + (int)get_global_id(1);
    if (column >= args.window[2] || row >= args.window[3]) return;
    const int count = counts[row * args.layout.columns + column];
    if (count == 0) return;
    const uint start = starts[row * args.layout.columns + column];
    __global const skg_real *at = weights + (long)row * args.stride + column;
    int winding[SKG_SLOTS];
    uint active[SKG_WORDS];
    skg_real before = 0;
    hits += start;
    for (int k = 0; k < count; k++) winding[hits[k].code / 2] = 0;
    for (int w = 0; w < SKG_WORDS; w++) active[w] = 0;
    for (int k = 0; k < count; k++) {
        skg_real off = 0;
        skg_pass_hit(hits[k].code, winding, active);
        if (k + 1 < count && hits[k + 1].depth > hits[k].depth) {
            uint dropped[SKG_WORDS];
            skg_drop(table, active, dropped);
            for (int w = 0; w < SKG_WORDS; w++)
                for (uint rest = dropped[w]; rest; rest &= rest - 1) {
                    const int slot = 32 * w + 31 - (int)clz(rest & (~rest + 1));
                    off += (skg_real)winding[slot] *
                           skg_taken_off(&parts[table[slot * SKG_ENTRY]], contributions, at, args.plane);
                }
        } else if (k + 1 < count) {
            off = before; /* an interval without length: the hits at one depth share what changes there */
        }
        slopes[start + (uint)k] = off - before;
        before = off;
    }
}
