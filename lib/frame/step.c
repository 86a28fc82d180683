/* One step of a job. */
#include "frame/jobs.h"

skg_status skg_submit_step(skg_job *job, int64_t end, skg_frame_work *work) {
    const int64_t index = job->enqueued / job->steps, step = job->enqueued % job->steps;
    cl_event last = NULL;
    work->end = &last;
    work->followed = job->steps == 1 && job->enqueued + 1 < end;
    skg_status status = job->kind->step(job, index, step, work);
    if (status == SKG_OK && !last) {
        const cl_int code = clEnqueueMarkerWithWaitList(job->machine->context->device->queue, 0, NULL, &last);
        if (code != CL_SUCCESS) status = skg_cl_fail(code, "clEnqueueMarkerWithWaitList", __FILE__, __LINE__);
    }
    if (status != SKG_OK) {
        if (last) clReleaseEvent(last);
        return status;
    }
    job->followed = work->followed;
    job->ends[job->enqueued++] = last;
    return SKG_OK;
}
