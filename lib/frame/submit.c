/* The public calls that submit frames. */
#include "core/text.h"
#include "device/self_tests.h"
#include "frame/frames.h"

#include <skiagraph/opencl.h>

#include <inttypes.h>

skg_status skg_caller_events_check(const char *call, const skg_caller_events *events) {
    if (events->done) *events->done = NULL;
    if (events->waits < 0 || (events->waits > 0 && !events->wait_list))
        return skg_fail(SKG_ERR_ARGUMENT, "%s: %" PRId32 " events to wait for, but no list", call,
                        events->waits);
    return SKG_OK;
}

skg_status skg_caller_events_wait(skg_context *context, const skg_caller_events *events) {
    if (events->waits > 0)
        SKG_CL_TRY(clEnqueueBarrierWithWaitList(context->device->queue, (cl_uint)events->waits,
                                                events->wait_list, NULL));
    return SKG_OK;
}

/* The begin of every submission. */
static skg_status begin(const char *call, skg_plan *plan, skg_job **job) {
    SKG_NEEDS_OF(call, plan);
    SKG_NEEDS_OF(call, job);
    *job = NULL;
    SKG_TRY(skg_context_enter(plan->context));
    skg_submission_flush(plan->context);
    return SKG_OK;
}

/* The self-tests of what not every plan computes. Outputs that cannot be read are refused later. */
static skg_status test_outputs(const skg_plan *plan, int64_t count, const skg_output *outputs) {
    for (int64_t o = 0; outputs && o < count; o++) {
        skg_output output = {0};
        SKG_TRY(skg_struct_read_at(outputs, o, "skg_output", &output, sizeof output));
        if (output.kind == SKG_OUTPUT_LENGTHS)
            SKG_TRY(skg_self_test_need(plan->context, SKG_SELF_TEST_LENGTHS));
        if (output.kind == SKG_OUTPUT_VARIANCE)
            SKG_TRY(skg_self_test_need(plan->context, SKG_SELF_TEST_VARIANCE));
    }
    return SKG_OK;
}

/* The self-test of frames that are drawn together. */
static skg_status test_together(const skg_plan *plan, int64_t count, int64_t output_count,
                                const skg_output *outputs) {
    skg_output output = {0};
    if (output_count != 1 || !outputs) return SKG_OK;
    SKG_TRY(skg_struct_read(outputs, "skg_output", &output, sizeof output));
    const int32_t side = skg_together_side(plan->recipe, &plan->machine, count, &output);
    if (side == 0) return SKG_OK;
    return skg_self_test_need(plan->context, side > 1 ? SKG_SELF_TEST_SIDE : SKG_SELF_TEST_PASSES);
}

/* call: the name of the public function. events: NULL: none. */
static skg_status submit(const char *call, skg_plan *plan, int64_t count, const skg_frame *frames,
                         int64_t output_count, const skg_output *outputs, const skg_caller_events *events,
                         skg_job **job) {
    SKG_PLAIN;
    skg_job *made = NULL;
    SKG_TRY(begin(call, plan, job));
    SKG_TRY(test_outputs(plan, output_count, outputs));
    if (events) SKG_TRY(skg_caller_events_check(call, events));
    SKG_TRY(skg_plan_renew(plan));
    SKG_TRY(test_together(plan, count, output_count, outputs));
    SKG_TRY(skg_job_create(call, &skg_job_images, plan->recipe, &plan->machine, &plan->outcome, count,
                           output_count, outputs, &made));
    made->scatterer = &plan->scatterer;
    if (events) {
        const skg_status status = skg_caller_events_wait(plan->context, events);
        if (status != SKG_OK) skg_job_end(&made);
        SKG_TRY(status);
    }
    SKG_TRY(skg_submit_frames(&made, frames, events != NULL));
    skg_ref(&plan->refs);
    made->plan = plan;
    *job = made;
    if (events && events->done) {
        SKG_CL_TRY(clRetainEvent(made->last));
        *events->done = made->last;
    }
    return SKG_OK;
}

skg_status skg_plan_submit(skg_plan *plan, int64_t count, const skg_frame *frames, int64_t output_count,
                           const skg_output *outputs, skg_job **job) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(
        begun, skg_feeder_start(
                   submit("skg_plan_submit", plan, count, frames, output_count, outputs, NULL, job), job));
}

skg_status skg_plan_submit_cl(skg_plan *plan, int64_t count, const skg_frame *frames, int64_t output_count,
                              const skg_output *outputs, int32_t waits, const cl_event *wait_list,
                              cl_event *done, skg_job **job) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    const skg_caller_events events = {waits, wait_list, done};
    return skg_call_end(
        begun, submit("skg_plan_submit_cl", plan, count, frames, output_count, outputs, &events, job));
}

skg_status skg_plan_image(skg_plan *plan, const skg_output *output) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    skg_job *job = NULL;
    skg_status status = submit("skg_plan_image", plan, 1, NULL, 1, output, NULL, &job);
    if (status == SKG_OK) status = skg_job_wait(&job);
    return skg_call_end(begun, status);
}
