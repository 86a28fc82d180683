/* Rasters made so far, by what they can do: sums of 32 or 64 bits, point or parallel beam, how many planes... Private.
 *
 * A raster is got pinned. It stays until its pin is released; only rasters without a pin are replaced. */
#ifndef SKG_RASTER_CACHE_H
#define SKG_RASTER_CACHE_H

#include "stage/raster.h"

enum { SKG_RASTER_CACHE_CAPACITY = 16 };

typedef struct {
    skg_raster *raster;
    skg_raster_options options;
    int32_t pins, reserved;
} skg_raster_entry;

/* All zero but for the context: empty. */
typedef struct {
    skg_context *context;
    int32_t count, next; /* entries in use; the entry to replace next, if it has no pin */
    skg_raster_entry entries[SKG_RASTER_CACHE_CAPACITY];
} skg_raster_cache;

/* A raster in use. All zero: none. The cache must not move while pins exist. */
typedef struct {
    skg_raster *raster;
    skg_raster_entry *entry;
} skg_raster_pin;

/* The raster with these options, made on demand, pinned. Whatever pin held before is released, after the new raster is
 * pinned. A cache full of pinned rasters is SKG_ERR_INTERNAL, and pin keeps what it holds. */
skg_status skg_raster_cache_pin(skg_raster_cache *cache, const skg_raster_options *options,
                                skg_raster_pin *pin);

/* Another pin of the same raster, which may hold one before. */
void skg_raster_pin_copy(const skg_raster_pin *from, skg_raster_pin *to);

/* Releases a pin; one that holds nothing is fine. What is enqueued for the raster may still be under way: OpenCL keeps
 * the memory of a raster that is replaced until it is done. */
void skg_raster_pin_release(skg_raster_pin *pin);

/* Releases all rasters, pinned or not. */
void skg_raster_cache_release(skg_raster_cache *cache);

/* Bytes on the device. */
int64_t skg_raster_cache_bytes(const skg_raster_cache *cache);

#endif
