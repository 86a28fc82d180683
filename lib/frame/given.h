/* What the caller gives: frames, densities of parts in them, OpenCL objects. Private. */
#ifndef SKG_GIVEN_H
#define SKG_GIVEN_H

#include "device/device.h"
#include "frame/jobs.h"
#include "plan/recipe.h"

/* --- Frames that the caller describes: read and checked, and copied if they are enqueued later */

/* Reads and checks a frame: itself, its view, its poses ([parts], NULL: the scene's) and the key of its noise. frames: the
 * caller's, or those of job->then; NULL: as plan and scene stand. */
skg_status skg_held_frame_read(const skg_job *job, const skg_frame *frames, int64_t index, skg_frame *frame,
                               skg_view *view, const double **poses, skg_noise_args *noise);

/* Reads and checks the view and the poses of a frame, over those that are given. index: for the message */
skg_status skg_held_frame_place(const skg_recipe *recipe, int64_t index, const skg_frame *frame,
                                skg_view *view, const double **poses);

/* Copies what the frames from job->enqueued on need of scene and caller. From then on the job looks at neither. */
skg_status skg_held_frames_copy(skg_job *job, const skg_frame *frames);

/* --- Frames in which parts have another density or fill fraction than planned: air that thins a lung, contrast medium that fills
 * a duct */

/* What every part of such a frame contributes; both arrays are freed by the caller.
 *
 * contributions   part p has first[p] to first[p + 1] - 1
 * first           [parts + 1] */
skg_status skg_overrides_apply(const skg_recipe *recipe, const skg_frame *given,
                               skg_contribution **contributions, int64_t **first);

/* The matter of all parts in a frame: density over that of the material, and the share that is there. [parts] each */
skg_status skg_overrides_matter(const skg_recipe *recipe, const skg_frame *given, double *density,
                                double *fill);

/* --- OpenCL objects of the caller */

/* The events that a call is given, and where the caller wants one of its own. */
typedef struct {
    int32_t waits;
    const cl_event *wait_list; /* [waits] */
    cl_event *done;            /* may be NULL */
} skg_caller_events;

/* Sets *done to NULL, and checks the list. call: the name of the function, for the message. */
skg_status skg_caller_events_check(const char *call, const skg_caller_events *events);

/* Enqueues that the caller's events are waited for. */
skg_status skg_caller_events_wait(skg_context *context, const skg_caller_events *events);

/* Checks that a buffer is of the context's, and gets its size. */
skg_status skg_caller_buffer_check(const char *call, const skg_context *context, cl_mem buffer,
                                   int64_t *bytes);

#endif
