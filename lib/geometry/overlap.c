/* Finds parts that overlap, by columns through all of them. */
#include "geometry/overlaps.h"

#include "core/threads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns along each side of the grid: 65,536 columns are 1.4 mm apart in a thorax. Threads share the rows in bands. The hits
 * of a band stay in a cache, and its memory is used again for the next. A scene of very many layers has fewer columns, so that
 * their hits take a second or two. */
enum { SIDE = SKG_OVERLAP_SIDE, BANDS = 16 };
static const double HITS_MAX = 1e7;

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

/* Numbers below a limit, each at most once. */
typedef struct {
    int32_t *items, *slot; /* slot: [limit] place among the items, from 1; 0: it is not there */
    int64_t count;
} number_set;

/* State of a column: the parts that contain it. Only parts that overlap or have left their parents are looked at between two hits, so that
 * many parts within each other cost no more than their hits. Parts of no parent have the number 0 as a parent, others that of
 * their parent and 1 more. */
typedef struct {
    const skg_solid *solids;
    int32_t *memory; /* of all that follow */
    int32_t *depth;  /* [parts] how deep the column is inside each part */
    /* [parts + 1] a part inside this parent that the column is inside of, and 1 more; 0: none */
    int32_t *first;
    int32_t *next, *before; /* [parts] others of the same parent, and 1 more */
    number_set crowded;     /* parents of which the column is inside of two parts or more */
    number_set strays;      /* parts that the column is inside of, but not of their parents */
    pair_table pairs;
} sweep_state;

static skg_status open_sweep(int64_t count, const skg_solid *solids, sweep_state *state) {
    *state = (sweep_state){.solids = solids};
    SKG_TRY(skg_alloc(8 * (count + 1), sizeof *state->memory, "overlap sweep", &state->memory));
    int32_t **const arrays[] = {&state->depth,        &state->first,         &state->next,
                                &state->before,       &state->crowded.items, &state->crowded.slot,
                                &state->strays.items, &state->strays.slot};
    for (int k = 0; k < 8; k++) *arrays[k] = state->memory + k * (count + 1);
    return SKG_OK;
}

static void put(number_set *set, int32_t number, int is_there) {
    const int32_t slot = set->slot[number];
    if ((slot > 0) == is_there) return;
    if (is_there) {
        set->items[set->count++] = number;
        set->slot[number] = (int32_t)set->count;
        return;
    }
    const int32_t last = set->items[--set->count];
    set->items[slot - 1] = last;
    set->slot[last] = slot;
    set->slot[number] = 0;
}

static int32_t parent_of(const sweep_state *state, int32_t part) {
    return (int32_t)state->solids[part].inside + 1;
}

/* Whether parts of this parent should be inside of it, and the column is not. */
static int is_left(const sweep_state *state, int32_t parent) {
    return parent > 0 && state->solids[parent - 1].triangles > 0 && state->depth[parent - 1] <= 0;
}

/* Adds a part to those of its parent that the column is inside of, or takes it away. */
static void list_part(sweep_state *state, int32_t part, int enters) {
    const int32_t parent = parent_of(state, part), first = state->first[parent];
    const int32_t next = enters ? first : state->next[part], before = enters ? 0 : state->before[part];
    if (enters) {
        state->next[part] = next, state->before[part] = 0;
        state->first[parent] = part + 1;
    } else if (before) {
        state->next[before - 1] = next;
    } else {
        state->first[parent] = next;
    }
    if (next) state->before[next - 1] = enters ? part + 1 : before;
    const int32_t now = state->first[parent];
    put(&state->crowded, parent, now && state->next[now - 1] > 0);
    put(&state->strays, part, enters && is_left(state, parent));
}

static void pass(sweep_state *state, int32_t part, int32_t sign) {
    const int32_t before = state->depth[part], after = before + sign;
    state->depth[part] = after;
    if ((before > 0) == (after > 0)) return;
    list_part(state, part, after > 0);
    for (int32_t child = state->first[part + 1]; child; child = state->next[child - 1])
        put(&state->strays, child - 1, is_left(state, part + 1));
}

/* Adds the stretch of a column between two hits to the parts that overlap, and to those that have left their parents. Cousins
 * need not be compared: where they overlap, their ancestors overlap or one of them has left its parent. */
static skg_status judge(sweep_state *state, const double *place, double length, double area) {
    skg_overlap_pair found = {.volume = length * area, .longest = length};
    memcpy(found.place, place, sizeof found.place);
    found.kind = SKG_OVERLAP_PROTRUDES;
    for (int64_t i = 0; i < state->strays.count; i++) {
        found.part = state->strays.items[i], found.other = state->solids[found.part].inside;
        SKG_TRY(add_pair(&state->pairs, &found));
    }
    found.kind = SKG_OVERLAP_SIBLINGS;
    for (int64_t i = 0; i < state->crowded.count; i++)
        for (int32_t k = state->first[state->crowded.items[i]]; k; k = state->next[k - 1])
            for (int32_t m = state->next[k - 1]; m; m = state->next[m - 1]) {
                found.part = k < m ? k - 1 : m - 1, found.other = k < m ? m - 1 : k - 1;
                SKG_TRY(add_pair(&state->pairs, &found));
            }
    return SKG_OK;
}

static skg_status sweep_cell(skg_columns *grid, sweep_state *state, int64_t cell) {
    const double area = grid->step[0] * grid->step[1];
    /* Touching surfaces differ by rounding, which is far below this share of the depth of the scene. */
    const double least = 1e-9 * (grid->high[2] - grid->low[2]);
    const int64_t first = grid->first[cell], end = grid->first[cell + 1];
    double place[3] = {skg_column_place(grid, 0, cell % grid->side),
                       skg_column_place(grid, 1, grid->first_row + cell / grid->side)};
    skg_columns_sort(grid, cell);
    for (int64_t h = first; h < end; h++) {
        const int32_t part = grid->hits[h].part, sign = grid->hits[h].sign;
        pass(state, part, state->solids[part].inward ? -sign : sign);
        if (h + 1 == end) break;
        const double from = grid->hits[h].depth, to = grid->hits[h + 1].depth;
        place[2] = (from + to) / 2;
        if (to - from > least) SKG_TRY(judge(state, place, to - from, area));
    }
    /* Surfaces that fold upon themselves may leave hits over. */
    for (int64_t h = first; h < end; h++) pass(state, grid->hits[h].part, -state->depth[grid->hits[h].part]);
    return SKG_OK;
}

/* Data of all threads of a sweep. */
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
    sweep_state state;
    skg_status status = SKG_OK;
    grid.rows = grid.side / BANDS, grid.first_row = band * grid.rows;
    SKG_TRY_CLEANUP(open_sweep(s->count, s->solids, &state));
    SKG_TRY_CLEANUP(skg_columns_gather(&grid, s->count, s->solids, s->rows));
    for (int64_t cell = 0; cell < grid.rows * grid.side; cell++)
        SKG_TRY_CLEANUP(sweep_cell(&grid, &state, cell));
cleanup:
    skg_columns_free(&grid);
    skg_free(&state.memory);
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

/* Columns along each side: as many as have HITS_MAX, but whole bands. */
static int64_t choose_side(const skg_columns *grid, int64_t count, const skg_solid *solids) {
    int64_t side = SIDE;
    const double hits = skg_columns_hits_estimate(grid, count, solids); /* of SIDE x SIDE columns */
    while (side > BANDS && hits * (double)(side * side) > HITS_MAX * SIDE * SIDE) side -= BANDS;
    return side;
}

skg_status skg_overlaps_find(int64_t count, const skg_solid *solids, int64_t *side, int64_t *pair_count,
                             skg_overlap_pair **pairs) {
    sweeping s = {.grid = {.side = SIDE}, .count = count, .solids = solids};
    pair_table found = {0};
    skg_status status = SKG_OK;
    *pair_count = 0;
    *pairs = NULL;
    *side = SIDE;
    skg_columns_bound(&s.grid, count, solids);
    if (!(s.grid.step[0] > 0 && s.grid.step[1] > 0)) return SKG_OK; /* no solid has an extent */
    *side = s.grid.side = choose_side(&s.grid, count, solids);
    for (int k = 0; k < 2; k++) s.grid.step[k] = (s.grid.high[k] - s.grid.low[k]) / (double)s.grid.side;
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
