/* The open beam behind what stands in it: heel effect, bow-tie filter, world, anti-scatter grid,
 * oblique scintillator. Private.
 *
 * Ratios are shares of the flat field of their own pixel, which has these effects; so scatter is divided by them, too. They change
 * smoothly over the detector, and are computed at some places of it, for all energies. */
#ifndef SKG_OPEN_BEAM_H
#define SKG_OPEN_BEAM_H

#include "scatter/beam_profile.h"

/* All zero: nothing stands in the beam. */
typedef struct {
    int64_t columns, rows;
    double *shares; /* [rows][columns] from the first pixel to the last */
} skg_open_beam;

/* What a channel records of the open beam in a pixel over what it would without these effects. Free it also after a failure. */
skg_status skg_open_beam_make(const skg_scatter_work *work, int32_t channel, skg_open_beam *open);
void skg_open_beam_free(skg_open_beam *open);

/* The share in a pixel of the view, between these places. */
double skg_open_beam_at(const skg_open_beam *open, const skg_view *view, int64_t row, int64_t column);

#endif
