#include "core/plain.h"
#include "device/self_tests.h"
#include "frame/caller.h"
#include "frame/submission.h"

#include <skiagraph/opencl.h>

#include <inttypes.h>

/* What every submission begins with. */
static skg_status begin(const char *call, skg_plan *plan, skg_job **job) {
    if (!plan) return skg_fail(SKG_ERR_ARGUMENT, "%s: the argument plan is NULL", call);
    if (!job) return skg_fail(SKG_ERR_ARGUMENT, "%s: the argument job is NULL", call);
    *job = NULL;
    return skg_context_enter(plan->context);
}

/* Checks a submission and takes over materials that have changed; then recipe and channels are the plan's. */
static skg_status prepare(skg_plan *plan, skg_submission *s, const skg_output *output) {
    s->recipe = plan->recipe;
    s->machine = &plan->machine;
    s->outcome = &plan->outcome;
    SKG_TRY(skg_submission_check(s, output));
    SKG_TRY(skg_plan_renew(plan));
    s->recipe = plan->recipe;
    return SKG_OK;
}

static skg_status submit(skg_plan *plan, const skg_submission *s, skg_job **job) {
    SKG_TRY(skg_submission_enqueue(s, job));
    skg_ref(&plan->refs);
    (*job)->plan = plan;
    return SKG_OK;
}

static skg_status submit_images(skg_plan *plan, int64_t count, const skg_frame *frames,
                                const skg_output *output, skg_job **job) {
    SKG_PLAIN;
    SKG_TRY(begin("skg_plan_submit", plan, job));
    skg_submission s = {.count = count, .frames = frames, .lengths_of = -1};
    SKG_TRY(prepare(plan, &s, output));
    return submit(plan, &s, job);
}

skg_status skg_plan_submit(skg_plan *plan, int64_t count, const skg_frame *frames, const skg_output *output,
                           skg_job **job) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(handler, submit_images(plan, count, frames, output, job));
}

static skg_status make_image(skg_plan *plan, const skg_output *output) {
    SKG_PLAIN;
    skg_job *job = NULL;
    SKG_TRY(begin("skg_plan_image", plan, &job));
    skg_submission s = {.count = 1, .lengths_of = -1};
    SKG_TRY(prepare(plan, &s, output));
    SKG_TRY(submit(plan, &s, &job));
    return skg_job_wait(&job);
}

skg_status skg_plan_image(skg_plan *plan, const skg_output *output) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(handler, make_image(plan, output));
}

static skg_status check_lengths(const char *call, const skg_plan *plan, int64_t part, int32_t kind) {
    const int64_t parts = plan->recipe->scene->count;
    if (part < 0 || part >= parts)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: part %" PRId64 " of %" PRId64, call, part, parts);
    if (kind != SKG_LENGTHS_NET && kind != SKG_LENGTHS_SURFACE)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "lengths of kind %" PRId32 " are unknown; SKG_LENGTHS_NET or SKG_LENGTHS_SURFACE",
                        kind);
    return SKG_OK;
}

static skg_status submit_lengths(skg_plan *plan, int64_t part, int32_t kind, int64_t count,
                                 const skg_frame *frames, const skg_output *output, skg_job **job) {
    SKG_PLAIN;
    SKG_TRY(begin("skg_plan_lengths", plan, job));
    SKG_TRY(skg_self_test_need(plan->context, SKG_SELF_TEST_LENGTHS));
    SKG_TRY(check_lengths("skg_plan_lengths", plan, part, kind));
    skg_submission s = {.count = count, .frames = frames, .lengths_of = part, .kind = kind};
    SKG_TRY(prepare(plan, &s, output));
    return submit(plan, &s, job);
}

skg_status skg_plan_lengths(skg_plan *plan, int64_t part, int32_t kind, int64_t count,
                            const skg_frame *frames, const skg_output *output, skg_job **job) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(handler, submit_lengths(plan, part, kind, count, frames, output, job));
}

/* --- into the caller's device memory */

/* Checks that the images fit the buffer, and fills in where they begin. */
static skg_status check_buffer(const char *call, skg_submission *s, int64_t offset) {
    const skg_output *output = &s->output;
    const int64_t element = skg_submission_element(s);
    int64_t bytes = 0;
    SKG_TRY(skg_caller_buffer_check(call, s->machine->context, s->buffer, &bytes));
    if (offset < 0 || offset % element)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "an offset of %" PRId64 " bytes is no multiple of an element's %" PRId64, offset,
                        element);
    s->first = offset / element;
    const int64_t last = (s->count - 1) * output->frame_stride + (s->channels - 1) * output->channel_stride +
                         (s->recipe->view.rows - 1) * output->row_stride + s->recipe->view.columns;
    if ((s->first + last) * element > bytes)
        return skg_fail(SKG_ERR_ARGUMENT, "the images end at byte %" PRId64 ", the buffer at %" PRId64,
                        (s->first + last) * element, bytes);
    return SKG_OK;
}

static skg_status submit_cl(const char *call, skg_plan *plan, skg_submission *s, const skg_output *output,
                            int64_t offset, const skg_caller_events *events, skg_job **job) {
    SKG_TRY(skg_caller_events_check(call, events));
    if (!s->buffer) return skg_fail(SKG_ERR_ARGUMENT, "%s: no buffer", call);
    SKG_TRY(prepare(plan, s, output));
    SKG_TRY(check_buffer(call, s, offset));
    SKG_TRY(skg_caller_events_wait(plan->context, events));
    SKG_TRY(submit(plan, s, job));
    if (events->done) {
        SKG_CL_TRY(clRetainEvent((*job)->last));
        *events->done = (*job)->last;
    }
    return SKG_OK;
}

static skg_status submit_images_cl(skg_plan *plan, int64_t count, const skg_frame *frames,
                                   const skg_output *output, cl_mem buffer, int64_t offset, int32_t waits,
                                   const cl_event *wait_list, cl_event *done, skg_job **job) {
    SKG_PLAIN;
    SKG_TRY(begin("skg_plan_submit_cl", plan, job));
    skg_submission s = {.count = count, .frames = frames, .lengths_of = -1, .buffer = buffer};
    const skg_caller_events given = {waits, wait_list, done};
    return submit_cl("skg_plan_submit_cl", plan, &s, output, offset, &given, job);
}

skg_status skg_plan_submit_cl(skg_plan *plan, int64_t count, const skg_frame *frames,
                              const skg_output *output, cl_mem buffer, int64_t offset, int32_t waits,
                              const cl_event *wait_list, cl_event *done, skg_job **job) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(
        handler, submit_images_cl(plan, count, frames, output, buffer, offset, waits, wait_list, done, job));
}

static skg_status submit_lengths_cl(skg_plan *plan, int64_t part, int32_t kind, int64_t count,
                                    const skg_frame *frames, const skg_output *output, cl_mem buffer,
                                    int64_t offset, const skg_caller_events *events, skg_job **job) {
    SKG_PLAIN;
    SKG_TRY(begin("skg_plan_lengths_cl", plan, job));
    SKG_TRY(skg_self_test_need(plan->context, SKG_SELF_TEST_LENGTHS));
    SKG_TRY(check_lengths("skg_plan_lengths_cl", plan, part, kind));
    skg_submission s = {.count = count, .frames = frames, .lengths_of = part, .kind = kind, .buffer = buffer};
    return submit_cl("skg_plan_lengths_cl", plan, &s, output, offset, events, job);
}

skg_status skg_plan_lengths_cl(skg_plan *plan, int64_t part, int32_t kind, int64_t count,
                               const skg_frame *frames, const skg_output *output, cl_mem buffer,
                               int64_t offset, int32_t waits, const cl_event *wait_list, cl_event *done,
                               skg_job **job) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    const skg_caller_events events = {waits, wait_list, done};
    return skg_call_end(
        handler, submit_lengths_cl(plan, part, kind, count, frames, output, buffer, offset, &events, job));
}
