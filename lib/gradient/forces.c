/* Derivatives of a loss by what moves, from the moments of faces (kernels/gradient/gradient.cl). */
#include "gradient/forces.h"

#include "core/maths.h"
#include "core/threads.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Faces that are added up together. The sums of chunks are added in their order, so that the number of threads changes no bit. */
enum { CHUNK = 4096 };

/* Camera and beam in the axes of a mesh. The places of corners are taken from `origin`. */
typedef struct {
    double inverse[3][3]; /* of the linear part of the pose */
    double origin[3], first[3], column[3], row[3];
    double beam[3]; /* parallel: d */
} local_camera;

/* Sums over faces in the axes of a mesh and in units of a moment, of which those of the world follow. With u = n / h, or n / n . d, the
 * moments m of a face, its length s, t or t - 1 summed over its hits, and what it pushes. */
typedef struct {
    double length, push[3];    /* of s, of s u */
    double moments[3][3];      /* of m u: [moment][axis] */
    skg_force_sums of_edge_on; /* in the world's axes */
} local_sums;

/* Consecutive faces of one part, or the vertices of one. */
typedef struct {
    int64_t part, first, end, of_vertices;
    local_sums sums;
} face_chunk;

typedef struct {
    const skg_face_moments *parts;
    double *const *vertices;
    local_camera *cameras;
    face_chunk *chunks;
} forces_run;

/* --- faces that rays contain */

/* A corner of a face: its vertex, its place in the world, and (t i, t j, t) or (i, j, t - 1). */
typedef struct {
    int64_t vertex;
    double at[3], seen[3];
} face_corner;

static int64_t vertex_of(const skg_face_moments *faces, int64_t face, int corner) {
    const int32_t number = faces->corners[3 * face + corner];
    return faces->source ? faces->source[number] : number;
}

static void find_corner(const skg_face_moments *faces, int64_t vertex, face_corner *corner) {
    double local[3];
    corner->vertex = vertex;
    skg_mesh_vertex(faces->mesh, vertex, local);
    for (int r = 0; r < 3; r++) corner->at[r] = skg_dot(faces->pose + 4 * r, local) + faces->pose[4 * r + 3];
    skg_camera_see(faces->camera, corner->at, corner->seen);
}

/* Adds the force at one corner. */
static void add_force(const skg_face_moments *faces, const face_corner *corner, const double force[3],
                      skg_force_sums *sums, double *vertices) {
    double torque[3];
    skg_cross(corner->at, force, torque);
    for (int k = 0; k < 3; k++) {
        sums->force[k] += force[k];
        sums->torque[k] += torque[k];
        sums->along[k] += corner->seen[2] * force[k];
    }
    for (int k = 0; vertices && k < 3; k++)
        vertices[3 * corner->vertex + k] +=
            faces->pose[k] * force[0] + faces->pose[4 + k] * force[1] + faces->pose[8 + k] * force[2];
}

void skg_face_outward(const skg_face_moments *faces, double at[3][3], double normal[3]) {
    const double *pose = faces->pose;
    const double x[3] = {pose[0], pose[4], pose[8]}, y[3] = {pose[1], pose[5], pose[9]},
                 z[3] = {pose[2], pose[6], pose[10]};
    double side[2][3], across[3];
    for (int k = 0; k < 2; k++) skg_add_scaled(at[k + 1], -1, at[0], side[k]);
    skg_cross(side[0], side[1], normal);
    skg_cross(y, z, across);
    const int outward = (skg_dot(x, across) < 0) == (faces->mesh->orientation < 0);
    if (!outward) skg_scale_vector(-1, normal, normal);
}

/* A face that contains rays. */
static skg_status add_edge_on(const skg_face_moments *faces, int64_t face, skg_force_sums *sums,
                              double *vertices) {
    face_corner corners[3];
    double at[3][3], seen[3][3], moments[3] = {0}, force[3], normal[3];
    for (int k = 0; k < 3; k++) {
        find_corner(faces, vertex_of(faces, face, k), &corners[k]);
        memcpy(at[k], corners[k].at, sizeof at[k]);
        memcpy(seen[k], corners[k].seen, sizeof seen[k]);
    }
    skg_face_outward(faces, at, normal);
    SKG_TRY(skg_steep_add(faces->camera, seen, faces->weigh, faces->weigh_user, moments));
    for (int k = 0; k < 3; k++) {
        skg_scale_vector(moments[k], normal, force);
        if (moments[k] != 0) add_force(faces, &corners[k], force, sums, vertices);
    }
    return SKG_OK;
}

/* --- all others */

/* Takes a vector of the world into the axes of the mesh. */
static void turn_to_mesh(const local_camera *local, const double *vector, double *turned) {
    for (int r = 0; r < 3; r++) turned[r] = skg_dot(local->inverse[r], vector);
}

static void find_camera(const skg_face_moments *faces, local_camera *local) {
    const skg_camera *camera = faces->camera;
    const double *pose = faces->pose;
    const double x[3] = {pose[0], pose[4], pose[8]}, y[3] = {pose[1], pose[5], pose[9]},
                 z[3] = {pose[2], pose[6], pose[10]};
    double from[3], first[3];
    skg_cross(y, z, local->inverse[0]);
    skg_cross(z, x, local->inverse[1]);
    skg_cross(x, y, local->inverse[2]);
    const double determinant = skg_dot(x, local->inverse[0]);
    for (int r = 0; r < 3; r++) {
        skg_scale_vector(1 / determinant, local->inverse[r], local->inverse[r]);
        from[r] = camera->origin[r] - pose[4 * r + 3];
        first[r] = (camera->parallel ? 0 : camera->first[r]) + (double)faces->pixel[0] * camera->column[r] +
                   (double)faces->pixel[1] * camera->row[r];
    }
    turn_to_mesh(local, from, local->origin);
    turn_to_mesh(local, first, local->first);
    turn_to_mesh(local, camera->column, local->column);
    turn_to_mesh(local, camera->row, local->row);
    turn_to_mesh(local, camera->first, local->beam);
}

void skg_face_planes_find(const skg_mesh *mesh, const int32_t *corners, const int32_t *source,
                          double *planes) {
    for (int64_t face = 0; face < mesh->triangles; face++) {
        double at[3][3], side[2][3];
        for (int k = 0; k < 3; k++) {
            const int32_t number = corners[3 * face + k];
            skg_mesh_vertex(mesh, source ? source[number] : number, at[k]);
        }
        for (int k = 0; k < 2; k++) skg_add_scaled(at[k + 1], -1, at[0], side[k]);
        skg_cross(side[0], side[1], planes + 4 * face);
        planes[4 * face + 3] = skg_dot(planes + 4 * face, at[0]);
    }
}

enum { BLOCK = 64, LANES = 4 }; /* faces that are worked out together; sums that do not wait for each other */

/* Faces seen from the camera's origin, one a column: normals, then n / h, or n / n . d; moments, of weight t^2, and of that times D, or with
 * a parallel beam of weight, and of that times the pixel; and lengths. */
typedef struct {
    double normal[3][BLOCK], moments[3][BLOCK], plane[BLOCK], length[BLOCK];
} face_block;

/* Takes faces `first` to end - 1. Those that rays contain, and what is behind the end, have moments of 0. Returns whether there are
 * faces that rays contain. */
static int take_block(const skg_face_moments *faces, int64_t first, int64_t end, face_block *block) {
    int edges = 0;
    for (int64_t i = 0; i < BLOCK; i++) {
        const int64_t face = first + i < end ? first + i : end - 1;
        const int64_t *moments = faces->moments + 4 * face;
        const double *plane = faces->planes + 4 * face;
        const int edge_on = moments[0] == SKG_EDGE_ON;
        const double counts = first + i < end && !edge_on ? 1 : 0;
        edges |= edge_on;
        block->plane[i] = plane[3];
        for (int c = 0; c < 3; c++) {
            block->normal[c][i] = plane[c];
            block->moments[c][i] = counts * (double)moments[c];
        }
    }
    return edges;
}

/* 1 / t = n . D / h; with a parallel beam t - 1 = n . (v_0 - p) / h, and hits lie behind their pixels by as much. Faces that
 * contain the source push nothing. */
static void see_block(const local_camera *camera, int parallel, face_block *block) {
    const double *o = camera->origin, *d = camera->beam, *f = camera->first, *c = camera->column,
                 *r = camera->row;
    double *x = block->normal[0], *y = block->normal[1], *z = block->normal[2];
    const double *m0 = block->moments[0], *m1 = block->moments[1], *m2 = block->moments[2];
    const double sign = parallel ? -1 : 1, way = parallel ? 1 : 0;
    for (int i = 0; i < BLOCK; i++) {
        const double height = block->plane[i] - (x[i] * o[0] + y[i] * o[1] + z[i] * o[2]);
        const double across = parallel ? x[i] * d[0] + y[i] * d[1] + z[i] * d[2] : height;
        const double inverse = fabs(across) >= DBL_MIN ? 1 / across : 0;
        const double to_first = x[i] * f[0] + y[i] * f[1] + z[i] * f[2];
        const double to_column = x[i] * c[0] + y[i] * c[1] + z[i] * c[2];
        const double to_row = x[i] * r[0] + y[i] * r[1] + z[i] * r[2];
        const double depth = m0[i] * to_first + m1[i] * to_column + m2[i] * to_row;
        block->length[i] = (sign * depth + way * (m0[i] * height)) * inverse;
        x[i] *= inverse, y[i] *= inverse, z[i] *= inverse;
    }
}

/* The sum of products, in lanes. */
static double sum_products(const double a[BLOCK], const double b[BLOCK]) {
    double lanes[LANES] = {0};
    for (int i = 0; i < BLOCK; i += LANES)
        for (int k = 0; k < LANES; k++) lanes[k] += a[i + k] * b[i + k];
    return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

static void add_block(const face_block *block, local_sums *sums) {
    double lanes[LANES] = {0};
    for (int i = 0; i < BLOCK; i += LANES)
        for (int k = 0; k < LANES; k++) lanes[k] += block->length[i + k];
    sums->length += (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
    for (int c = 0; c < 3; c++) {
        sums->push[c] += sum_products(block->length, block->normal[c]);
        for (int m = 0; m < 3; m++) sums->moments[m][c] += sum_products(block->moments[m], block->normal[c]);
    }
}

static skg_status add_faces(const skg_face_moments *faces, const local_camera *camera, int64_t first,
                            int64_t end, local_sums *sums) {
    face_block block;
    const int edges = take_block(faces, first, end, &block);
    for (int64_t f = first; edges && f < end; f++)
        if (faces->moments[4 * f] == SKG_EDGE_ON) SKG_TRY(add_edge_on(faces, f, &sums->of_edge_on, NULL));
    see_block(camera, faces->camera->parallel, &block);
    add_block(&block, sums);
    return SKG_OK;
}

/* --- vertices */

/* The derivative by corner k is n over h times the sum of weight lambda_k t^2 / t_k. lambda_k / t_k is D . (v_i x v_j) over h,
 * with a parallel beam it is ((v_i - p) x (v_j - p)) . d over h; i and j are the other corners. */
static void add_vertices(const skg_face_moments *faces, const local_camera *camera, int64_t face,
                         double *vertices) {
    const int64_t *moments = faces->moments + 4 * face;
    const double *plane = faces->planes + 4 * face, moment = (double)moments[0];
    const double height =
        faces->camera->parallel ? skg_dot(plane, camera->beam) : plane[3] - skg_dot(plane, camera->origin);
    double corner[3][3], place[3];
    int64_t number[3];
    if (!(fabs(height) >= DBL_MIN)) return;
    for (int k = 0; k < 3; k++) {
        number[k] = vertex_of(faces, face, k);
        for (int c = 0; c < 3; c++) /* a position that has just been stored would be slow to load again */
            corner[k][c] = skg_mesh_coordinate(faces->mesh, number[k], c) - camera->origin[c];
        place[k] = moment * camera->first[k] + (double)moments[1] * camera->column[k] +
                   (double)moments[2] * camera->row[k];
    }
    const double unit = faces->unit / (height * height);
    for (int k = 0; k < 3; k++) {
        const double *a = corner[(k + 1) % 3], *b = corner[(k + 2) % 3];
        double across[3], side[3], turned[3];
        skg_cross(a, b, across);
        double share = skg_dot(place, across);
        if (faces->camera->parallel) {
            skg_add_scaled(b, -1, a, side);
            skg_cross(side, camera->beam, turned);
            share = skg_dot(across, camera->beam) * moment - skg_dot(place, turned);
        }
        double *at = vertices + 3 * number[k];
        for (int c = 0; c < 3; c++) at[c] += plane[c] * (share * unit);
    }
}

/* Adds the forces on the faces of a part to its vertices, which faces share. */
static skg_status add_part(const skg_face_moments *faces, const local_camera *camera, double *vertices) {
    skg_force_sums again = {.force = {0}}; /* of faces that rays contain, which add_faces has */
    for (int64_t f = 0; f < faces->mesh->triangles; f++) {
        const int64_t *moments = faces->moments + 4 * f;
        if (moments[0] == SKG_EDGE_ON)
            SKG_TRY(add_edge_on(faces, f, &again, vertices));
        else if (moments[0] | moments[1] | moments[2])
            add_vertices(faces, camera, f, vertices);
    }
    return SKG_OK;
}

static skg_status add_chunk(void *user, int64_t number) {
    const forces_run *run = user;
    face_chunk *chunk = &run->chunks[number];
    const skg_face_moments *faces = &run->parts[chunk->part];
    const local_camera *camera = &run->cameras[chunk->part];
    if (chunk->of_vertices) return add_part(faces, camera, run->vertices[chunk->part]);
    for (int64_t f = chunk->first; f < chunk->end; f += BLOCK)
        SKG_TRY(add_faces(faces, camera, f, f + BLOCK < chunk->end ? f + BLOCK : chunk->end, &chunk->sums));
    return SKG_OK;
}

/* --- the parts */

/* Lists what is done by itself, in chunks, which may be NULL: first the vertices of parts, then the sums over faces. Returns its
 * number. */
static int64_t divide(int64_t count, const forces_run *run, face_chunk *chunks) {
    int64_t made = 0;
    for (int64_t p = 0; run->vertices && p < count; p++)
        if (run->vertices[p] && run->parts[p].moments) {
            if (chunks) chunks[made] = (face_chunk){.part = p, .of_vertices = 1};
            made++;
        }
    for (int64_t p = 0; p < count; p++) {
        const int64_t triangles = run->parts[p].moments ? run->parts[p].mesh->triangles : 0;
        for (int64_t first = 0; first < triangles; first += CHUNK, made++)
            if (chunks)
                chunks[made] = (face_chunk){
                    .part = p, .first = first, .end = first + CHUNK < triangles ? first + CHUNK : triangles};
    }
    return made;
}

/* Adds the sums of a chunk, which count units, to those of its part, in the world's axes. */
static void add_sums(const local_sums *more, const skg_face_moments *faces, const local_camera *camera,
                     skg_force_sums *sums) {
    const double unit = faces->unit;
    const int parallel = faces->camera->parallel;
    const double *force_of_mesh = parallel ? more->moments[0] : more->push;
    const double *along_of_mesh = parallel ? more->push : more->moments[0];
    double world[3][3], local[3][3], turn[3][3], torque[3], force[3], along[3];
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++)
            local[r][k] = camera->first[r] * more->moments[0][k] + camera->column[r] * more->moments[1][k] +
                          camera->row[r] * more->moments[2][k] +
                          (parallel ? camera->beam[r] * more->push[k] : 0);
    for (int r = 0; r < 3; r++) {
        force[r] = along[r] = 0;
        for (int k = 0; k < 3; k++) {
            force[r] += camera->inverse[k][r] * force_of_mesh[k];
            along[r] += camera->inverse[k][r] * along_of_mesh[k];
            turn[r][k] = faces->pose[4 * r] * local[0][k] + faces->pose[4 * r + 1] * local[1][k] +
                         faces->pose[4 * r + 2] * local[2][k];
        }
    }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            world[r][c] = turn[r][0] * camera->inverse[0][c] + turn[r][1] * camera->inverse[1][c] +
                          turn[r][2] * camera->inverse[2][c];
    skg_cross(faces->camera->origin, force, torque);
    sums->length += unit * more->length;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        sums->force[k] += unit * force[k] + more->of_edge_on.force[k];
        sums->along[k] += unit * along[k] + more->of_edge_on.along[k];
        sums->torque[k] += unit * (torque[k] + world[i][j] - world[j][i]) + more->of_edge_on.torque[k];
    }
}

/* x = s + t (p - s), so t p = x - (1 - t) s; with a parallel beam p = x - (t - 1) d. */
static void find_pixel_torque(const skg_camera *camera, skg_force_sums *sums) {
    double lever[3], turned[3];
    for (int k = 0; k < 3; k++)
        lever[k] = camera->parallel ? sums->along[k] : sums->force[k] - sums->along[k];
    skg_cross(camera->parallel ? camera->first : camera->origin, lever, turned);
    for (int k = 0; k < 3; k++) sums->pixel_torque[k] = sums->torque[k] - turned[k];
}

skg_status skg_forces_find(int64_t count, const skg_face_moments *parts, double *const *vertices,
                           skg_force_sums *sums) {
    forces_run run = {.parts = parts, .vertices = vertices};
    skg_status status = SKG_OK;
    const int64_t chunks = divide(count, &run, NULL);
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *run.cameras, "gradient", &run.cameras));
    SKG_TRY_CLEANUP(skg_alloc(chunks, sizeof *run.chunks, "gradient", &run.chunks));
    for (int64_t p = 0; p < count; p++)
        if (parts[p].moments) find_camera(&parts[p], &run.cameras[p]);
    (void)divide(count, &run, run.chunks);
    SKG_TRY_CLEANUP(skg_parallel(chunks, add_chunk, &run));
    for (int64_t p = 0; p < count; p++) sums[p] = (skg_force_sums){.force = {0}};
    for (int64_t c = 0; c < chunks; c++) {
        const int64_t part = run.chunks[c].part;
        add_sums(&run.chunks[c].sums, &parts[part], &run.cameras[part], &sums[part]);
    }
    for (int64_t p = 0; p < count; p++)
        if (parts[p].moments) find_pixel_torque(parts[p].camera, &sums[p]);
cleanup:
    skg_free(&run.cameras);
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
