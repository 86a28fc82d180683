/* Fewer planes than materials. Private.
 *
 * Tissues differ in little: the attenuation of most is a mixture of that of a few. Those few are the planes
 * (the plane is then mm of that material), taken by a Gram-Schmidt order with the largest remainder first,
 * weighted by how many photons of an energy arrive and how thick the material is; the others are mixtures by
 * least squares. */
#ifndef SKG_BASIS_H
#define SKG_BASIS_H

#include "spectral/verify.h"

typedef struct {
    int32_t planes, reserved;
    int32_t *material; /* [planes] whose attenuation a plane has */
    double *mix;       /* [materials][planes] what a mm of a material adds to the planes */
    double *mu;        /* [materials][bins] 1/mm, as the planes give it */
    double error;      /* of transmissions, greatest over the points */
} skg_basis;

void skg_basis_release(skg_basis *basis);

/* In which order materials become planes: order[materials]. first: a material that has to be one, or -1. */
skg_status skg_basis_order(const skg_polychromatic *beam, const skg_lengths *points, int32_t first,
                           int32_t *order);

/* The basis of the first `planes` of that order, and its error at the points. */
skg_status skg_basis_make(const skg_polychromatic *beam, const skg_lengths *points, const int32_t *order,
                          int32_t planes, skg_basis *basis);

#endif
