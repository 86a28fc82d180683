/* Takes positions of vertices from the caller's device memory. */
#include "core/text.h"
#include "device/self_tests.h"
#include "frame/jobs.h"

#include <skiagraph/opencl.h>

#include <inttypes.h>
#include <math.h>

static const char CALL[] = "skg_plan_positions_set_cl";

static skg_status check_part(const skg_plan *plan, int64_t part) {
    const skg_recipe *recipe = plan->recipe;
    const skg_scene *scene = recipe->scene;
    if (scene->structure != recipe->structure)
        return skg_fail(
            SKG_STALE,
            "parts of the scene were added or put elsewhere since the plan was made; make a new plan");
    if (part < 0 || part >= scene->count)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: part %" PRId64 " of %" PRId64, CALL, part, scene->count);
    if (!scene->parts[part].mesh->closed && recipe->options.repair == SKG_REPAIR_EXACT)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "part %s: its mesh is leaky, and SKG_REPAIR_EXACT traces rays through the positions "
                        "on the host; plan with SKG_REPAIR_NEIGHBOURS",
                        scene->parts[part].label);
    return SKG_OK;
}

static skg_status check_bounds(const float *lowest, const float *highest, skg_place_source *source) {
    if (!lowest || !highest) return skg_fail(SKG_ERR_ARGUMENT, "%s: the bounds are NULL", CALL);
    for (int k = 0; k < 3; k++) {
        if (!isfinite(lowest[k]) || !isfinite(highest[k]) || lowest[k] > highest[k])
            return skg_fail(SKG_ERR_ARGUMENT, "%s: the bounds along %c are %g to %g mm", CALL, "xyz"[k],
                            (double)lowest[k], (double)highest[k]);
        source->lowest[k] = lowest[k];
        source->highest[k] = highest[k];
    }
    return SKG_OK;
}

static skg_status check_memory(const skg_plan *plan, const skg_mesh *mesh, int64_t offset,
                               skg_place_source *source) {
    const int64_t element = sizeof(float), needed = 3 * mesh->vertices * element;
    int64_t bytes = 0;
    SKG_TRY(skg_caller_buffer_check(CALL, plan->context, source->memory, &bytes));
    if (offset < 0 || offset % element)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: an offset of %" PRId64 " bytes is no multiple of a float's %" PRId64, CALL,
                        offset, element);
    if (offset > bytes || needed > bytes - offset)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: %" PRId64 " vertices need %" PRId64 " bytes from byte %" PRId64
                        " on, and the buffer has %" PRId64,
                        CALL, mesh->vertices, needed, offset, bytes);
    source->first = offset / element;
    return SKG_OK;
}

static skg_status set_positions(skg_plan *plan, int64_t part, cl_mem buffer, int64_t offset,
                                const float *lowest, const float *highest, const skg_caller_events *events) {
    SKG_PLAIN;
    skg_place_source source = {.memory = buffer};
    SKG_NEEDS_OF(CALL, plan);
    SKG_TRY(skg_context_enter(plan->context));
    SKG_TRY(skg_self_test_need(plan->context, SKG_SELF_TEST_PLACE));
    skg_submission_flush(plan->context);
    SKG_TRY(skg_caller_events_check(CALL, events));
    SKG_TRY(check_part(plan, part));
    SKG_TRY(check_bounds(lowest, highest, &source));
    const skg_mesh *mesh = plan->recipe->scene->parts[part].mesh;
    if (plan->recipe->scene->parts[part].volume)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: %s is a volume of cells; move it by its pose", CALL,
                        plan->recipe->scene->parts[part].label);
    SKG_TRY(check_memory(plan, mesh, offset, &source));
    SKG_TRY(skg_caller_events_wait(plan->context, events));
    SKG_TRY(skg_placement_place(&plan->machine.placement, plan->context, &plan->machine.geometry, mesh,
                                plan->recipe->meshes.of_part[part], &source));
    cl_command_queue queue = plan->context->device->queue;
    if (events->done) SKG_CL_TRY(clEnqueueMarkerWithWaitList(queue, 0, NULL, events->done));
    return skg_queue_flush(plan->context);
}

skg_status skg_plan_positions_set_cl(skg_plan *plan, int64_t part, cl_mem buffer, int64_t offset,
                                     const float *lowest, const float *highest, int32_t waits,
                                     const cl_event *wait_list, cl_event *done) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    const skg_caller_events events = {waits, wait_list, done};
    return skg_call_end(begun, set_positions(plan, part, buffer, offset, lowest, highest, &events));
}
