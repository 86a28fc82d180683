/* An index of parts by a hash, because a scene may have a million of them. */
#include "scene/part_index.h"

uint64_t skg_hash_bytes(uint64_t hash, const void *bytes, size_t count) {
    const unsigned char *at = bytes;
    if (hash == 0) hash = UINT64_C(14695981039346656037);
    for (size_t n = 0; n < count; n++) hash = (hash ^ at[n]) * UINT64_C(1099511628211);
    return hash;
}

static int64_t slot_of(const skg_part_index *index, uint64_t hash, int64_t step) {
    return (int64_t)((hash + (uint64_t)step) & (uint64_t)(index->capacity - 1));
}

skg_status skg_part_index_reserve(skg_part_index *index) {
    if (2 * (index->used + 1) <= index->capacity) return SKG_OK;
    skg_part_index grown = {.capacity = index->capacity ? 2 * index->capacity : 16};
    SKG_TRY(skg_alloc(grown.capacity, sizeof *grown.slots, "index of the parts", &grown.slots));
    for (int64_t i = 0; i < grown.capacity; i++) grown.slots[i].part = -1;
    for (int64_t i = 0; i < index->capacity; i++)
        if (index->slots[i].part >= 0) skg_part_index_add(&grown, index->slots[i].hash, index->slots[i].part);
    skg_free(&index->slots);
    *index = grown;
    return SKG_OK;
}

void skg_part_index_add(skg_part_index *index, uint64_t hash, int64_t part) {
    int64_t step = 0;
    SKG_ASSERT(2 * (index->used + 1) <= index->capacity); /* else the search for a free slot need not end */
    while (index->slots[slot_of(index, hash, step)].part >= 0) step++;
    index->slots[slot_of(index, hash, step)] = (skg_part_slot){hash, part};
    index->used++;
}

int64_t skg_part_index_next(const skg_part_index *index, uint64_t hash, int64_t *at) {
    while (index->capacity > 0) {
        const skg_part_slot *slot = &index->slots[slot_of(index, hash, (*at)++)];
        if (slot->part < 0) return -1;
        if (slot->hash == hash) return slot->part;
    }
    return -1;
}
