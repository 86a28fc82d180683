/* Work under way: what must stay until the device is done with it, and what is told then. Private. */
#ifndef SKG_JOB_H
#define SKG_JOB_H

#include "stage/kernels.h"

#include <skiagraph/plan.h>

typedef struct skg_staged skg_staged;

struct skg_job {
    skg_plan *plan;     /* retained */
    skg_staged *staged; /* host memory that the device reads or writes */
    int32_t finished;   /* everything enqueued is done */
    int32_t reserved;
    cl_event last;     /* of the last command; NULL where the submission failed half way */
    skg_stage_log log; /* of all frames, where stages are timed */
    int32_t *negative; /* staged: pixels with a negative exponent in the last frame; outside the
                          verified range in any */
    int32_t *listed;   /* staged: [2] as skg_raster_read_listed has it, of the last frame */
    int32_t *broken;   /* staged: the lowest vertex that was not finite, over all parts; INT32_MAX: none */
    int64_t bad_count; /* open parts of the last frame that add something: */
    int64_t *bad_open; /* staged: [bad_count] numbers in plan->open */
    int32_t *bad;      /* staged: [bad_count][1 + SKG_FIRST_BAD] verdicts on them */
};

skg_status skg_job_create(skg_plan *plan, skg_job **job);

/* Waits for everything enqueued, then frees; *job becomes NULL. Also for submissions that failed half way. */
void skg_job_release(skg_job **job);

/* Host memory that lives as long as the job; zeroed. */
skg_status skg_job_stage(skg_job *job, int64_t count, size_t size, const char *what, void *pointer_address);

/* Reads a buffer into staged memory without waiting. */
skg_status skg_job_read(skg_job *job, cl_mem buffer, int64_t bytes, void *staged);

#endif
