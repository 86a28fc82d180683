/* Source, field and detector of scattered photons. Private. */
#ifndef SKG_SCATTER_SIGHT_H
#define SKG_SCATTER_SIGHT_H

#include "scatter/object.h"
#include "skg_shared.h"

/* Fills what a view decides: detector, field, source. The cells are known.
 *
 * errors   SKG_ERR_UNSUPPORTED unless rows and columns of the detector are at right angles */
skg_status skg_sight_fill(const skg_scatter_work *work, const skg_cells *cells, skg_scatter_args *args);

/* Sets across to the unit vector across the strips of the options' grid, in the plane of the detector. */
skg_status skg_sight_strips(const skg_scatter_work *work, double across[3]);

/* The points of the source, [count][4] mm from the lowest corner of the cells; of a parallel beam its direction. The caller frees
 * *spots. */
skg_status skg_sight_spots(const skg_scatter_work *work, const skg_cells *cells, int64_t *count,
                           float (**spots)[4]);

/* What a history whose photon arrives adds to a pixel, as photons of the spectrum: the photons that the field receives over those
 * of a pixel. */
double skg_sight_photons(const skg_scatter_work *work, const skg_scatter_args *args);

#endif
