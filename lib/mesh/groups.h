/* The edges of a mesh, sorted, and the winding that is found along them. Private. */
#ifndef SKG_MESH_GROUPS_H
#define SKG_MESH_GROUPS_H

#include "mesh/mesh.h"

/* Items of the triangles, grouped by a vertex: those of vertex v are key[start[v]] to key[start[v + 1] - 1], sorted. The key of an
 * edge is its other vertex (from bit 32 on), then the triangle (fewer than 2^30), then the direction in the lowest bit. */
typedef struct {
    int64_t *start;
    uint64_t *key;
} skg_mesh_groups;

static inline int32_t skg_mesh_edge_triangle(uint64_t key) {
    return (int32_t)(key >> 1 & 0x3fffffff);
}

/* The item behind the last one that has the edge of item `first`, of vertex `vertex`. */
static inline int64_t skg_mesh_group_end(const skg_mesh_groups *edges, int64_t vertex, int64_t first) {
    int64_t end = first + 1;
    while (end < edges->start[vertex + 1] && edges->key[end] >> 32 == edges->key[first] >> 32) end++;
    return end;
}

/* Turns triangles until neighbours are wound alike: those of every patch that is connected through edges of two triangles and is
 * wound both ways. A closed patch then faces outward, or inward inside another one; an open one keeps the winding of most of its
 * triangles. One-sided patches stay as they are. Counts in the health what was turned, and exchanges the second and third corner of it. */
skg_status skg_mesh_wind(skg_mesh *mesh, const skg_mesh_groups *edges);

#endif
