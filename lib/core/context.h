/* The part of a context that every room may use: its life, its log, and its device by name only. Private. */
#ifndef SKG_CONTEXT_PRIVATE_H
#define SKG_CONTEXT_PRIVATE_H

#include "core/core.h"
#include "core/log.h"
#include "core/mailbox.h"

#include <skiagraph/context.h>

struct skg_device; /* defined in lib/device */

/* Who hears of failures. All zero: nobody. */
typedef struct {
    skg_error_function call;
    void *user;
} skg_error_handler;

struct skg_context {
    skg_refs refs;
    int64_t process; /* that made it: any other one is a child after fork */
    skg_logger log;
    skg_error_handler error;
    skg_mailbox *driver; /* what the OpenCL driver's threads have said */
    struct skg_device *device;
    struct skg_job *held; /* the job some of whose frames are not enqueued yet (lib/frame); NULL: none */
};

/* To be called first by every public call that uses a context: SKG_ERR_ARGUMENT for NULL, SKG_ERR_FORK in a child
 * process. What the driver has said since the last call is logged here, so that the log is called by the thread
 * that uses the context and by no other. */
skg_status skg_context_enter(const skg_context *context);

/* The beginning and the end of a public call whose failures the handler of a context hears of; context may be NULL. Of
 * public calls within public calls, the outermost is heard of. The context may be freed meanwhile. The end returns status. */
skg_error_handler skg_call_begin(const skg_context *context);
skg_status skg_call_end(skg_error_handler handler, skg_status status);

#endif
