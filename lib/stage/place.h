/* Positions of vertices that come from the caller's device memory. Private. */
#ifndef SKG_PLACE_STAGE_H
#define SKG_PLACE_STAGE_H

#include "stage/project.h"

/* A mesh whose positions the caller gave. */
typedef struct {
    /* of the mesh on the host at that time; 0: never. A later version of the host holds again */
    int64_t version;
    float lowest[3]; /* bounds, mm from the mesh's origin */
    float highest[3];
    skg_buffer taken; /* int [vertices of the layout]: the caller's vertex whose position each takes */
} skg_placed_mesh;

typedef struct {
    int64_t count;
    skg_placed_mesh *meshes; /* [count]; NULL: nothing was placed */
    cl_kernel kernel;
    skg_buffer outside; /* int [count]: the lowest vertex outside of its bounds; INT32_MAX: none */
} skg_placement;

/* Where positions come from. */
typedef struct {
    cl_mem memory;
    int64_t first; /* element at which they begin */
    float lowest[3], highest[3];
} skg_place_source;

/* Enqueues the copy of the positions of mesh number `index` into the vertex buffer. Nothing is waited for. */
skg_status skg_placement_place(skg_placement *placement, skg_context *context, skg_geometry *geometry,
                               const skg_mesh *mesh, int64_t index, const skg_place_source *source);

/* The mesh as it was placed; NULL if the positions of the host hold. */
const skg_placed_mesh *skg_placement_of(const skg_placement *placement, const skg_mesh *mesh, int64_t index);

void skg_placement_release(skg_placement *placement);

int64_t skg_placement_bytes(const skg_placement *placement);

#endif
