/* An index of parts by a hash, because a scene may have a million of them. Private. */
#ifndef SKG_PART_INDEX_H
#define SKG_PART_INDEX_H

#include "core/core.h"

typedef struct {
    uint64_t hash;
    int64_t part; /* -1: the slot is free */
} skg_part_slot;

/* A hash table with linear probing. All zero: empty. At least half of the slots are free. */
typedef struct {
    skg_part_slot *slots;
    int64_t capacity, used;
} skg_part_index;

/* The hash FNV-1a of 64 bits, continued from `hash`; 0 starts a new one. */
uint64_t skg_hash_bytes(uint64_t hash, const void *bytes, size_t count);

/* Makes sure that one part more fits. On SKG_ERR_MEMORY the index stays as it was. */
skg_status skg_part_index_reserve(skg_part_index *index);

/* Adds a part. Does not fail after skg_part_index_reserve. */
void skg_part_index_add(skg_part_index *index, uint64_t hash, int64_t part);

/* The next part with this hash; -1 if there are no more. *at is 0 for the first call and is advanced. */
int64_t skg_part_index_next(const skg_part_index *index, uint64_t hash, int64_t *at);

#endif
