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
    atomic_fetch_add_explicit(&refs->owners, 1, memory_order_relaxed);
}

int skg_unref(skg_refs *refs) {
    return atomic_fetch_sub_explicit(&refs->owners, 1, memory_order_acq_rel) == 1;
}

void skg_struct_init(void *theirs, int32_t size, const void *defaults, size_t our_size) {
    if (!theirs || size < (int32_t)sizeof size) return;
    memset(theirs, 0, (size_t)size);
    memcpy(theirs, defaults, (size_t)size < our_size ? (size_t)size : our_size);
    memcpy(theirs, &size, sizeof size);
}

/* A size beyond this is memory that nobody prepared; a struct of a later version stays far below it. */
enum { LARGEST_STRUCT = 1 << 16 };

skg_status skg_struct_read(const void *theirs, const char *name, void *ours, size_t our_size) {
    int32_t their_size = 0;
    if (!theirs) return skg_fail(SKG_ERR_ARGUMENT, "%s is NULL; pass one prepared by %s_init", name, name);
    memcpy(&their_size, theirs, sizeof their_size);
    if (their_size < (int32_t)sizeof their_size || their_size > LARGEST_STRUCT)
        return skg_fail(SKG_ERR_ARGUMENT, "%s has size %" PRId32 "; prepare it with %s_init", name,
                        their_size, name);
    for (size_t i = our_size; i < (size_t)their_size; i++)
        if (((const unsigned char *)theirs)[i] != 0)
            return skg_fail(SKG_ERR_ARGUMENT,
                            "%s has size %" PRId32 " with fields that this version (size %zu) does not know; "
                            "leave them zero or use the newer library",
                            name, their_size, our_size);
    size_t shared = (size_t)their_size < our_size ? (size_t)their_size : our_size;
    memcpy(ours, theirs, shared);
    int32_t size = (int32_t)our_size;
    memcpy(ours, &size, sizeof size);
    return SKG_OK;
}

skg_status skg_struct_read_at(const void *array, int64_t index, const char *name, void *ours,
                              size_t our_size) {
    int32_t step = 0, size = 0;
    if (!array) return skg_struct_read(array, name, ours, our_size);
    memcpy(&step, array, sizeof step);
    const char *element = (const char *)array + index * step;
    memcpy(&size, element, sizeof size);
    if (size != step)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: element %" PRId64 " has size %" PRId32 ", the first %" PRId32
                        "; prepare every element with %s_init",
                        name, index, size, step, name);
    return skg_struct_read(element, name, ours, our_size);
}

skg_status skg_struct_write(const void *ours, size_t our_size, const char *name, void *theirs) {
    int32_t their_size = 0;
    if (!theirs) return skg_fail(SKG_ERR_ARGUMENT, "%s is NULL; pass one prepared by %s_init", name, name);
    memcpy(&their_size, theirs, sizeof their_size);
    if (their_size < (int32_t)sizeof their_size || their_size > LARGEST_STRUCT)
        return skg_fail(SKG_ERR_ARGUMENT, "%s has size %" PRId32 "; prepare it with %s_init", name,
                        their_size, name);
    size_t shared = (size_t)their_size < our_size ? (size_t)their_size : our_size;
    memcpy(theirs, ours, shared);
    memcpy(theirs, &their_size, sizeof their_size);
    return SKG_OK;
}
