/* Smoothing by cosines: what arrived on a coarse grid, as an image. Private. */
#ifndef SKG_SCATTER_SMOOTH_H
#define SKG_SCATTER_SMOOTH_H

#include "core/core.h"

/* Sums of photons in each place of the detector, of independent batches. */
typedef struct {
    int64_t batches, columns, rows;
    const double *values; /* [batches][rows][columns] */
} skg_arrivals;

/* Cosines cos(pi m x) cos(pi n y), x and y from 0 to 1 over the detector, with 0 <= m, n < kept. */
typedef struct {
    int64_t columns, rows; /* most cosines: those of the grid */
    int64_t kept[2];       /* along columns and rows */
    double *value;         /* [rows][columns] coefficients of the smooth function, per place of the grid */
    double *variance;      /* [rows][columns] of them */
    double bias;           /* mean square of what was left out, per place of the grid */
    double doubt;          /* standard error of it */
    double mean, sigma;    /* over the detector: of a place; root mean square of its error, bias included */
} skg_cosines;

/* Chooses how many cosines to keep: as many as make the expected square of the error smallest, judged by the spread of the batches.
 * A cosine that is kept costs its variance, one that is left out the square of its mean less its variance (C. L. Mallows, Some
 * comments on C_p, Technometrics 15 (1973) 661-675). */
skg_status skg_cosines_fit(const skg_arrivals *arrivals, skg_cosines *cosines);

/* The cosines that `like` keeps, of other values on its grid: [rows][columns]. Their variance is not known. */
skg_status skg_cosines_like(const skg_cosines *like, const double *values, skg_cosines *cosines);
void skg_cosines_free(skg_cosines *cosines);

/* The smooth function at the middles of rows x columns pixels that fill the same detector, per pixel; squares: 1: the variance
 * instead, bias included. image: [rows][columns] */
skg_status skg_cosines_show(const skg_cosines *cosines, int squares, int64_t rows, int64_t columns,
                            double *image);

#endif
