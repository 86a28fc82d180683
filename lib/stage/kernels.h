/* Which kernels with which -D: the one place that writes option strings for the stages that project and
 * rasterise. Private. */
#ifndef SKG_KERNELS_H
#define SKG_KERNELS_H

#include "device/device.h"

typedef struct {
    int32_t precision;     /* SKG_PRECISION_SINGLE, SKG_PRECISION_DOUBLE */
    int32_t bits;          /* of the accumulators: 32 or 64 */
    int32_t parallel;      /* parallel beam */
    int32_t source_plane;  /* some part may reach the source, or the plane where parallel paths start */
    int32_t half;          /* distances are rounded to 16 bits; precision is single */
    int32_t listed_writes; /* 0: every part adds to one plane, without bias; 1: as its list says */
} skg_kernel_options;

/* Lanes that kernels with wide vectors use on this device. */
int32_t skg_kernel_lanes(skg_context *context, int32_t precision);

/* The program of these kernel files (after the headers that all need), from the context's cache or built. */
skg_status skg_kernels_get(skg_context *context, const skg_kernel_options *options, int32_t files,
                           const char *const *names, const char *more_options, cl_program *program);

/* Sets arguments `first`, first + 1, ... to these buffers. */
skg_status skg_kernel_set_memory(cl_kernel kernel, cl_uint first, int32_t count, const cl_mem *memory);

/* Events of what was enqueued, by stage, where stages are timed. All zero and on = 1 to begin. */
typedef struct {
    int32_t on, reserved;
    int64_t count, room;
    const char **names; /* [count] static storage */
    cl_event *events;   /* [count] */
} skg_stage_log;

/* Takes an event over; keeps it where the log is on. log or event may be NULL. */
skg_status skg_stage_log_add(skg_stage_log *log, const char *stage, cl_event event);
void skg_stage_log_clear(skg_stage_log *log);

/* Where the log wants an event put; NULL where it wants none. */
cl_event *skg_stage_event(const skg_stage_log *log, cl_event *event);

/* Enqueues a kernel. global and local: sizes in `dimensions` dimensions; local may be NULL. stage: for the
 * log, which may be NULL, and for messages. */
skg_status skg_kernel_run(skg_context *context, cl_kernel kernel, const char *stage, cl_uint dimensions,
                          const size_t *global, const size_t *local, skg_stage_log *log);

/* Enqueues a write that reads `bytes` of data when its turn comes: the data must stay. */
skg_status skg_stage_write(skg_context *context, const char *stage, cl_mem buffer, int64_t offset,
                           int64_t bytes, const void *data, skg_stage_log *log);

#endif
