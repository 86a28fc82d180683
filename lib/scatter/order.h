/* How many coefficients of a smooth function are kept. Private. */
#ifndef SKG_SCATTER_ORDER_H
#define SKG_SCATTER_ORDER_H

#include "core/core.h"

typedef struct {
    int64_t order; /* coefficients up to this order are kept */
    double bias;   /* sum of the squares of those that are left out */
    double doubt;  /* standard error of it */
} skg_choice;

/* Chooses the order that makes the expected square of the error smallest. A coefficient that is kept costs its variance, one that is
 * left out the square of its mean less its variance (C. L. Mallows, Some comments on C_p, Technometrics 15 (1973) 661-675). Some may
 * be far noisier than others, because lattices of points have waves that they miss: they hardly count among those that are
 * left out.
 *
 * orders, value, variance   [count] of orthonormal functions; orders >= 1; variance of the value */
skg_status skg_choose_order(int64_t count, const int64_t *orders, const double *value, const double *variance,
                            skg_choice *choice);

#endif
