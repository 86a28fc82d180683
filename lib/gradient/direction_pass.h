/* The share of one pass in the derivative of an image along a direction. Private. */
#ifndef SKG_DERIVATIVE_PASS_H
#define SKG_DERIVATIVE_PASS_H

#include "gradient/work.h"

/* Adds the derivatives of the intensities of one pass, whose sums are made, and waits for them. Arguments as of
 * skg_gradient_add_pass. */
skg_status skg_derivative_add_pass(skg_job *job, const skg_frame_work *work, int64_t number,
                                   const skg_pass *pass, const skg_sums *sums, double factor);

#endif
