/* One frame: everything from vertices to pixels, enqueued stage by stage. Private. */
#ifndef SKG_FRAME_H
#define SKG_FRAME_H

#include "frame/job.h"

/* Expects the programs of images of the recipe's view (skg_expected_begin), as far as they are known before a frame. What fails
 * here fails again, and is reported, where it is needed. */
void skg_frame_expect(const skg_recipe *recipe, const skg_machine *machine);

/* Compiles and allocates for images of the recipe's view. */
skg_status skg_frame_prepare(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome);

/* Enqueues the sums of the first pass of a gradient, which find them where they stand. */
skg_status skg_frame_enqueue_sums(skg_job *job, const skg_frame_work *work);

/* Enqueues a frame, or a pass of a gradient. When the device is done with it the result is in its place. */
skg_status skg_frame_enqueue(skg_job *job, const skg_frame_work *work);

#endif
