/* Stage `leaky`: meshes that are not closed. Private.
 *
 * Each leaky part is rastered into planes and a count plane of its own. In a pixel whose signed hits cancel, the part's
 * sums join those of the closed parts; in a bad pixel they are left out, or repaired (repair.h). Parts do not share a count
 * plane: +1 of one mesh and -1 of another would cancel (docs/numerics.md). */
#ifndef SKG_LEAKY_H
#define SKG_LEAKY_H

#include "stage/leaky_batch.h"

typedef struct {
    int64_t count;
    const int64_t *parts; /* [count] numbers of the leaky parts, as the memory was made for */
    int32_t repair;       /* SKG_REPAIR_... */
    int32_t strategy;     /* of their rasters */
    int32_t tile;         /* of that strategy; 0: chosen there */
    int32_t reserved;
} skg_leaky_parts;

/* What is read of the leaky parts that contribute to the last frame. */
typedef struct {
    int64_t count;
    int64_t *indices; /* [count] into the leaky parts; staged */
    int32_t *pixels;  /* [count][1 + SKG_FIRST_BAD] as skg_raster_bad_pixels leaves it; staged */
} skg_leaky_verdicts;

/* Memory for the verdicts on `count` leaky parts. */
skg_status skg_leaky_verdicts_create(int64_t count, skg_staging *staging, skg_leaky_verdicts *verdicts);

/* Enqueues the leaky parts of a pass behind the raster of the closed ones, whose sums they join. An exact repair waits
 * for the rasters. */
skg_status skg_leaky_run(const skg_leaky_parts *leaky, const skg_pass *pass, skg_geometry *geometry,
                         skg_raster_cache *rasters, skg_leaky_memory *memory, skg_leaky_verdicts *verdicts,
                         skg_staging *staging);

#endif
