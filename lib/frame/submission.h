/* Frames of a job: checked and enqueued, all at once or one after another. Private. */
#ifndef SKG_SUBMISSION_H
#define SKG_SUBMISSION_H

#include "frame/job.h"

/* Checks the frames and enqueues them. Of frames that keep the device busy for long, only the first ones are enqueued, so that a
 * job can be cancelled; the others follow while it is asked or waited for. frames: [job->count] the caller's; NULL: each as
 * plan and scene stand. at_once: 1: all are enqueued. After a failure nothing is under way, and the job is released. */
skg_status skg_submission_enqueue(skg_job **job, const skg_frame *frames, int at_once);

/* The kind of job whose frames are images, and other outputs. */
extern const skg_job_kind skg_job_images;

/* Enqueues a step of one output of a frame; of an undivided job all of it. index: of the frame */
skg_status skg_frame_enqueue_output(skg_job *job, const skg_frame_output *output, int64_t index,
                                    skg_frame_work *work);

/* Enqueues frames that the device can be given by now, unless the job was cancelled. A failure is reported by skg_job_wait. */
void skg_submission_continue(skg_job *job);

/* Enqueues what is left of a context's earlier job, so that its jobs run in order. */
void skg_submission_flush(const skg_context *context);

/* Enqueues the reads of what is reported, and the marker that is waited for, if that was not done. */
skg_status skg_submission_finish(skg_job *job);

#endif
