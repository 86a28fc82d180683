/* Work under way: what must stay until the device is done with it, and what is reported then. Private. */
#ifndef SKG_JOB_H
#define SKG_JOB_H

#include "frame/plan.h"
#include "plan/report.h"

struct skg_job {
    skg_plan *plan;     /* retained; NULL: the caller keeps machine and outcome */
    skg_recipe *recipe; /* retained: that of the submission */
    skg_machine *machine;
    skg_outcome *outcome;
    skg_staging staging; /* host memory that the device reads or writes; the log of all frames */
    skg_results results; /* staged */
    cl_event last;       /* of the last command; NULL if the submission failed half way */
    int32_t finished;    /* 1: everything enqueued is done */
    int32_t reserved;
};

/* frames: how many it is to make. */
skg_status skg_job_create(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome,
                          int64_t frames, skg_job **job);

/* Waits for everything enqueued, then frees; *job becomes NULL. Also for submissions that failed half way. */
void skg_job_release(skg_job **job);

/* Waits, reports and releases. */
skg_status skg_job_complete(skg_job **job);

#endif
