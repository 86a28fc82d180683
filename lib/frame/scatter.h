/* Scattered photons of a frame. Private. */
#ifndef SKG_FRAME_SCATTER_H
#define SKG_FRAME_SCATTER_H

#include "frame/job.h"

/* Whether images of the job hold scattered photons. */
int skg_frame_scatters(const skg_job *job);

/* Densities of all parts in a frame, and behind them the shares that are there; NULL: those of the materials. The caller frees
 * them. */
skg_status skg_frame_matter(const skg_recipe *recipe, const skg_frame *frame, double **matter);

/* Refuses positions that are on the device alone, which are not known here. */
skg_status skg_frame_check_places(const skg_recipe *recipe, const skg_machine *machine);

/* Computes the scatter of the frame, waits for it, and enqueues what adds it to the intensities. image: where these are. */
skg_status skg_frame_add_scatter(skg_job *job, const skg_frame_work *work, const skg_image_place *image);

/* The same of an output that shows the scatter, its standard error or a component, alone. */
skg_status skg_frame_show_scatter(skg_job *job, const skg_frame_work *work);

#endif
