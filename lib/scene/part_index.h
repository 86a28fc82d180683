/* Finds parts by a hash: a scene may have a million of them. Private. */
#ifndef SKG_PART_INDEX_H
#define SKG_PART_INDEX_H

#include "core/core.h"

typedef struct {
    uint64_t hash;
    int64_t part; /* -1: free */
} skg_part_slot;

/* All zero: empty. Free slots follow each other no farther than hashes collide. */
typedef struct {
    skg_part_slot *slots;
    int64_t room, used;
} skg_part_index;

/* FNV-1a, 64 bits, continued from `hash` (0: from the start). */
uint64_t skg_hash_bytes(uint64_t hash, const void *bytes, size_t count);

/* Room for one more: SKG_ERR_MEMORY, and the index stays as it was. */
skg_status skg_part_index_reserve(skg_part_index *index);

/* After skg_part_index_reserve; does not fail. */
void skg_part_index_add(skg_part_index *index, uint64_t hash, int64_t part);

/* The next part with this hash, -1: none more. *at: 0 at first. */
int64_t skg_part_index_next(const skg_part_index *index, uint64_t hash, int64_t *at);

#endif
