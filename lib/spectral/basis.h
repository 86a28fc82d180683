/* Fewer planes than materials. Private.
 *
 * Tissues differ little: the attenuation of most is a mixture of that of a few. Those few become the planes, and
 * a plane holds mm of its material. They are taken in the order of Gram and Schmidt with the largest remainder
 * first, where an energy is weighted with the photons that arrive and a material with its thickness. The other
 * materials are mixtures by least squares. */
#ifndef SKG_BASIS_H
#define SKG_BASIS_H

#include "spectral/verify.h"

typedef struct {
    int32_t planes, reserved;
    int32_t *material; /* [planes] the material whose attenuation a plane has */
    double *mix;       /* [materials][planes] what a mm of a material adds to the planes */
    double *mu;        /* [materials][bins] 1/mm, as the planes give it */
    double error;      /* the greatest error of a transmission over the points */
} skg_basis;

void skg_basis_release(skg_basis *basis);

/* Weighs each bin with the root of its mean share of the recorded signal over points and sets, because the error of an
 * exponent counts in proportion to that share. weight: [bins]. */
skg_status skg_basis_weigh(const skg_polychromatic *beam, const skg_lengths *points, double *weight);

/* The order[materials] in which materials become planes. first: a material that has to be a plane, or -1. */
skg_status skg_basis_order(const skg_polychromatic *beam, const double *weight, int32_t first,
                           int32_t *order);

/* The basis of the first `planes` materials in that order, and its error at the points. */
skg_status skg_basis_make(const skg_polychromatic *beam, const skg_lengths *points, const double *weight,
                          const int32_t *order, int32_t planes, skg_basis *basis);

#endif
