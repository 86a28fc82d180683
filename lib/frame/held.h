/* Frames that the caller describes: read and checked, and copied if they are enqueued later. Private. */
#ifndef SKG_HELD_H
#define SKG_HELD_H

#include "frame/job.h"

/* Reads and checks a frame: itself, its view, its poses ([parts], NULL: the scene's) and the key of its noise. frames: the
 * caller's, or those of job->then; NULL: as plan and scene stand. */
skg_status skg_held_frame_read(const skg_job *job, const skg_frame *frames, int64_t index, skg_frame *frame,
                               skg_view *view, const double **poses, skg_noise_args *noise);

/* Reads and checks the view and the poses of a frame, over those that are given. index: for the message */
skg_status skg_held_frame_place(const skg_recipe *recipe, int64_t index, const skg_frame *frame,
                                skg_view *view, const double **poses);

/* Copies what the frames from job->enqueued on need of scene and caller. From then on the job looks at neither. */
skg_status skg_held_frames_copy(skg_job *job, const skg_frame *frames);

#endif
