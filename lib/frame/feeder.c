/* Goes on with a job while its program neither asks for it nor waits, so that the device is not idle. */
#include "frame/feeder.h"

#include "device/device.h"

/* Gives the device what it can be given by now. Returns the event of the oldest step that is not done, retained; NULL: nothing is
 * left to do. A failure is that of the job, or skg_job_wait meets it again. */
static void *go_on(void *user) {
    skg_job *job = user;
    if (skg_job_look(job) != SKG_OK || job->failure != SKG_OK || job->last || skg_job_is_cancelled(job))
        return NULL;
    cl_event oldest = job->ends[job->done];
    return clRetainEvent(oldest) == CL_SUCCESS ? oldest : NULL;
}

static int wait_for(void *oldest) {
    const cl_int code = skg_event_wait(oldest);
    clReleaseEvent(oldest);
    return code == CL_SUCCESS;
}

skg_status skg_feeder_start(skg_status status, skg_job *const *job) {
    static const skg_aside_work work = {go_on, wait_for};
    if (SKG_FAILED(status) || !*job) return status;
    skg_context *context = (*job)->machine->context;
    if (context->held == *job) skg_aside_begin(context->turn, work, *job, &(*job)->feeder);
    return status;
}
