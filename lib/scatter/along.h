/* Smooth functions of a place along a series: 1, t, t^2 and cosines, made orthonormal over some places. Private.
 *
 * The powers take over what differs between both ends, so that few cosines suffice. */
#ifndef SKG_SCATTER_ALONG_H
#define SKG_SCATTER_ALONG_H

#include "core/core.h"

typedef struct {
    int64_t places;
    int64_t count;   /* functions, at most three quarters of the places */
    double *values;  /* [count][places] */
    double *mixture; /* [count][count] each as a sum of the powers and cosines */
} skg_along;

/* at: [places] from 0 to 1, rising; 4 places or more. Free it also after a failure. */
skg_status skg_along_make(int64_t places, const double *at, skg_along *along);
void skg_along_free(skg_along *along);

/* The functions at t. values: [count] */
void skg_along_at(const skg_along *along, double t, double *values);

#endif
