/* Stage `hits`: what priorities and clipping take off the sums of closed parts, from lists of the hits of each
 * pixel. Private. */
#ifndef SKG_HITS_H
#define SKG_HITS_H

#include "geometry/priority.h"
#include "stage/kernels.h"

/* Buffers of the lists, kept from frame to frame. */
typedef struct {
    skg_buffer slots, table, shifts, counts, starts, total, hits;
} skg_priority_memory;

void skg_priority_memory_release(skg_priority_memory *memory);
int64_t skg_priority_memory_bytes(const skg_priority_memory *memory);

#endif
