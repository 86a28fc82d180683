/* The part of a context that every room may use: its life, where warnings go, and its device by name only.
 * Private. */
#ifndef SKG_CONTEXT_PRIVATE_H
#define SKG_CONTEXT_PRIVATE_H

#include "core/core.h"

#include <skiagraph/context.h>

struct skg_device; /* lib/device's */

struct skg_context {
    skg_refs refs;
    int64_t process; /* that made it: another one is a child after fork */
    skg_log_function log;
    void *log_user;
    struct skg_device *device;
};

/* One warning or note, formatted; dropped where context is NULL or has no log. */
void skg_log(skg_context *context, int32_t level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* To be called first by every public call that uses a context: SKG_ERR_ARGUMENT for NULL, SKG_ERR_FORK in a
 * child. */
skg_status skg_context_enter(const skg_context *context);

#endif
