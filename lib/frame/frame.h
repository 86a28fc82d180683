/* One frame: everything from vertices to pixels, enqueued stage by stage. Private. */
#ifndef SKG_FRAME_H
#define SKG_FRAME_H

#include "frame/job.h"

/* Prefetches the programs of images of the recipe's view (skg_prefetch_begin), as far as they are known before a frame. What fails
 * here fails again, and is reported, where it is needed. */
void skg_frame_prefetch(const skg_recipe *recipe, const skg_machine *machine);

/* Compiles and allocates for images of the recipe's view. */
skg_status skg_frame_prepare(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome);

/* Fills a pass and draws its sums, by itself; release it with skg_pass_release, also after a failure. number: of the pass, below 0:
 * the only one */
skg_status skg_frame_draw_pass(skg_job *job, const skg_frame_work *work, int64_t number, skg_pass *pass);

/* The sums of a pass that was drawn, as the attenuation reads them, with what it reads beside them. place: of the pass among those of
 * its raster */
skg_status skg_frame_sums(skg_job *job, const skg_pass *pass, int32_t place, skg_sums *sums);

/* What the intensities of a pass are multiplied by. */
double skg_frame_factor(const skg_recipe *recipe, const skg_frame_work *work, const skg_pass *pass);

/* Draws the path lengths through a part along every ray of a pass into a buffer, [rows][columns] of the pass's precision. The pass is
 * made for it alone; release it with skg_pass_release, also after a failure. */
skg_status skg_frame_draw_lengths(skg_job *job, const skg_frame_work *work, int64_t number, int64_t part,
                                  skg_buffer *lengths, skg_pass *pass);

/* The number of the first pass of an image; -1: its only one, which is averaged with none. */
static inline int64_t skg_frame_first_pass(const skg_recipe *recipe) {
    return skg_recipe_averages(recipe) ? 0 : -1;
}

/* Enqueues the passes from number `first` on, before `end`. */
skg_status skg_frame_enqueue_passes(skg_job *job, const skg_frame_work *work, int64_t first, int64_t end);

/* The steps of an output (enum skg_output_kind) of which an image's have `each` passes; 0: all. */
int64_t skg_frame_steps(const skg_recipe *recipe, int32_t shows, int64_t each);

/* Enqueues a step of a frame. When the device is done with the last one the result is in its place. */
skg_status skg_frame_enqueue(skg_job *job, const skg_frame_work *work);

#endif
