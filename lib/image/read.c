/* Functions that the readers of image files share. */
#include "image/image.h"

#include <inttypes.h>
#include <string.h>

double skg_number_of_bytes(const void *at, int bytes, char kind, int swapped) {
    unsigned char own[8];
    uint64_t whole = 0;
    SKG_ASSERT(1 <= bytes && bytes <= (int)sizeof own);
    for (int k = 0; k < bytes; k++) own[k] = ((const unsigned char *)at)[swapped ? bytes - 1 - k : k];
    if (kind == 'f' && bytes == 4) {
        float value;
        memcpy(&value, own, sizeof value);
        return (double)value;
    }
    if (kind == 'f') {
        double value;
        memcpy(&value, own, sizeof value);
        return value;
    }
    for (int k = 0; k < bytes; k++) whole = whole << 8 | own[skg_host_is_big_endian() ? k : bytes - 1 - k];
    if (kind == 'u') return (double)whole;
    const uint64_t sign = UINT64_C(1) << (8 * bytes - 1);
    return whole & sign ? -(double)((~whole + 1) & ((sign << 1) - 1)) : (double)whole;
}

skg_status skg_image_open(const skg_image_source *source, FILE **stream) {
    if (!source->bytes) return skg_input_open(source->name, SKG_INPUT_LARGE, stream, NULL);
    /* fmemopen has one function for reading and writing; "rb" does not write. */
    *stream = fmemopen((void *)(uintptr_t)source->bytes, (size_t)source->size, "rb");
    return *stream ? SKG_OK : skg_fail(SKG_ERR_MEMORY, "%s: out of host memory", source->name);
}

skg_status skg_image_put(const skg_image_target *target, const void *bytes, int64_t size) {
    SKG_ASSERT(size >= 0);
    *target->size = size;
    if (!target->bytes) return SKG_OK;
    if (size > target->capacity)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: has %" PRId64 " bytes, and there is memory for %" PRId64
                        "; the call says how many in size",
                        target->name, size, target->capacity);
    memcpy(target->bytes, bytes, (size_t)size);
    return SKG_OK;
}

int32_t skg_quantity_of_title(const char *title) {
    /* As skg_quantity_get, of a room above, has names and units; a test compares them. */
    static const char *const titles[] = {"energy (keV per pixel)", "fluence (keV/mm2)",
                                         "photons (photons per pixel)", "transmission (I/I0)",
                                         "attenuation (-ln(I/I0))"};
    for (int32_t q = 0; q < (int32_t)(sizeof titles / sizeof *titles); q++)
        if (!strncmp(title, titles[q], strlen(titles[q]))) return q;
    return -1;
}

skg_status skg_picture_size_check(const char *path, double columns, double rows, double pages) {
    enum { MOST = 32768 };
    if (columns >= 1 && rows >= 1 && pages >= 1 && columns <= MOST && rows <= MOST && pages <= 1e7)
        return SKG_OK;
    return skg_fail(SKG_ERR_FORMAT,
                    "%s: %.0f x %.0f pixels and %.0f pages; from 1 to %d pixels along each side can be read",
                    path, columns, rows, pages, MOST);
}

skg_status skg_picture_page_check(const char *path, int64_t page, int64_t pages) {
    if (page >= 0 && page < pages) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT,
                    "%s: there is no page %" PRId64 "; the file has %" PRId64 ", counted from 0", path, page,
                    pages);
}
