/* OpenCL objects of the caller: events and buffers, checked. */
#include "frame/given.h"

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

skg_status skg_caller_buffer_check(const char *call, const skg_context *context, cl_mem buffer,
                                   int64_t *bytes) {
    cl_context of = NULL;
    size_t size = 0;
    if (!buffer) return skg_fail(SKG_ERR_ARGUMENT, "%s: no buffer", call);
    SKG_CL_TRY(clGetMemObjectInfo(buffer, CL_MEM_CONTEXT, sizeof of, &of, NULL));
    if (of != context->device->cl)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: the buffer is another OpenCL context's; make it in that of the plan "
                        "(skg_context_create_cl)",
                        call);
    SKG_CL_TRY(clGetMemObjectInfo(buffer, CL_MEM_SIZE, sizeof size, &size, NULL));
    *bytes = (int64_t)size;
    return SKG_OK;
}
