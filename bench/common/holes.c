/* Leaky meshes: copies of closed ones that lack triangles. */
#include "holes.h"

#include <stdlib.h>
#include <string.h>

skg_mesh *bench_mesh_with_holes(skg_context *context, const skg_mesh *mesh, int every, const char *name) {
    int64_t vertices, triangles, kept = 0;
    skg_mesh *leaky = NULL;
    bench_try(skg_mesh_count(mesh, &vertices, &triangles), name);
    double *positions = bench_alloc((size_t)vertices * 3, sizeof *positions);
    int32_t *corners = bench_alloc((size_t)triangles * 3, sizeof *corners);
    bench_try(skg_mesh_positions_get(mesh, positions, 0), name);
    bench_try(skg_mesh_triangles_get(mesh, corners, 0), name);
    for (int64_t t = 0; t < triangles; t++)
        if (t % every != every / 2) memmove(corners + 3 * kept++, corners + 3 * t, 3 * sizeof *corners);
    bench_try(skg_mesh_create(context, name,
                              &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                 .vertices = vertices,
                                                 .positions = positions,
                                                 .triangles = kept,
                                                 .corners = corners,
                                                 .unit_mm = 1},
                              &leaky),
              name);
    free(corners);
    free(positions);
    return leaky;
}
