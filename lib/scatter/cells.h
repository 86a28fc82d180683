/* The object as cells, each with the mixture of materials in it. Private.
 *
 * Parallel columns through all parts, along z: each hit adds what its part's material is more than its parent's to the cells
 * behind it, and its share to its own cell (cumulative path lengths). Along the columns this is exact, across them sampled by
 * SKG_CELL_COLUMNS x SKG_CELL_COLUMNS columns a cell. Amounts are whole multiples of a small unit, so that a cell of void holds
 * exactly nothing. */
#ifndef SKG_SCATTER_CELLS_H
#define SKG_SCATTER_CELLS_H

#include "geometry/columns.h"
#include "scatter/physics.h"

enum { SKG_CELLS_DEFAULT = 64, SKG_CELLS_MAX = 256, SKG_CELL_COLUMNS = 2 };

typedef struct {
    int64_t count[3];              /* cells along x, y, z; along x and y as many */
    double low[3], size[3];        /* mm, of the box of all parts */
    skg_mix4 *mixtures;            /* [z][y][x] coefficients of skg_scatter_physics per mm */
    double mean[SKG_SCATTER_RANK]; /* over the cells */
} skg_cells;

/* Closed parts. */
typedef struct {
    int64_t count;
    const skg_solid *solids;
    const int32_t *sign; /* 1; -1: the solid's hits have the other sign */
    const double *base;  /* [SKG_SCATTER_RANK] of what is around all solids, per mm; NULL: void */
    const double (*coefficients)[SKG_SCATTER_RANK]; /* of each solid less those of its parent, per mm */
    const int32_t
        *priority; /* of each, which decides where solids with the same parent overlap; NULL: amounts add */
    int32_t clip;  /* 1, with priority: a solid counts only inside its parent */
} skg_cell_parts;

/* Makes the cells of parts. voxel_mm: about; 0: SKG_CELLS_DEFAULT cells along each side. Without any triangle there are no cells. */
skg_status skg_cells_make(const skg_cell_parts *parts, double voxel_mm, skg_cells *cells);
void skg_cells_free(skg_cells *cells);

#endif
