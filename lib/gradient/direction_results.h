/* Where derivatives along directions go: the caller's output, whose frames are the directions. Private. */
#ifndef SKG_DIRECTION_RESULTS_H
#define SKG_DIRECTION_RESULTS_H

#include "gradient/work.h"

/* Checks the caller's output and says where the image of each direction is made: in the caller's memory, if that is dense and of doubles,
 * or in memory of its own. */
skg_status skg_direction_results_place(const skg_context *context, const skg_recipe *recipe,
                                       const skg_output *derivatives, skg_gradient_work *work);

/* Clears the images, which passes are added to. */
void skg_direction_results_clear(const skg_job *job);

/* Puts the image of a direction where the caller wants it, and waits for it. */
skg_status skg_direction_results_put(const skg_job *job, int64_t direction);

#endif
