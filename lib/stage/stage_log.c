/* The events of what was enqueued, by stage, kept when stages are timed. */
#include "stage/stage_log.h"

void skg_stage_log_clear(skg_stage_log *log) {
    for (int64_t i = 0; i < log->count; i++) clReleaseEvent(log->events[i]);
    skg_free(&log->names);
    skg_free(&log->events);
    log->count = log->capacity = 0;
}

cl_event *skg_stage_event(const skg_stage_log *log, cl_event *event) {
    return log && log->on ? event : NULL;
}

static skg_status grow(skg_stage_log *log) {
    const int64_t capacity = 2 * log->capacity + 16;
    if (log->count < log->capacity) return SKG_OK;
    SKG_TRY(skg_realloc(capacity, sizeof *log->names, "stage log", &log->names));
    SKG_TRY(skg_realloc(capacity, sizeof *log->events, "stage log", &log->events));
    log->capacity = capacity;
    return SKG_OK;
}

skg_status skg_stage_log_add(skg_stage_log *log, const char *stage, cl_event event) {
    if (!event) return SKG_OK;
    const int wanted = log && log->on;
    const skg_status status = wanted ? grow(log) : SKG_OK;
    if (!wanted || status != SKG_OK) {
        clReleaseEvent(event);
        return status;
    }
    log->names[log->count] = stage;
    log->events[log->count++] = event;
    return SKG_OK;
}

skg_status skg_stage_log_time(const skg_stage_log *log, int64_t index, double *ns) {
    SKG_ASSERT(0 <= index && index < log->count);
    const cl_event event = log->events[index];
    cl_ulong start = 0, end = 0;
    SKG_CL_TRY(clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof start, &start, NULL));
    SKG_CL_TRY(clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL));
    *ns = (double)(end - start);
    return SKG_OK;
}
