/* A mesh with its pose, as geometry reads it. */
#include "geometry/overlaps.h"

#include "core/maths.h"

skg_status skg_solid_place(const skg_mesh *mesh, const double pose[16], int64_t inside, skg_solid *solid,
                           double **positions) {
    *solid = (skg_solid){.inside = inside};
    if (!mesh->closed) return SKG_OK;
    SKG_TRY(skg_alloc(mesh->vertices * 3, sizeof **positions, "closed surfaces", positions));
    for (int64_t v = 0; v < mesh->vertices; v++) {
        double at[3];
        skg_mesh_vertex(mesh, v, at);
        skg_pose_point(pose, at, *positions + 3 * v);
    }
    *solid = (skg_solid){.vertices = mesh->vertices,
                         .triangles = mesh->triangles,
                         .positions = *positions,
                         .corners = mesh->corners,
                         .inside = inside,
                         .inward = (skg_pose_determinant(pose) < 0) != (mesh->orientation < 0)};
    return SKG_OK;
}
