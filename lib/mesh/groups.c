/* Named pieces of mesh files: groups and objects of OBJ, objects of 3MF, nodes of what Assimp reads. */
#include "mesh/mesh.h"

#include "core/text.h"

#include <inttypes.h>
#include <string.h>

const char *skg_mesh_piece_name(const skg_mesh_piece *piece) {
    return piece->group ? piece->group : piece->object;
}

static int has_name(const skg_mesh_piece *piece, const char *name) {
    return (piece->group && strcmp(piece->group, name) == 0) ||
           (piece->object && strcmp(piece->object, name) == 0);
}

static skg_status fail(const skg_mesh_arrays *arrays, const char *path, const char *name) {
    const char **names = NULL;
    int64_t count = 0;
    SKG_TRY(skg_alloc(2 * arrays->piece_count, sizeof *names, path, &names));
    for (int64_t i = 0; i < arrays->piece_count; i++) {
        if (arrays->pieces[i].group) names[count++] = arrays->pieces[i].group;
        if (arrays->pieces[i].object) names[count++] = arrays->pieces[i].object;
    }
    const char *near = count ? skg_nearest_name(name, names, count) : NULL;
    skg_fail(SKG_ERR_MESH, "%s: no group \"%s\"%s%s%s; `skiagraph mesh FILE --groups` lists them", path, name,
             near ? ", did you mean \"" : "", near ? near : "", near ? "\"?" : "");
    skg_free(&names);
    return SKG_ERR_MESH;
}

skg_status skg_mesh_drop_unused(skg_mesh_arrays *arrays, const char *path) {
    int32_t *number = NULL; /* of each vertex, and 1 more; 0: not used */
    int64_t count = 0;
    SKG_TRY(skg_alloc(arrays->vertices, sizeof *number, path, &number));
    for (int64_t i = 0; i < 3 * arrays->triangles; i++) {
        const int32_t corner = arrays->corners[i];
        if (corner < 0 ||
            corner >=
                arrays
                    ->vertices) { /* no mesh is made of it, and the refusal counts the vertices of the file */
            skg_free(&number);
            return SKG_OK;
        }
        number[corner] = 1;
    }
    for (int64_t v = 0; v < arrays->vertices; v++) {
        if (!number[v]) continue;
        memmove(arrays->positions + 3 * count, arrays->positions + 3 * v, 3 * sizeof(double));
        number[v] = (int32_t)++count;
    }
    for (int64_t i = 0; i < 3 * arrays->triangles; i++) arrays->corners[i] = number[arrays->corners[i]] - 1;
    arrays->unused = arrays->vertices - count;
    arrays->vertices = count;
    skg_free(&number);
    return SKG_OK;
}

skg_status skg_mesh_keep_group(skg_mesh_arrays *arrays, const char *path, const char *name) {
    int64_t kept = 0, found = 0;
    for (int64_t i = 0; i < arrays->piece_count; i++) {
        const skg_mesh_piece *piece = &arrays->pieces[i];
        const int64_t end = i + 1 < arrays->piece_count ? piece[1].first : arrays->triangles;
        if (!has_name(piece, name)) continue;
        found++;
        memmove(arrays->corners + 3 * kept, arrays->corners + 3 * piece->first,
                (size_t)(end - piece->first) * 3 * sizeof *arrays->corners);
        kept += end - piece->first;
    }
    if (!found) return fail(arrays, path, name);
    arrays->triangles = kept;
    return SKG_OK;
}
