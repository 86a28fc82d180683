/* Calls of the functions that take a context, a plan or a job, with nothing else. handlers.cmake writes them. */
#ifndef HANDLERS_H
#define HANDLERS_H

#include <skiagraph/breathing.h>
#include <skiagraph/live.h>
#include <skiagraph/opencl.h>
#include <skiagraph/registration.h>
#include <skiagraph/scanning.h>
#include <skiagraph/skiagraph.h>

typedef struct {
    skg_context *context;
    skg_plan *plan;
    skg_job *job;
} handles;

typedef struct {
    const char *name;
    skg_status (*call)(const handles *h);
} bare_call;

/* Ends with an entry without a name. */
extern const bare_call bare_calls[];

#endif
