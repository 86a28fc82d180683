/* The part of a context that every room may use: its life, its log, and its device by name only. Private. */
#ifndef SKG_CONTEXT_PRIVATE_H
#define SKG_CONTEXT_PRIVATE_H

#include "core/core.h"
#include "core/log.h"
#include "core/threads.h"

#include <skiagraph/context.h>

#include <stdatomic.h>

struct skg_device; /* defined in lib/device */

/* The function that receives failures (skg_context_error_set). All zero: none. */
typedef struct {
    skg_error_function call;
    void *user;
} skg_error_handler;

struct skg_context {
    skg_refs refs;
    int64_t process; /* that made it: any other one is a child after fork */
    skg_logger log;
    skg_error_handler error;
    skg_mailbox *driver; /* messages of the OpenCL driver's threads, and of the library's own */
    skg_turn *turn;
    skg_pool *jobs; /* whose handles another thread may cancel when they are over */
    struct skg_device *device;
    atomic_int interrupted; /* 1: what a plan computes while it is made is to end */
    struct skg_job *held;   /* the job some of whose frames are not enqueued yet (lib/frame); NULL: none */
};

/* To be called first by every public call that uses a context: SKG_ERR_ARGUMENT for NULL, SKG_ERR_FORK in a child
 * process. It logs the driver's messages since the last call, so that only the thread that uses the context calls the
 * log. */
skg_status skg_context_enter(const skg_context *context);

/* A public call that has begun. */
typedef struct {
    skg_error_handler error;
    skg_turn *turn; /* retained and taken */
} skg_call;

/* Bracket a public call, so that it has its turn on the context, and its failure is reported to the context's error handler:
 *
 *     const skg_call begun = skg_call_begin(context);
 *     return skg_call_end(begun, do_the_work(context));
 *
 * skg_call_end calls the handler if status is a failure, and returns status. If a public call makes other public calls, only the
 * outermost one reports, so that a failure is reported once. skg_call_begin copies the handler, because the call in between may
 * free the context. context: NULL has neither handler nor turn. */
skg_call skg_call_begin(const skg_context *context);
skg_status skg_call_end(skg_call begun, skg_status status);

#endif
