/* Counts the triangles that a mesh lists twice: neither those without area nor the common walls of bodies in contact. */
#include "mesh/groups.h"

#include "core/maths.h"

/* Whether the triangle of a group, of vertex `vertex`, has no area. */
static int is_flat(const skg_mesh *mesh, int64_t vertex, uint64_t key) {
    double a[3], b[3], c[3], u[3], v[3], cross[3];
    skg_mesh_vertex(mesh, vertex, a);
    skg_mesh_vertex(mesh, (int64_t)(key >> 32), b);
    skg_mesh_vertex(mesh, (int64_t)(key & UINT32_MAX), c);
    for (int k = 0; k < 3; k++) u[k] = b[k] - a[k], v[k] = c[k] - a[k];
    skg_cross(u, v, cross);
    return skg_mesh_no_area(cross, u, v);
}

/* Counts the triangles of area that repeat an earlier one. */
static void count_repeats(skg_mesh *mesh, const skg_mesh_groups *triangles) {
    for (int64_t v = 0; v < mesh->vertices; v++)
        for (int64_t i = triangles->start[v] + 1; i < triangles->start[v + 1]; i++)
            mesh->health.duplicate_triangles +=
                triangles->key[i] == triangles->key[i - 1] && !is_flat(mesh, v, triangles->key[i]);
}

/* Whether the corners of a triangle follow each other as their numbers do. */
static int rises(const uint32_t c[3]) {
    return (c[0] < c[1]) + (c[1] < c[2]) + (c[2] < c[0]) == 2;
}

/* Sets partner[t] of triangles that are listed twice, once each way: the first of the two; -1 of all others. first: [items] scratch,
 * the first triangle of an item; -1 at the start */
static void pair(const skg_mesh *mesh, const skg_mesh_groups *triangles, int32_t *first, int32_t *partner) {
    for (int32_t t = 0; t < mesh->triangles; t++) {
        uint32_t corner[3], other[3], vertex[1];
        uint64_t key[1];
        partner[t] = -1;
        if (!skg_mesh_welded(mesh, t, corner)) continue;
        skg_mesh_triangle_item(corner, vertex, key);
        const int64_t end = triangles->start[vertex[0] + 1];
        int64_t low = triangles->start[vertex[0]], count = 0;
        for (int64_t high = end; low < high;) {
            const int64_t middle = (low + high) / 2;
            if (triangles->key[middle] < key[0])
                low = middle + 1;
            else
                high = middle;
        }
        while (low + count < end && triangles->key[low + count] == key[0]) count++;
        if (count != 2 || is_flat(mesh, vertex[0], key[0])) continue;
        if (first[low] < 0) {
            first[low] = t;
            continue;
        }
        skg_mesh_welded(mesh, first[low], other);
        if (rises(other) != rises(corner)) partner[t] = partner[first[low]] = first[low];
    }
}

/* Joins pairs along their edges; found[root]: an edge of theirs has a triangle of no pair. */
static void join_pairs(const skg_mesh *mesh, const skg_mesh_groups *edges, int32_t *partner, int8_t *found) {
    for (int64_t v = 0; v < mesh->vertices; v++)
        for (int64_t i = edges->start[v], end; i < edges->start[v + 1]; i = end) {
            int32_t paired = -1, single = 0;
            end = skg_mesh_group_end(edges, v, i);
            for (int64_t k = i; k < end; k++) {
                const int32_t t = skg_mesh_edge_triangle(edges->key[k]);
                single |= partner[t] < 0;
                if (partner[t] < 0) continue;
                if (paired >= 0) {
                    const int32_t a = skg_root_of(partner, t), b = skg_root_of(partner, paired);
                    found[a > b ? b : a] |= found[a > b ? a : b];
                    skg_join(partner, a, b);
                }
                paired = t;
            }
            if (paired >= 0 && single) found[skg_root_of(partner, paired)] = 1;
        }
}

/* In a closed mesh, two triangles that face each other cancel, and the lengths are those of the rest: where the rest goes on at the
 * edges of such pairs, they are a common wall of two bodies in contact, and no duplicates. Pairs alone are a body that is listed
 * twice, once inward. */
static skg_status forgive_walls(skg_mesh *mesh, const skg_mesh_groups *triangles) {
    skg_mesh_groups edges = {0};
    int32_t *first = NULL, *partner = NULL;
    int8_t *found = NULL;
    skg_status status = SKG_OK;
    const int64_t items = triangles->start[mesh->vertices];
    SKG_TRY_CLEANUP(skg_alloc(items + 1, sizeof *first, mesh->name, &first));
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, sizeof *partner, mesh->name, &partner));
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, sizeof *found, mesh->name, &found));
    SKG_TRY_CLEANUP(skg_mesh_group_edges(mesh, &edges));
    for (int64_t i = 0; i < items; i++) first[i] = -1;
    pair(mesh, triangles, first, partner);
    join_pairs(mesh, &edges, partner, found);
    int64_t forgiven = 0;
    for (int32_t t = 0; t < mesh->triangles; t++)
        if (partner[t] >= 0) forgiven += found[skg_root_of(partner, t)];
    mesh->health.duplicate_triangles -= forgiven / 2;
cleanup:
    skg_mesh_groups_free(&edges);
    skg_free(&first);
    skg_free(&partner);
    skg_free(&found);
    return status;
}

skg_status skg_mesh_count_duplicates(skg_mesh *mesh) {
    skg_mesh_groups triangles;
    SKG_TRY(skg_mesh_group_triangles(mesh, &triangles));
    count_repeats(mesh, &triangles);
    skg_status status = SKG_OK;
    if (mesh->health.duplicate_triangles > 0 && mesh->health.closed) status = forgive_walls(mesh, &triangles);
    skg_mesh_groups_free(&triangles);
    return status;
}
