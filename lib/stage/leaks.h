/* Leaky parts: their planes, and the repair of bad pixels. Private. */
#ifndef SKG_LEAKS_H
#define SKG_LEAKS_H

#include "geometry/retrace.h"
#include "stage/pass.h"

/* --- Leaky parts that are rastered together, and what the stages `leaky` and `repair` keep. */

/* Kept from frame to frame. */
typedef struct {
    skg_buffer verdicts; /* [leaky parts][1 + SKG_FIRST_BAD] */
    skg_buffer table;    /* of the batch at hand, as the kernels of leaky.cl take it */
    skg_buffer gaps;     /* as skg_leaky_gaps leaves them */
    int64_t count;       /* leaky parts */
    skg_caps *caps;      /* [count] that close their meshes, each made on demand */
} skg_leaky_memory;

/* count: leaky parts. */
skg_status skg_leaky_memory_create(skg_context *context, int64_t count, skg_leaky_memory *memory);
void skg_leaky_memory_release(skg_leaky_memory *memory);

/* Bytes on the device. */
int64_t skg_leaky_memory_bytes(const skg_leaky_memory *memory);

typedef struct {
    const skg_pass *pass;
    const int64_t *leaky; /* numbers of the scene's leaky parts */
    skg_leaky_memory *memory;
    skg_staging *staging;
    int64_t parts;
    const int64_t *indices; /* [parts] into leaky */
    /* of their planes: each part's sums in the order of its contributions, then its count */
    const skg_raster *raster;
    const skg_raster *shared; /* that their sums join */
} skg_leaky_batch;

/* The number in the scene of part k of a batch. */
static inline int64_t skg_leaky_part(const skg_leaky_batch *batch, int64_t k) {
    return batch->leaky[batch->indices[k]];
}

/* The program leaky.cl for a batch. */
skg_status skg_leaky_program(const skg_leaky_batch *batch, cl_program *program);

/* The scalar arguments of its kernels. */
skg_leaky_args skg_leaky_scalars(const skg_leaky_batch *batch);

/* The arguments that its kernels have in common. */
#define SKG_LEAKY_ARGUMENTS(kernel, scalars, batch)                                                          \
    SKG_ARGUMENT(kernel, args, scalars), SKG_ARGUMENT(kernel, copies, (batch)->raster->sums.memory),         \
        SKG_ARGUMENT(kernel, used, (batch)->raster->used.memory),                                            \
        SKG_ARGUMENT(kernel, table, (batch)->memory->table.memory)

/* The caps of a leaky part, made at the first call, which warns of pieces that they leave nothing of. index: into the leaky parts. */
skg_status skg_leaky_caps(const skg_leaky_batch *batch, int64_t index, const skg_mesh *mesh,
                          const skg_caps **caps);

/* --- Stage `leaky`: meshes that are not closed. *
 * Each leaky part is rastered into planes and a count plane of its own. In a pixel whose signed hits cancel, the part's
 * sums join those of the closed parts; in a bad pixel they are left out, or repaired. Parts do not share a count
 * plane: +1 of one mesh and -1 of another would cancel (docs/numerics.md). */

typedef struct {
    int64_t count;
    const int64_t *parts; /* [count] numbers of the leaky parts, as the memory was made for */
    int32_t repair;       /* SKG_REPAIR_... */
    int32_t strategy;     /* of their rasters */
    int32_t tile;         /* of that strategy; 0: chosen there */
    int32_t reserved;
} skg_leaky_parts;

/* The counts that are read of the leaky parts that contribute to the last frame. */
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

/* --- Stage `repair`: what the bad pixels of leaky parts get. *
 * Values are added to the shared sums as integers, so that every strategy leaves the same bits. */

/* Enqueues the repair of a batch behind its verdicts and its sums. repair: SKG_REPAIR_...; EXACT waits for the raster. */
skg_status skg_repair_run(const skg_leaky_batch *batch, int32_t repair);

#endif
