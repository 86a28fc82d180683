/* Waiting for a job, and giving the device its frames meanwhile. Private. */
#ifndef SKG_WAIT_H
#define SKG_WAIT_H

#include "frame/job.h"

/* Waits, reports and releases. */
skg_status skg_job_complete(skg_job **job);

#endif
