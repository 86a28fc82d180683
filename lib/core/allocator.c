/* Host memory from the allocator of the process. */
#include "core/allocator.h"
#include "core/core.h"

#include <skiagraph/memory.h>

#include <inttypes.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static skg_allocator hooks; /* without functions: the C library's */
static atomic_llong live;

void skg_allocator_init_sized(void *allocator, int32_t size) {
    const skg_allocator defaults = {0};
    skg_struct_init(allocator, size, &defaults, sizeof defaults);
}

skg_status skg_allocator_set(const skg_allocator *allocator) {
    skg_allocator ours = {0};
    const int64_t blocks = atomic_load(&live);
    if (allocator) SKG_TRY(skg_struct_read(allocator, "skg_allocator", &ours, sizeof ours));
    const int given = (ours.allocate != NULL) + (ours.reallocate != NULL) + (ours.release != NULL);
    if (given != 0 && given != 3)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "skg_allocator: set allocate, reallocate and release, or none of them");
    if (blocks > 0)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "skg_allocator_set: the library has %" PRId64
                        " pieces of memory from the present allocator; release all handles first",
                        blocks);
    hooks = ours;
    return SKG_OK;
}

skg_status skg_allocation_count(int64_t *count) {
    SKG_NEEDS(count);
    *count = atomic_load(&live);
    return SKG_OK;
}

void *skg_block_make(size_t count, size_t size) {
    void *made = hooks.allocate ? hooks.allocate((int64_t)(count * size), hooks.user) : calloc(count, size);
    if (!made) return NULL;
    if (hooks.allocate) memset(made, 0, count * size);
    atomic_fetch_add_explicit(&live, 1, memory_order_relaxed);
    return made;
}

void *skg_block_resize(void *block, size_t bytes) {
    void *resized =
        hooks.reallocate ? hooks.reallocate(block, (int64_t)bytes, hooks.user) : realloc(block, bytes);
    if (resized && !block) atomic_fetch_add_explicit(&live, 1, memory_order_relaxed);
    return resized;
}

void skg_block_drop(void *block) {
    if (!block) return;
    atomic_fetch_sub_explicit(&live, 1, memory_order_relaxed);
    if (hooks.release)
        hooks.release(block, hooks.user);
    else
        free(block);
}
