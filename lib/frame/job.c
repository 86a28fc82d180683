#include "frame/job.h"

#include "core/plain.h"
#include "driver/driver.h"

skg_status skg_job_create(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome,
                          int64_t frames, skg_job **job) {
    SKG_TRY(skg_alloc(1, sizeof **job, "job", job));
    skg_job *made = *job;
    skg_results *results = &made->results;
    skg_status status = SKG_OK;
    made->recipe = skg_recipe_retain(recipe);
    made->machine = machine;
    skg_work_begin();
    made->outcome = outcome;
    made->staging.context = machine->context;
    made->staging.log.on = recipe->options.profile;
    SKG_TRY_CLEANUP(
        skg_staging_take(&made->staging, 3, sizeof *results->negative, "counters", &results->negative));
    SKG_TRY_CLEANUP(
        skg_staging_take(&made->staging, 2, sizeof *results->listed, "counters", &results->listed));
    SKG_TRY_CLEANUP(skg_staging_take(&made->staging, frames, sizeof *results->bad_vertex, "counters",
                                     &results->bad_vertex));
    results->frames = frames;
    SKG_TRY_CLEANUP(skg_leaky_verdicts_create(recipe->leaky_count, &made->staging, &results->leaky));
    return SKG_OK;
cleanup:
    skg_job_release(job);
    return status;
}

void skg_job_release(skg_job **job) {
    if (!job || !*job) return;
    skg_job *done = *job;
    /* A submission that failed half way has no event to wait for, but may have enqueued what reads staged memory. */
    if (!done->finished) {
        clFinish(done->machine->context->device->queue);
        skg_work_end();
    }
    if (done->last) clReleaseEvent(done->last);
    skg_staging_release(&done->staging);
    skg_recipe_release(&done->recipe);
    skg_plan_release(&done->plan);
    skg_free(job);
}

skg_status skg_job_complete(skg_job **job) {
    skg_job *done = *job;
    skg_context *context = done->machine->context;
    const int64_t programs = context->device->builds + context->device->loads;
    const int first = context->device->launched < programs;
    if (first) skg_signals_keep();
    const cl_int code = clWaitForEvents(1, &done->last);
    if (first) skg_signals_restore();
    context->device->launched = programs;
    done->finished = code == CL_SUCCESS;
    if (done->finished) {
        skg_work_end();
        skg_programs_launched(context);
    }
    const skg_status status = code == CL_SUCCESS
                                  ? skg_report_work(done->recipe, context, &done->machine->geometry,
                                                    &done->results, &done->staging.log, done->outcome)
                                  : skg_cl_fail(code, "clWaitForEvents", __FILE__, __LINE__);
    skg_job_release(job);
    return status;
}

static skg_status test(const skg_job *job, int32_t *done) {
    SKG_NEEDS_OF("skg_job_test", job);
    SKG_NEEDS_OF("skg_job_test", done);
    SKG_TRY(skg_context_enter(job->machine->context));
    cl_int stage = CL_COMPLETE;
    SKG_CL_TRY(clGetEventInfo(job->last, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof stage, &stage, NULL));
    /* A failed command has a negative status: it is over, and skg_job_wait reports it. */
    *done = stage <= CL_COMPLETE;
    return SKG_OK;
}

skg_status skg_job_test(const skg_job *job, int32_t *done) {
    const skg_error_handler handler = skg_call_begin(job ? job->machine->context : NULL);
    return skg_call_end(handler, test(job, done));
}

static skg_status wait_for(skg_job **job) {
    SKG_PLAIN;
    if (!job || !*job) return skg_fail(SKG_ERR_ARGUMENT, "skg_job_wait: no job");
    SKG_TRY(skg_context_enter((*job)->machine->context));
    return skg_job_complete(job);
}

skg_status skg_job_wait(skg_job **job) {
    const skg_error_handler handler = skg_call_begin(job && *job ? (*job)->machine->context : NULL);
    return skg_call_end(handler, wait_for(job));
}
