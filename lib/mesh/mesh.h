/* What a mesh is inside, and what a plan reads of it. Private. */
#ifndef SKG_MESH_PRIVATE_H
#define SKG_MESH_PRIVATE_H

#include "core/core.h"

#include <skiagraph/mesh.h>

/* Most vertices and most triangles: 3 * count stays below 2^31, so that kernels index with int. */
#define SKG_MESH_LIMIT ((int64_t)(INT32_MAX / 3))

struct skg_mesh {
    skg_refs refs;
    char *name;
    int64_t vertices, triangles;
    double *positions;   /* 3 * vertices, mm; valid unless positions_stale */
    float *offsets;      /* 3 * vertices, mm from origin: what single precision uploads */
    double origin[3];    /* mm */
    int32_t *corners;    /* 3 * triangles, as given */
    int32_t *weld;       /* per vertex the first one at the same place; NULL: each is its own */
    int32_t orientation; /* 1; -1: corners run the wrong way round, the plan turns the sign */
    int32_t closed;      /* as health.closed */
    int positions_stale; /* the offsets were written in place: a position is origin + offset */
    int64_t version;     /* of the positions, from 1 */
    float lowest[3];     /* bounds of the finite offsets, mm from origin */
    float highest[3];
    int64_t first_bad;      /* first vertex that is not finite; -1: none */
    int32_t layers;         /* how many times a ray may be inside at once, in version 1 */
    skg_mesh_health health; /* volume, area, bounds and degenerate_triangles of version 1 */
};

/* Arrays that grow while a file is read; a mesh takes them over. Corner numbers are checked there. */
typedef struct {
    double *positions;
    int32_t *corners;
    int64_t vertices, triangles;
    int64_t vertex_room, triangle_room;
    int64_t left_out; /* points and lines seen */
} skg_mesh_arrays;

/* Makes a mesh of arrays (mm), which it empties whether it succeeds or not. Checks everything that
 * skg_mesh_create promises but the strides and the unit. */
skg_status skg_mesh_adopt(skg_context *context, const char *name, skg_mesh_arrays *arrays, skg_mesh **mesh);
void skg_mesh_arrays_free(skg_mesh_arrays *arrays);

/* Fills health and orientation of a new mesh, and its weld map. */
skg_status skg_mesh_examine(skg_mesh *mesh);

/* Sets mesh->layers: as many components, by edges, as may lie over each other by their boxes, times how often
 * an edge runs one way (coincident copies weld into one component). root: [triangles] one of its component.
 */
skg_status skg_mesh_count_layers(skg_mesh *mesh, const int32_t *root, int32_t multiplicity);

/* Volume (times orientation), area, bounds and degenerate triangles of the mesh as it lies now. */
void skg_mesh_measure(const skg_mesh *mesh, skg_mesh_health *health);

/* Position of one vertex now, mm. */
static inline void skg_mesh_vertex(const skg_mesh *mesh, int64_t vertex, double position[3]) {
    for (int k = 0; k < 3; k++)
        position[k] = mesh->positions_stale ? mesh->origin[k] + (double)mesh->offsets[3 * vertex + k]
                                            : mesh->positions[3 * vertex + k];
}

/* Bounds of the offsets (mm from the origin) over the finite vertices; *first_bad: the first vertex that is
 * not finite, or -1. Kept up to date by every write and skg_mesh_offsets_moved: costs nothing. */
void skg_mesh_bounds(const skg_mesh *mesh, float lowest[3], float highest[3], int64_t *first_bad);

/* Corners (3 * triangles) in an order for the device: along a space-filling curve where the caller's order
 * jumps about, else the caller's. Each triangle keeps its own corner order; sorted: 1 when reordered. */
skg_status skg_mesh_sorted_corners(const skg_mesh *mesh, int32_t *corners, int32_t *sorted);

#endif
