/* A job: what a submission holds until it is waited for, its steps, and its references. */
#include "frame/jobs.h"

#include <inttypes.h>
#include <stddef.h>
#include <string.h>

/* The memory of a job, all 0. */
static skg_status take_shell(const skg_context *context, skg_job **job) {
    SKG_TRY(skg_pool_take(context->jobs, sizeof **job, "job", job));
    memset((char *)*job + offsetof(skg_job, pool), 0, sizeof **job - offsetof(skg_job, pool));
    atomic_store(&(*job)->cancelled, 0);
    (*job)->pool = skg_pool_retain(context->jobs);
    return SKG_OK;
}

skg_status skg_job_create(const char *call, const skg_job_kind *kind, const skg_recipe *recipe,
                          skg_machine *machine, skg_outcome *outcome, int64_t count, int64_t output_count,
                          const skg_output *outputs, skg_job **job) {
    skg_job *made = NULL;
    skg_status status = SKG_OK;
    if (count < 1)
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " frames were asked for; at least one", count);
    if (output_count < 1 || !outputs)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: there is no output to put images into", call);
    SKG_TRY(take_shell(machine->context, &made));
    skg_results *results = &made->results;
    atomic_init(&made->references, 1);
    made->kind = kind;
    made->recipe = skg_recipe_retain(recipe);
    made->machine = machine;
    skg_work_begin();
    made->outcome = outcome;
    made->count = results->frames = count;
    made->staging.context = machine->context;
    made->staging.log.on = recipe->options.profile;
    SKG_TRY_CLEANUP(
        skg_staging_take(&made->staging, output_count, sizeof *made->outputs, "outputs", &made->outputs));
    for (; made->output_count < output_count; made->output_count++)
        SKG_TRY_CLEANUP(skg_frame_output_read(call, recipe, machine, count, outputs, made->output_count,
                                              &made->outputs[made->output_count]));
    SKG_TRY_CLEANUP(skg_job_divide(made, 1));
    SKG_TRY_CLEANUP(
        skg_staging_take(&made->staging, 4, sizeof *results->negative, "counters", &results->negative));
    SKG_TRY_CLEANUP(
        skg_staging_take(&made->staging, 2, sizeof *results->listed, "counters", &results->listed));
    SKG_TRY_CLEANUP(skg_staging_take(&made->staging, count, sizeof *results->bad_vertex, "counters",
                                     &results->bad_vertex));
    SKG_TRY_CLEANUP(skg_leaky_verdicts_create(recipe->leaky_count, &made->staging, &results->leaky));
    *job = made;
    return SKG_OK;
cleanup:
    skg_job_end(&made);
    return status;
}

skg_status skg_job_divide(skg_job *job, int64_t steps) {
    SKG_ASSERT(job->enqueued == 0 && steps >= 1);
    job->steps = steps;
    return skg_staging_take(&job->staging, job->count * steps, sizeof *job->ends, "events", &job->ends);
}

skg_status skg_job_step(skg_job *job, int64_t end, skg_frame_work *work) {
    const int64_t index = job->enqueued / job->steps, step = job->enqueued % job->steps;
    cl_event last = NULL;
    SKG_ASSERT(job->enqueued < skg_job_steps(job) && job->enqueued < end);
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

void skg_job_empty(skg_job *done) {
    skg_context *context = done->machine->context;
    skg_aside_end(&done->feeder);
    if (context->held == done) context->held = NULL;
    /* A submission that failed half way has no event to wait for, but may have enqueued what reads staged memory. */
    if (!done->finished) {
        clFinish(context->device->queue);
        skg_work_end();
    }
    for (int64_t f = 0; done->ends && f < done->enqueued; f++) clReleaseEvent(done->ends[f]);
    if (done->last) clReleaseEvent(done->last);
    skg_raster_pin_release(&done->main);
    if (done->state) done->kind->release(&done->state);
    for (int64_t o = 0; o < done->output_count; o++) skg_frame_output_release(&done->outputs[o]);
    skg_staging_release(&done->staging);
    skg_recipe_release(&done->recipe);
    skg_recipe_release(&done->then.given);
    skg_plan_release(&done->plan);
    skg_free(&done->sentence);
    atomic_store(&done->over, 1);
}

skg_status skg_job_retain(skg_job *job) {
    SKG_NEEDS(job);
    atomic_fetch_add(&job->references, 1);
    return SKG_OK;
}

void skg_job_release(skg_job **job) {
    if (!job || !*job) return;
    skg_job *left = *job;
    *job = NULL;
    if (atomic_fetch_sub(&left->references, 1) > 1) return;
    if (!atomic_load(&left->over)) { /* nobody waits for it any more */
        const skg_call begun = skg_call_begin(left->machine->context);
        atomic_store(&left->cancelled, 1);
        skg_job_empty(left);
        (void)skg_call_end(begun, SKG_OK);
    }
    skg_pool *pool = left->pool;
    skg_pool_give(pool, left);
    skg_pool_release(&pool);
}

void skg_job_end(skg_job **job) {
    if (!job || !*job) return;
    skg_job_empty(*job);
    skg_job_release(job);
}
