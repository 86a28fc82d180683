/* Samples and materials of a CTSimU scenario from the parts of a scene. */
#include "setup/scenario_parts.h"
#include "core/core.h"
#include "core/maths.h"
#include "material/material.h"
#include "scene/scene.h"
#include "setup/scenario_json.h"

#include <skiagraph/mesh.h>

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { PATH_LENGTH = 4096 };

/* The surfaces of a sample, in the axes of the stage. */
typedef struct {
    int64_t vertices, triangles;
    double *positions; /* [vertices][3] mm */
    int32_t *corners;  /* [triangles][3] */
} surface;

static void surface_free(surface *s) {
    skg_free(&s->positions);
    skg_free(&s->corners);
}

static double determinant_sign(const double *pose) {
    return skg_pose_determinant(pose) < 0 ? -1 : 1;
}

/* Adds the mesh of a part. inward: with its inside and outside exchanged, as the wall of a cavity */
static skg_status add_mesh(const skg_part *part, const skg_scenario_stage *stage, int inward, surface *s) {
    int64_t vertices = 0, triangles = 0;
    SKG_TRY(skg_mesh_count(part->mesh, &vertices, &triangles));
    if (s->vertices + vertices > INT32_MAX)
        return skg_fail(SKG_ERR_UNSUPPORTED, "part %s: has too many vertices for a scenario", part->label);
    SKG_TRY(
        skg_realloc(s->vertices + vertices, 3 * sizeof *s->positions, "sample of a scenario", &s->positions));
    SKG_TRY(
        skg_realloc(s->triangles + triangles, 3 * sizeof *s->corners, "sample of a scenario", &s->corners));
    double *positions = s->positions + 3 * s->vertices;
    int32_t *corners = s->corners + 3 * s->triangles;
    SKG_TRY(skg_mesh_positions_get(part->mesh, positions, 3));
    SKG_TRY(skg_mesh_triangles_get(part->mesh, corners, 3));
    for (int64_t v = 0; v < vertices; v++) {
        double world[3];
        skg_pose_point(part->pose, positions + 3 * v, world);
        skg_add_scaled(world, -1, stage->centre, world);
        for (int k = 0; k < 3; k++) positions[3 * v + k] = skg_dot(stage->axes[k], world);
    }
    for (int64_t t = 0; t < triangles; t++) {
        int32_t *corner = corners + 3 * t;
        for (int k = 0; k < 3; k++) corner[k] += (int32_t)s->vertices;
        if (inward != (determinant_sign(part->pose) < 0)) {
            const int32_t second = corner[1];
            corner[1] = corner[2], corner[2] = second;
        }
    }
    s->vertices += vertices, s->triangles += triangles;
    return SKG_OK;
}

/* The centre of the box around all vertices, from which they are counted afterwards. */
static void centre_surface(surface *s, double centre[3]) {
    for (int k = 0; k < 3; k++) {
        double low = s->positions[k], high = low;
        for (int64_t v = 0; v < s->vertices; v++) {
            low = fmin(low, s->positions[3 * v + k]);
            high = fmax(high, s->positions[3 * v + k]);
        }
        centre[k] = 0.5 * (low + high);
        for (int64_t v = 0; v < s->vertices; v++) s->positions[3 * v + k] -= centre[k];
    }
}

static skg_status save_surface(const skg_setup *setup, const surface *s, const char *label,
                               const char *path) {
    skg_mesh_source source;
    skg_mesh *mesh = NULL;
    skg_mesh_source_init(&source);
    source.vertices = s->vertices, source.positions = s->positions;
    source.triangles = s->triangles, source.corners = s->corners;
    skg_status status = skg_mesh_create(setup->scene->context, label, &source, &mesh);
    if (status == SKG_OK) status = skg_mesh_save(mesh, path);
    skg_mesh_release(&mesh);
    return status;
}

static skg_status put_material(const skg_material *material, const char *id, const char *what,
                               json_t *materials) {
    json_t *composition = json_array(), *one = json_object();
    int64_t count = 0;
    double density = 0;
    skg_status status = skg_material_element_count(material, &count);
    if (status == SKG_OK) status = skg_material_density_get(material, &density);
    if (status == SKG_OK && (count == 0 || !(density > 0)))
        status = skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: its material is given by its attenuation, or has no density; a CTSimU scenario holds compositions "
            "with densities: give a formula (H2O), fractions by mass or a name of the tables",
            what);
    for (int64_t i = 0; i < count && status == SKG_OK; i++) {
        int32_t z = 0;
        double fraction = 0;
        const char *symbol = NULL;
        status = skg_material_element_get(material, i, &z, &fraction);
        if (status == SKG_OK) status = skg_element_symbol_get(z, &symbol);
        if (status == SKG_OK)
            json_array_append_new(composition, json_pack("{s:{s:s}, s:{s:f}}", "formula", "value", symbol,
                                                         "mass_fraction", "value", fraction));
    }
    json_object_set_new(one, "id", json_string(id));
    json_object_set_new(one, "name", json_string(id));
    json_object_set_new(one, "density", skg_scenario_number(density, "g/cm^3"));
    json_object_set_new(one, "composition", composition);
    json_array_append_new(materials, one);
    return status;
}

static json_t *position_of(const double *centre) {
    static const double u[3] = {1, 0, 0}, w[3] = {0, 0, 1};
    json_t *position = json_object();
    json_object_set_new(position, "center", skg_scenario_vector(centre, "uvw", "mm"));
    json_object_set_new(position, "vector_u", skg_scenario_vector(u, "uvw", NULL));
    json_object_set_new(position, "vector_w", skg_scenario_vector(w, "uvw", NULL));
    json_object_set_new(position, "deviations", json_array());
    return position;
}

/* Writes the mesh of a part without those that lie inside it, and describes the sample. */
static skg_status put_sample(const skg_setup *setup, const skg_scenario_stage *stage, const char *path,
                             int64_t number, json_t *samples) {
    char name[PATH_LENGTH], file[PATH_LENGTH], ending[64];
    skg_part part;
    surface s = {0};
    double centre[3];
    skg_status status = SKG_OK;
    skg_part_init(&part);
    SKG_TRY(skg_scene_part_get(setup->scene, number, &part));
    snprintf(ending, sizeof ending, "-part-%" PRId64 ".stl", number + 1);
    SKG_TRY(skg_scenario_name(path, ending, 1, file, sizeof file));
    SKG_TRY(skg_scenario_name(path, ending, 0, name, sizeof name));
    SKG_TRY_CLEANUP(add_mesh(&part, stage, 0, &s));
    for (int64_t i = 0; i < setup->scene->count; i++) {
        skg_part other;
        skg_part_init(&other);
        SKG_TRY_CLEANUP(skg_scene_part_get(setup->scene, i, &other));
        if (other.inside == number) SKG_TRY_CLEANUP(add_mesh(&other, stage, 1, &s));
    }
    centre_surface(&s, centre);
    SKG_TRY_CLEANUP(save_surface(setup, &s, part.label, file));
    json_array_append_new(samples, json_pack("{s:s, s:{s:s}, s:s, s:s?, s:o}", "name", part.label, "file",
                                             "value", name, "unit", "mm", "material_id",
                                             skg_material_is_void(part.material) ? NULL : part.label,
                                             "position", position_of(centre)));
cleanup:
    surface_free(&s);
    return status;
}

skg_status skg_scenario_put_parts(const skg_setup *setup, const skg_scenario_stage *stage, const char *path,
                                  json_t *scenario) {
    json_t *samples = json_array(), *materials = json_array();
    json_object_set_new(scenario, "samples", samples);
    json_object_set_new(scenario, "materials", materials);
    json_object_set_new(scenario, "environment",
                        json_pack("{s:s?}", "material_id", setup->world ? "the world around" : NULL));
    if (setup->world) SKG_TRY(put_material(setup->world, "the world around", "World", materials));
    for (int64_t i = 0; i < setup->scene->count; i++) {
        char what[256];
        skg_part part;
        skg_part_init(&part);
        SKG_TRY(skg_scene_part_get(setup->scene, i, &part));
        snprintf(what, sizeof what, "part %s", part.label);
        if (part.volume)
            return skg_fail(SKG_ERR_UNSUPPORTED,
                            "%s: is a volume of cells, and a CTSimU scenario holds meshes", what);
        if (!skg_material_is_void(part.material))
            SKG_TRY(put_material(part.material, part.label, what, materials));
    }
    for (int64_t i = 0; i < setup->scene->count; i++) SKG_TRY(put_sample(setup, stage, path, i, samples));
    return SKG_OK;
}
