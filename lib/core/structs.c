/* Structs of callers, whose size may be that of another version. */
#include "core/core.h"

#include <inttypes.h>
#include <string.h>

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
