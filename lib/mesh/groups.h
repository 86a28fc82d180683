/* The edges of a mesh, sorted, and the winding that is found along them. Private. */
#ifndef SKG_MESH_GROUPS_H
#define SKG_MESH_GROUPS_H

#include "core/maths.h"
#include "mesh/mesh.h"

#include <float.h>

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

/* The edges of the triangles that are not degenerate; the triangles themselves, each listed at the lowest of its vertices, with the
 * two others in order as its key. Degenerate ones have three corners at fewer places: their edges cancel. */
skg_status skg_mesh_group_edges(const skg_mesh *mesh, skg_mesh_groups *found);
skg_status skg_mesh_group_triangles(const skg_mesh *mesh, skg_mesh_groups *found);
void skg_mesh_groups_free(skg_mesh_groups *found);

/* The vertex and the key of one triangle among the groups of triangles. */
void skg_mesh_triangle_item(const uint32_t corner[3], uint32_t *vertex, uint64_t *key);

/* The welded corners of a triangle. Returns 0 if two of them are the same vertex. */
int skg_mesh_welded(const skg_mesh *mesh, int64_t triangle, uint32_t corner[3]);

/* Sets of numbers that are joined: the lowest of each is its root. */
static inline int32_t skg_root_of(int32_t *parent, int32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
}

static inline void skg_join(int32_t *parent, int32_t a, int32_t b) {
    a = skg_root_of(parent, a), b = skg_root_of(parent, b);
    parent[a > b ? a : b] = a > b ? b : a;
}

/* Rounding leaves the cross product of parallel edges at a few |u| |v| epsilon. Eight leave a margin. */
static inline int skg_mesh_no_area(const double cross[3], const double u[3], const double v[3]) {
    const double bar = 8 * DBL_EPSILON;
    return skg_dot(cross, cross) <= bar * bar * skg_dot(u, u) * skg_dot(v, v);
}

/* Counts in the health the triangles of area that repeat an earlier one. */
skg_status skg_mesh_count_duplicates(skg_mesh *mesh);

/* Turns triangles until neighbours are wound alike: those of every patch that is connected through edges of two triangles and is
 * wound both ways. A closed patch then faces outward, or inward inside another one; an open one keeps the winding of most of its
 * triangles. One-sided patches stay as they are. Counts in the health what was turned, and exchanges the second and third corner of it. */
skg_status skg_mesh_wind(skg_mesh *mesh, const skg_mesh_groups *edges);

#endif
