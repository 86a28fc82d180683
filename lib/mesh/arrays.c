/* Vertices and triangles of a mesh while it is read or made. */
#include "mesh/arrays.h"

#include <inttypes.h>
#include <string.h>

void skg_mesh_arrays_free(skg_mesh_arrays *arrays) {
    skg_free(&arrays->positions);
    skg_free(&arrays->corners);
    for (int64_t i = 0; i < arrays->piece_count; i++) {
        skg_free(&arrays->pieces[i].object);
        skg_free(&arrays->pieces[i].group);
    }
    skg_free(&arrays->pieces);
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

/* A piece without triangles is begun anew. */
static skg_status begin(skg_mesh_arrays *arrays, const char *object, const char *group) {
    skg_mesh_piece piece = {.first = arrays->triangles};
    SKG_TRY(grow(arrays->piece_count, &arrays->piece_capacity, sizeof *arrays->pieces, &arrays->pieces));
    skg_status status = skg_copy_text(object, &piece.object);
    if (status == SKG_OK) status = skg_copy_text(group, &piece.group);
    if (status != SKG_OK) {
        skg_free(&piece.object);
        return status;
    }
    skg_mesh_piece *last = arrays->piece_count ? &arrays->pieces[arrays->piece_count - 1] : NULL;
    if (last && last->first == arrays->triangles) {
        skg_free(&last->object);
        skg_free(&last->group);
        *last = piece;
    } else {
        arrays->pieces[arrays->piece_count++] = piece;
    }
    return SKG_OK;
}

skg_status skg_mesh_begin_object(skg_mesh_arrays *arrays, const char *name) {
    return begin(arrays, name, NULL);
}

skg_status skg_mesh_begin_group(skg_mesh_arrays *arrays, const char *name) {
    char *object = NULL;
    SKG_TRY(
        skg_copy_text(arrays->piece_count ? arrays->pieces[arrays->piece_count - 1].object : NULL, &object));
    const skg_status status = begin(arrays, object, name);
    skg_free(&object);
    return status;
}
