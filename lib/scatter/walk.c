/* Lengths through the object as photons read it: kernels/scatter/walk.clh in double precision. */
#include "scatter/voxels.h"

#include "core/maths.h"
#include "skg_shared.h"

#include <math.h>
#include <string.h>

static const double NUDGE = (double)SKG_CELL_NUDGE;

typedef struct {
    const skg_cells *cells;
    double start[3], step[3]; /* in cells; from one end to the other */
    const double *from, *to;  /* mm */
} line;

static void add(const float *medium, double factor, double *sum) {
    for (int k = 0; k < SKG_SCATTER_RANK; k++) sum[k] += factor * (double)medium[k];
}

/* Whether a face is crossed: 1 into the part, -1 out of it. */
static int meets(const float face[16], const double from[3], const double to[3], double *share) {
    double reach = 0, height = 0, u = 0, v = 0;
    for (int k = 0; k < 3; k++) {
        reach += (double)face[4 + k] * (to[k] - from[k]);
        height -= (double)face[4 + k] * (from[k] - (double)face[k]);
    }
    if (reach == 0) return 0;
    *share = height / reach;
    if (!(*share > 0 && *share <= 1)) return 0;
    for (int k = 0; k < 3; k++) {
        const double at = from[k] + *share * (to[k] - from[k]) - (double)face[k];
        u += (double)face[8 + k] * at, v += (double)face[12 + k] * at;
    }
    return u >= 0 && v >= 0 && u + v <= 1 ? (reach < 0 ? 1 : -1) : 0;
}

static void across_faces(const skg_cells *cells, const uint32_t *list, const double from[3],
                         const double to[3], double mm, double *sum) {
    float known[3];
    double place[3], share;
    memcpy(known, list + 2, sizeof known);
    for (int k = 0; k < 3; k++) place[k] = (double)known[k];
    add(cells->media[list[0]], mm, sum);
    for (uint32_t i = 0; i < list[1]; i++) {
        const float *face = cells->faces[list[SKG_LIST_HEAD + i]];
        uint32_t more;
        memcpy(&more, face + 3, sizeof more);
        const int before = meets(face, place, from, &share);
        add(cells->media[more], before * mm, sum);
        const int sign = meets(face, from, to, &share);
        if (sign) add(cells->media[more], sign * mm * (1 - share), sum);
    }
}

/* The word at a place, and how many cells there are along each side of a coarse one. */
static uint32_t word_at(const skg_cells *cells, const double at[3], double *parts) {
    int64_t cell[3], fine[3];
    for (int k = 0; k < 3; k++)
        cell[k] = (int64_t)skg_lesser(skg_greater(at[k], 0), (double)(cells->count[k] - 1));
    const uint32_t word = cells->tree[(cell[2] * cells->count[1] + cell[1]) * cells->count[0] + cell[0]];
    *parts = 1;
    if (SKG_CELL_KIND(word) != SKG_CELL_BRICK) return word;
    const uint32_t *brick = cells->tree + SKG_CELL_PLACE(word);
    const int64_t n = brick[0];
    *parts = (double)n;
    for (int k = 0; k < 3; k++)
        fine[k] = (int64_t)skg_lesser(skg_greater((at[k] - (double)cell[k]) * (double)n, 0), (double)(n - 1));
    return brick[1 + (fine[2] * n + fine[1]) * n + fine[0]];
}

/* The end of a step from t on, in shares of the line. */
static double step_on(const line *l, double t, uint32_t *word) {
    double at[3], parts, next = 1, least = HUGE_VAL;
    for (int k = 0; k < 3; k++) at[k] = l->start[k] + t * l->step[k] + (l->step[k] > 0 ? NUDGE : -NUDGE);
    *word = word_at(l->cells, at, &parts);
    const double leap = SKG_CELL_KIND(*word) == SKG_CELL_MEDIUM ? (double)(*word >> 24) : 0;
    for (int k = 0; k < 3; k++) {
        const double cell = floor(at[k] * parts), face = l->step[k] > 0 ? cell + 1 + leap : cell - leap;
        if (l->step[k] == 0) continue;
        next = skg_lesser(next, (face / parts - l->start[k]) / l->step[k]);
        least = skg_lesser(least, fabs(0.5 * NUDGE / l->step[k]));
    }
    return skg_lesser(skg_greater(next, t + least), 1);
}

void skg_cells_along(const skg_cells *cells, const double from[3], const double to[3],
                     double mm[SKG_SCATTER_RANK]) {
    line l = {.cells = cells, .from = from, .to = to};
    double way[3], next;
    for (int k = 0; k < 3; k++) {
        const double per_mm = (double)cells->count[k] / cells->size[k];
        way[k] = to[k] - from[k];
        l.start[k] = from[k] * per_mm, l.step[k] = way[k] * per_mm;
    }
    const double length = skg_length(way);
    for (int k = 0; k < SKG_SCATTER_RANK; k++) mm[k] = 0;
    for (double t = 0; length > 0 && t < 1; t = next) {
        uint32_t word;
        next = step_on(&l, t, &word);
        if (SKG_CELL_KIND(word) != SKG_CELL_FACES) {
            add(cells->media[SKG_CELL_MEDIUM_OF(word)], (next - t) * length, mm);
            continue;
        }
        double a[3], b[3];
        for (int k = 0; k < 3; k++) a[k] = from[k] + t * way[k], b[k] = from[k] + next * way[k];
        across_faces(cells, cells->tree + SKG_CELL_PLACE(word), a, b, (next - t) * length, mm);
    }
}

void skg_cells_roughly(const skg_cells *cells, const double from[3], const double to[3],
                       double mm[SKG_SCATTER_RANK]) {
    double way[3];
    for (int k = 0; k < 3; k++) way[k] = to[k] - from[k];
    const double step = skg_length(way) / SKG_ROUGH_STEPS;
    for (int k = 0; k < SKG_SCATTER_RANK; k++) mm[k] = 0;
    for (int i = 0; i < SKG_ROUGH_STEPS && cells->rough; i++) {
        int64_t cell[3], count[3];
        for (int k = 0; k < 3; k++) {
            const double at = from[k] + (i + 0.5) / SKG_ROUGH_STEPS * way[k];
            count[k] = (cells->count[k] + SKG_CELL_ROUGH - 1) / SKG_CELL_ROUGH;
            cell[k] = (int64_t)skg_lesser(
                skg_greater(at / cells->size[k] * (double)cells->count[k] / SKG_CELL_ROUGH, 0),
                (double)(count[k] - 1));
        }
        add(cells->media[cells->rough + (uint32_t)((cell[2] * count[1] + cell[1]) * count[0] + cell[0])],
            step, mm);
    }
}
