/* A TIFF in memory, which libtiff reads or writes by functions. Private. */
#ifndef SKG_IMAGE_TIFF_BYTES_H
#define SKG_IMAGE_TIFF_BYTES_H

#include "image/reasons.h"

#include <skiagraph/error.h>

#include <tiffio.h>

/* Prepare with the name and, of one that is read, with `given` and `size`. */
typedef struct {
    const char *name;           /* for libtiff's reasons */
    const unsigned char *given; /* what is read; NULL: it is written */
    unsigned char *written;     /* the caller frees it */
    int64_t size, capacity, at;
    skg_status status; /* of the memory that is written to */
} skg_tiff_bytes;

/* Opens it; NULL: *kept says why not. mode: "rm", "w" or "w8". *bytes has to stay until the TIFF is closed. */
TIFF *skg_tiff_open_bytes(skg_tiff_bytes *bytes, const char *mode, skg_tiff_reason *kept);

#endif
