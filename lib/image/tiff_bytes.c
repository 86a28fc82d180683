/* Reads and writes memory for libtiff. */
#include "image/tiff_bytes.h"

#include "core/core.h"

#include <string.h>

static tmsize_t read_bytes(thandle_t of, void *to, tmsize_t count) {
    skg_tiff_bytes *bytes = of;
    const unsigned char *from = bytes->given ? bytes->given : bytes->written;
    const int64_t left = bytes->size - bytes->at;
    const int64_t taken = left < 0 ? 0 : left < count ? left : count;
    if (taken > 0) memcpy(to, from + bytes->at, (size_t)taken);
    bytes->at += taken;
    return taken;
}

/* Grows by doubling, and fills with zeros what a seek passed over. */
static int reserve(skg_tiff_bytes *bytes, int64_t size) {
    if (size > bytes->capacity) {
        const int64_t capacity = size > INT64_MAX / 2 ? size : 2 * size;
        if (bytes->status == SKG_OK) bytes->status = skg_realloc(capacity, 1, "TIFF", &bytes->written);
        if (bytes->status != SKG_OK) return 0;
        bytes->capacity = capacity;
    }
    if (bytes->at > bytes->size) memset(bytes->written + bytes->size, 0, (size_t)(bytes->at - bytes->size));
    if (size > bytes->size) bytes->size = size;
    return 1;
}

static tmsize_t write_bytes(thandle_t of, void *from, tmsize_t count) {
    skg_tiff_bytes *bytes = of;
    if (bytes->given || count < 0 || count > INT64_MAX - bytes->at || !reserve(bytes, bytes->at + count))
        return -1;
    memcpy(bytes->written + bytes->at, from, (size_t)count);
    bytes->at += count;
    return count;
}

static toff_t seek_bytes(thandle_t of, toff_t offset, int whence) {
    skg_tiff_bytes *bytes = of;
    const int64_t from = whence == SEEK_CUR ? bytes->at : whence == SEEK_END ? bytes->size : 0;
    if (offset > (toff_t)(INT64_MAX - from)) return (toff_t)-1;
    bytes->at = from + (int64_t)offset;
    return (toff_t)bytes->at;
}

static int close_bytes(thandle_t of) {
    (void)of;
    return 0;
}

static toff_t size_of_bytes(thandle_t of) {
    return (toff_t)((const skg_tiff_bytes *)of)->size;
}

TIFF *skg_tiff_open_bytes(skg_tiff_bytes *bytes, const char *mode, skg_tiff_reason *kept) {
    TIFFOpenOptions *options = skg_tiff_options(kept);
    if (!options) return NULL;
    TIFF *tiff = TIFFClientOpenExt(bytes->name, mode, bytes, read_bytes, write_bytes, seek_bytes, close_bytes,
                                   size_of_bytes, NULL, NULL, options);
    TIFFOpenOptionsFree(options);
    return tiff;
}
