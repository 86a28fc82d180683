/* How fast the planes and exponents of rays change along a direction, by densities and attenuation coefficients. Private.
 *
 * Both rates are sums over parts of the path length through the part times what the direction says of it. */
#ifndef SKG_DERIVATIVE_RATES_H
#define SKG_DERIVATIVE_RATES_H

#include "gradient/work.h"

/* Sets the rates of a pass to 0. */
void skg_derivative_clear_rates(skg_job *job);

/* Adds a part, from the path lengths through it. own: [planes] what a mm of its material adds to each; lengths: [rows][columns] */
skg_status skg_derivative_add_lengths(skg_job *job, const skg_pass *pass, int64_t part, const double *own,
                                      const double *lengths);

#endif
