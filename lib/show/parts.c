/* The parts of a scene as triangles of a model. */
#include "show/drawing.h"

#include "core/maths.h"
#include "mesh/mesh.h"

#include <inttypes.h>

/* Squared cosines. Faces at a corner that differ by more than 45 degrees meet in a crease; others are shaded as one smooth
 * surface. Faces that differ by at most half of that from one direction make no crease with each other. */
static const double CREASE = 0.5, SMOOTH = 0.85355339059327376;

/* One part while it is added. */
typedef struct {
    const skg_mesh *mesh;
    const double *pose;
    double *world; /* [vertices][3] mm */
    double *faces; /* [triangles][4] normals as long as twice the area, and the square of that */
    /* [vertices][3] normal of length 1 that all faces around a vertex share; 0 where they do not */
    double *smooth;
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
    SKG_TRY(skg_alloc(3 * vertices, sizeof *s->world, "places of vertices", &s->world));
    SKG_TRY(skg_alloc(3 * vertices, sizeof *s->smooth, "normals of vertices", &s->smooth));
    SKG_TRY(skg_alloc(4 * s->mesh->triangles, sizeof *s->faces, "normals of faces", &s->faces));
    /* counted two places higher, so that after filling starts[v] is where the list of v begins */
    for (int64_t i = 0; i < corners; i++) s->starts[place_of(s, i) + 2]++;
    for (int64_t v = 0; v < vertices; v++) s->starts[v + 2] += s->starts[v + 1];
    for (int64_t i = 0; i < corners; i++) s->around[s->starts[place_of(s, i) + 1]++] = (int32_t)(i / 3);
    return SKG_OK;
}

static void find_normal(const surface *s, int64_t triangle, double normal[4]) {
    const int32_t *corner = s->mesh->corners + 3 * triangle;
    const double *a = s->world + 3 * (int64_t)corner[0];
    double ab[3], ac[3];
    skg_add_scaled(s->world + 3 * (int64_t)corner[1], -1, a, ab);
    skg_add_scaled(s->world + 3 * (int64_t)corner[2], -1, a, ac);
    skg_cross(ab, ac, normal);
    normal[3] = skg_dot(normal, normal);
}

/* Whether the angle between a face and another normal, of that squared length, has at least that squared cosine. */
static int is_near(const double *face, const double *normal, double length2, double cosine2) {
    const double product = skg_dot(face, normal);
    return product > 0 && product * product >= cosine2 * length2 * face[3];
}

/* The normal of the faces around a place, each with its area: of all, or of those that make no crease with `own`. Returns
 * 0 if they have none. */
static int mean_normal(const surface *s, int64_t place, const double *own, double normal[3]) {
    double sum[3] = {0, 0, 0};
    for (int32_t i = s->starts[place]; i < s->starts[place + 1]; i++) {
        const double *face = s->faces + 4 * (int64_t)s->around[i];
        if (!own || is_near(face, own, own[3], CREASE)) skg_add_scaled(sum, 1, face, sum);
    }
    const double length = skg_length(sum);
    if (length > 0) skg_scale_vector(1 / length, sum, normal);
    return length > 0;
}

/* Finds a normal for all corners at a place at once, where no two of its faces make a crease. */
static void find_smooth(surface *s, int64_t place) {
    double *normal = s->smooth + 3 * place;
    int smooth = mean_normal(s, place, NULL, normal);
    for (int32_t i = s->starts[place]; smooth && i < s->starts[place + 1]; i++)
        smooth = is_near(s->faces + 4 * (int64_t)s->around[i], normal, 1, SMOOTH);
    if (!smooth) normal[0] = 0, normal[1] = 0, normal[2] = 0;
}

static void corner_normal(const surface *s, int64_t corner, double normal[3]) {
    const int64_t place = place_of(s, corner);
    const double *smooth = s->smooth + 3 * place;
    if (smooth[0] != 0 || smooth[1] != 0 || smooth[2] != 0)
        normal[0] = smooth[0], normal[1] = smooth[1], normal[2] = smooth[2];
    else if (!mean_normal(s, place, s->faces + 4 * (corner / 3), normal))
        normal[0] = 0, normal[1] = 0, normal[2] = 1; /* a triangle without area is not drawn */
}

/* Adds the part's vertices and triangles, for which there is room. */
static skg_status add_surface(skg_show_model *model, surface *s, uint32_t colour) {
    const skg_mesh *mesh = s->mesh;
    const int64_t first = model->vertices;
    SKG_TRY(list_faces(s));
    for (int64_t v = 0; v < mesh->vertices; v++) {
        double at[3], *world = s->world + 3 * v;
        skg_mesh_vertex(mesh, v, at);
        skg_pose_point(s->pose, at, world);
        skg_show_model_add_vertex(model, world);
    }
    for (int64_t t = 0; t < mesh->triangles; t++) find_normal(s, t, s->faces + 4 * t);
    for (int64_t v = 0; v < mesh->vertices; v++) find_smooth(s, v);
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

static void free_surface(surface *s) {
    skg_free(&s->world);
    skg_free(&s->faces);
    skg_free(&s->smooth);
    skg_free(&s->starts);
    skg_free(&s->around);
}

/* One thread adds all parts: those of OpenMP would spin beside the device's on the same cores. */
skg_status skg_show_parts_add(skg_show_model *model, const skg_scene *scene, const skg_look *look,
                              const skg_show_camera *camera) {
    for (int64_t i = 0; i < scene->count; i++) {
        const uint8_t *colour = look->colours + 4 * i;
        surface s = {.mesh = scene->parts[i].mesh, .pose = skg_show_pose_of(scene, look, i)};
        if (colour[3] == 0) continue;
        if (s.mesh->first_bad >= 0)
            return skg_fail(SKG_ERR_SCENE,
                            "part %s: vertex %" PRId64 " is not finite; correct it or leave the part out",
                            scene->parts[i].label, s.mesh->first_bad);
        SKG_TRY(skg_show_model_reserve(model, s.mesh->vertices, s.mesh->triangles));
        const skg_status status =
            add_surface(model, &s, SKG_SHOW_COLOUR(colour[0], colour[1], colour[2], colour[3]));
        free_surface(&s);
        SKG_TRY(status);
    }
    SKG_TRY(skg_show_clip_near(model, camera, 0));
    if (!look->cut) return SKG_OK;
    SKG_TRY(skg_show_clip(model, 0, look->cut));
    model->sections = model->triangles;
    return SKG_OK;
}

const double *skg_show_pose_of(const skg_scene *scene, const skg_look *look, int64_t part) {
    SKG_ASSERT(0 <= part && part < scene->count);
    return look->poses ? look->poses + 16 * part : scene->parts[part].pose;
}

void skg_show_part_bounds(const skg_mesh *mesh, const double *pose, double low[3], double high[3]) {
    float lowest[3], highest[3];
    int64_t bad;
    skg_mesh_bounds(mesh, lowest, highest, &bad);
    if (mesh->vertices == 0 || !(lowest[0] <= highest[0])) return;
    for (int corner = 0; corner < 8; corner++) {
        double at[3], world[3];
        for (int k = 0; k < 3; k++)
            at[k] = mesh->origin[k] + (double)(corner >> k & 1 ? highest[k] : lowest[k]);
        skg_pose_point(pose, at, world);
        for (int k = 0; k < 3; k++) low[k] = fmin(low[k], world[k]), high[k] = fmax(high[k], world[k]);
    }
}
