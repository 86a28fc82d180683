/* The lists by which planes are mixed, on the device. */
#include "stage/tables.h"

#include "stage/kernels.h"

#include <string.h>

static skg_status enqueue(skg_mix_lists *lists, const double *numbers, int64_t count, int32_t is_double,
                          skg_staging *staging) {
    const size_t size = is_double ? sizeof(double) : sizeof(float);
    const int64_t bytes = count * (int64_t)size;
    void *staged = NULL;
    SKG_TRY(skg_staging_take(staging, count, size, "planes", &staged));
    for (int64_t i = 0; i < count; i++)
        if (is_double)
            ((double *)staged)[i] = numbers[i];
        else
            ((float *)staged)[i] = (float)numbers[i];
    SKG_TRY(skg_buffer_reserve(staging->context, &lists->memory, bytes, CL_MEM_READ_ONLY, "planes"));
    return skg_stage_write(staging->context, "upload", lists->memory.memory, 0, bytes, staged, &staging->log);
}

skg_status skg_mix_lists_send(skg_mix_lists *lists, const double *numbers, int64_t count, int32_t is_double,
                              skg_staging *staging) {
    const size_t bytes = (size_t)count * sizeof *numbers;
    if (lists->sent && lists->count == count && memcmp(lists->sent, numbers, bytes) == 0) return SKG_OK;
    if (lists->count != count) skg_free(&lists->sent);
    lists->count = 0; /* until the device has the new ones */
    if (!lists->sent) SKG_TRY(skg_alloc(count, sizeof *lists->sent, "planes of the parts", &lists->sent));
    SKG_TRY(enqueue(lists, numbers, count, is_double, staging));
    memcpy(lists->sent, numbers, bytes);
    lists->count = count;
    return SKG_OK;
}

void skg_mix_lists_release(skg_mix_lists *lists) {
    skg_buffer_release(&lists->memory);
    skg_free(&lists->sent);
    lists->count = 0;
}
