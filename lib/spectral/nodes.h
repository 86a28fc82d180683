/* Few energies with positive weights instead of many. Private.
 *
 * Transmission is a sum of exponentials over the bins. A few bins with weights of their own reproduce it over the
 * range of lengths that rays meet. Method:
 *
 * 1. Non-negative least squares on relative errors at points of the range finds a first set of bins.
 * 2. Bins are removed one by one, each time the one whose absence costs least; the others are shifted to neighbouring
 *    bins while that lowers the errors.
 * 3. Weights are fitted so that the greatest error becomes small (Lawson's reweighting).
 * 4. The result is checked on other points.
 *
 * Several sets of weights (channels, variances) share the bins. */
#ifndef SKG_NODES_H
#define SKG_NODES_H

#include "spectral/verify.h"

typedef struct {
    skg_nodes nodes;
    double bound;     /* the stated bound: twice the worst error found */
    int64_t verified; /* points on which it was verified */
} skg_compression;

/* Finds few nodes whose bound is at most `tolerance`. nodes.count is 0 if only all bins meet it.
 *
 * mu      [materials][bins] 1/mm, as the planes give it; that of the beam if they are exact
 * given   [count][materials] mm, lengths that rays meet */
skg_status skg_nodes_find(const skg_polychromatic *beam, const double *mu, double tolerance, int64_t count,
                          const double *given, skg_compression *compression);

#endif
