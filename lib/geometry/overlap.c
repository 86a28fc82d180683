#include "geometry/overlap.h"

#include "core/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns along each side of the grid: 65,536 columns are 1.4 mm apart in a thorax. Threads share the rows in bands. The hits
 * of a band stay in a cache, and its memory is used again for the next. */
enum { SIDE = 256, BANDS = 16, BAND_ROWS = SIDE / BANDS };

typedef struct {
    int64_t slots, used;
    skg_overlap_pair *table; /* a hash table with linear probing; part < 0: the slot is free */
} pair_table;

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

/* Adds a volume with its longest chord to a pair. */
static skg_status add_pair(pair_table *pairs, const skg_overlap_pair *found) {
    if (2 * (pairs->used + 1) > pairs->slots) SKG_TRY(grow(pairs));
    skg_overlap_pair *slot = find_slot(pairs, found->kind, found->part, found->other);
    if (slot->part < 0) {
        *slot = (skg_overlap_pair){.kind = found->kind, .part = found->part, .other = found->other};
        pairs->used++;
    }
    slot->volume += found->volume;
    if (found->longest > slot->longest) {
        slot->longest = found->longest;
        memcpy(slot->place, found->place, sizeof slot->place);
    }
    return SKG_OK;
}

/* --- sweep --- */

typedef struct {
    int32_t *depth;  /* [parts] how deep the column is inside each part */
    int32_t *active; /* parts with depth > 0 */
    int64_t count;
    pair_table pairs;
} sweep_state;

static void pass(sweep_state *state, const skg_column_hit *hit) {
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
static skg_status judge(sweep_state *state, const skg_solid *solids, const double *place, double length,
                        double area) {
    skg_overlap_pair found = {.volume = length * area, .longest = length};
    memcpy(found.place, place, sizeof found.place);
    for (int64_t i = 0; i < state->count; i++) {
        int64_t part = state->active[i], parent = solids[part].inside;
        if (parent >= 0 && solids[parent].triangles > 0 && state->depth[parent] <= 0) {
            found.kind = SKG_OVERLAP_PROTRUDES, found.part = part, found.other = parent;
            SKG_TRY(add_pair(&state->pairs, &found));
        }
        for (int64_t k = i + 1; k < state->count; k++) {
            int64_t other = state->active[k];
            if (solids[other].inside != parent) continue;
            found.kind = SKG_OVERLAP_SIBLINGS;
            found.part = part < other ? part : other, found.other = part < other ? other : part;
            SKG_TRY(add_pair(&state->pairs, &found));
        }
    }
    return SKG_OK;
}

static skg_status sweep_cell(skg_columns *grid, const skg_solid *solids, sweep_state *state, int64_t cell) {
    const double area = grid->step[0] * grid->step[1];
    /* Touching surfaces differ by rounding, which is far below this share of the depth of the scene. */
    const double least = 1e-9 * (grid->high[2] - grid->low[2]);
    const int64_t first = grid->first[cell], end = grid->first[cell + 1];
    double place[3] = {skg_column_place(grid, 0, cell % SIDE),
                       skg_column_place(grid, 1, grid->first_row + cell / SIDE)};
    skg_columns_sort(grid, cell);
    for (int64_t h = first; h < end; h++) {
        pass(state, &grid->hits[h]);
        if (h + 1 == end) break;
        const double from = grid->hits[h].depth, to = grid->hits[h + 1].depth;
        place[2] = (from + to) / 2;
        if (to - from > least) SKG_TRY(judge(state, solids, place, to - from, area));
    }
    for (int64_t h = first; h < end; h++) state->depth[grid->hits[h].part] = 0;
    state->count = 0;
    return SKG_OK;
}

/* What threads share. */
typedef struct {
    skg_columns grid; /* of all bands, without hits */
    int64_t count;
    const skg_solid *solids;
    skg_column_rows *rows; /* of the triangles */
    pair_table found[BANDS];
} sweeping;

static skg_status sweep_band(void *user, int64_t band) {
    sweeping *s = user;
    skg_columns grid = s->grid;
    sweep_state state = {0};
    skg_status status = SKG_OK;
    grid.first_row = band * BAND_ROWS, grid.rows = BAND_ROWS;
    SKG_TRY_CLEANUP(skg_alloc(s->count, sizeof *state.depth, "overlap sweep", &state.depth));
    SKG_TRY_CLEANUP(skg_alloc(s->count, sizeof *state.active, "overlap sweep", &state.active));
    SKG_TRY_CLEANUP(skg_columns_gather(&grid, s->count, s->solids, s->rows));
    for (int64_t cell = 0; cell < BAND_ROWS * SIDE; cell++)
        SKG_TRY_CLEANUP(sweep_cell(&grid, s->solids, &state, cell));
cleanup:
    skg_columns_free(&grid);
    skg_free(&state.depth);
    skg_free(&state.active);
    s->found[band] = state.pairs;
    return status;
}

/* Adds up the bands in their order, so that sums do not depend on the threads. */
static skg_status add_bands(const sweeping *s, pair_table *found) {
    for (int band = 0; band < BANDS; band++) {
        const pair_table *pairs = &s->found[band];
        for (int64_t i = 0; i < pairs->slots; i++)
            if (pairs->table[i].part >= 0) SKG_TRY(add_pair(found, &pairs->table[i]));
    }
    return SKG_OK;
}

static int worst_first(const void *a, const void *b) {
    const skg_overlap_pair *left = a, *right = b;
    if (left->volume != right->volume) return left->volume > right->volume ? -1 : 1;
    if (left->part != right->part) return left->part < right->part ? -1 : 1;
    return left->other < right->other ? -1 : left->other > right->other;
}

skg_status skg_overlaps_find(int64_t count, const skg_solid *solids, int64_t *pair_count,
                             skg_overlap_pair **pairs) {
    sweeping s = {.grid = {.side = SIDE}, .count = count, .solids = solids};
    pair_table found = {0};
    skg_status status = SKG_OK;
    *pair_count = 0;
    *pairs = NULL;
    skg_columns_bound(&s.grid, count, solids);
    if (!(s.grid.step[0] > 0 && s.grid.step[1] > 0)) return SKG_OK; /* no solid has an extent */
    SKG_TRY_CLEANUP(skg_columns_span(&s.grid, count, solids, &s.rows));
    SKG_TRY_CLEANUP(skg_parallel(BANDS, sweep_band, &s));
    SKG_TRY_CLEANUP(add_bands(&s, &found));
    for (int64_t i = 0; i < found.slots; i++)
        if (found.table[i].part >= 0) found.table[(*pair_count)++] = found.table[i];
    if (*pair_count) qsort(found.table, (size_t)*pair_count, sizeof *found.table, worst_first);
    *pairs = found.table;
    found.table = NULL;
cleanup:
    skg_free(&s.rows);
    for (int band = 0; band < BANDS; band++) skg_free(&s.found[band].table);
    skg_free(&found.table);
    return status;
}
