/* The transmission of a beam of several energies through lengths of materials, what it becomes with fewer
 * energies and planes, and where that is worst. Private.
 *
 * Errors are relative where a transmission exceeds 1e-6 of the open beam's, and shares of that below. */
#ifndef SKG_VERIFY_H
#define SKG_VERIFY_H

#include "core/core.h"

#define SKG_RELATIVE_FROM 1e-6 /* of the transmission of the open beam */
#define SKG_MOST_EXPONENT 80   /* of the energy that passes best */

/* Exact: every bin. A set is what one channel counts of a bin's photons, as a share of its open beam. */
typedef struct {
    int32_t bins, materials, sets;
    int32_t paired;       /* 1: sets k and sets/2 + k have positive weights at the same energies, or none */
    const double *mu;     /* [materials][bins] 1/mm */
    const double *shares; /* [bins][sets], each set sums to 1 */
    const double *low;    /* [materials] mm: range of the lengths */
    const double *high;
    double floor; /* transmission from which on errors are relative */
} skg_polychromatic;

/* Few energies: bins, each with a weight per set. */
typedef struct {
    int32_t count, reserved;
    int32_t *bin;   /* [count] rising */
    double *shares; /* [count][sets], >= 0 */
} skg_nodes;

/* Lengths, [count][materials] mm, with the exact transmission of each, [count][sets]. */
typedef struct {
    int64_t count, room;
    double *lengths, *exact;
} skg_lengths;

void skg_nodes_release(skg_nodes *nodes);
void skg_lengths_release(skg_lengths *points);

/* Transmission of each set through lengths [materials]: exact [sets]. */
void skg_transmit_exact(const skg_polychromatic *beam, const double *lengths, double *exact);

/* exp(-sum of lengths times mu), [bins]; mu: [materials][bins]. */
void skg_transmit(const skg_polychromatic *beam, const double *mu, const double *lengths, double *passed);

/* Adds a point, its exponent capped, with its exact transmission. */
skg_status skg_lengths_add(const skg_polychromatic *beam, const double *lengths, skg_lengths *points);

/* Adds the corners of the range (all, or `most` of them), `draws` random points of the sequence that `seed`
 * starts (half of them evenly over the range, half with more thin ones), and `count` given ones. */
skg_status skg_lengths_fill(const skg_polychromatic *beam, int64_t most, int64_t draws, uint64_t seed,
                            int64_t count, const double *given, skg_lengths *points);

/* Worst error over the sets at lengths, of nodes whose materials attenuate as mu ([materials][bins]) says.
 * exact: [sets] there. */
double skg_nodes_error(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                       const double *lengths, const double *exact);

/* Worst error over points, then uphill from the worst ten within the range. checked: counts what was looked
 * at. Where worst is given, the points that ascents have ended at are added to it. */
skg_status skg_nodes_verify(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                            const skg_lengths *points, double *error, int64_t *checked, skg_lengths *worst);

#endif
