/* Calls that need kernels which not every plan needs: these are tested first. */
#include "core/plain.h"
#include "device/device.h"
#include "frame/plan.h"
#include "selftest/trial.h"
#include "show/picture.h"

#include <skiagraph/opencl.h>

/* A plan that is NULL is refused by the call itself. */
static skg_status need(const skg_plan *plan, skg_trial_number number) {
    if (!plan) return SKG_OK;
    SKG_TRY(skg_context_enter(plan->context));
    return skg_trial_need(plan->context, number);
}

static skg_status lengths(skg_plan *plan, int64_t part, int32_t kind, int64_t count, const skg_frame *frames,
                          const skg_output *output, skg_job **job) {
    SKG_PLAIN;
    SKG_TRY(need(plan, SKG_TRIAL_LENGTHS));
    return skg_plan_lengths_enqueue(plan, part, kind, count, frames, output, job);
}

skg_status skg_plan_lengths(skg_plan *plan, int64_t part, int32_t kind, int64_t count,
                            const skg_frame *frames, const skg_output *output, skg_job **job) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(handler, lengths(plan, part, kind, count, frames, output, job));
}

static skg_status lengths_cl(skg_plan *plan, int64_t part, int32_t kind, int64_t count,
                             const skg_frame *frames, const skg_output *output, cl_mem buffer, int64_t offset,
                             const skg_caller_events *events, skg_job **job) {
    SKG_PLAIN;
    SKG_TRY(need(plan, SKG_TRIAL_LENGTHS));
    return skg_plan_lengths_enqueue_cl(plan, part, kind, count, frames, output, buffer, offset, events, job);
}

skg_status skg_plan_lengths_cl(skg_plan *plan, int64_t part, int32_t kind, int64_t count,
                               const skg_frame *frames, const skg_output *output, cl_mem buffer,
                               int64_t offset, int32_t waits, const cl_event *wait_list, cl_event *done,
                               skg_job **job) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    const skg_caller_events events = {waits, wait_list, done};
    return skg_call_end(handler,
                        lengths_cl(plan, part, kind, count, frames, output, buffer, offset, &events, job));
}

static skg_status positions(skg_plan *plan, int64_t part, cl_mem buffer, int64_t offset, const float *lowest,
                            const float *highest, const skg_caller_events *events) {
    SKG_PLAIN;
    SKG_TRY(need(plan, SKG_TRIAL_PLACE));
    return skg_plan_positions_enqueue(plan, part, buffer, offset, lowest, highest, events);
}

skg_status skg_plan_positions_set_cl(skg_plan *plan, int64_t part, cl_mem buffer, int64_t offset,
                                     const float *lowest, const float *highest, int32_t waits,
                                     const cl_event *wait_list, cl_event *done) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    const skg_caller_events events = {waits, wait_list, done};
    return skg_call_end(handler, positions(plan, part, buffer, offset, lowest, highest, &events));
}

skg_status skg_view_picture(skg_context *context, const skg_scene *scene, const skg_view *view,
                            const skg_look *look, uint8_t *rgba) {
    SKG_PLAIN;
    SKG_TRY(skg_context_enter(context));
    SKG_TRY(skg_trial_need(context, SKG_TRIAL_PICTURE));
    return skg_show_picture(context, scene, view, look, rgba);
}
