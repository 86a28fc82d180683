/* The part of a context that every room may use: its life, its log, and its device by name only. Private. */
#ifndef SKG_CONTEXT_PRIVATE_H
#define SKG_CONTEXT_PRIVATE_H

#include "core/core.h"
#include "core/log.h"
#include "core/mailbox.h"

#include <skiagraph/context.h>

struct skg_device; /* defined in lib/device */

struct skg_context {
    skg_refs refs;
    int64_t process; /* that made it: any other one is a child after fork */
    skg_logger log;
    skg_mailbox *driver; /* what the OpenCL driver's threads have said */
    struct skg_device *device;
};

/* To be called first by every public call that uses a context: SKG_ERR_ARGUMENT for NULL, SKG_ERR_FORK in a child
 * process. What the driver has said since the last call is logged here, so that the log is called by the thread
 * that uses the context and by no other. */
skg_status skg_context_enter(const skg_context *context);

#endif
