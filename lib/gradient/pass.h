/* The share of one pass in a gradient. Private. */
#ifndef SKG_GRADIENT_PASS_H
#define SKG_GRADIENT_PASS_H

#include "gradient/work.h"

/* Adds the share of one pass, whose sums are made, and waits for it.
 *
 * number   of the pass, below 0: the only one
 * factor   of its intensities */
skg_status skg_gradient_add_pass(skg_job *job, const skg_frame_work *work, int64_t number,
                                 const skg_pass *pass, const skg_sums *sums, double factor);

/* Enqueues the derivatives by the sums of a pass from those by its intensities: skg_gradient_of(job)->adjoint, if no channel is wanted. */
skg_status skg_gradient_weigh(skg_job *job, const skg_pass *pass, const skg_sums *sums,
                              const skg_weights_wanted *wanted);

#endif
