/* Calls that need kernels which not every plan needs: these are tested first. */
#include "core/plain.h"
#include "device/device.h"
#include "frame/plan.h"
#include "show/picture.h"
#include "trial/trial.h"

#include <skiagraph/opencl.h>

/* A plan that is NULL is refused by the call itself. */
static skg_status need(const skg_plan *plan, skg_trial_number number) {
    if (!plan) return SKG_OK;
    SKG_TRY(skg_context_enter(plan->context));
    return skg_trial_need(plan->context, number);
}

/* Outputs that cannot be read are refused by the call itself. */
static skg_status need_outputs(const skg_plan *plan, int64_t count, const skg_output *outputs) {
    for (int64_t o = 0; outputs && o < count; o++) {
        skg_output output = {0};
        SKG_TRY(skg_struct_read_at(outputs, o, "skg_output", &output, sizeof output));
        if (output.kind == SKG_OUTPUT_LENGTHS) SKG_TRY(need(plan, SKG_TRIAL_LENGTHS));
    }
    return SKG_OK;
}

static skg_status submit(const char *call, skg_plan *plan, int64_t count, const skg_frame *frames,
                         int64_t output_count, const skg_output *outputs, const skg_caller_events *events,
                         skg_job **job) {
    SKG_PLAIN;
    SKG_TRY(need_outputs(plan, output_count, outputs));
    return skg_plan_enqueue(call, plan, count, frames, output_count, outputs, events, job);
}

skg_status skg_plan_submit(skg_plan *plan, int64_t count, const skg_frame *frames, const skg_output *output,
                           skg_job **job) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(handler, submit("skg_plan_submit", plan, count, frames, 1, output, NULL, job));
}

skg_status skg_plan_outputs_submit(skg_plan *plan, int64_t count, const skg_frame *frames,
                                   int64_t output_count, const skg_output *outputs, skg_job **job) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(
        handler, submit("skg_plan_outputs_submit", plan, count, frames, output_count, outputs, NULL, job));
}

skg_status skg_plan_submit_cl(skg_plan *plan, int64_t count, const skg_frame *frames, int64_t output_count,
                              const skg_output *outputs, int32_t waits, const cl_event *wait_list,
                              cl_event *done, skg_job **job) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    const skg_caller_events events = {waits, wait_list, done};
    return skg_call_end(
        handler, submit("skg_plan_submit_cl", plan, count, frames, output_count, outputs, &events, job));
}

static skg_status make_image(skg_plan *plan, const skg_output *output) {
    skg_job *job = NULL;
    SKG_TRY(submit("skg_plan_image", plan, 1, NULL, 1, output, NULL, &job));
    return skg_job_wait(&job);
}

skg_status skg_plan_image(skg_plan *plan, const skg_output *output) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(handler, make_image(plan, output));
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
