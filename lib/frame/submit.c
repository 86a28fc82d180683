#include "core/plain.h"
#include "frame/caller.h"
#include "frame/submission.h"

/* What every submission begins with. */
static skg_status begin(const char *call, skg_plan *plan, skg_job **job) {
    SKG_NEEDS_OF(call, plan);
    SKG_NEEDS_OF(call, job);
    *job = NULL;
    SKG_TRY(skg_context_enter(plan->context));
    skg_submission_flush(plan->context);
    return SKG_OK;
}

skg_status skg_plan_enqueue(const char *call, skg_plan *plan, int64_t count, const skg_frame *frames,
                            int64_t output_count, const skg_output *outputs, const skg_caller_events *events,
                            skg_job **job) {
    SKG_PLAIN;
    skg_job *made = NULL;
    SKG_TRY(begin(call, plan, job));
    if (events) SKG_TRY(skg_caller_events_check(call, events));
    SKG_TRY(skg_plan_renew(plan));
    SKG_TRY(skg_job_create(call, plan->recipe, &plan->machine, &plan->outcome, count, output_count, outputs,
                           &made));
    if (events) {
        const skg_status status = skg_caller_events_wait(plan->context, events);
        if (status != SKG_OK) skg_job_release(&made);
        SKG_TRY(status);
    }
    SKG_TRY(skg_submission_enqueue(&made, frames, events != NULL));
    skg_ref(&plan->refs);
    made->plan = plan;
    *job = made;
    if (events && events->done) {
        SKG_CL_TRY(clRetainEvent(made->last));
        *events->done = made->last;
    }
    return SKG_OK;
}
