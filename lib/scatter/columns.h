/* All functions of each material at the points of the tables, one below the other. Private. */
#ifndef SKG_SCATTER_COLUMNS_H
#define SKG_SCATTER_COLUMNS_H

#include "scatter/physics.h"

/* The functions in their order: the first three have a row for each energy, the others for each momentum transfer. */
enum {
    SKG_SCATTER_TOTAL,
    SKG_SCATTER_COMPTON,
    SKG_SCATTER_RAYLEIGH,
    SKG_SCATTER_INCOHERENT,
    SKG_SCATTER_COHERENT,
    SKG_SCATTER_FUNCTIONS
};

/* The first row of a function; that of SKG_SCATTER_FUNCTIONS is the number of rows. */
int64_t skg_scatter_first_row(const skg_scatter_physics *grid, int function);

/* columns: [count][rows] 1/mm, freed by the caller. Only the points of grid are read. */
skg_status skg_scatter_columns(int64_t count, skg_material *const *materials, const skg_scatter_physics *grid,
                               double **columns);

#endif
