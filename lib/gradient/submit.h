/* How jobs of gradients and of derivatives are submitted. Private. */
#ifndef SKG_GRADIENT_SUBMIT_H
#define SKG_GRADIENT_SUBMIT_H

#include "frame/plans.h"
#include "gradient/kind.h"

/* The begin of every submission: the plan as the scene is now, and work that release ends. *job becomes NULL. */
skg_status skg_gradient_begin(const char *call, skg_plan *plan, skg_job **job, skg_gradient_work **work);

/* Makes sure that the device computes derivatives of the plan rightly, by self-tests. */
skg_status skg_gradient_self_test(const skg_plan *plan);

/* Makes a job of the passes of a frame, which takes over the work. */
skg_status skg_gradient_make_job(skg_plan *plan, const skg_job_kind *kind, skg_gradient_work **work,
                                 skg_job **job);

/* Starts a job that is complete but for its device: *made becomes *job. */
skg_status skg_gradient_start(skg_plan *plan, const skg_frame *frame, skg_job **made, skg_job **job);

/* Waits for a job that a call has started. status: of the start */
skg_status skg_gradient_wait(skg_status status, skg_job **job);

#endif
