/* The worth of faces that rays contain: d loss / d t at a pixel, from the weights of a pass. */
#include "gradient/edges.h"

#include "core/threads.h"

#include <math.h>
#include <string.h>

skg_status skg_edge_weights_create(const skg_pass *pass, skg_edge_weights *w) {
    *w = (skg_edge_weights){
        .read = {.pass = pass, .layout = skg_attenuate_weight_layout(pass->main.raster, pass->fine)}};
    return skg_alloc(w->read.layout.planes, sizeof *w->read.planes, "gradient", &w->read.planes);
}

void skg_edge_weights_clear(skg_edge_weights *w) {
    for (int64_t k = 0; w->read.planes && k < w->read.layout.planes; k++)
        skg_host_view_close(w->read.pass->main.raster->context, &w->read.planes[k]);
}

void skg_edge_weights_release(skg_edge_weights *w) {
    skg_edge_weights_clear(w);
    for (int64_t s = 0; w->competitors && s < w->read.pass->priority.count; s++)
        skg_crossings_release(&w->competitors[s]);
    skg_edge_volumes_release(&w->volumes);
    skg_free(&w->read.planes);
    skg_free(&w->competitors);
    skg_free(&w->slots);
    skg_free(&w->table);
}

static skg_status read_planes(skg_job *job, int64_t number, skg_edge_weights *w) {
    const skg_geometry_part *part = &w->read.pass->parts[number];
    for (int32_t c = 0; c < part->contributions; c++)
        SKG_TRY(skg_edge_plane_read(job, part->contribution[c].plane, &w->read));
    return SKG_OK;
}

/* --- the parts that compete */

typedef struct {
    const skg_job *job;
    skg_edge_weights *weights;
} tracing;

static skg_status prepare_competitor(void *user, int64_t slot) {
    const tracing *t = user;
    const skg_pass *pass = t->weights->read.pass;
    const int64_t part = pass->priority.parts[slot];
    const skg_mesh *mesh = &t->job->then.meshes[t->job->machine->geometry.mesh_of_part[part]];
    return skg_crossings_make(&pass->camera, mesh, pass->parts[part].pose, (int32_t)slot,
                              &t->weights->competitors[slot]);
}

static skg_status prepare_competitors(const skg_job *job, skg_edge_weights *w) {
    const skg_pass *pass = w->read.pass;
    const skg_priority *priority = &pass->priority;
    tracing t = {job, w};
    SKG_TRY(skg_alloc(pass->scene->count, sizeof *w->slots, "gradient", &w->slots));
    SKG_TRY(
        skg_alloc(priority->count * skg_priority_entry(priority), sizeof *w->table, "gradient", &w->table));
    skg_priority_tables(pass->scene, pass->rules, priority, w->slots, w->table);
    SKG_TRY(skg_alloc(priority->count, sizeof *w->competitors, "gradient", &w->competitors));
    return skg_parallel(priority->count, prepare_competitor, &t);
}

skg_status skg_edge_weights_read(skg_job *job, int64_t part, skg_edge_weights *w) {
    const skg_priority *priority = &w->read.pass->priority;
    int competes = 0;
    for (int64_t s = 0; s < priority->count; s++) competes |= priority->parts[s] == part;
    SKG_TRY(read_planes(job, part, w));
    for (int64_t s = 0; competes && s < priority->count; s++)
        SKG_TRY(read_planes(job, priority->parts[s], w));
    if (competes) SKG_TRY(skg_edge_volumes_find(job, &w->read, &w->volumes));
    return competes && !w->competitors ? prepare_competitors(job, w) : SKG_OK;
}

/* --- a pixel */

/* d loss / d t of a part that wins. */
static double weight_of(const skg_edge_weights *w, int64_t number, int64_t column, int64_t row) {
    const skg_geometry_part *part = &w->read.pass->parts[number];
    double sum = 0;
    for (int32_t c = 0; c < part->contributions; c++)
        sum += part->contribution[c].weight *
               skg_edge_plane_at(&w->read, part->contribution[c].plane, column, row);
    return part->depth > 0 ? sum * w->read.pass->scale.scale : 0;
}

/* The competitors at a place along a ray. */
typedef struct {
    const skg_edge_weights *all;
    int64_t column, row, words;
    const double *middle;       /* of the detector, where the ray goes */
    double depth;               /* between two crossings */
    int32_t *winding;           /* [slots] */
    uint32_t *active, *dropped; /* [words] */
} place_state;

static int is_in(const uint32_t *set, int64_t slot) {
    return (int)(set[slot / 32] >> slot % 32 & 1);
}

/* Whether an active slot loses, as skg_loses of kernels/raster/hits.cl says. */
static int loses(const place_state *s, int64_t slot) {
    const int32_t *entry = s->all->table + slot * skg_priority_entry(&s->all->read.pass->priority);
    int lost = entry[1] >= 0 && !is_in(s->active, entry[1]);
    for (int64_t k = 0; k < s->words; k++)
        lost |= ((uint32_t)entry[2 + k] & s->active[k]) != 0 ||
                ((uint32_t)entry[2 + s->words + k] & s->dropped[k]) != 0;
    return lost;
}

/* The worth of the cells of volumes that are displaced. */
static double cells_off(const place_state *s) {
    double sum = 0;
    for (int64_t v = 0; v < s->all->volumes.count; v++) {
        const skg_edge_volume *volume = &s->all->volumes.of[v];
        int displaced = is_in(s->dropped, volume->slot);
        for (int64_t k = 0; k < s->words; k++)
            displaced |= (s->active[k] & (uint32_t)volume->displacing[k]) != 0;
        if (displaced)
            sum += skg_edge_volume_worth(&s->all->volumes, v, &s->all->read, s->middle, s->depth, s->column,
                                         s->row);
    }
    return sum;
}

/* The worth that is taken off for a unit of length. */
static double taken_off(const place_state *s) {
    const skg_priority *priority = &s->all->read.pass->priority;
    double sum = 0;
    memset(s->active, 0, (size_t)s->words * sizeof *s->active);
    memset(s->dropped, 0, (size_t)s->words * sizeof *s->dropped);
    for (int64_t slot = 0; slot < priority->count; slot++)
        if (s->winding[slot] > 0) s->active[slot / 32] |= (uint32_t)1 << slot % 32;
    for (int64_t slot = 0; slot < priority->count; slot++) { /* parents before their children */
        if (!is_in(s->active, slot) || !loses(s, slot)) continue;
        s->dropped[slot / 32] |= (uint32_t)1 << slot % 32;
        sum += s->winding[slot] * weight_of(s->all, priority->parts[slot], s->column, s->row);
    }
    return sum + cells_off(s);
}

/* The worth of a face of a part where the state is. */
static double worth_of(const place_state *s, int64_t part, int64_t slot) {
    double off[2];
    for (int inside = 0; inside < 2; inside++) {
        s->winding[slot] = inside;
        off[inside] = taken_off(s);
    }
    return weight_of(s->all, part, s->column, s->row) - off[1] + off[0];
}

static skg_status find_crossings(const skg_edge_weights *w, int64_t slot, int64_t row, const double middle[2],
                                 skg_steep_weights *weights) {
    for (int64_t other = 0; other < w->read.pass->priority.count; other++)
        if (other != slot) /* the ray lies in the part's own surface */
            SKG_TRY(skg_crossings_find(&w->competitors[other], middle, row, &weights->planes));
    SKG_TRY(skg_edge_volumes_cross(&w->volumes, &w->read.pass->camera, middle, &weights->planes));
    skg_crossings_sort(&weights->planes);
    if (weights->planes.capacity > weights->capacity) {
        SKG_TRY(
            skg_realloc(weights->planes.capacity, sizeof *weights->weights, "gradient", &weights->weights));
        weights->capacity = weights->planes.capacity;
    }
    return SKG_OK;
}

static skg_status weigh_competitor(const skg_part_edges *edges, int64_t slot, place_state *s,
                                   const double middle[2], skg_steep_weights *weights) {
    const skg_crossing_list *planes = &weights->planes;
    SKG_TRY(find_crossings(s->all, slot, s->row, middle, weights));
    SKG_TRY(skg_alloc(s->all->read.pass->priority.count, sizeof *s->winding, "gradient", &s->winding));
    SKG_TRY(skg_alloc(2 * s->words, sizeof *s->active, "gradient", &s->active));
    s->dropped = s->active + s->words;
    s->middle = middle;
    for (int64_t k = 0; k < planes->count; k++) {
        /* In front of the first and behind the last there are no cells. */
        s->depth = k ? 0.5 * (planes->at[k - 1].depth + planes->at[k].depth) : -HUGE_VAL;
        weights->weights[k] = worth_of(s, edges->part, slot);
        if (planes->at[k].owner >= 0) s->winding[planes->at[k].owner] += planes->at[k].enters ? 1 : -1;
    }
    s->depth = -HUGE_VAL;
    weights->rest = worth_of(s, edges->part, slot);
    return SKG_OK;
}

skg_status skg_edge_weigh(const void *user, int64_t column, int64_t row, const double middle[2],
                          skg_steep_weights *weights) {
    const skg_part_edges *edges = user;
    const skg_edge_weights *w = edges->all;
    const int64_t slot = w->competitors ? w->slots[edges->part] : -1;
    place_state state = {.all = w, .column = column, .row = row};
    weights->planes.count = 0;
    weights->rest = weight_of(w, edges->part, column, row);
    if (slot < 0) return SKG_OK;
    state.words = skg_priority_slots(&w->read.pass->priority) / 32;
    const skg_status status = weigh_competitor(edges, slot % SKG_HITS_BACKGROUND, &state, middle, weights);
    skg_free(&state.winding);
    skg_free(&state.active);
    return status;
}
