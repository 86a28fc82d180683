/* Smoothing by cosines: what arrived on a coarse grid, as an image. Private. */
#ifndef SKG_SCATTER_SMOOTH_H
#define SKG_SCATTER_SMOOTH_H

#include "core/core.h"

/* Sums of photons in each place of the detector, of independent batches. */
typedef struct {
    int64_t batches, columns, rows;
    const double *values; /* [batches][rows][columns] */
} skg_arrivals;

/* Cosines cos(pi m x) cos(pi n y), x and y from 0 to 1 over the detector, of which those with (m + 1)(n + 1) <= an order are kept.
 * A smooth function has coefficients that fall with m^2 n^2, since its slope at the edges is not 0: this hyperbolic cross
 * (K. I. Babenko, Approximation of periodic functions of many variables by trigonometric polynomials, Soviet Mathematics Doklady 1
 * (1960) 513-516) holds as much of it as a square of several times as many. */
typedef struct {
    int64_t columns, rows; /* most cosines: those of the grid */
    int64_t kept[2];       /* 0 <= m < kept[0], 0 <= n < kept[1] holds all that are kept */
    int64_t count;         /* so many are kept */
    double *
        value; /* [rows][columns] coefficients of the smooth function at the middle of a place; 0 if not kept */
    double *variance; /* [rows][columns] of them */
    double
        *spread;  /* [rows][columns] coefficients of the variance that the batches show from place to place */
    double bias;  /* mean square of what was left out, of means over places */
    double doubt; /* standard error of it */
    double mean, sigma; /* over the detector: of a place; root mean square of its error, bias included */
} skg_cosines;

/* Keeps as many cosines as make the error smallest (order.h). */
skg_status skg_cosines_fit(const skg_arrivals *arrivals, skg_cosines *cosines);

/* The coefficients of `count` grids. values, coefficients: [count][rows][columns] */
skg_status skg_cosines_of(int64_t columns, int64_t rows, int64_t count, const double *values,
                          double *coefficients);

/* Completes cosines of which grid, bias, and value and variance of means over places are given: keeps those up to an order, with the
 * same variance all over the detector. */
void skg_cosines_complete(skg_cosines *cosines, int64_t order);

/* The cosines that `like` keeps, of other values on its grid: [rows][columns]. Their variance is not known. */
skg_status skg_cosines_like(const skg_cosines *like, const double *values, skg_cosines *cosines);
void skg_cosines_free(skg_cosines *cosines);

/* The smooth function at the middles of rows x columns pixels that fill the same detector, per pixel; squares: 1: the variance of it
 * instead, bias included. image: [rows][columns] */
skg_status skg_cosines_show(const skg_cosines *cosines, int squares, int64_t rows, int64_t columns,
                            double *image);

#endif
