/* Memory of the host: allocated with a sentence if there is none. */
#include "core/allocator.h"
#include "core/core.h"

#include <inttypes.h>
#include <string.h>

/* A caller's pointer has a type of its own, so that an access through void ** would be undefined (and link-time
 * optimisation relies on that). Its bytes may be copied. */
static void *load_pointer(const void *pointer_address) {
    void *pointer;
    memcpy(&pointer, pointer_address, sizeof pointer);
    return pointer;
}

static void store_pointer(void *pointer_address, void *pointer) {
    memcpy(pointer_address, &pointer, sizeof pointer);
}

static skg_status check_bytes(int64_t count, size_t size, const char *what) {
    if (count < 0 || (count > 0 && (uint64_t)count > (uint64_t)PTRDIFF_MAX / size))
        return skg_fail(SKG_ERR_MEMORY, "%s: %" PRId64 " items of %zu bytes are more than memory can hold",
                        what, count, size);
    return SKG_OK;
}

static skg_status no_memory(int64_t count, size_t size, const char *what) {
    return skg_fail(SKG_ERR_MEMORY, "%s: no memory for %" PRId64 " items of %zu bytes", what, count, size);
}

skg_status skg_alloc(int64_t count, size_t size, const char *what, void *pointer_address) {
    store_pointer(pointer_address, NULL);
    SKG_TRY(check_bytes(count, size, what));
    void *made = skg_block_make(count > 0 ? (size_t)count : 1, size);
    if (!made) return no_memory(count, size, what);
    store_pointer(pointer_address, made);
    return SKG_OK;
}

skg_status skg_realloc(int64_t count, size_t size, const char *what, void *pointer_address) {
    SKG_TRY(check_bytes(count, size, what));
    void *grown = skg_block_resize(load_pointer(pointer_address), count > 0 ? (size_t)count * size : 1);
    if (!grown) return no_memory(count, size, what);
    store_pointer(pointer_address, grown);
    return SKG_OK;
}

void skg_free(void *pointer_address) {
    skg_block_drop(load_pointer(pointer_address));
    store_pointer(pointer_address, NULL);
}

skg_status skg_copy_text(const char *text, char **copy) {
    *copy = NULL;
    if (!text) return SKG_OK;
    SKG_TRY(skg_alloc((int64_t)strlen(text) + 1, 1, "text", copy));
    strcpy(*copy, text);
    return SKG_OK;
}

void skg_refs_init(skg_refs *refs) {
    atomic_init(&refs->owners, 1);
}

void skg_ref(skg_refs *refs) {
    const int before = atomic_fetch_add_explicit(&refs->owners, 1, memory_order_relaxed);
    SKG_ASSERT(before > 0);
    (void)before;
}

int skg_unref(skg_refs *refs) {
    const int before = atomic_fetch_sub_explicit(&refs->owners, 1, memory_order_acq_rel);
    SKG_ASSERT(before > 0);
    return before == 1;
}
