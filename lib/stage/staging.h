/* Staging for work under way: host memory that the device reads or writes, and the log of the stages. Private. */
#ifndef SKG_STAGING_H
#define SKG_STAGING_H

#include "stage/stage_log.h"

typedef struct {
    skg_context *context;
    struct skg_staged *first; /* the blocks of host memory */
    skg_stage_log log;
} skg_staging;

/* A block of host memory, zeroed, that stays until skg_staging_release. what: for the message. */
skg_status skg_staging_take(skg_staging *staging, int64_t count, size_t size, const char *what,
                            void *pointer_address);

/* Enqueues a write of a staged block, for which the buffer is made large enough. what: for the message. */
skg_status skg_staging_write(skg_staging *staging, skg_buffer *buffer, int64_t bytes, const void *staged,
                             const char *what);

/* Enqueues a read of a buffer into a staged block. */
skg_status skg_staging_read(skg_staging *staging, cl_mem buffer, int64_t bytes, void *staged);

/* Frees the blocks and clears the log. Everything enqueued that uses them must be done. */
void skg_staging_release(skg_staging *staging);

#endif
