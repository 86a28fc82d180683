/* Emission of the source, and response of the detector to scattered photons. Private. */
#ifndef SKG_BEAMS_H
#define SKG_BEAMS_H

#include "scatter/voxels.h"
#include "skg_shared.h"

/* --- How the photons of a beam differ over its directions: heel effect and bow-tie filter. *
 * The primary has few directions of the spectrum for them (spectral/shading.h), fitted over its rays. A photon that is to scatter has
 * an energy and a direction, so its share is taken from the effects themselves, over the whole field. */

/* Rows of the table of the heel effect. */
enum { SKG_HEEL_ROWS = 65 };

/* heel and bowtie 0: the same in all directions. */
typedef struct {
    int64_t bins;         /* of the recipe's spectrum */
    int32_t heel, bowtie; /* 1: the beam has it */
    double mean;          /* share of the spectrum's photons over the field */
    double anode[3];      /* unit vector across the anode's face */
    double low, high;     /* cosines between it and the rays to the field */
    double *shares;       /* [SKG_HEEL_ROWS][bins] of photons that leave, even from low to high */
    /* unit vectors to the middle of the detector, and where the angles of the fan grow */
    double central[3], fan[3];
    const skg_bowtie *filter; /* the recipe's */
    double *tangents;         /* [rows of the filter] */
    double *attenuation;      /* [bins] of the filter, 1/mm */
} skg_beam_profile;

/* Makes the profile for the field of a frame's view, as seen from the middle of the source. A parallel beam has none. Free it also
 * after a failure.
 *
 * errors   SKG_ERR_BEAM, SKG_ERR_SCENE where the field is wider than the anode or the filter allows */
skg_status skg_beam_profile_make(const skg_scatter_work *work, skg_beam_profile *profile);
void skg_beam_profile_free(skg_beam_profile *profile);

/* Where a ray stands in the profile. */
typedef struct {
    int64_t row;
    double share; /* of the way to the next row of the heel effect's table */
    double mm;    /* of the filter */
} skg_beam_place;

/* way: of any length */
skg_beam_place skg_beam_profile_find(const skg_beam_profile *profile, const double way[3]);

/* The share of the photons of a bin that leave the source there, over those towards the middle of the detector through no filter. */
double skg_beam_profile_at(const skg_beam_profile *profile, const skg_beam_place *place, int64_t bin);

/* --- Source, field and detector of scattered photons. */

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

/* Contribution to a pixel of a history whose photon arrives, in photons of the spectrum: the photons that the field receives over those of
 * a pixel. */
double skg_sight_photons(const skg_scatter_work *work, const skg_scatter_args *args);

/* --- The open beam behind what stands in it: heel effect, bow-tie filter, world, anti-scatter grid,
 * oblique scintillator. *
 * Ratios are shares of the flat field of their own pixel, which has these effects; so scatter is divided by them, too. They change
 * smoothly over the detector, and are computed at some places of it, for all energies. */

/* All zero: nothing stands in the beam. */
typedef struct {
    int64_t columns, rows;
    double *shares; /* [rows][columns] from the first pixel to the last */
} skg_open_beam;

/* Makes the shares: the signal of the open beam that a channel records in a pixel, over the signal without these effects. Free it also
 * after a failure. */
skg_status skg_open_beam_make(const skg_scatter_work *work, int32_t channel, skg_open_beam *open);
void skg_open_beam_free(skg_open_beam *open);

/* The share in a pixel of the view, between these places. */
double skg_open_beam_at(const skg_open_beam *open, const skg_view *view, int64_t row, int64_t column);

#endif
