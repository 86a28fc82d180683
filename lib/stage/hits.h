/* Stage `hits`: what priorities and clipping take off the sums of closed parts. Private.
 *
 * Each pixel's hits of the parts that compete are counted, listed, sorted and swept (hits.cl). */
#ifndef SKG_HITS_H
#define SKG_HITS_H

#include "stage/pass.h"

/* Buffers of the lists, kept from frame to frame. */
typedef struct {
    skg_buffer slots, runs, table, shifts, spans, counts, starts, total, hits;
} skg_hits_memory;

void skg_hits_memory_release(skg_hits_memory *memory);

/* Bytes on the device. */
int64_t skg_hits_memory_bytes(const skg_hits_memory *memory);

/* Bytes of the list of all hits, from the count that the device returns. More hits than SKG_HITS_MAX are
 * SKG_ERR_DEVICE_MEMORY. */
skg_status skg_hits_bytes(const skg_hit_count *count, int32_t is_double, int64_t *bytes);

/* Prefetches the program of the stage (skg_prefetch_begin). */
skg_status skg_hits_prefetch(skg_context *context, const skg_pass *pass);

/* Enqueues the stage behind the raster of the closed parts, whose tables the device has. Waits for the count of hits. */
skg_status skg_hits_run(const skg_pass *pass, const skg_geometry *geometry, skg_hits_memory *memory,
                        skg_staging *staging);

#endif
