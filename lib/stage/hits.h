/* Stage `hits`: what priorities and clipping take off the sums of closed parts. Private.
 *
 * Each pixel's hits of the parts that compete are counted, listed, sorted and swept (hits.cl). */
#ifndef SKG_HITS_H
#define SKG_HITS_H

#include "stage/pass.h"

/* Kept from frame to frame. */
typedef struct {
    skg_buffer slots, runs, table, shifts, spans, counts, starts, total, hits;
    int32_t *sent; /* [sent_count] slots, runs and table as the device has them */
    int64_t sent_count;
    /* Of the pass whose hits were counted last. */
    int64_t triangles[2]; /* of winners and clipped parts, of background parts */
    cl_event counted;     /* `count` is read; NULL: no hits */
    skg_hit_count count;
} skg_hits_memory;

void skg_hits_memory_release(skg_hits_memory *memory);

/* Bytes on the device. */
int64_t skg_hits_memory_bytes(const skg_hits_memory *memory);

/* Bytes of the list of all hits, from the count that the device returns. More hits than SKG_HITS_MAX are
 * SKG_ERR_DEVICE_MEMORY. */
skg_status skg_hits_bytes(const skg_hit_count *count, int32_t is_double, int64_t *bytes);

/* Prefetches the program of the stage (skg_prefetch_begin). */
skg_status skg_hits_prefetch(skg_context *context, const skg_pass *pass);

/* The path parameter where depths of hits are 0. The pass has competitors. */
double skg_hits_common(const skg_pass *pass);

/* Enqueues the count of hits behind the projection, before the raster of the closed parts is enqueued: the device draws while the
 * host waits for the count, and enqueues what takes hits off. */
skg_status skg_hits_count(const skg_pass *pass, const skg_geometry *geometry, skg_hits_memory *memory,
                          skg_staging *staging);

/* Waits for the count, and enqueues the rest of the stage behind the raster. */
skg_status skg_hits_settle(const skg_pass *pass, const skg_geometry *geometry, skg_hits_memory *memory,
                           skg_staging *staging);

#endif
