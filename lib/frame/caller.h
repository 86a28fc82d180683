/* OpenCL objects of the caller. Private. */
#ifndef SKG_CALLER_H
#define SKG_CALLER_H

#include "device/device.h"

/* The events that a call is given, and where the caller wants one of its own. */
typedef struct {
    int32_t waits;
    const cl_event *wait_list; /* [waits] */
    cl_event *done;            /* may be NULL */
} skg_caller_events;

/* Sets *done to NULL, and checks the list. call: the name of the function, for the message. */
skg_status skg_caller_events_check(const char *call, const skg_caller_events *events);

/* Enqueues that the caller's events are waited for. */
skg_status skg_caller_events_wait(skg_context *context, const skg_caller_events *events);

/* Checks that a buffer is of the context's, and gets its size. */
skg_status skg_caller_buffer_check(const char *call, const skg_context *context, cl_mem buffer,
                                   int64_t *bytes);

#endif
