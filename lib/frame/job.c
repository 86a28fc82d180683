#include "frame/job.h"
#include "frame/plan.h"
#include "plan/report.h"

struct skg_staged {
    struct skg_staged *next;
    void *bytes;
};

skg_status skg_job_create(skg_plan *plan, skg_job **job) {
    SKG_TRY(skg_alloc(1, sizeof **job, "job", job));
    (*job)->plan = plan;
    (*job)->log.on = plan->options.profile;
    skg_ref(&plan->refs);
    return SKG_OK;
}

skg_status skg_job_stage(skg_job *job, int64_t count, size_t size, const char *what, void *pointer_address) {
    skg_staged *entry = NULL;
    SKG_TRY(skg_alloc(1, sizeof *entry, what, &entry));
    skg_status status = skg_alloc(count, size, what, &entry->bytes);
    if (status != SKG_OK) {
        skg_free(&entry);
        return status;
    }
    entry->next = job->staged;
    job->staged = entry;
    *(void **)pointer_address = entry->bytes;
    return SKG_OK;
}

skg_status skg_job_read(skg_job *job, cl_mem buffer, int64_t bytes, void *staged) {
    SKG_CL_TRY(clEnqueueReadBuffer(job->plan->context->device->queue, buffer, CL_FALSE, 0, (size_t)bytes,
                                   staged, 0, NULL, NULL));
    return SKG_OK;
}

void skg_job_release(skg_job **job) {
    if (!job || !*job) return;
    skg_job *done = *job;
    /* A submission that failed half way has no event to wait for, but may have enqueued what reads staged
     * memory. */
    if (!done->finished) clFinish(done->plan->context->device->queue);
    if (done->last) clReleaseEvent(done->last);
    skg_stage_log_clear(&done->log);
    while (done->staged) {
        skg_staged *entry = done->staged;
        done->staged = entry->next;
        skg_free(&entry->bytes);
        skg_free(&entry);
    }
    skg_plan_release(&done->plan);
    skg_free(job);
}

skg_status skg_job_test(const skg_job *job, int32_t *done) {
    if (!job || !done) return skg_fail(SKG_ERR_ARGUMENT, "skg_job_test: no job or no result");
    SKG_TRY(skg_context_enter(job->plan->context));
    cl_int stage = CL_COMPLETE;
    SKG_CL_TRY(clGetEventInfo(job->last, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof stage, &stage, NULL));
    /* A failed command has a negative status: it is over, and skg_job_wait reports it. */
    *done = stage <= CL_COMPLETE;
    return SKG_OK;
}

skg_status skg_job_wait(skg_job **job) {
    if (!job || !*job) return skg_fail(SKG_ERR_ARGUMENT, "skg_job_wait: no job");
    SKG_TRY(skg_context_enter((*job)->plan->context));
    skg_status status = SKG_OK;
    cl_int code = clWaitForEvents(1, &(*job)->last);
    if (code != CL_SUCCESS) status = skg_cl_fail(code, "clWaitForEvents", __FILE__, __LINE__);
    (*job)->finished = code == CL_SUCCESS;
    if (status == SKG_OK) status = skg_report_job(*job);
    skg_job_release(job);
    return status;
}
