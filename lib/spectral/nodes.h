/* Few energies with positive weights for many. Private.
 *
 * Transmission is a sum of exponentials over the bins; a few bins with weights of their own reproduce it over
 * the range of lengths met. Method: non-negative least squares over points of the range, relative errors,
 * finds a first set of bins; those whose absence costs least are taken away one by one, the rest is shifted
 * to neighbouring bins while that helps; weights are then fitted towards the smallest greatest error
 * (Lawson's reweighting), and the whole is checked on other points. Several sets of weights (channels,
 * variances) share the bins. */
#ifndef SKG_NODES_H
#define SKG_NODES_H

#include "spectral/verify.h"

typedef struct {
    skg_nodes nodes;
    double bound;     /* stated: twice the worst error found */
    int64_t verified; /* on so many points */
} skg_compression;

/* The fewest nodes found whose bound is at most `tolerance`. mu: [materials][bins], as planes give it (the
 * beam's own where they are exact). given: [count][materials] mm, lengths that are met. nodes.count is 0
 * where no fewer than all bins meet it. */
skg_status skg_nodes_find(const skg_polychromatic *beam, const double *mu, double tolerance, int64_t count,
                          const double *given, skg_compression *compression);

#endif
