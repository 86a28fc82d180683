#include "geometry/overlap.h"

#include "core/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns along each side of the grid: 65,536 columns are 1.4 mm apart in a thorax. */
enum { SIDE = 256 };

typedef struct {
    double depth;
    int32_t part, sign;
} column_hit;

typedef struct {
    double low[3], high[3], step[2];
    int64_t *first;   /* [SIDE * SIDE + 1] hits of each column */
    column_hit *hits; /* NULL while counting */
} columns;

typedef struct {
    int64_t slots, used;
    skg_overlap_pair *table; /* a hash table with linear probing; part < 0: the slot is free */
} pair_table;

/* --- columns --- */

/* Columns are off the corner of their cell by an irrational part of it (the square roots of 3 and 2 less 1), so that
 * faces along the axes and shared vertices are rarely met exactly. Where they are, the half-open rule below still
 * balances the hits. */
static double column_place(const columns *grid, int axis, int64_t index) {
    return grid->low[axis] +
           ((double)index + (axis ? 0.4142135623730951 : 0.7320508075688772)) * grid->step[axis];
}

/* The x at which the edge from a to b crosses y. The end with the lower y comes first, so that both triangles at
 * an edge get the same bits. */
static double crossing(const double *a, const double *b, double y) {
    if (a[1] > b[1] || (a[1] == b[1] && a[0] > b[0])) {
        const double *swap = a;
        a = b, b = swap;
    }
    return a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
}

/* Adds the hits of one triangle by the scan-crossing rule of the kernels, in double. */
static void add_triangle(columns *grid, int32_t part, const double *a, const double *b, const double *c) {
    const double *p[3] = {a, b, c};
    double lo = fmin(a[1], fmin(b[1], c[1])), hi = fmax(a[1], fmax(b[1], c[1]));
    double ab[3], ac[3], normal[3];
    skg_add_scaled(b, -1, a, ab);
    skg_add_scaled(c, -1, a, ac);
    skg_cross(ab, ac, normal);
    int64_t row = (int64_t)fmax(0, floor((lo - grid->low[1]) / grid->step[1]) - 1);
    for (; row < SIDE; row++) {
        double y = column_place(grid, 1, row), x[2];
        int found = 0, downward[2];
        if (y < lo) continue;
        if (y >= hi) break;
        for (int e = 0; e < 3 && found < 2; e++) {
            const double *from = p[e], *to = p[(e + 1) % 3];
            if ((from[1] <= y) == (to[1] <= y)) continue;
            downward[found] = from[1] > to[1];
            x[found++] = crossing(from, to, y);
        }
        if (found < 2) continue;
        int first = x[0] <= x[1] ? 0 : 1;
        int64_t column = (int64_t)fmax(0, floor((x[first] - grid->low[0]) / grid->step[0]) - 1);
        for (; column < SIDE; column++) {
            double at = column_place(grid, 0, column);
            if (at < x[first]) continue;
            if (at >= x[1 - first]) break;
            int64_t cell = row * SIDE + column;
            if (grid->hits) {
                double depth = normal[2] != 0
                                   ? a[2] - ((at - a[0]) * normal[0] + (y - a[1]) * normal[1]) / normal[2]
                                   : a[2];
                /* With a normal against +z the triangle is clockwise in x and y: the first crossing runs up, and
                 * the ray enters. */
                grid->hits[grid->first[cell]] = (column_hit){depth, part, downward[first] ? -1 : 1};
            }
            grid->first[cell]++;
        }
    }
}

static void add_all(columns *grid, int64_t count, const skg_solid *solids) {
    for (int64_t i = 0; i < count; i++)
        for (int64_t t = 0; t < solids[i].triangles; t++) {
            const int32_t *corner = solids[i].corners + 3 * t;
            const double *at = solids[i].positions;
            add_triangle(grid, (int32_t)i, at + 3 * (int64_t)corner[0], at + 3 * (int64_t)corner[1],
                         at + 3 * (int64_t)corner[2]);
        }
}

/* Counts the hits of each column, sums the counts, and fills: the hits of column c are those from grid->first[c] to
 * grid->first[c + 1] - 1. */
static skg_status gather(columns *grid, int64_t count, const skg_solid *solids) {
    const int64_t cells = (int64_t)SIDE * SIDE;
    SKG_TRY(skg_alloc(cells + 1, sizeof *grid->first, "overlap columns", &grid->first));
    add_all(grid, count, solids);
    int64_t sum = 0;
    for (int64_t c = 0; c <= cells; c++) {
        int64_t here = grid->first[c];
        grid->first[c] = sum;
        sum += here;
    }
    SKG_TRY(skg_alloc(sum, sizeof *grid->hits, "overlap hits", &grid->hits));
    add_all(grid, count, solids);
    memmove(grid->first + 1, grid->first, (size_t)cells * sizeof *grid->first);
    grid->first[0] = 0;
    return SKG_OK;
}

/* --- pairs --- */

static skg_overlap_pair *find_slot(const pair_table *pairs, int32_t kind, int64_t part, int64_t other) {
    uint64_t hash =
        (uint64_t)part * 0x9E3779B97F4A7C15u ^ (uint64_t)other * 0xC2B2AE3D27D4EB4Fu ^ (uint64_t)kind;
    for (int64_t i = (int64_t)((hash >> 20) % (uint64_t)pairs->slots);; i = (i + 1) % pairs->slots) {
        skg_overlap_pair *slot = &pairs->table[i];
        if (slot->part < 0 || (slot->kind == kind && slot->part == part && slot->other == other)) return slot;
    }
}

static skg_status grow(pair_table *pairs) {
    pair_table bigger = {.slots = pairs->slots ? pairs->slots * 4 : 256, .used = pairs->used};
    SKG_TRY(skg_alloc(bigger.slots, sizeof *bigger.table, "overlapping pairs", &bigger.table));
    for (int64_t i = 0; i < bigger.slots; i++) bigger.table[i].part = -1;
    for (int64_t i = 0; i < pairs->slots; i++) {
        const skg_overlap_pair *old = &pairs->table[i];
        if (old->part >= 0) *find_slot(&bigger, old->kind, old->part, old->other) = *old;
    }
    skg_free(&pairs->table);
    *pairs = bigger;
    return SKG_OK;
}

static skg_status add_chord(pair_table *pairs, int32_t kind, int64_t part, int64_t other, const double *place,
                            double length, double area) {
    if (2 * (pairs->used + 1) > pairs->slots) SKG_TRY(grow(pairs));
    skg_overlap_pair *slot = find_slot(pairs, kind, part, other);
    if (slot->part < 0) {
        *slot = (skg_overlap_pair){.kind = kind, .part = part, .other = other};
        pairs->used++;
    }
    slot->volume += length * area;
    if (length > slot->longest) {
        slot->longest = length;
        memcpy(slot->place, place, sizeof slot->place);
    }
    return SKG_OK;
}

/* --- sweep --- */

static int by_depth(const void *a, const void *b) {
    const column_hit *left = a, *right = b;
    if (left->depth != right->depth) return left->depth < right->depth ? -1 : 1;
    /* At touching surfaces the ray leaves one part before it enters the other, so that they do not overlap. */
    if (left->sign != right->sign) return left->sign < right->sign ? -1 : 1;
    return left->part < right->part ? -1 : left->part > right->part;
}

typedef struct {
    int32_t *depth;  /* [parts] how deep the column is inside each part */
    int32_t *active; /* parts with depth > 0 */
    int64_t count;
} sweep_state;

static void pass(sweep_state *state, const column_hit *hit) {
    int32_t before = state->depth[hit->part], after = before + hit->sign;
    state->depth[hit->part] = after;
    if (before <= 0 && after > 0) state->active[state->count++] = hit->part;
    if (before > 0 && after <= 0)
        for (int64_t i = 0; i < state->count; i++)
            if (state->active[i] == hit->part) {
                state->active[i] = state->active[--state->count];
                break;
            }
}

/* Compares every active part with its siblings and its parent over the stretch of a column between two hits.
 * Cousins need not be compared: where they overlap, their ancestors overlap or one of them has left its parent. */
static skg_status judge(const sweep_state *state, const skg_solid *solids, pair_table *pairs,
                        const double *place, double length, double area) {
    for (int64_t i = 0; i < state->count; i++) {
        int64_t part = state->active[i], parent = solids[part].inside;
        if (parent >= 0 && solids[parent].triangles > 0 && state->depth[parent] <= 0)
            SKG_TRY(add_chord(pairs, SKG_OVERLAP_PROTRUDES, part, parent, place, length, area));
        for (int64_t k = i + 1; k < state->count; k++) {
            int64_t other = state->active[k];
            if (solids[other].inside != parent) continue;
            SKG_TRY(add_chord(pairs, SKG_OVERLAP_SIBLINGS, part < other ? part : other,
                              part < other ? other : part, place, length, area));
        }
    }
    return SKG_OK;
}

static skg_status sweep(const columns *grid, const skg_solid *solids, sweep_state *state, pair_table *pairs) {
    const double area = grid->step[0] * grid->step[1];
    /* Touching surfaces differ by rounding, which is far below this share of the depth of the scene. */
    const double least = 1e-9 * (grid->high[2] - grid->low[2]);
    for (int64_t cell = 0; cell < (int64_t)SIDE * SIDE; cell++) {
        int64_t first = grid->first[cell], end = grid->first[cell + 1];
        qsort(grid->hits + first, (size_t)(end - first), sizeof *grid->hits, by_depth);
        for (int64_t h = first; h < end; h++) {
            pass(state, &grid->hits[h]);
            if (h + 1 == end) break;
            double from = grid->hits[h].depth, to = grid->hits[h + 1].depth;
            double place[3] = {column_place(grid, 0, cell % SIDE), column_place(grid, 1, cell / SIDE),
                               (from + to) / 2};
            if (to - from > least) SKG_TRY(judge(state, solids, pairs, place, to - from, area));
        }
        for (int64_t h = first; h < end; h++) state->depth[grid->hits[h].part] = 0;
        state->count = 0;
    }
    return SKG_OK;
}

static int worst_first(const void *a, const void *b) {
    const skg_overlap_pair *left = a, *right = b;
    if (left->volume != right->volume) return left->volume > right->volume ? -1 : 1;
    if (left->part != right->part) return left->part < right->part ? -1 : 1;
    return left->other < right->other ? -1 : left->other > right->other;
}

static void bound(columns *grid, int64_t count, const skg_solid *solids) {
    for (int k = 0; k < 3; k++) grid->low[k] = HUGE_VAL, grid->high[k] = -HUGE_VAL;
    for (int64_t i = 0; i < count; i++)
        for (int64_t v = 0; solids[i].triangles > 0 && v < 3 * solids[i].vertices; v++) {
            grid->low[v % 3] = fmin(grid->low[v % 3], solids[i].positions[v]);
            grid->high[v % 3] = fmax(grid->high[v % 3], solids[i].positions[v]);
        }
    for (int k = 0; k < 2; k++) grid->step[k] = (grid->high[k] - grid->low[k]) / SIDE;
}

skg_status skg_overlaps_find(int64_t count, const skg_solid *solids, int64_t *pair_count,
                             skg_overlap_pair **pairs) {
    columns grid = {0};
    sweep_state state = {0};
    pair_table found = {0};
    skg_status status = SKG_OK;
    *pair_count = 0;
    *pairs = NULL;
    bound(&grid, count, solids);
    if (!(grid.step[0] > 0 && grid.step[1] > 0)) return SKG_OK; /* no solid has an extent */
    SKG_TRY_CLEANUP(gather(&grid, count, solids));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *state.depth, "overlap sweep", &state.depth));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *state.active, "overlap sweep", &state.active));
    SKG_TRY_CLEANUP(sweep(&grid, solids, &state, &found));
    for (int64_t i = 0; i < found.slots; i++)
        if (found.table[i].part >= 0) found.table[(*pair_count)++] = found.table[i];
    if (*pair_count) qsort(found.table, (size_t)*pair_count, sizeof *found.table, worst_first);
    *pairs = found.table;
    found.table = NULL;
cleanup:
    skg_free(&grid.first);
    skg_free(&grid.hits);
    skg_free(&state.depth);
    skg_free(&state.active);
    skg_free(&found.table);
    return status;
}
