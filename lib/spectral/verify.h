/* The transmission of a beam of several energies through lengths of materials, its error with fewer energies and
 * planes, and the search for the worst error. Private.
 *
 * Errors are relative for transmissions above 1e-6; below, they are relative to 1e-6. */
#ifndef SKG_VERIFY_H
#define SKG_VERIFY_H

#include "core/core.h"

/* The transmission from which on errors are relative. Smaller ones are lost in the noise of real images. */
#define SKG_RELATIVE_FROM 1e-6

/* The largest exponent of the energy that passes best. Single precision ends at exp(-87). */
#define SKG_EXPONENT_MAX 80

/* The exact beam, with every bin. A set is the weight of each bin in one channel, as a share of the flat field. */
typedef struct {
    int32_t bins, materials, sets;
    int32_t paired;       /* 1: sets k and sets/2 + k must use the same nodes */
    const double *mu;     /* [materials][bins] 1/mm */
    const double *shares; /* [bins][sets], each set sums to 1 */
    const double *low;    /* [materials] mm: range of the lengths */
    const double *high;
    double floor; /* transmission from which on errors are relative */
} skg_polychromatic;

/* Few energies: some of the bins, each with a weight in every set. */
typedef struct {
    int32_t count, reserved;
    int32_t *bin;   /* [count] rising */
    double *shares; /* [count][sets], >= 0 */
} skg_nodes;

/* Points: lengths [count][materials] in mm, with the exact transmission of each [count][sets]. */
typedef struct {
    int64_t count, capacity;
    double *lengths, *exact;
} skg_lengths;

/* Which points are taken. */
typedef struct {
    int64_t corners; /* all corners of the range, or this many */
    int64_t draws;   /* random points */
    int64_t rays;    /* at most this many of the rays, evenly spread */
    uint64_t seed;
} skg_sampling;

/* Lengths that rays meet, of which the first columns are those of the materials. */
typedef struct {
    int64_t count, width;
    const double *lengths; /* [count][width] mm */
} skg_rays;

void skg_nodes_release(skg_nodes *nodes);
void skg_lengths_release(skg_lengths *points);

/* Sets exact [sets] to the transmission of each set through lengths [materials], which are scaled down first until the
 * energy that passes best has at most the largest exponent. exponents: [bins], for the work. */
void skg_transmit_exact(const skg_polychromatic *beam, double *lengths, double *exact, double *exponents);

/* Sets passed [bins] to exp(-sum of lengths times mu). mu: [materials][bins] 1/mm. */
void skg_transmit(const skg_polychromatic *beam, const double *mu, const double *lengths, double *passed);

/* Adds points with their transmissions: no matter at all, the corners of the range, random points of the sequence that
 * `seed` starts, and rays. Half of the random points are even over the range, half have more thin lengths. */
skg_status skg_lengths_fill(const skg_polychromatic *beam, const skg_sampling *sampling, const skg_rays *rays,
                            skg_lengths *points);

/* The worst error over the sets, at one point, of nodes whose materials attenuate by mu ([materials][bins]).
 * exact: [sets] at that point. */
double skg_nodes_error(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                       const double *lengths, const double *exact);

/* The error of -ln of the transmission, and the smallest transmission of a set that rays meet.
 *
 * error   absolute, at most, over the rays and sets
 * least   share of the flat field */
skg_status skg_nodes_log_error(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                               const skg_rays *rays, double *error, double *least);

/* The worst error over the points, and uphill from the worst ten of them within the range.
 *
 * checked   the number of points that were compared
 * worst     NULL, or the list to which the ends of the ascents are added */
skg_status skg_nodes_verify(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                            const skg_lengths *points, double *error, int64_t *checked, skg_lengths *worst);

#endif
