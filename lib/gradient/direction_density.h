/* The derivative of an image along a direction in which densities or attenuation coefficients change. Private.
 *
 * A ray whose mm of plane k change at the rate X_k, and whose exponent of node n at the rate Y_n (direction_rates.h), changes by the
 * sum of X_k and Y_n times its derivatives by them. */
#ifndef SKG_DERIVATIVE_DENSITY_H
#define SKG_DERIVATIVE_DENSITY_H

#include "gradient/work.h"

/* Adds what the rates change in one channel of the intensities, whose adjoint is 1. It replaces the weights on the device. */
skg_status skg_derivative_add_changes(skg_job *job, const skg_pass *pass, const skg_sums *sums, double factor,
                                      int64_t channel);

#endif
