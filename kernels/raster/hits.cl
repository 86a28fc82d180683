/* Parts that compete for intervals along a ray. The hits of these parts are listed per pixel: counted, given their place,
 * and written. Then they are sorted and swept, and what the losers had added is subtracted from the sums as integers.
 * Coverage and depths are those of the rasterisers (triangle.clh), so that exactly what was added is subtracted. */

typedef struct {
    __global const int *slots;       /* [parts] -1: the part does not compete; see SKG_HITS_BACKGROUND */
    __global const skg_real *shifts; /* [slots] the part's reference minus the common one */
    __global int *counts;            /* [rows][columns] of background parts; then cursors */
    __global uint *starts;           /* [rows][columns] while hits are counted, those of winners; then places */
    __global skg_listed *hits;
    int task; /* SKG_HITS_... */
} skg_lists;

/* The slot of a part whose hits this launch takes; -1: it does not take them. background: whether it wins over none. */
static int skg_slot_of(const skg_lists *lists, int part, int *background) {
    const int slot = lists->slots[part];
    *background = slot >= SKG_HITS_BACKGROUND;
    const int takes = lists->task == SKG_HITS_LIST || *background == (lists->task == SKG_HITS_COUNT_BACKGROUND);
    return slot < 0 || !takes ? -1 : *background ? slot - SKG_HITS_BACKGROUND : slot;
}

/* Whether a hit at a pixel is listed. Winners are the parts that displace another one; their hits always are. Hits of the other
 * competitors are listed only in pixels where a winner was hit, too: elsewhere nothing displaces them. `starts` says where that
 * is. While hits are counted it holds the number of winners' hits of each pixel, which is 0 if there are none. Afterwards it
 * holds the place of each pixel's list, which is SKG_HITS_MAX if there are none. */
static int skg_is_listed(const skg_lists *lists, int pixel, int background) {
    return !background || lists->starts[pixel] != (lists->task == SKG_HITS_LIST ? SKG_HITS_MAX : 0);
}

/* Counts or lists one hit. q: its depth as skg_depth returns it. */
static void skg_list(const skg_lists *lists, int slot, int pixel, skg_real q, skg_real reference, int enters) {
    if (lists->task == SKG_HITS_COUNT) {
        atomic_inc(&lists->starts[pixel]);
        return;
    }
    const int place = atomic_inc(&lists->counts[pixel]);
    if (lists->task == SKG_HITS_COUNT_BACKGROUND) return;
#if SKG_PARALLEL
    const skg_real depth = q + lists->shifts[slot];
#else
    const skg_real depth = fma(q, reference, lists->shifts[slot]);
#endif
    lists->hits[lists->starts[pixel] + (uint)place] = (skg_listed){depth, 2 * slot + enters};
}

#define SKG_LIST_ARGUMENTS                                                                                            \
    __global const int *slots, __global const skg_real *shifts, __global int *counts, __global uint *starts,          \
        __global skg_listed *hits

/* The columns of a row in which hits of a triangle may be listed: of a winner all columns of the triangle's box, of another
 * competitor only those from the first column in which a winner was hit (span[0]) to the last (span[1] - 1). */
static skg_box skg_between_winners(const skg_box *box, __global const int *span, int pixel_i, int background) {
    skg_box seen = *box;
    if (background) {
        seen.i0 = max(seen.i0, span[0] - pixel_i);
        seen.i1 = min(seen.i1, span[1] - pixel_i);
    }
    return seen;
}

/* Whether nothing is listed of a row of a triangle. */
static int skg_is_apart(const skg_box *box, __global const int *spans, const skg_range *range, int row, int background) {
    const skg_box seen = skg_between_winners(box, spans + 2 * (range->pixel_j + row), range->pixel_i, background);
    return seen.i0 >= seen.i1;
}

/* Clears what a frame counts; a work-item takes a row of the window. */
__kernel void skg_hits_clear(skg_hits_args args, __global int2 *spans, __global int *counts, __global uint *starts,
                             __global skg_hit_count *total) {
    const int row = args.window[1] + (int)get_global_id(0);
    if (row == args.window[1]) total->low = total->high = 0;
    if (row >= args.window[3]) return;
    /* Winners that reach the source's plane are listed by a kernel that leaves the spans alone. */
    spans[row] = SKG_SOURCE_PLANE ? (int2)(0, args.layout.columns) : (int2)(args.layout.columns, 0);
    for (int column = args.window[0]; column < args.window[2]; column++) {
        counts[row * args.layout.columns + column] = 0;
        starts[row * args.layout.columns + column] = 0;
    }
}

/* The part of a run of competitors' triangles. */
typedef struct {
    skg_range range;
    skg_real reference;
    int slot, background;
} skg_rival;

/* Lists the hits of one triangle in every get_global_size(1)-th row. */
static void skg_list_triangle(const skg_hits_args *args, const skg_lists *lists, __global const int *corners,
                              __global const skg_real4 *projected, __global int *spans, const skg_rival *rival, int triangle) {
    const skg_range *range = &rival->range;
    const int background = rival->background;
    skg_real4 a, b, c;
    skg_box box;
    skg_corners(corners, projected, range, triangle, &a, &b, &c);
    if (!skg_bounds(range, a, b, c, skg_window(range, args->window[0], args->window[1], args->window[2], args->window[3]), &box)) return;
    int row = box.j0 + (int)get_global_id(1);
    while (row < box.j1 && skg_is_apart(&box, spans, range, row, background)) row += (int)get_global_size(1);
    if (row >= box.j1) return; /* most, before their face is worked out */
    skg_face f;
    skg_face_of(range, a, b, c, &f);
    for (; row < box.j1; row += (int)get_global_size(1)) {
        __global int *span = spans + 2 * (range->pixel_j + row);
        const skg_box seen = skg_between_winners(&box, span, range->pixel_i, background);
        if (seen.i0 >= seen.i1) continue;
        skg_line line;
        skg_row(&f, (skg_real)row, &line);
        const int enters = skg_negative(&f, &line) != 0;
        const int first = (range->pixel_j + row) * args->layout.columns + range->pixel_i;
        const int2 columns = skg_columns_of(&line, &seen);
        if (args->task == SKG_HITS_COUNT && columns.x < columns.y) {
            atomic_min(span, range->pixel_i + columns.x);
            atomic_max(span + 1, range->pixel_i + columns.y);
        }
        for (int column = columns.x; column < columns.y; column++)
            if (skg_is_listed(lists, first + column, background) && skg_hit(&line, (skg_real)column))
                skg_list(lists, rival->slot, first + column, skg_depth(&f, &line, (skg_real)column), rival->reference, enters);
    }
}

/* A work-item of a CPU takes SKG_HITS_TRIANGLES triangles, of a GPU some rows of one. runs: of the competitors' triangles, each the number of
 * the first triangle, its part and its slot, of winners first; those from chosen[0] to chosen[1] - 1 are listed. spans: of each row the columns,
 * from and to, where winners may be; they grow while winners are counted. */
__kernel void skg_hits_list(skg_hits_args args, __global const int *corners, __global const skg_real4 *projected,
                            __global const skg_part_entry *parts, __global const int *runs,
                            __global int *spans, SKG_LIST_ARGUMENTS) {
    const skg_lists lists = {slots, shifts, counts, starts, hits, args.task};
    const int each = SKG_CPU ? SKG_HITS_TRIANGLES : 1;
    int run = args.chosen[0], item = each * (int)get_global_id(0) + runs[3 * run];
    for (const int end = item + each; item < end && run < args.chosen[1]; run++) {
        const int number = runs[3 * run + 1], first = runs[3 * run], last = min(end, first + parts[number].triangles);
        skg_rival rival;
        if (item >= last) continue;
        skg_range_of(parts, number, &rival.range);
        rival.reference = parts[number].reference;
        rival.slot = runs[3 * run + 2];
        rival.background = run >= args.winners;
        for (; item < last; item++)
            skg_list_triangle(&args, &lists, corners, projected, spans, &rival, rival.range.first + item - first);
    }
}

/* Adds to a count of hits. The low word carries into the high one, so that the count is exact however many hits there
 * are, without 64-bit atomics. Returns the low word as it was before. */
static uint skg_add_hits(__global skg_hit_count *total, ulong count) {
    const uint low = atomic_add(&total->low, (uint)count);
    const uint high = (uint)(count >> 32) + (low + (uint)count < low ? 1 : 0);
    if (high) atomic_add(&total->high, high);
    return low;
}

/* Columns of a row that a work-item takes: many on a CPU, where work-items that find nothing cost more than it does. */
#define SKG_HITS_RUN (SKG_CPU ? SKG_CPU_RUN : 1)

/* Gives each pixel of the window a stretch of the list for its hits, in any order, and counts all hits in *total. Counts become
 * 0 and then serve as cursors. Starts are valid only where the host finds that *total is not above SKG_HITS_MAX. */
__kernel void skg_hits_place(skg_hits_args args, __global int *counts, __global uint *starts,
                             __global skg_hit_count *total) {
    const int column = args.window[0] + SKG_HITS_RUN * (int)get_global_id(0);
    const int row = args.window[1] + (int)get_global_id(1), end = min(column + SKG_HITS_RUN, args.window[2]);
    ulong all = 0;
    if (column >= end || row >= args.window[3]) return;
    counts += row * args.layout.columns;
    starts += row * args.layout.columns;
    for (int k = column; k < end; k++) all += (ulong)starts[k] + (ulong)counts[k];
    uint next = all ? skg_add_hits(total, all) : 0;
    for (int k = column; k < end; k++) {
        const uint count = starts[k] + (uint)counts[k];
        starts[k] = count ? next : SKG_HITS_MAX;
        counts[k] = 0;
        next += count;
    }
}

static void skg_sort_hits(__global skg_listed *hits, int count) {
    for (int k = 1; k < count; k++) {
        const skg_listed moving = hits[k];
        int to = k;
        for (; to > 0 && (hits[to - 1].depth > moving.depth ||
                          (hits[to - 1].depth == moving.depth && hits[to - 1].code > moving.code));
             to--)
            hits[to] = hits[to - 1];
        hits[to] = moving;
    }
}

/* The first copy that counts for a plane: of one to which parts have added there is one. */
static int skg_copy_of(const skg_raster_layout *layout, __global const int *used, int plane) {
    int copy = 0;
    while (copy + 1 < layout->copies && !SKG_COUNTS(used[copy], plane)) copy++;
    return copy;
}

/* Subtracts what a part has added to the sums of a pixel over an interval. place: of the pixel in a plane. */
static void skg_take_off(const skg_raster_layout *layout, __global const skg_part_entry *part,
                         __global const skg_contribution *contributions, skg_real length, size_t place,
                         __global const int *used, __global skg_sum *sums) {
#if !SKG_PARALLEL
    length /= part->reference; /* the unit of the contributions */
#endif
    for (int w = part->first_contribution; w < part->first_contribution + part->contributions; w++) {
        const int plane = contributions[w].plane;
        const size_t first = (size_t)skg_copy_of(layout, used, plane) * (size_t)layout->planes + (size_t)plane;
        sums[first * (size_t)layout->plane + place] -= (skg_sum)skg_round(length * contributions[w].weight);
    }
}

/* Notes after a hit whether a united slot has other layers than 0 or 1. */
static void skg_note_layers(__global const int *table, int code, const int *winding, uint *layered) {
    const int slot = code / 2;
    const uint bit = 1u << (slot % 32);
    if (!(table[slot * SKG_ENTRY] & SKG_HITS_UNITED)) return;
    layered[slot / 32] = winding[slot] < 0 || winding[slot] > 1 ? layered[slot / 32] | bit : layered[slot / 32] & ~bit;
}

/* How many times a slot has added too much over an interval: all of its layers if it loses it, otherwise those but one. */
static int skg_times_off(const uint *dropped, const int *winding, int slot) {
    return skg_is_in(dropped, slot) ? winding[slot] : winding[slot] - (winding[slot] > 0);
}

/* The part of a slot. */
static __global const skg_part_entry *skg_slot_part(__global const skg_part_entry *parts, __global const int *table, int slot) {
    return &parts[table[slot * SKG_ENTRY] & ~SKG_HITS_UNITED];
}

/* Decides every interval of a pixel that has hits. */
SKG_APART void skg_settle_pixel(const skg_raster_layout *layout, __global const skg_part_entry *parts,
                                __global const skg_contribution *contributions, __global skg_listed *hits, int count,
                                __global const int *table, size_t place, __global const int *used,
                                __global skg_sum *sums) {
    int winding[SKG_SLOTS];
    uint active[SKG_WORDS], layered[SKG_WORDS];
    skg_sort_hits(hits, count);
    for (int k = 0; k < count; k++) winding[hits[k].code / 2] = 0;
    for (int w = 0; w < SKG_WORDS; w++) active[w] = layered[w] = 0;
    for (int k = 0; k + 1 < count; k++) {
        skg_pass_hit(hits[k].code, winding, active);
        skg_note_layers(table, hits[k].code, winding, layered);
        const skg_real length = hits[k + 1].depth - hits[k].depth;
        if (!(length > 0)) continue;
        uint dropped[SKG_WORDS];
        skg_drop(table, active, dropped);
        for (int w = 0; w < SKG_WORDS; w++)
            for (uint rest = dropped[w] | layered[w]; rest; rest &= rest - 1) {
                const int slot = 32 * w + 31 - (int)clz(rest & (~rest + 1));
                skg_take_off(layout, skg_slot_part(parts, table, slot), contributions,
                             length * (skg_real)skg_times_off(dropped, winding, slot), place, used, sums);
            }
    }
}

/* Decides every interval of the pixels of the window. table: [slots][SKG_ENTRY], parents before their children. */
__kernel void skg_hits_settle(skg_hits_args args, __global const skg_part_entry *parts,
                              __global const skg_contribution *contributions, __global const int *counts,
                              __global const uint *starts, __global skg_listed *hits, __global const int *table,
                              __global const int *used, __global skg_sum *sums) {
    const int first = args.window[0] + SKG_HITS_RUN * (int)get_global_id(0);
    const int row = args.window[1] + (int)get_global_id(1), end = min(first + SKG_HITS_RUN, args.window[2]);
    if (row >= args.window[3]) return;
    for (int column = first; column < end; column++) {
        const int pixel = row * args.layout.columns + column, count = counts[pixel];
        if (count == 0) continue;
        const size_t place = (size_t)row * (size_t)args.layout.stride + (size_t)column;
        skg_settle_pixel(&args.layout, parts, contributions, hits + starts[pixel], count, table, place, used, sums);
    }
}

/* Makes the kernel of source_plane.cl list hits, too. */
#define SKG_SOURCE_KERNEL skg_hits_source_plane
#define SKG_SOURCE_ARGS skg_hits_args args
#define SKG_SOURCE_LAYOUT args.layout
#define SKG_SOURCE_BUFFERS SKG_LIST_ARGUMENTS
#define SKG_SOURCE_BEGIN(range)                                                                                       \
    const skg_lists lists = {slots, shifts, counts, starts, hits, args.task};                                         \
    int background;                                                                                                        \
    const int slot = skg_slot_of(&lists, range.number, &background);                                                       \
    if (slot < 0) return
#define SKG_SOURCE_HIT(row, column, q, factor)                                                                        \
    if ((row) >= args.window[1] && (row) < args.window[3] && (column) >= args.window[0] &&                            \
        (column) < args.window[2] && skg_is_listed(&lists, (row) * args.layout.columns + (column), background))             \
    skg_list(&lists, slot, (row) * args.layout.columns + (column), q, p->reference, (factor) < 0)
