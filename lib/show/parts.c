#include "show/parts.h"

#include "core/vector.h"
#include "mesh/mesh.h"

#include <inttypes.h>

/* Faces at a corner that differ by more than 45 degrees meet in a crease; others are shaded as one smooth surface. */
static const double CREASE = 0.70710678118654752;

/* One part while it is added. */
typedef struct {
    const skg_mesh *mesh;
    const skg_scene_part_data *part;
    double *faces;   /* [triangles][4] normals of length 1, and the area */
    int32_t *starts; /* [vertices + 1] of the triangles around each vertex */
    int32_t *around; /* [3 * triangles] */
} surface;

static int64_t place_of(const surface *s, int64_t corner) {
    const int64_t vertex = s->mesh->corners[corner];
    return s->mesh->weld ? s->mesh->weld[vertex] : vertex;
}

static skg_status list_faces(surface *s) {
    const int64_t vertices = s->mesh->vertices, corners = 3 * s->mesh->triangles;
    SKG_TRY(skg_alloc(vertices + 2, sizeof *s->starts, "faces of vertices", &s->starts));
    SKG_TRY(skg_alloc(corners, sizeof *s->around, "faces of vertices", &s->around));
    SKG_TRY(skg_alloc(4 * s->mesh->triangles, sizeof *s->faces, "normals of faces", &s->faces));
    /* counted two places higher, so that after filling starts[v] is where the list of v begins */
    for (int64_t i = 0; i < corners; i++) s->starts[place_of(s, i) + 2]++;
    for (int64_t v = 0; v < vertices; v++) s->starts[v + 2] += s->starts[v + 1];
    for (int64_t i = 0; i < corners; i++) s->around[s->starts[place_of(s, i) + 1]++] = (int32_t)(i / 3);
    return SKG_OK;
}

/* The normal of a triangle, of length 1 or 0, and its area. */
static void find_normal(const skg_mesh *mesh, const double *pose, int64_t triangle, double normal[4]) {
    double at[3][3], world[3][3], ab[3], ac[3];
    for (int k = 0; k < 3; k++) {
        skg_mesh_vertex(mesh, mesh->corners[3 * triangle + k], at[k]);
        skg_pose_point(pose, at[k], world[k]);
    }
    skg_add_scaled(world[1], -1, world[0], ab);
    skg_add_scaled(world[2], -1, world[0], ac);
    skg_cross(ab, ac, normal);
    const double length = skg_length(normal);
    if (length > 0) skg_scale_vector(1 / length, normal, normal);
    normal[3] = 0.5 * length;
}

/* The normal at a corner: of the faces around it that make no crease with the corner's own, each with its area. */
static void corner_normal(const surface *s, int64_t corner, double normal[3]) {
    const double *own = s->faces + 4 * (corner / 3);
    const int64_t place = place_of(s, corner);
    double sum[3] = {0, 0, 0};
    for (int32_t i = s->starts[place]; i < s->starts[place + 1]; i++) {
        const double *face = s->faces + 4 * (int64_t)s->around[i];
        if (skg_dot(face, own) >= CREASE) skg_add_scaled(sum, face[3], face, sum);
    }
    const double length = skg_length(sum);
    if (length > 0)
        skg_scale_vector(1 / length, sum, normal);
    else
        normal[0] = 0, normal[1] = 0, normal[2] = 1; /* a triangle without area is not drawn */
}

/* Adds the part's vertices and triangles, for which there is room. */
static skg_status add_surface(skg_show_model *model, surface *s, uint32_t colour) {
    const skg_mesh *mesh = s->mesh;
    const int64_t first = model->vertices;
    SKG_TRY(list_faces(s));
    for (int64_t v = 0; v < mesh->vertices; v++) {
        double at[3], world[3];
        skg_mesh_vertex(mesh, v, at);
        skg_pose_point(s->part->pose, at, world);
        skg_show_model_add_vertex(model, world);
    }
    for (int64_t t = 0; t < mesh->triangles; t++) find_normal(mesh, s->part->pose, t, s->faces + 4 * t);
    for (int64_t t = 0; t < mesh->triangles; t++) {
        int64_t corners[3];
        double normals[3][3];
        for (int k = 0; k < 3; k++) {
            corners[k] = first + mesh->corners[3 * t + k];
            corner_normal(s, 3 * t + k, normals[k]);
        }
        skg_show_model_add_triangle(model, corners, normals, colour);
    }
    return SKG_OK;
}

/* One thread adds all parts: those of OpenMP would spin beside the device's on the same cores. */
skg_status skg_show_parts_add(skg_show_model *model, const skg_scene *scene, const uint8_t *colours) {
    for (int64_t i = 0; i < scene->count; i++) {
        const uint8_t *colour = colours + 4 * i;
        surface s = {.mesh = scene->parts[i].mesh, .part = scene->parts + i};
        if (colour[3] == 0) continue;
        if (s.mesh->first_bad >= 0)
            return skg_fail(SKG_ERR_SCENE,
                            "part %s: vertex %" PRId64 " is not finite; correct it or leave the part out",
                            s.part->label, s.mesh->first_bad);
        SKG_TRY(skg_show_model_reserve(model, s.mesh->vertices, s.mesh->triangles));
        const skg_status status =
            add_surface(model, &s, SKG_SHOW_COLOUR(colour[0], colour[1], colour[2], colour[3]));
        skg_free(&s.faces);
        skg_free(&s.starts);
        skg_free(&s.around);
        SKG_TRY(status);
    }
    return SKG_OK;
}

void skg_show_part_bounds(const skg_scene_part_data *part, double low[3], double high[3]) {
    float lowest[3], highest[3];
    int64_t bad;
    skg_mesh_bounds(part->mesh, lowest, highest, &bad);
    if (part->mesh->vertices == 0 || !(lowest[0] <= highest[0])) return;
    for (int corner = 0; corner < 8; corner++) {
        double at[3], world[3];
        for (int k = 0; k < 3; k++)
            at[k] = part->mesh->origin[k] + (double)(corner >> k & 1 ? highest[k] : lowest[k]);
        skg_pose_point(part->pose, at, world);
        for (int k = 0; k < 3; k++) low[k] = fmin(low[k], world[k]), high[k] = fmax(high[k], world[k]);
    }
}
