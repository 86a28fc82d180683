/* Planting: turns the faces of parts into cells that photons can read. Private. */
#ifndef SKG_PLANTING_H
#define SKG_PLANTING_H

#include "scatter/media.h"

/* A cell with faces: what stands for it, each made when it is first asked for. */
typedef struct {
    int64_t cell;
    double contrast;        /* optical depth over its side by which its media may differ */
    uint32_t mixed, traced; /* words: of its mean mixture; of its faces or its brick; SKG_UNMADE */
} skg_faced;
#define SKG_UNMADE UINT32_MAX

struct skg_planting {
    const skg_cell_parts *parts;
    skg_cells *cells;
    const double *mu;
    int64_t face_count;
    double (*corners)[9];     /* [faces] in cells */
    int32_t *part;            /* [faces] */
    skg_cell_amount *amounts; /* [parts] with the sign of the solid */
    uint32_t *more;           /* [parts] the medium that a face adds */
    /* [copies] likewise of faces beyond `originals`, copies for single cells of a volume (volume_faces.c) */
    uint32_t *own;
    int64_t originals;
    int64_t *seen; /* [parts] 1 + the cell that a part was last seen in */
    int64_t faced_count;
    skg_faced *faced;
    int has_rough, has_faces; /* 1: they are written */
    skg_media media;
    skg_words tree;
    int64_t *first;     /* [cells + 1] */
    uint32_t *faces_of; /* of each cell */
    uint8_t *settled;   /* [cells] 1: parts compete there, and no face is met */
};

static inline uint32_t skg_cell_word(uint32_t kind, int64_t place) {
    return kind << 30 | (uint32_t)place;
}

/* The lowest corner of a coarse cell, in cells. */
static inline void skg_cell_place(const skg_cells *cells, int64_t cell, double place[3]) {
    place[0] = (double)(cell % cells->count[0]);
    place[1] = (double)(cell / cells->count[0] % cells->count[1]);
    place[2] = (double)(cell / cells->count[0] / cells->count[1]);
}

/* Sums the amounts at a place in a coarse cell, those of its volumes included. */
static inline void skg_cell_all(const skg_cells *cells, int64_t cell, const int64_t *amounts,
                                skg_cell_amount all) {
    for (int k = 0; k < SKG_CELL_AMOUNTS; k++) all[k] = k < SKG_SCATTER_RANK ? amounts[k] : 0;
    for (int64_t v = 0; v < cells->volume_count; v++) {
        const int64_t times = amounts[SKG_CELL_TIMES + v] / (int64_t)SKG_CELL_UNIT;
        const int64_t *within = cells->within[v * skg_cells_count(cells) + cell];
        for (int k = 0; k < SKG_SCATTER_RANK && times; k++) all[k] += times * within[k];
    }
}

/* Beside volumes: gives each cell copies of its own of faces at which a volume begins or ends, and settles cells where its box and what
 * displaces it meet. */
skg_status skg_plant_copies(skg_planting *p);

/* A list of faces, and its word. at: where the medium is known, in coarse cells */
skg_status skg_plant_list(skg_planting *p, uint32_t medium, const double at[3], int64_t count,
                          const uint32_t *faces, uint32_t *word);

/* A brick of finer cells in the place of a cell with many faces. Coordinates are in finer cells. */
typedef struct {
    const skg_planting *p;
    int64_t n, cell, count; /* finer cells along a side; the coarse cell; its faces */
    const uint32_t *faces;  /* [count] */
    double low[3];          /* of the coarse cell, in coarse cells */
    double (*corners)[9];   /* [count] while it is made */
    int64_t *first;         /* [n^3 + 1] */
    /* of each finer cell: 2 * the place of a face in the list of the coarse cell, + 1 if it is within */
    uint32_t *list;
    skg_cell_amount *state; /* [n^3] */
} skg_brick;

/* Makes a brick, in any thread. Freed by the caller, whatever comes of it. */
skg_status skg_brick_make(const skg_planting *p, int64_t cell, skg_brick *brick);

/* Writes it behind the others; *word: its place. */
skg_status skg_brick_write(skg_planting *p, const skg_brick *brick, uint32_t *word);
void skg_brick_free(skg_brick *brick);

/* Adds the media of rough cells, of SKG_CELL_ROUGH^3 others each; none are needed if each of them has one medium. The tree has the words of the coarse cells. */
skg_status skg_plant_rough(skg_planting *p);

#endif
