/* Views of device memory, for the host to read. Private. */
#ifndef SKG_HOST_VIEW_H
#define SKG_HOST_VIEW_H

#include "device/device.h"

/* All zero: it is not open. */
typedef struct {
    const void *bytes;
    void *mapped; /* the same */
    cl_mem buffer;
} skg_host_view;

/* Opens bytes of a buffer from byte `first` on, when all that was enqueued is done. They are mapped: the memory of a processor is
 * the host's, and is not copied. Nothing may be written to the buffer until skg_host_view_close. */
skg_status skg_host_view_open(skg_context *context, cl_mem buffer, int64_t first, int64_t bytes,
                              skg_host_view *view);

/* Does nothing if it is not open. */
void skg_host_view_close(skg_context *context, skg_host_view *view);

#endif
