/* Cells with faces: their lists, and bricks of finer cells where there are many. */
#include "scatter/planting.h"

#include "skg_shared.h"

#include <math.h>
#include <string.h>

/* A brick has so many finer cells along each side that one of them has about PER_FINE faces, as surfaces have n^2 of n^3 cells, and no
 * more than ROOM finer cells for each face, which bounds the memory. */
enum { ROOM = 8, FINEST = 16 };
static const double PER_FINE = 3;

skg_status skg_plant_list(skg_planting *p, uint32_t medium, const double at[3], int64_t count,
                          const uint32_t *faces, uint32_t *word) {
    int64_t place = 0;
    SKG_TRY(skg_words_grow(&p->tree, SKG_LIST_HEAD + count, &place));
    uint32_t *list = p->tree.of + place;
    list[0] = medium, list[1] = (uint32_t)count;
    for (int k = 0; k < 3; k++) {
        const float mm = (float)(at[k] * p->cells->size[k] / (double)p->cells->count[k]);
        memcpy(&list[2 + k], &mm, sizeof mm);
    }
    memcpy(list + SKG_LIST_HEAD, faces, (size_t)count * sizeof *faces);
    *word = skg_cell_word(SKG_CELL_FACES, place);
    return SKG_OK;
}

/* --- bricks: coordinates in finer cells */

static void fine_place(const skg_brick *b, int64_t fine, double at[3]) {
    at[0] = (double)(fine % b->n) + SKG_KNOWN[0];
    at[1] = (double)(fine / b->n % b->n) + SKG_KNOWN[1];
    at[2] = (double)(fine / b->n / b->n) + SKG_KNOWN[2];
}

/* Adds each finer cell that a face has a piece in or about, and its entry of the list there, to `pairs`. Faces on boundaries change the state
 * on the way from one finer cell to the next, but are in neither list of the device. */
static skg_status visit(const skg_brick *b, int64_t face, skg_words *pairs) {
    const double margin = (double)SKG_CELL_MARGIN * (double)b->n;
    const int64_t count[3] = {b->n, b->n, b->n};
    int64_t first[3], last[3], place = 0;
    skg_face_axes axes;
    skg_face_axes_find(b->corners[face], &axes);
    skg_face_cells(b->corners[face], count, margin, first, last);
    for (int64_t z = first[2]; z <= last[2]; z++)
        for (int64_t y = first[1]; y <= last[1]; y++)
            for (int64_t x = first[0]; x <= last[0]; x++) {
                const double low[3] = {(double)x, (double)y, (double)z};
                const double distance = skg_face_distance(&axes, low, 0.5 + margin);
                if (distance >= 0.5 + margin) continue;
                SKG_TRY(skg_words_grow(pairs, 2, &place));
                pairs->of[place] = (uint32_t)((z * b->n + y) * b->n + x);
                pairs->of[place + 1] = (uint32_t)(2 * face + (distance < 0.5 - margin));
            }
    return SKG_OK;
}

static skg_status share_faces(skg_brick *b, skg_words *pairs) {
    const int64_t fine = b->n * b->n * b->n;
    for (int64_t f = 0; f < b->count; f++) SKG_TRY(visit(b, f, pairs));
    for (int64_t i = 0; i < pairs->count; i += 2) b->first[pairs->of[i] + 1]++;
    for (int64_t c = 0; c < fine; c++) b->first[c + 1] += b->first[c];
    SKG_TRY(skg_alloc(b->first[fine] + 1, sizeof *b->list, "cells", &b->list));
    for (int64_t i = 0; i < pairs->count; i += 2) b->list[b->first[pairs->of[i]]++] = pairs->of[i + 1];
    memmove(b->first + 1, b->first, (size_t)fine * sizeof *b->first);
    b->first[0] = 0;
    return SKG_OK;
}

static void cross(const skg_brick *b, int64_t face, const double from[3], const double to[3],
                  int64_t *state) {
    double share;
    const int sign = skg_face_crossed(b->corners[face], from, to, &share);
    const int64_t *more = b->p->amounts[b->p->part[b->faces[face]]];
    for (int k = 0; sign && k < SKG_CELL_AMOUNTS; k++) state[k] += sign * more[k];
}

static int holds(const skg_brick *b, int64_t fine, uint32_t face) {
    for (int64_t i = b->first[fine]; i < b->first[fine + 1]; i++)
        if (b->list[i] / 2 == face) return 1;
    return 0;
}

/* Finds the amounts at the known place of each finer cell, from one to the next. */
static void find_states(skg_brick *b) {
    const int64_t n = b->n;
    double from[3], to[3];
    for (int64_t fine = 0; fine < n * n * n; fine++) {
        const int64_t before = fine % n ? fine - 1 : fine / n % n ? fine - n : fine - n * n;
        fine_place(b, fine, to);
        if (fine == 0) {
            for (int k = 0; k < 3; k++) from[k] = SKG_KNOWN[k] * (double)n;
            memcpy(b->state[0], b->p->cells->known[b->cell], sizeof *b->state);
            for (int64_t f = 0; f < b->count; f++) cross(b, f, from, to, b->state[0]);
            continue;
        }
        fine_place(b, before, from);
        memcpy(b->state[fine], b->state[before], sizeof *b->state);
        for (int64_t i = b->first[before]; i < b->first[before + 1]; i++)
            cross(b, b->list[i] / 2, from, to, b->state[fine]);
        for (int64_t i = b->first[fine]; i < b->first[fine + 1]; i++)
            if (!holds(b, before, b->list[i] / 2)) cross(b, b->list[i] / 2, from, to, b->state[fine]);
    }
}

skg_status skg_brick_write(skg_planting *p, const skg_brick *b, uint32_t *word) {
    const int64_t fine = b->n * b->n * b->n;
    uint32_t *own = NULL;
    int64_t place = 0;
    SKG_TRY(skg_alloc(b->count + 1, sizeof *own, "cells", &own));
    skg_status status = skg_words_grow(&p->tree, 1 + fine, &place);
    if (status == SKG_OK) p->tree.of[place] = (uint32_t)b->n;
    for (int64_t c = 0; status == SKG_OK && c < fine; c++) {
        uint32_t medium = 0, made = 0;
        int64_t count = 0;
        double at[3];
        skg_cell_amount all;
        for (int64_t i = b->first[c]; i < b->first[c + 1]; i++)
            if (b->list[i] % 2) own[count++] = b->faces[b->list[i] / 2];
        fine_place(b, c, at);
        for (int k = 0; k < 3; k++) at[k] = b->low[k] + at[k] / (double)b->n;
        skg_cell_all(p->cells, b->cell, b->state[c], all);
        status = skg_media_find(&p->media, (const int64_t *)all, &medium);
        made = skg_cell_word(SKG_CELL_MEDIUM, medium);
        if (status == SKG_OK && count) status = skg_plant_list(p, medium, at, count, own, &made);
        if (status == SKG_OK) p->tree.of[place + 1 + c] = made;
    }
    skg_free(&own);
    *word = skg_cell_word(SKG_CELL_BRICK, place);
    return status;
}

skg_status skg_brick_make(const skg_planting *p, int64_t cell, skg_brick *b) {
    const int64_t count = p->first[cell + 1] - p->first[cell];
    const double most = fmin(sqrt((double)count / PER_FINE), cbrt(ROOM * (double)count));
    skg_words pairs = {0};
    skg_status status = SKG_OK;
    *b = (skg_brick){.p = p,
                     .cell = cell,
                     .count = count,
                     .faces = p->faces_of + p->first[cell],
                     .n = (int64_t)fmin(fmax(ceil(most), 2), FINEST)};
    const int64_t fine = b->n * b->n * b->n;
    skg_cell_place(p->cells, cell, b->low);
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *b->corners, "cells", &b->corners));
    SKG_TRY_CLEANUP(skg_alloc(fine + 1, sizeof *b->first, "cells", &b->first));
    SKG_TRY_CLEANUP(skg_alloc(fine, sizeof *b->state, "cells", &b->state));
    for (int64_t f = 0; f < count; f++)
        for (int c = 0; c < 9; c++)
            b->corners[f][c] = (p->corners[b->faces[f]][c] - b->low[c % 3]) * (double)b->n;
    SKG_TRY_CLEANUP(share_faces(b, &pairs));
    find_states(b);
cleanup:
    skg_free(&pairs.of);
    skg_free(&b->corners);
    return status;
}

void skg_brick_free(skg_brick *b) {
    skg_free(&b->first);
    skg_free(&b->list);
    skg_free(&b->state);
}
