/* Cells as photons read them: a medium as far as it goes, a brick of finer cells, or the faces of parts in a cell. */
#include "scatter/planting.h"

#include "core/maths.h"
#include "core/threads.h"
#include "skg_shared.h"

#include <math.h>
#include <string.h>

/* A cell with more faces gets a brick of finer cells. */
enum { FACES = 12 };

/* --- faces */

static skg_status find_faces(skg_planting *p) {
    const skg_cells *cells = p->cells;
    int64_t count = 0, f = 0;
    for (int64_t s = 0; s < p->parts->count; s++) count += p->parts->solids[s].triangles;
    SKG_TRY(skg_alloc(count, sizeof *p->corners, "cells", &p->corners));
    SKG_TRY(skg_alloc(count, sizeof *p->part, "cells", &p->part));
    for (int64_t s = 0; s < p->parts->count; s++) {
        const skg_solid *solid = &p->parts->solids[s];
        for (int64_t t = 0; t < solid->triangles; t++, f++) {
            p->part[f] = (int32_t)s;
            for (int c = 0; c < 9; c++) {
                const int k = c % 3;
                p->corners[f][c] =
                    (solid->positions[3 * (int64_t)solid->corners[3 * t + c / 3] + k] - cells->low[k]) /
                    cells->size[k] * (double)cells->count[k];
            }
        }
    }
    p->face_count = count;
    return SKG_OK;
}

/* Adds each cell that a face has a piece in, and the face, to `pairs`. */
static skg_status visit(skg_planting *p, int64_t face, skg_words *pairs) {
    const int64_t *count = p->cells->count;
    const double margin = -(double)SKG_CELL_MARGIN;
    skg_face_axes axes;
    int64_t first[3], last[3], place = 0;
    skg_face_cells(p->corners[face], count, margin, first, last);
    const int alone = first[0] == last[0] && first[1] == last[1] && first[2] == last[2];
    if (!alone) skg_face_axes_find(p->corners[face], &axes);
    for (int64_t z = first[2]; z <= last[2]; z++)
        for (int64_t y = first[1]; y <= last[1]; y++)
            for (int64_t x = first[0]; x <= last[0]; x++) {
                const double low[3] = {(double)x, (double)y, (double)z}, half = 0.5 + margin;
                if (!alone && skg_face_distance(&axes, low, half) >= half) continue;
                SKG_TRY(skg_words_grow(pairs, 2, &place));
                pairs->of[place] = (uint32_t)((z * count[1] + y) * count[0] + x);
                pairs->of[place + 1] = (uint32_t)face;
            }
    return SKG_OK;
}

/* Faces in shares of all, each share by one thread. */
enum { SHARES = 16 };
typedef struct {
    skg_planting *p;
    skg_words pairs[SHARES];
} visits;

static skg_status visit_share(void *user, int64_t share) {
    visits *v = user;
    const int64_t count = v->p->face_count;
    for (int64_t f = share * count / SHARES; f < (share + 1) * count / SHARES; f++)
        SKG_TRY(visit(v->p, f, &v->pairs[share]));
    return SKG_OK;
}

static skg_status sort_pairs(skg_planting *p, const visits *v) {
    const int64_t total = skg_cells_count(p->cells);
    SKG_TRY(skg_alloc(total + 1, sizeof *p->first, "cells", &p->first));
    for (int s = 0; s < SHARES; s++)
        for (int64_t i = 0; i < v->pairs[s].count; i += 2) p->first[v->pairs[s].of[i] + 1]++;
    for (int64_t c = 0; c < total; c++) p->first[c + 1] += p->first[c];
    SKG_TRY(skg_alloc(p->first[total] + 1, sizeof *p->faces_of, "cells", &p->faces_of));
    for (int s = 0; s < SHARES; s++)
        for (int64_t i = 0; i < v->pairs[s].count; i += 2)
            p->faces_of[p->first[v->pairs[s].of[i]]++] = v->pairs[s].of[i + 1];
    memmove(p->first + 1, p->first, (size_t)total * sizeof *p->first);
    p->first[0] = 0;
    return SKG_OK;
}

/* The faces in each cell. */
static skg_status sort_faces(skg_planting *p) {
    visits v = {.p = p};
    skg_status status = skg_parallel(SHARES, visit_share, &v);
    if (status == SKG_OK) status = sort_pairs(p, &v);
    for (int s = 0; s < SHARES; s++) skg_free(&v.pairs[s].of);
    return status;
}

/* --- coarse cells */

/* The optical depth over a side of a cell by which its media may differ: of all parts that have faces there. */
static double contrast_of(skg_planting *p, int64_t cell) {
    const skg_cells *cells = p->cells;
    double side = 0, sum = 0;
    for (int k = 0; k < 3; k++) side = fmax(side, cells->size[k] / (double)cells->count[k]);
    for (int64_t i = p->first[cell]; i < p->first[cell + 1]; i++) {
        const int64_t part = p->part[p->faces_of[i]];
        double more = 0;
        if (p->seen[part] == cell + 1) continue;
        p->seen[part] = cell + 1;
        for (int k = 0; k < SKG_SCATTER_RANK; k++) more += p->mu[k] * p->parts->coefficients[part][k];
        for (int64_t v = 0; v < cells->volume_count; v++) {
            const int32_t times = p->parts->volumes[v].times[part];
            const int64_t *within = cells->within[v * skg_cells_count(cells) + cell];
            for (int k = 0; k < SKG_SCATTER_RANK && times; k++)
                more += p->mu[k] * (times * ((double)within[k] / SKG_CELL_UNIT));
        }
        sum += fabs(more) * side;
    }
    return sum;
}

/* Whether the faces of a cell make no difference, so that its mean mixture stands for it. */
static int is_mixed(const skg_planting *p, const skg_faced *f, double limit) {
    return p->settled[f->cell] || !(f->contrast > limit);
}

static skg_status write_mixed(skg_planting *p, skg_faced *f) {
    uint32_t medium = 0;
    SKG_TRY(skg_media_add(&p->media, p->cells->mixtures[f->cell], &medium));
    f->mixed = skg_cell_word(SKG_CELL_MEDIUM, medium);
    return SKG_OK;
}

static skg_status write_list(skg_planting *p, skg_faced *f) {
    const int64_t first = p->first[f->cell];
    uint32_t medium = 0;
    skg_cell_amount all;
    double at[3];
    skg_cell_all(p->cells, f->cell, p->cells->known[f->cell], all);
    SKG_TRY(skg_media_find(&p->media, (const int64_t *)all, &medium));
    skg_cell_place(p->cells, f->cell, at);
    for (int k = 0; k < 3; k++) at[k] += SKG_KNOWN[k];
    return skg_plant_list(p, medium, at, p->first[f->cell + 1] - first, p->faces_of + first, &f->traced);
}

/* The words of cells without faces, and which have some. Many neighbours hold the same. */
static skg_status sort_cells(skg_planting *p) {
    const int64_t total = skg_cells_count(p->cells);
    int64_t place = 0, faced = 0;
    uint32_t medium = 0;
    skg_cell_amount all, last;
    for (int64_t c = 0; c < total; c++) p->faced_count += p->first[c + 1] > p->first[c];
    SKG_TRY(skg_alloc(p->faced_count, sizeof *p->faced, "cells", &p->faced));
    SKG_TRY(skg_words_grow(&p->tree, total, &place));
    memset(last, 0xff, sizeof last);
    for (int64_t c = 0; c < total; c++) {
        if (p->first[c + 1] > p->first[c]) {
            p->faced[faced++] = (skg_faced){c, contrast_of(p, c), SKG_UNMADE, SKG_UNMADE};
            continue;
        }
        skg_cell_all(p->cells, c, p->cells->known[c], all);
        if (memcmp(all, last, sizeof all)) SKG_TRY(skg_media_find(&p->media, (const int64_t *)all, &medium));
        memcpy(last, all, sizeof all);
        p->tree.of[c] = skg_cell_word(SKG_CELL_MEDIUM, medium);
    }
    return SKG_OK;
}

/* --- all of it */

static skg_status prepare(skg_planting *p) {
    const int64_t parts = p->parts->count;
    static const skg_cell_amount nothing;
    uint32_t world = 0;
    SKG_TRY(skg_cells_amounts(p->parts, &p->amounts));
    SKG_TRY(skg_media_find(&p->media, nothing, &world)); /* the first */
    SKG_TRY(skg_alloc(parts, sizeof *p->more, "cells", &p->more));
    SKG_TRY(skg_alloc(parts, sizeof *p->seen, "cells", &p->seen));
    for (int64_t i = 0; i < parts; i++) {
        skg_mixture more;
        for (int k = 0; k < SKG_SCATTER_RANK; k++) {
            p->amounts[i][k] *= p->parts->sign[i];
            more[k] = (float)((double)p->amounts[i][k] / SKG_CELL_UNIT);
        }
        for (int k = SKG_CELL_TIMES; k < SKG_CELL_AMOUNTS; k++) p->amounts[i][k] *= p->parts->sign[i];
        SKG_TRY(skg_media_add(&p->media, more, &p->more[i]));
    }
    SKG_TRY(skg_cells_settled(p->parts, p->cells, &p->settled));
    SKG_TRY(find_faces(p));
    SKG_TRY(sort_faces(p));
    p->originals = p->face_count;
    if (p->parts->volume_count > 0) SKG_TRY(skg_plant_copies(p));
    return sort_cells(p);
}

/* Cells that are planted together: the bricks among them are made by several threads, and written in their order. */
enum { TOGETHER = 4096 };
typedef struct {
    skg_planting *p;
    double limit;
    int64_t count;     /* bricks */
    skg_brick *bricks; /* [TOGETHER] */
} planted;

static skg_status make_brick(void *user, int64_t item) {
    planted *g = user;
    return skg_brick_make(g->p, g->bricks[item].cell, &g->bricks[item]);
}

static int needs_brick(const planted *g, const skg_faced *f) {
    return f->traced == SKG_UNMADE && !is_mixed(g->p, f, g->limit) &&
           g->p->first[f->cell + 1] - g->p->first[f->cell] > FACES;
}

/* Puts what stands for a cell into the tree. *brick: its number, which is then the next one's, if it needs one */
static skg_status write_word(planted *g, skg_faced *f, int64_t *brick) {
    skg_planting *p = g->p;
    const int mixed = is_mixed(p, f, g->limit);
    if (mixed && f->mixed == SKG_UNMADE) SKG_TRY(write_mixed(p, f));
    if (needs_brick(g, f))
        SKG_TRY(skg_brick_write(p, &g->bricks[(*brick)++], &f->traced));
    else if (!mixed && f->traced == SKG_UNMADE)
        SKG_TRY(write_list(p, f));
    p->tree.of[f->cell] = mixed ? f->mixed : f->traced;
    p->cells->smeared += mixed && !p->settled[f->cell];
    p->cells->traced += !mixed;
    return SKG_OK;
}

static skg_status plant_some(planted *g, skg_faced *faced, int64_t count) {
    int64_t brick = 0;
    g->count = 0;
    for (int64_t i = 0; i < count; i++)
        if (needs_brick(g, &faced[i])) g->bricks[g->count++] = (skg_brick){.cell = faced[i].cell};
    skg_status status = g->count ? skg_parallel(g->count, make_brick, g) : SKG_OK;
    for (int64_t i = 0; i < count && status == SKG_OK; i++) status = write_word(g, &faced[i], &brick);
    for (int64_t b = 0; b < g->count; b++) skg_brick_free(&g->bricks[b]);
    return status;
}

static skg_status plant(skg_planting *p, double limit) {
    const int64_t total = skg_cells_count(p->cells);
    planted g = {.p = p, .limit = limit};
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(TOGETHER, sizeof *g.bricks, "cells", &g.bricks));
    for (int64_t i = 0; i < p->faced_count && status == SKG_OK; i += TOGETHER)
        status = plant_some(&g, p->faced + i, p->faced_count - i < TOGETHER ? p->faced_count - i : TOGETHER);
    skg_free(&g.bricks);
    SKG_TRY(status);
    for (int64_t c = 0; c < total; c++) /* without the leaps of another limit */
        if (SKG_CELL_KIND(p->tree.of[c]) == SKG_CELL_MEDIUM)
            p->tree.of[c] = skg_cell_word(SKG_CELL_MEDIUM, SKG_CELL_MEDIUM_OF(p->tree.of[c]));
    SKG_TRY(skg_plant_rough(p));
    return skg_cells_leap(p->cells, p->tree.of);
}

/* A corner, the normal, and vectors whose products with a place relative to the corner are its shares of both edges. */
static void write_face(const skg_cells *cells, const double corners[9], float to[16]) {
    double edge[2][3], normal[3], across[2][3];
    for (int k = 0; k < 3; k++) {
        const double mm = cells->size[k] / (double)cells->count[k];
        to[k] = (float)(corners[k] * mm);
        for (int e = 0; e < 2; e++) edge[e][k] = (corners[3 + 3 * e + k] - corners[k]) * mm;
    }
    skg_cross(edge[0], edge[1], normal);
    const double square = skg_dot(normal, normal), per = square > 0 ? 1 / square : 0, length = sqrt(square);
    skg_cross(edge[1], normal, across[0]);
    skg_cross(normal, edge[0], across[1]);
    for (int k = 0; k < 3; k++) {
        to[4 + k] = length > 0 ? (float)(normal[k] / length) : 0;
        to[8 + k] = (float)(across[0][k] * per);
        to[12 + k] = (float)(across[1][k] * per);
    }
}

/* Writes the faces for the photons, as soon as a cell has one. */
static skg_status write_faces(skg_planting *p) {
    skg_cells *cells = p->cells;
    if (p->has_faces || (cells->traced == 0 && cells->faces)) return SKG_OK;
    p->has_faces = cells->traced > 0;
    cells->face_count = p->has_faces ? p->face_count : 0;
    SKG_TRY(skg_realloc(cells->face_count + 1, sizeof *cells->faces, "cells", &cells->faces));
    for (int64_t f = 0; f < cells->face_count; f++) {
        const uint32_t *more = f < p->originals ? &p->more[p->part[f]] : &p->own[f - p->originals];
        memcpy(&cells->faces[f][3], more, sizeof cells->faces[f][3]);
        write_face(cells, p->corners[f], cells->faces[f]);
    }
    cells->face_count++; /* a buffer is not empty */
    return SKG_OK;
}

/* Lends the cells what has been planted; they own it when the planting ends. */
static void lend(skg_planting *p) {
    p->cells->media = p->media.mixtures, p->cells->media_count = p->media.count;
    p->cells->tree = p->tree.of, p->cells->tree_count = p->tree.count;
}

skg_status skg_planting_begin(const skg_cell_parts *parts, const double mu[SKG_SCATTER_RANK],
                              skg_cells *cells, skg_planting **planting) {
    skg_planting *p = NULL;
    *planting = NULL;
    if (!cells->mixtures) return SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof *p, "cells", &p));
    *p = (skg_planting){.parts = parts, .cells = cells, .mu = mu, .media = {.base = parts->base}};
    skg_free(&cells->media);
    skg_free(&cells->tree);
    skg_free(&cells->faces);
    *planting = p;
    const skg_status status = prepare(p);
    lend(p);
    return status;
}

skg_status skg_planting_to(skg_planting *p, double limit) {
    if (!p) return SKG_OK;
    p->cells->smeared = p->cells->traced = 0;
    skg_status status = plant(p, limit);
    if (status == SKG_OK) status = write_faces(p);
    lend(p);
    return status;
}

int64_t skg_planting_smears(const skg_planting *p, double limit) {
    int64_t count = 0;
    for (int64_t i = 0; p && i < p->faced_count; i++)
        count += !p->settled[p->faced[i].cell] && is_mixed(p, &p->faced[i], limit);
    return count;
}

void skg_planting_end(skg_planting **planting) {
    skg_planting *p = *planting;
    if (!p) return;
    p->media.mixtures = NULL; /* the cells' own now, as is the tree */
    skg_media_free(&p->media);
    skg_free(&p->corners);
    skg_free(&p->part);
    skg_free(&p->amounts);
    skg_free(&p->more);
    skg_free(&p->own);
    skg_free(&p->seen);
    skg_free(&p->first);
    skg_free(&p->faces_of);
    skg_free(&p->settled);
    skg_free(&p->faced);
    skg_free(planting);
}

skg_status skg_cells_trace(const skg_cell_parts *parts, const double mu[SKG_SCATTER_RANK], double limit,
                           skg_cells *cells) {
    skg_planting *planting = NULL;
    skg_status status = skg_planting_begin(parts, mu, cells, &planting);
    if (status == SKG_OK) status = skg_planting_to(planting, limit);
    skg_planting_end(&planting);
    return status;
}
