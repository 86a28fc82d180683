/* Smoothing of what arrived in some frames of a series, over the detector and along the series. Private. */
#ifndef SKG_SCATTER_JOINT_H
#define SKG_SCATTER_JOINT_H

#include "scatter/along.h"
#include "scatter/smooth.h"

/* All zero: none. Cosines over the detector times functions along the series, of which those with (m + 1)(n + 1)(l + 1) up to an
 * order are kept, as of skg_cosines. */
typedef struct {
    int64_t batches, columns, rows;
    skg_along along;
    int64_t kept;       /* functions along the series */
    int64_t order;      /* of those that are kept */
    double *value;      /* [along.count][rows][columns] coefficients, of means over places; 0 if not kept */
    double *of_each;    /* [along.count][rows][columns] variance of the coefficients; 0 if not kept */
    double bias;        /* mean square of what was left out, per place */
    double mean, sigma; /* over the detector and the series: of a place; root mean square of its error */
} skg_joint;

/* at: [frames] from 0 to 1, rising; coefficients: [frames] each [batches][rows][columns], those of skg_cosines_of */
skg_status skg_joint_fit(int64_t batches, int64_t columns, int64_t rows, int64_t frames, const double *at,
                         const double *const *coefficients, skg_joint *joint);
void skg_joint_free(skg_joint *joint);

/* The cosines at t. Free them also after a failure. */
skg_status skg_joint_at(const skg_joint *joint, double t, skg_cosines *cosines);

/* Compares with another frame at t, which was not among those that were fitted: the mean square by which both differ beyond
 * noise, per place, and its standard error. coefficients: [batches][rows][columns] */
skg_status skg_joint_compare(const skg_joint *joint, double t, const double *coefficients, double *square,
                             double *error);

#endif
