/* One frame: everything from vertices to pixels, enqueued stage by stage. Private. */
#ifndef SKG_FRAME_H
#define SKG_FRAME_H

#include "frame/job.h"

/* Prefetches the programs of images of the recipe's view (skg_prefetch_begin), as far as they are known before a frame. What fails
 * here fails again, and is reported, where it is needed. */
void skg_frame_prefetch(const skg_recipe *recipe, const skg_machine *machine);

/* Compiles and allocates for images of the recipe's view. */
skg_status skg_frame_prepare(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome);

/* Enqueues the sums of the first pass of a gradient, which find them where they stand. */
skg_status skg_frame_enqueue_sums(skg_job *job, const skg_frame_work *work);

/* The number of the first pass of an image; -1: its only one, which is averaged with none. */
static inline int64_t skg_frame_first_pass(const skg_recipe *recipe) {
    return skg_recipe_averages(recipe) ? 0 : -1;
}

/* Enqueues the passes from number `first` on, before `end`. */
skg_status skg_frame_enqueue_passes(skg_job *job, const skg_frame_work *work, int64_t first, int64_t end);

/* The steps of an output (enum skg_output_kind) of which an image's have `each` passes; 0: all. */
int64_t skg_frame_steps(const skg_recipe *recipe, int32_t shows, int64_t each);

/* Enqueues a step of a frame, or a pass of a gradient. When the device is done with the last one the result is in its place. */
skg_status skg_frame_enqueue(skg_job *job, const skg_frame_work *work);

#endif
