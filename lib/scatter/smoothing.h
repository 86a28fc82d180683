/* Smooth functions over the detector and along a series. Private. */
#ifndef SKG_SMOOTHING_H
#define SKG_SMOOTHING_H

#include "core/core.h"

#include <skiagraph/scatter_series.h>

/* --- How many coefficients of a smooth function are kept. */

typedef struct {
    int64_t order; /* nothing is kept of coefficients beyond this order */
    double bias;   /* expected sum of the squares of what is left out */
    double doubt;  /* standard error of it */
} skg_choice;

/* Chooses the share of each coefficient that makes the expected square of the error smallest. In blocks of orders, of which all
 * coefficients are taken for about as large, it is signal / (signal + variance): W. James and C. Stein, Estimation with quadratic
 * loss, Proc. 4th Berkeley Symposium 1 (1961) 361-379; in blocks: L. Cavalier and A. B. Tsybakov, Penalized blockwise Stein's method,
 * Mathematical Methods of Statistics 10 (2001) 247-282. Some coefficients may be far noisier than others, because lattices of
 * points have waves that they miss: they hardly count in the signal of a block, and little is kept of them.
 *
 * orders, value, variance   [count] of orthonormal functions; orders >= 1; variance of the value
 * shares                    [count] from 0 to 1 */
skg_status skg_choose_order(int64_t count, const int64_t *orders, const double *value, const double *variance,
                            double *shares, skg_choice *choice);

/* --- Smoothing by cosines: what arrived on a coarse grid, as an image. */

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
    /* [rows][columns] coefficients of the smooth function at the middle of a place; 0 if not kept */
    double *value;
    double *variance; /* [rows][columns] of them */
    double *share;    /* [rows][columns] how much of each is kept */
    /* [rows][columns] coefficients of the variance that the batches show from place to place */
    double *spread;
    double bias;        /* mean square of what was left out, of means over places */
    double doubt;       /* standard error of it */
    double mean, sigma; /* over the detector: of a place; root mean square of its error, bias included */
} skg_cosines;

/* Keeps of each cosine what makes the error smallest. */
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

/* --- Smooth functions of a place along a series: 1, t, t^2 and cosines, made orthonormal over some places. *
 * The powers take over what differs between both ends, so that few cosines suffice. */

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

/* --- Smoothing of what arrived in some frames of a series, over the detector and along the series. */

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
