/* What memory of a device holds, for the host to read. Private. */
#ifndef SKG_HOST_VIEW_H
#define SKG_HOST_VIEW_H

#include "device/device.h"

/* All zero: nothing is open. */
typedef struct {
    const void *bytes; /* NULL: it is not open */
    cl_mem mapped;     /* NULL: `copy` is shown */
    void *unmap;       /* the bytes of `mapped` */
    void *copy;        /* of a GPU's memory; kept for the next time */
    int64_t capacity;  /* of the copy, bytes */
} skg_host_view;

/* Opens `bytes` bytes of a buffer from byte `first` on, when all that was enqueued is done. The memory of a processor is the
 * host's: it is mapped, and nothing may be written to it until skg_host_view_close. what: for the message. */
skg_status skg_host_view_open(skg_context *context, cl_mem buffer, int64_t first, int64_t bytes,
                              const char *what, skg_host_view *view);

/* Does nothing if it is not open. */
skg_status skg_host_view_close(skg_context *context, skg_host_view *view);

/* Frees the memory of a view that is closed. */
void skg_host_view_release(skg_host_view *view);

#endif
