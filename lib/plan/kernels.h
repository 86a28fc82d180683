/* Which kernels with which -D: the one place that writes option strings for the stages that project and
 * rasterise. Private. */
#ifndef SKG_KERNELS_H
#define SKG_KERNELS_H

#include "device/device.h"

typedef struct {
    int32_t precision;     /* SKG_SINGLE, SKG_DOUBLE */
    int32_t bits;          /* of the accumulators: 32 or 64 */
    int32_t parallel;      /* parallel beam */
    int32_t source_plane;  /* some part may reach the source, or the plane where parallel paths start */
    int32_t listed_writes; /* 0: every part adds to plane 0, without bias; 1: as its list says */
} skg_kernel_options;

/* Lanes that kernels with wide vectors use on this device. */
int32_t skg_kernel_lanes(skg_context *context, int32_t precision);

/* The program of these kernel files (after the headers that all need), from the context's cache or built. */
skg_status skg_kernels_get(skg_context *context, const skg_kernel_options *options, int32_t files,
                           const char *const *names, const char *more_options, cl_program *program);

/* Sets arguments `first`, first + 1, ... to these buffers. */
skg_status skg_kernel_set_memory(cl_kernel kernel, cl_uint first, int32_t count, const cl_mem *memory);

/* Enqueues a kernel and logs its event; log may be NULL. */
enum { SKG_MOST_STAGES = 16 };
typedef struct {
    int32_t count;
    const char *names[SKG_MOST_STAGES];
    cl_event events[SKG_MOST_STAGES]; /* released by whoever reads the log: skg_stage_log_clear */
} skg_stage_log;
void skg_stage_log_clear(skg_stage_log *log);

/* global and local: sizes in `dimensions` dimensions; local may be NULL. stage: for the log. */
skg_status skg_kernel_run(skg_context *context, cl_kernel kernel, const char *stage, cl_uint dimensions,
                          const size_t *global, const size_t *local, skg_stage_log *log);

#endif
