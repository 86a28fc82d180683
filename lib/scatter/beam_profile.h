/* How the photons of a beam differ over its directions: heel effect and bow-tie filter. Private.
 *
 * The primary has few directions of the spectrum for them (spectral/shades.h), fitted over its rays. A photon that is to scatter has
 * an energy and a direction, so its share is taken from the effects themselves, over the whole field. */
#ifndef SKG_BEAM_PROFILE_H
#define SKG_BEAM_PROFILE_H

#include "scatter/object.h"

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
    double central[3],
        fan[3]; /* unit vectors to the middle of the detector, and where the angles of the fan grow */
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

#endif
