/* How far the medium of a cell reaches in all directions, so that photons cross it in one step. */
#include "scatter/media.h"

#include "core/threads.h"
#include "skg_shared.h"

/* The least of the neighbours' leaps and one more, along the sweep of a chessboard's distance (G. Borgefors, Distance transformations
 * in digital images, Computer Vision, Graphics, and Image Processing 34 (1986) 344-371). */
static int64_t nearest(const skg_cells *cells, const uint8_t *leap, int64_t x, int64_t y, int64_t z,
                       int64_t sweep) {
    const int64_t across = cells->count[0], plane = across * cells->count[1], at = z * plane + y * across + x;
    const int inside =
        x > 0 && y > 0 && z > 0 && x + 1 < across && y + 1 < cells->count[1] && z + 1 < cells->count[2];
    int64_t least = SKG_CELL_LEAP_MAX;
    for (int64_t n = 0; n < 13; n++) {
        const int64_t i = n % 3 - 1, j = n / 3 % 3 - 1, k = n / 9 - 1;
        if (!inside &&
            (x + sweep * i < 0 || y + sweep * j < 0 || z + sweep * k < 0 || x + sweep * i >= across ||
             y + sweep * j >= cells->count[1] || z + sweep * k >= cells->count[2]))
            continue;
        const int64_t own = leap[at + sweep * (k * plane + j * across + i)] + 1;
        least = own < least ? own : least;
    }
    return least;
}

/* 1 if a neighbour has another word. Beyond the box there is nothing that differs. */
static int differs(const skg_cells *cells, const uint32_t *words, int64_t x, int64_t y, int64_t z) {
    const int64_t across = cells->count[0], plane = across * cells->count[1],
                  own = z * plane + y * across + x;
    for (int64_t k = z > 0 ? -1 : 0; k <= (z + 1 < cells->count[2]); k++)
        for (int64_t j = y > 0 ? -1 : 0; j <= (y + 1 < cells->count[1]); j++)
            for (int64_t i = x > 0 ? -1 : 0; i <= (x + 1 < across); i++)
                if (words[own + k * plane + j * across + i] != words[own]) return 1;
    return 0;
}

typedef struct {
    const skg_cells *cells;
    const uint32_t *words;
    uint8_t *leap;
} leaping;

/* A plane of cells: those beside another word have no leap. */
static skg_status begin_plane(void *user, int64_t z) {
    const leaping *l = user;
    const int64_t across = l->cells->count[0], down = l->cells->count[1];
    for (int64_t y = 0; y < down; y++)
        for (int64_t x = 0; x < across; x++)
            l->leap[(z * down + y) * across + x] =
                differs(l->cells, l->words, x, y, z) ? 0 : SKG_CELL_LEAP_MAX;
    return SKG_OK;
}

skg_status skg_cells_leap(const skg_cells *cells, uint32_t *words) {
    const int64_t total = cells->count[0] * cells->count[1] * cells->count[2], across = cells->count[0],
                  plane = across * cells->count[1];
    leaping l = {.cells = cells, .words = words};
    SKG_TRY(skg_alloc(total, 1, "cells", &l.leap));
    const skg_status status = skg_parallel(cells->count[2], begin_plane, &l);
    for (int64_t c = 0; c < total; c++)
        if (l.leap[c])
            l.leap[c] =
                (uint8_t)nearest(cells, l.leap, c % across, c / across % cells->count[1], c / plane, 1);
    for (int64_t c = total - 1; c >= 0; c--)
        if (l.leap[c]) {
            const int64_t own =
                nearest(cells, l.leap, c % across, c / across % cells->count[1], c / plane, -1);
            if (own < l.leap[c]) l.leap[c] = (uint8_t)own;
        }
    for (int64_t c = 0; c < total; c++)
        if (SKG_CELL_KIND(words[c]) == SKG_CELL_MEDIUM) words[c] |= (uint32_t)l.leap[c] << 24;
    skg_free(&l.leap);
    return status;
}
