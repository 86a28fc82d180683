/* The media of an object, and where faces of parts are in its cells. */
#include "scatter/media.h"

#include "core/maths.h"

#include <math.h>
#include <string.h>

/* --- media */

static uint64_t hash(const skg_cell_amount amounts) {
    uint64_t h = 0;
    for (int k = 0; k < SKG_SCATTER_RANK; k++)
        h = (h ^ (uint64_t)amounts[k]) * 0x9E3779B97F4A7C15u, h ^= h >> 29;
    return h;
}

static skg_status reserve(skg_media *m) {
    if (m->count < m->capacity) return SKG_OK;
    const int64_t more = m->capacity ? 2 * m->capacity : 64;
    SKG_TRY(skg_realloc(more, sizeof *m->mixtures, "media", &m->mixtures));
    SKG_TRY(skg_realloc(more, sizeof *m->amounts, "media", &m->amounts));
    m->capacity = more;
    return SKG_OK;
}

/* The slot where a medium is or would be. */
static int64_t slot_of(const skg_media *m, const skg_cell_amount amounts) {
    int64_t s = (int64_t)(hash(amounts) & (uint64_t)(m->slots - 1));
    while (m->slot[s] && memcmp(m->amounts[m->slot[s] - 1], amounts, sizeof *m->amounts))
        s = (s + 1) & (m->slots - 1);
    return s;
}

/* At most half of the slots are taken. */
static skg_status spread(skg_media *m) {
    if (2 * m->count < m->slots) return SKG_OK;
    uint32_t *old = m->slot;
    const int64_t slots = m->slots;
    m->slot = NULL;
    m->slots = slots ? 2 * slots : 128;
    const skg_status status = skg_alloc(m->slots, sizeof *m->slot, "media", &m->slot);
    for (int64_t s = 0; status == SKG_OK && s < slots; s++)
        if (old[s]) m->slot[slot_of(m, m->amounts[old[s] - 1])] = old[s];
    skg_free(&old);
    return status;
}

skg_status skg_media_add(skg_media *m, const float *mixture, uint32_t *number) {
    SKG_TRY(reserve(m));
    memcpy(m->mixtures[m->count], mixture, sizeof *m->mixtures);
    memset(m->amounts[m->count], 0, sizeof *m->amounts);
    *number = (uint32_t)m->count++;
    return SKG_OK;
}

skg_status skg_media_find(skg_media *m, const skg_cell_amount amounts, uint32_t *number) {
    skg_mixture mixture;
    SKG_TRY(spread(m));
    const int64_t s = slot_of(m, amounts);
    if (m->slot[s]) {
        *number = m->slot[s] - 1;
        return SKG_OK;
    }
    for (int k = 0; k < SKG_SCATTER_RANK; k++)
        mixture[k] = (float)((double)amounts[k] / SKG_CELL_UNIT + (m->base ? m->base[k] : 0));
    SKG_TRY(skg_media_add(m, mixture, number));
    memcpy(m->amounts[*number], amounts, sizeof *m->amounts);
    m->slot[s] = *number + 1;
    return SKG_OK;
}

void skg_media_free(skg_media *m) {
    skg_free(&m->mixtures);
    skg_free(&m->amounts);
    skg_free(&m->slot);
}

/* --- faces */

void skg_face_cells(const double corners[9], const int64_t count[3], double margin, int64_t first[3],
                    int64_t last[3]) {
    for (int k = 0; k < 3; k++) {
        const double low = skg_lesser(corners[k], skg_lesser(corners[3 + k], corners[6 + k])),
                     high = skg_greater(corners[k], skg_greater(corners[3 + k], corners[6 + k])),
                     end = (double)(count[k] - 1);
        first[k] = (int64_t)skg_lesser(skg_greater(floor(low - margin), 0), end + 1);
        last[k] = (int64_t)skg_greater(skg_lesser(ceil(high + margin) - 1, end), -1);
    }
}

/* The shadow of the corners on an axis, over the shadow of a cube of half side 1. An axis without length shows nothing. */
static void add_axis(const double corners[9], const double axis[3], skg_face_axes *f) {
    const double reach = fabs(axis[0]) + fabs(axis[1]) + fabs(axis[2]);
    if (!(reach > 0)) return;
    double *own = f->axis[f->count];
    for (int k = 0; k < 3; k++) own[k] = axis[k] / reach;
    const double a = skg_dot(own, corners), b = skg_dot(own, corners + 3), c = skg_dot(own, corners + 6);
    f->low[f->count] = skg_lesser(a, skg_lesser(b, c));
    f->high[f->count++] = skg_greater(a, skg_greater(b, c));
}

void skg_face_axes_find(const double corners[9], skg_face_axes *f) {
    double edge[3][3], axis[3];
    f->count = 0;
    for (int k = 0; k < 3; k++) {
        const double along[3] = {k == 0, k == 1, k == 2};
        add_axis(corners, along, f);
    }
    for (int e = 0; e < 3; e++)
        for (int k = 0; k < 3; k++) edge[e][k] = corners[3 * ((e + 1) % 3) + k] - corners[3 * e + k];
    skg_cross(edge[0], edge[1], axis);
    add_axis(corners, axis, f);
    for (int e = 0; e < 3; e++)
        for (int k = 0; k < 3; k++) {
            const double along[3] = {k == 0, k == 1, k == 2};
            skg_cross(along, edge[e], axis);
            add_axis(corners, axis, f);
        }
}

double skg_face_distance(const skg_face_axes *f, const double low[3], double enough) {
    const double middle[3] = {low[0] + 0.5, low[1] + 0.5, low[2] + 0.5};
    double distance = -HUGE_VAL;
    for (int n = 0; n < f->count && distance < enough; n++) {
        const double at = skg_dot(f->axis[n], middle);
        distance = skg_greater(distance, skg_greater(f->low[n] - at, at - f->high[n]));
    }
    return distance;
}

int skg_face_crossed(const double corners[9], const double from[3], const double to[3], double *share) {
    double way[3], a[3], b[3], off[3], across[3], up[3];
    for (int k = 0; k < 3; k++) {
        way[k] = to[k] - from[k];
        a[k] = corners[3 + k] - corners[k], b[k] = corners[6 + k] - corners[k];
        off[k] = from[k] - corners[k];
    }
    skg_cross(way, b, across);
    const double reach = skg_dot(a, across);
    if (reach == 0) return 0;
    skg_cross(off, a, up);
    const double u = skg_dot(off, across) / reach, v = skg_dot(way, up) / reach;
    *share = skg_dot(b, up) / reach;
    if (!(u >= 0 && v >= 0 && u + v <= 1 && *share > 0 && *share <= 1)) return 0;
    return reach > 0 ? 1 : -1;
}

/* --- lists */

skg_status skg_words_grow(skg_words *words, int64_t more, int64_t *first) {
    if (words->count + more > words->capacity) {
        const int64_t capacity = 2 * words->capacity + more;
        SKG_TRY(skg_realloc(capacity, sizeof *words->of, "cells", &words->of));
        words->capacity = capacity;
    }
    *first = words->count;
    words->count += more;
    return SKG_OK;
}
