/* Leaky parts that are rastered together, and what the stages `leaky` and `repair` keep. Private. */
#ifndef SKG_LEAKY_BATCH_H
#define SKG_LEAKY_BATCH_H

#include "geometry/caps.h"
#include "stage/pass.h"

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
    const skg_raster
        *raster; /* of their planes: each part's sums in the order of its contributions, then its count */
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

/* The caps of a leaky part, made at the first call. index: into the leaky parts. */
skg_status skg_leaky_caps(skg_leaky_memory *memory, int64_t index, const skg_mesh *mesh,
                          const skg_caps **caps);

#endif
