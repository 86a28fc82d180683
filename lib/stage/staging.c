/* Staging for work under way: host memory that the device reads or writes, and the log of the stages. */
#include "stage/staging.h"

#include <string.h>

struct skg_staged {
    struct skg_staged *next;
    void *bytes;
};

skg_status skg_staging_take(skg_staging *staging, int64_t count, size_t size, const char *what,
                            void *pointer_address) {
    struct skg_staged *block = NULL;
    SKG_TRY(skg_alloc(1, sizeof *block, what, &block));
    const skg_status status = skg_alloc(count, size, what, &block->bytes);
    if (status != SKG_OK) {
        skg_free(&block);
        return status;
    }
    block->next = staging->first;
    staging->first = block;
    memcpy(pointer_address, &block->bytes, sizeof block->bytes);
    return SKG_OK;
}

skg_status skg_staging_write(skg_staging *staging, skg_buffer *buffer, int64_t bytes, const void *staged,
                             const char *what) {
    SKG_ASSERT(bytes >= 0 && staged);
    SKG_TRY(skg_buffer_reserve(staging->context, buffer, bytes, CL_MEM_READ_ONLY, what));
    SKG_CL_TRY(clEnqueueWriteBuffer(staging->context->device->queue, buffer->memory, CL_FALSE, 0,
                                    (size_t)bytes, staged, 0, NULL, NULL));
    return SKG_OK;
}

skg_status skg_staging_read(skg_staging *staging, cl_mem buffer, int64_t bytes, void *staged) {
    SKG_ASSERT(bytes >= 0 && staged);
    SKG_CL_TRY(clEnqueueReadBuffer(staging->context->device->queue, buffer, CL_FALSE, 0, (size_t)bytes,
                                   staged, 0, NULL, NULL));
    return SKG_OK;
}

void skg_staging_release(skg_staging *staging) {
    skg_stage_log_clear(&staging->log);
    while (staging->first) {
        struct skg_staged *block = staging->first;
        staging->first = block->next;
        skg_free(&block->bytes);
        skg_free(&block);
    }
}
