/* Jobs are asked, cancelled and waited for; while nobody does so, a thread goes on with them, so that the device is not idle. */
#include "frame/jobs.h"

#include "core/text.h"
#include "device/device.h"
#include "driver/driver.h"

/* Waits until every frame that will be made is, and gives the device those that were held back. */
static cl_int wait_for_frames(skg_job *job) {
    cl_int code = CL_SUCCESS;
    while (code == CL_SUCCESS && !job->last) {
        skg_submission_continue(job);
        if (job->last || job->failure != SKG_OK || skg_job_is_cancelled(job)) break;
        code = skg_event_wait(job->ends[job->done]);
        job->done++;
    }
    return code;
}

/* Reports the outcome of a job whose commands are done. */
static skg_status outcome_of(skg_job *job) {
    if (job->enqueued < skg_job_steps(job) && job->followed) job->results.negative[0] = 0;
    const skg_status reported = skg_report_work(job->recipe, job->machine->context, &job->machine->geometry,
                                                &job->results, &job->staging.log, job->outcome);
    if (job->failure != SKG_OK)
        return skg_fail(job->failure, "%s", job->sentence ? job->sentence : "out of host memory");
    if (job->enqueued == skg_job_steps(job)) {
        if (job->kind->finish && reported >= 0) SKG_TRY(job->kind->finish(job));
        return reported;
    }
    return job->kind->cancelled(job);
}

skg_status skg_job_complete(skg_job **job) {
    skg_job *done = *job;
    skg_context *context = done->machine->context;
    const int64_t programs = context->device->builds + context->device->loads;
    const int first = context->device->launched < programs;
    skg_status status = SKG_OK;
    if (first) skg_signals_keep();
    cl_int code = wait_for_frames(done);
    if (code == CL_SUCCESS) status = skg_submission_finish(done);
    if (code == CL_SUCCESS && status == SKG_OK) code = skg_event_wait(done->last);
    if (first) skg_signals_restore();
    context->device->launched = programs;
    done->finished = code == CL_SUCCESS && status == SKG_OK;
    if (done->finished) {
        skg_work_end();
        skg_programs_launched(context);
        skg_machine_slots_settle(done->machine);
        status = outcome_of(done);
    } else if (status == SKG_OK) {
        status = skg_cl_fail(code, "clWaitForEvents", __FILE__, __LINE__);
    }
    skg_job_end(job);
    return status;
}

/* Whether a command is over. A failed one has a negative status: skg_job_wait reports it. */
static skg_status is_over(cl_event event, int *over) {
    cl_int stage = CL_COMPLETE;
    SKG_CL_TRY(clGetEventInfo(event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof stage, &stage, NULL));
    *over = stage <= CL_COMPLETE;
    return SKG_OK;
}

skg_status skg_job_look(skg_job *job) {
    for (int over = 1; over && job->done < job->enqueued; job->done += over)
        SKG_TRY(is_over(job->ends[job->done], &over));
    skg_submission_continue(job);
    return SKG_OK;
}

/* The context of a job; NULL: there is no job, or it is over. */
static skg_context *context_of(const skg_job *job) {
    return job && !atomic_load(&job->over) ? job->machine->context : NULL;
}

static skg_status test(skg_job *job, int32_t *done) {
    int over = 1;
    SKG_NEEDS_OF("skg_job_test", job);
    SKG_NEEDS_OF("skg_job_test", done);
    *done = 1;
    if (atomic_load(&job->over)) return SKG_OK;
    SKG_TRY(skg_context_enter(job->machine->context));
    SKG_TRY(skg_job_look(job));
    const int ends_early = job->failure != SKG_OK || skg_job_is_cancelled(job);
    if (job->last) SKG_TRY(is_over(job->last, &over));
    *done = job->last ? over : ends_early && job->done == job->enqueued;
    return SKG_OK;
}

skg_status skg_job_test(skg_job *job, int32_t *done) {
    const skg_call begun = skg_call_begin(context_of(job));
    return skg_call_end(begun, test(job, done));
}

static skg_status progress(skg_job *job, int64_t *done, int64_t *total) {
    SKG_NEEDS_OF("skg_job_progress", job);
    if (!atomic_load(&job->over)) {
        SKG_TRY(skg_context_enter(job->machine->context));
        SKG_TRY(skg_job_look(job));
    }
    if (done) *done = job->done;
    if (total) *total = skg_job_steps(job);
    return SKG_OK;
}

skg_status skg_job_progress(skg_job *job, int64_t *done, int64_t *total) {
    const skg_call begun = skg_call_begin(context_of(job));
    return skg_call_end(begun, progress(job, done, total));
}

skg_status skg_job_cancel(skg_job *job) {
    SKG_NEEDS(job);
    atomic_store(&job->cancelled, 1);
    return SKG_OK;
}

static skg_status wait_for(skg_job **job) {
    SKG_PLAIN;
    if (!job || !*job) return skg_fail(SKG_ERR_ARGUMENT, "skg_job_wait: no job");
    if (atomic_load(&(*job)->over))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "skg_job_wait: this job was waited for; skg_job_release gives up a retained one");
    SKG_TRY(skg_context_enter((*job)->machine->context));
    return skg_job_complete(job);
}

skg_status skg_job_wait(skg_job **job) {
    const skg_call begun = skg_call_begin(job ? context_of(*job) : NULL);
    return skg_call_end(begun, wait_for(job));
}

/* --- while nobody asks */

/* Gives the device what it can be given by now. Returns the event of the oldest step that is not done, retained; NULL: nothing is
 * left to do. A failure is that of the job, or skg_job_wait meets it again. */
static void *go_on(void *user) {
    skg_job *job = user;
    if (skg_job_look(job) != SKG_OK || job->failure != SKG_OK || job->last || skg_job_is_cancelled(job))
        return NULL;
    cl_event oldest = job->ends[job->done];
    return clRetainEvent(oldest) == CL_SUCCESS ? oldest : NULL;
}

static int wait_for_step(void *oldest) {
    const cl_int code = skg_event_wait(oldest);
    clReleaseEvent(oldest);
    return code == CL_SUCCESS;
}

skg_status skg_feeder_start(skg_status status, skg_job *const *job) {
    static const skg_aside_work work = {go_on, wait_for_step};
    if (SKG_FAILED(status) || !*job) return status;
    skg_context *context = (*job)->machine->context;
    if (context->held == *job) skg_aside_begin(context->turn, work, *job, &(*job)->feeder);
    return status;
}
