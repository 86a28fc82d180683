#include "mesh/arrays.h"

#include <inttypes.h>
#include <string.h>

void skg_mesh_arrays_free(skg_mesh_arrays *arrays) {
    skg_free(&arrays->positions);
    skg_free(&arrays->corners);
    *arrays = (skg_mesh_arrays){0};
}

/* Makes sure that one item more fits. */
static skg_status grow(int64_t count, int64_t *capacity, size_t size, void *array_address) {
    if (count < *capacity) return SKG_OK;
    int64_t more = *capacity < 512 ? 1024 : 2 * *capacity;
    SKG_TRY(skg_realloc(more, size, "mesh", array_address));
    *capacity = more;
    return SKG_OK;
}

skg_status skg_mesh_add_vertex(skg_mesh_arrays *arrays, const double position[3]) {
    SKG_TRY(grow(arrays->vertices, &arrays->vertex_capacity, 3 * sizeof(double), &arrays->positions));
    memcpy(arrays->positions + 3 * arrays->vertices++, position, 3 * sizeof(double));
    return SKG_OK;
}

skg_status skg_mesh_add_corner(skg_mesh_arrays *arrays, skg_polygon *polygon, int64_t vertex) {
    if (vertex < 0 || vertex >= SKG_MESH_LIMIT)
        return skg_fail(SKG_ERR_MESH, "triangle %" PRId64 " names vertex %" PRId64 ", which no mesh has",
                        arrays->triangles, vertex);
    if (polygon->corners++ == 0) polygon->first = (int32_t)vertex;
    if (polygon->corners >= 3) {
        SKG_TRY(grow(arrays->triangles, &arrays->triangle_capacity, 3 * sizeof(int32_t), &arrays->corners));
        int32_t *corner = arrays->corners + 3 * arrays->triangles++;
        corner[0] = polygon->first, corner[1] = polygon->last, corner[2] = (int32_t)vertex;
    }
    polygon->last = (int32_t)vertex;
    return SKG_OK;
}
