/* Sorts the edges or the triangles of a mesh by their welded vertices, so that equal ones stand side by side. */
#include "mesh/groups.h"

#include <stdlib.h>
#include <string.h>

int skg_mesh_welded(const skg_mesh *mesh, int64_t triangle, uint32_t corner[3]) {
    for (int k = 0; k < 3; k++) {
        const int32_t given = mesh->corners[3 * triangle + k];
        corner[k] = (uint32_t)(mesh->weld ? mesh->weld[given] : given);
    }
    return corner[0] != corner[1] && corner[1] != corner[2] && corner[2] != corner[0];
}

/* Lists the items (at most 3) of a triangle with the vertex of each, and returns their number. */
typedef int (*items_of)(int64_t triangle, const uint32_t corner[3], uint32_t vertex[3], uint64_t key[3]);

/* The edges of a triangle, each listed at the lower of its vertices. The key is the other vertex, then the triangle
 * (fewer than 2^30), then the direction in the lowest bit. */
static int edges_of(int64_t triangle, const uint32_t corner[3], uint32_t vertex[3], uint64_t key[3]) {
    for (int k = 0; k < 3; k++) {
        uint32_t a = corner[k], b = corner[(k + 1) % 3];
        vertex[k] = a < b ? a : b;
        key[k] = (uint64_t)(a < b ? b : a) << 32 | (uint64_t)triangle << 1 | (a < b);
    }
    return 3;
}

void skg_mesh_triangle_item(const uint32_t corner[3], uint32_t *vertex, uint64_t *key) {
    uint32_t a = corner[0], b = corner[1], c = corner[2], swap;
    if (a > b) swap = a, a = b, b = swap;
    if (b > c) swap = b, b = c, c = swap;
    if (a > b) swap = a, a = b, b = swap;
    *vertex = a;
    *key = (uint64_t)b << 32 | c;
}

/* The triangle itself. */
static int triangle_of(int64_t triangle, const uint32_t corner[3], uint32_t vertex[3], uint64_t key[3]) {
    (void)triangle;
    skg_mesh_triangle_item(corner, vertex, key);
    return 1;
}

static int compare_keys(const void *a, const void *b) {
    uint64_t x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

static void sort_keys(uint64_t *key, int64_t count) {
    if (count > 32) { /* below, a call of qsort takes longer than an insertion sort */
        qsort(key, (size_t)count, sizeof *key, compare_keys);
        return;
    }
    for (int64_t i = 1; i < count; i++) {
        uint64_t moving = key[i];
        int64_t j = i;
        for (; j > 0 && key[j - 1] > moving; j--) key[j] = key[j - 1];
        key[j] = moving;
    }
}

void skg_mesh_groups_free(skg_mesh_groups *found) {
    skg_free(&found->start);
    skg_free(&found->key);
}

/* A counting sort by vertex, then a sort of each group by key. Degenerate triangles have no items: their edges
 * cancel. */
static skg_status group(const skg_mesh *mesh, items_of items, skg_mesh_groups *found) {
    uint32_t corner[3], vertex[3];
    uint64_t key[3];
    skg_status status = SKG_OK;
    *found = (skg_mesh_groups){0};
    SKG_TRY_CLEANUP(skg_alloc(mesh->vertices + 2, sizeof *found->start, mesh->name, &found->start));
    /* Counts are stored two places on, so that start[v] is where group v begins when the groups are filled. */
    for (int64_t t = 0; t < mesh->triangles; t++)
        for (int k = skg_mesh_welded(mesh, t, corner) ? items(t, corner, vertex, key) : 0; k-- > 0;)
            found->start[vertex[k] + 2]++;
    for (int64_t v = 0; v < mesh->vertices; v++) found->start[v + 2] += found->start[v + 1];
    SKG_TRY_CLEANUP(skg_alloc(found->start[mesh->vertices + 1], sizeof *found->key, mesh->name, &found->key));
    for (int64_t t = 0; t < mesh->triangles; t++)
        for (int k = skg_mesh_welded(mesh, t, corner) ? items(t, corner, vertex, key) : 0; k-- > 0;)
            found->key[found->start[vertex[k] + 1]++] = key[k];
    for (int64_t v = 0; v < mesh->vertices; v++)
        sort_keys(found->key + found->start[v], found->start[v + 1] - found->start[v]);
    return SKG_OK;
cleanup:
    skg_mesh_groups_free(found);
    return status;
}

skg_status skg_mesh_group_edges(const skg_mesh *mesh, skg_mesh_groups *found) {
    return group(mesh, edges_of, found);
}

skg_status skg_mesh_group_triangles(const skg_mesh *mesh, skg_mesh_groups *found) {
    return group(mesh, triangle_of, found);
}
