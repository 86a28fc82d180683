/* The 256 colours that come nearest to those of a film. */
#include "film/palette.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BITS = 6, SHIFT = 8 - BITS, CELLS = 1 << 3 * BITS, SLOTS = 1024, ROUNDS = 6 };

/* The colours of the film that share their upper 6 bits. */
typedef struct {
    double count, sum[3];
} cell;

typedef struct {
    double mean[3], weight;
    uint32_t at; /* its place among all cells */
} colour;

/* Colours first to end - 1, and how much they vary along the axis on which they vary most. */
typedef struct {
    int64_t first, end;
    int axis;
    double middle, variance;
} box;

struct palette {
    cell *cells;
    unsigned char *nearest; /* of each cell: the number of its colour */
    /* While the film has at most 256 colours: a table of them by their hash, 1 + the number of the colour. */
    uint32_t known[SLOTS];
    uint16_t number[SLOTS];
    int distinct; /* 257: there are more */
};

palette *palette_create(void) {
    palette *new = calloc(1, sizeof *new);
    if (!new) return NULL;
    new->cells = calloc(CELLS, sizeof *new->cells);
    new->nearest = calloc(CELLS, 1);
    if (new->cells &&new->nearest) return new;
    palette_free(new);
    return NULL;
}

void palette_free(palette *p) {
    if (!p) return;
    free(p->cells);
    free(p->nearest);
    free(p);
}

static uint32_t pack(const unsigned char *pixel) {
    return (uint32_t)pixel[0] << 16 | (uint32_t)pixel[1] << 8 | pixel[2];
}

static uint32_t cell_of(const unsigned char *pixel) {
    return (uint32_t)(pixel[0] >> SHIFT) << 2 * BITS | (uint32_t)(pixel[1] >> SHIFT) << BITS |
           (uint32_t)(pixel[2] >> SHIFT);
}

/* The slot that a colour has or would have. */
static uint32_t find_slot(const palette *p, uint32_t packed) {
    uint32_t slot = packed * 2654435761u >> 22; /* 2^32 over the golden ratio; 10 bits of the product */
    while (p->number[slot] && p->known[slot] != packed) slot = (slot + 1) % SLOTS;
    return slot;
}

static void know(palette *p, const unsigned char *pixel) {
    const uint32_t packed = pack(pixel), slot = find_slot(p, packed);
    if (p->number[slot] || p->distinct++ == PALETTE_COLOURS) return;
    p->known[slot] = packed;
    p->number[slot] = (uint16_t)p->distinct;
}

void palette_count(palette *p, const unsigned char *pixels, int64_t count) {
    for (int64_t i = 0; i < count; i++, pixels += 4) {
        cell *its = p->cells + cell_of(pixels);
        its->count++;
        for (int k = 0; k < 3; k++) its->sum[k] += pixels[k];
        if (p->distinct <= PALETTE_COLOURS) know(p, pixels);
    }
}

static void measure(const colour *colours, box *b) {
    double weight = 0, sum[3] = {0}, squares[3] = {0};
    for (int64_t i = b->first; i < b->end; i++) {
        weight += colours[i].weight;
        for (int k = 0; k < 3; k++) {
            sum[k] += colours[i].weight * colours[i].mean[k];
            squares[k] += colours[i].weight * colours[i].mean[k] * colours[i].mean[k];
        }
    }
    b->variance = -1;
    for (int k = 0; k < 3; k++) {
        const double variance = squares[k] - sum[k] * sum[k] / weight;
        if (variance > b->variance) b->variance = variance, b->axis = k, b->middle = sum[k] / weight;
    }
    if (b->end - b->first < 2) b->variance = -1; /* cannot be split */
}

/* Colours below the middle first; returns the first of the others. */
static int64_t divide(colour *colours, const box *b) {
    int64_t end = b->first;
    for (int64_t i = b->first; i < b->end; i++)
        if (colours[i].mean[b->axis] < b->middle) {
            const colour moved = colours[i];
            colours[i] = colours[end];
            colours[end++] = moved;
        }
    return end;
}

/* Splits the box that varies most, until there are 256 or none can be split. Returns how many there are. */
static int split(colour *colours, int64_t count, box boxes[PALETTE_COLOURS]) {
    int found = 1;
    boxes[0] = (box){.end = count};
    measure(colours, boxes);
    while (found < PALETTE_COLOURS) {
        int most = 0;
        for (int b = 1; b < found; b++)
            if (boxes[b].variance > boxes[most].variance) most = b;
        if (!(boxes[most].variance > 0)) break;
        const int64_t end = divide(colours, boxes + most);
        if (end == boxes[most].first || end == boxes[most].end) {
            boxes[most].variance = -1; /* equal but for rounding */
            continue;
        }
        boxes[found] = (box){.first = end, .end = boxes[most].end};
        boxes[most].end = end;
        measure(colours, boxes + most);
        measure(colours, boxes + found++);
    }
    return found;
}

static int nearest_of(const double centres[PALETTE_COLOURS][3], int count, const double *mean) {
    int nearest = 0;
    double least = HUGE_VAL;
    for (int c = 0; c < count; c++) {
        const double r = centres[c][0] - mean[0], g = centres[c][1] - mean[1], b = centres[c][2] - mean[2];
        const double distance = r * r + g * g + b * b;
        if (distance < least) least = distance, nearest = c;
    }
    return nearest;
}

/* Moves the centres to the means of the colours that are nearest to them, some times. */
static void settle(const colour *colours, int64_t count, double centres[PALETTE_COLOURS][3], int used) {
    for (int round = 0; round < ROUNDS; round++) {
        double weight[PALETTE_COLOURS] = {0}, sum[PALETTE_COLOURS][3] = {{0}};
        for (int64_t i = 0; i < count; i++) {
            const int c = nearest_of(centres, used, colours[i].mean);
            weight[c] += colours[i].weight;
            for (int k = 0; k < 3; k++) sum[c][k] += colours[i].weight * colours[i].mean[k];
        }
        for (int c = 0; c < used; c++)
            for (int k = 0; k < 3 && weight[c] > 0; k++) centres[c][k] = sum[c][k] / weight[c];
    }
}

static void choose_known(const palette *p, unsigned char chosen[PALETTE_COLOURS][3]) {
    for (int slot = 0; slot < SLOTS; slot++) {
        if (!p->number[slot]) continue;
        unsigned char *its = chosen[p->number[slot] - 1];
        for (int k = 0; k < 3; k++) its[k] = (unsigned char)(p->known[slot] >> 8 * (2 - k));
    }
}

/* The cells that have pixels. */
static int64_t list_colours(const palette *p, colour *colours) {
    int64_t count = 0;
    for (uint32_t at = 0; at < CELLS; at++) {
        const cell *its = p->cells + at;
        if (!(its->count > 0)) continue;
        colours[count] = (colour){.weight = its->count, .at = at};
        for (int k = 0; k < 3; k++) colours[count].mean[k] = its->sum[k] / its->count;
        count++;
    }
    return count;
}

int palette_choose(palette *p, unsigned char chosen[PALETTE_COLOURS][3]) {
    box boxes[PALETTE_COLOURS];
    double centres[PALETTE_COLOURS][3];
    memset(chosen, 0, sizeof(unsigned char) * PALETTE_COLOURS * 3);
    if (p->distinct <= PALETTE_COLOURS) {
        choose_known(p, chosen);
        return 1;
    }
    colour *colours = malloc(CELLS * sizeof *colours);
    if (!colours) return 0;
    const int64_t count = list_colours(p, colours);
    const int used = split(colours, count, boxes);
    for (int c = 0; c < used; c++) {
        double weight = 0, sum[3] = {0};
        for (int64_t i = boxes[c].first; i < boxes[c].end; i++) {
            weight += colours[i].weight;
            for (int k = 0; k < 3; k++) sum[k] += colours[i].weight * colours[i].mean[k];
        }
        for (int k = 0; k < 3; k++) centres[c][k] = sum[k] / weight;
    }
    settle(colours, count, centres, used);
    for (int c = 0; c < used; c++)
        for (int k = 0; k < 3; k++) {
            chosen[c][k] = (unsigned char)lround(centres[c][k]);
            centres[c][k] = chosen[c][k];
        }
    for (int64_t i = 0; i < count; i++)
        p->nearest[colours[i].at] = (unsigned char)nearest_of(centres, used, colours[i].mean);
    free(colours);
    return 1;
}

unsigned char palette_index(const palette *p, const unsigned char *pixel) {
    if (p->distinct <= PALETTE_COLOURS) return (unsigned char)(p->number[find_slot(p, pack(pixel))] - 1);
    return p->nearest[cell_of(pixel)];
}
