/* Stage `hits`: what priorities and clipping take off the sums of closed parts, from lists of the hits of each
 * pixel. Private. */
#ifndef SKG_HITS_H
#define SKG_HITS_H

#include "geometry/priority.h"
#include "stage/kernels.h"

/* Buffers of the lists, kept from frame to frame. */
typedef struct {
    skg_buffer slots, table, shifts, counts, starts, total, hits;
} skg_contest_memory;

void skg_contest_memory_release(skg_contest_memory *memory);
int64_t skg_contest_memory_bytes(const skg_contest_memory *memory);

#endif
