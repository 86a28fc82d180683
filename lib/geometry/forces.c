#include "geometry/forces.h"

#include "core/parallel.h"
#include "core/vector.h"

#include <string.h>

/* Faces that are added up together. The sums of chunks are added in their order, so that the number of threads changes no bit. */
enum { CHUNK = 4096, FEW_CHUNKS = 8 }; /* threads take as long to start as a few chunks */

typedef struct {
    const skg_face_moments *faces;
    skg_force_sums *chunks;
    double *vertices;
} forces_run;

/* A corner of a face: its vertex, its place in the world, and (t i, t j, t) or (i, j, t - 1). */
typedef struct {
    int64_t vertex;
    double at[3], seen[3];
} face_corner;

static void find_corner(const skg_face_moments *faces, int32_t number, face_corner *corner) {
    double local[3];
    corner->vertex = faces->source ? faces->source[number] : number;
    skg_mesh_vertex(faces->mesh, corner->vertex, local);
    for (int r = 0; r < 3; r++) corner->at[r] = skg_dot(faces->pose + 4 * r, local) + faces->pose[4 * r + 3];
    skg_camera_see(faces->camera, corner->at, corner->seen);
}

/* Adds the force at one corner. */
static void add_force(const skg_face_moments *faces, const face_corner *corner, const double force[3],
                      skg_force_sums *sums, double *vertices) {
    const skg_camera *camera = faces->camera;
    double torque[3], pixel[3];
    const double along = corner->seen[2];
    skg_cross(corner->at, force, torque);
    /* x = s + t (p - s), so t p = x - (1 - t) s; with a parallel beam p = x - (t - 1) d. */
    for (int k = 0; k < 3; k++)
        pixel[k] =
            corner->at[k] - (camera->parallel ? along * camera->first[k] : (1 - along) * camera->origin[k]);
    double turned[3];
    skg_cross(pixel, force, turned);
    for (int k = 0; k < 3; k++) {
        sums->force[k] += force[k];
        sums->torque[k] += torque[k];
        sums->along[k] += along * force[k];
        sums->pixel_torque[k] += turned[k];
    }
    for (int k = 0; vertices && k < 3; k++)
        vertices[3 * corner->vertex + k] +=
            faces->pose[k] * force[0] + faces->pose[4 + k] * force[1] + faces->pose[8 + k] * force[2];
}

/* A face that contains rays. Its normal is turned outward: the mesh grows where it moves along it. */
static void add_edge_on(const skg_face_moments *faces, const face_corner corners[3], const double normal[3],
                        skg_force_sums *sums, double *vertices) {
    double seen[3][3], moments[3] = {0}, across[3], force[3];
    for (int k = 0; k < 3; k++) memcpy(seen[k], corners[k].seen, sizeof seen[k]);
    const double *pose = faces->pose;
    const double x[3] = {pose[0], pose[4], pose[8]}, y[3] = {pose[1], pose[5], pose[9]},
                 z[3] = {pose[2], pose[6], pose[10]};
    skg_cross(y, z, across);
    const int outward = (skg_dot(x, across) < 0) == (faces->mesh->orientation < 0);
    skg_steep_add(faces->camera, seen, faces->weight, faces->weight_user, moments);
    for (int k = 0; k < 3; k++) {
        skg_scale_vector(outward ? moments[k] : -moments[k], normal, force);
        if (moments[k] != 0) add_force(faces, &corners[k], force, sums, vertices);
    }
}

static void add_face(const skg_face_moments *faces, int64_t face, skg_force_sums *sums, double *vertices) {
    const int64_t *moments = faces->moments + 3 * face;
    const int parallel = faces->camera->parallel;
    face_corner corners[3];
    double side[2][3], normal[3], from[3];
    if (!moments[0] && !moments[1] && !moments[2]) return;
    for (int k = 0; k < 3; k++) find_corner(faces, faces->corners[3 * face + k], &corners[k]);
    for (int k = 0; k < 2; k++) skg_add_scaled(corners[k + 1].at, -1, corners[0].at, side[k]);
    skg_cross(side[0], side[1], normal);
    if (moments[0] == SKG_EDGE_ON) {
        add_edge_on(faces, corners, normal, sums, vertices);
        return;
    }
    skg_add_scaled(corners[0].at, -1, faces->camera->origin, from);
    const double height = skg_dot(normal, parallel ? faces->camera->first : from);
    const double share[3] = {(double)(moments[0] - moments[1] - moments[2]), (double)moments[1],
                             (double)moments[2]};
    for (int k = 0; k < 3; k++) {
        double force[3];
        const double size = share[k] * faces->unit / (parallel ? height : height * corners[k].seen[2]);
        skg_scale_vector(size, normal, force);
        if (isfinite(size)) add_force(faces, &corners[k], force, sums, vertices);
    }
}

static skg_status add_chunk(void *user, int64_t chunk) {
    const forces_run *run = user;
    const int64_t end = (chunk + 1) * CHUNK, triangles = run->faces->mesh->triangles;
    for (int64_t f = chunk * CHUNK; f < end && f < triangles; f++)
        add_face(run->faces, f, &run->chunks[chunk], run->vertices);
    return SKG_OK;
}

static void add_sums(const skg_force_sums *more, skg_force_sums *sums) {
    for (int k = 0; k < 3; k++) {
        sums->force[k] += more->force[k];
        sums->torque[k] += more->torque[k];
        sums->along[k] += more->along[k];
        sums->pixel_torque[k] += more->pixel_torque[k];
    }
}

skg_status skg_forces_add(const skg_face_moments *faces, skg_force_sums *sums, double *vertices) {
    const int64_t count = (faces->mesh->triangles + CHUNK - 1) / CHUNK;
    forces_run run = {.faces = faces, .vertices = vertices};
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(count, sizeof *run.chunks, "gradient", &run.chunks));
    if (vertices || count < FEW_CHUNKS) /* faces of two chunks share vertices */
        for (int64_t c = 0; c < count; c++) (void)add_chunk(&run, c);
    else
        status = skg_parallel(count, add_chunk, &run);
    for (int64_t c = 0; c < count && status == SKG_OK; c++) add_sums(&run.chunks[c], sums);
    skg_free(&run.chunks);
    return status;
}

skg_status skg_forces_share(const skg_mesh *mesh, double *vertices) {
    int32_t *copies = NULL;
    if (!mesh->weld) return SKG_OK;
    SKG_TRY(skg_alloc(mesh->vertices, sizeof *copies, "gradient", &copies));
    for (int64_t v = 0; v < mesh->vertices; v++) {
        const int64_t first = mesh->weld[v];
        copies[first]++;
        for (int k = 0; k < 3 && first != v; k++) vertices[3 * first + k] += vertices[3 * v + k];
    }
    for (int64_t v = mesh->vertices - 1; v >= 0; v--) {
        const int64_t first = mesh->weld[v];
        for (int k = 0; k < 3; k++) vertices[3 * v + k] = vertices[3 * first + k] / copies[first];
    }
    skg_free(&copies);
    return SKG_OK;
}
