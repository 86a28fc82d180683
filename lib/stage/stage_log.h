/* The events of what was enqueued, by stage, kept when stages are timed. Private. */
#ifndef SKG_STAGE_LOG_H
#define SKG_STAGE_LOG_H

#include "device/device.h"

/* All zero is a log that is off; set `on` to 1 to time stages. */
typedef struct {
    int32_t on, reserved;
    int64_t count, capacity;
    const char **names; /* [count] static storage */
    cl_event *events;   /* [count] */
} skg_stage_log;

/* Takes over an event, and keeps it if the log is on. log and event may be NULL. */
skg_status skg_stage_log_add(skg_stage_log *log, const char *stage, cl_event event);
void skg_stage_log_clear(skg_stage_log *log);

/* Time of an entry on the device, nanoseconds; its work must be done. */
skg_status skg_stage_log_time(const skg_stage_log *log, int64_t index, double *ns);

/* Where OpenCL is to put an event for the log; NULL if the log wants none. */
cl_event *skg_stage_event(const skg_stage_log *log, cl_event *event);

#endif
