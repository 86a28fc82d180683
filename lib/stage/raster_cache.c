/* Rasters that a plan keeps, pinned while they are in use. */
#include "stage/raster_private.h"

#include <string.h>

static skg_raster_entry *find(skg_raster_cache *cache, const skg_raster_options *options) {
    for (int32_t i = 0; i < cache->count; i++)
        if (memcmp(options, &cache->entries[i].options, sizeof *options) == 0) return &cache->entries[i];
    return NULL;
}

/* An entry for one more raster: a new one, or else the oldest without a pin. NULL: all are pinned. */
static skg_raster_entry *find_place(skg_raster_cache *cache) {
    if (cache->count < SKG_RASTER_CACHE_CAPACITY) return &cache->entries[cache->count];
    for (int32_t tried = 0; tried < SKG_RASTER_CACHE_CAPACITY; tried++) {
        skg_raster_entry *entry = &cache->entries[cache->next];
        cache->next = (cache->next + 1) % SKG_RASTER_CACHE_CAPACITY;
        if (entry->pins == 0) return entry;
    }
    return NULL;
}

static skg_status make(skg_raster_cache *cache, const skg_raster_options *options, skg_raster_entry **entry) {
    skg_raster *raster = NULL;
    *entry = find_place(cache);
    if (!*entry)
        return skg_fail(SKG_ERR_INTERNAL, "all %d rasters are in use at once",
                        (int)SKG_RASTER_CACHE_CAPACITY);
    SKG_TRY(skg_raster_create(cache->context, options, &raster));
    if (*entry == &cache->entries[cache->count]) cache->count++;
    skg_raster_release(&(*entry)->raster);
    **entry = (skg_raster_entry){.raster = raster, .options = *options};
    return SKG_OK;
}

skg_status skg_raster_cache_pin(skg_raster_cache *cache, const skg_raster_options *options,
                                skg_raster_pin *pin) {
    skg_raster_entry *entry = find(cache, options);
    if (!entry) SKG_TRY(make(cache, options, &entry));
    entry->pins++;
    skg_raster_pin_release(pin);
    *pin = (skg_raster_pin){entry->raster, entry};
    return SKG_OK;
}

void skg_raster_pin_copy(const skg_raster_pin *from, skg_raster_pin *to) {
    if (from->entry) from->entry->pins++;
    skg_raster_pin_release(to);
    *to = *from;
}

void skg_raster_pin_release(skg_raster_pin *pin) {
    if (pin->entry) pin->entry->pins--;
    *pin = (skg_raster_pin){NULL, NULL};
}

void skg_raster_cache_release(skg_raster_cache *cache) {
    for (int32_t i = 0; i < cache->count; i++) skg_raster_release(&cache->entries[i].raster);
    cache->count = cache->next = 0;
}

int64_t skg_raster_cache_bytes(const skg_raster_cache *cache) {
    int64_t bytes = 0;
    for (int32_t i = 0; i < cache->count; i++) bytes += skg_raster_bytes(cache->entries[i].raster);
    return bytes;
}
