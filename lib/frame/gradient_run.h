/* A job that is a gradient: what comes before its passes and after them. Private. */
#ifndef SKG_GRADIENT_RUN_H
#define SKG_GRADIENT_RUN_H

#include "frame/gradient_work.h"
#include "frame/job.h"

/* Before the first pass: waits for the adjoint and the image, and turns them into derivatives by intensities. */
skg_status skg_gradient_begin(skg_job *job);

/* After the last pass: fills the caller's memory. */
skg_status skg_gradient_finish(skg_job *job);

#endif
