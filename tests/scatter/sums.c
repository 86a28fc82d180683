/* Reads the sums of the last frame before they are smoothed: by batch, kind and place. */
#include "sums.h"

#include "frame/plans.h"

_Static_assert((int)SUMS_BATCHES == (int)SKG_SCATTER_BATCHES && SUMS_KINDS == SKG_SCATTER_KINDS &&
                   SUMS_PLANES == SKG_SCATTER_PLANES,
               "the library's numbers");

skg_status sums_read(skg_context *context, const skg_plan *plan, int64_t *sums) {
    return skg_trace_read(context, &plan->scatterer.tracing, sums);
}

skg_status staged_read(skg_context *context, const skg_plan *plan, int64_t count, float *means) {
    SKG_CL_TRY(clEnqueueReadBuffer(context->device->queue, plan->scatterer.images.mean.memory, CL_TRUE, 0,
                                   (size_t)count * sizeof *means, means, 0, NULL, NULL));
    return SKG_OK;
}
