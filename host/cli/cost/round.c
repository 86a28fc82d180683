/* The dial of parts that can have any number of triangles. */
#include "cost/dials.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FEWEST_SECTORS = 8, SECTORS_MAX = 26000, TRIANGLES_MAX = 1500000 };

static int has_same_positions(const skg_mesh *a, const skg_mesh *b) {
    int64_t vertices = 0, others = 0, triangles;
    if (skg_mesh_count(a, &vertices, &triangles) != SKG_OK ||
        skg_mesh_count(b, &others, &triangles) != SKG_OK)
        return 0;
    if (vertices != others) return 0;
    double *positions = calloc((size_t)(6 * vertices), sizeof *positions);
    int same = positions && skg_mesh_positions_get(a, positions, 3) == SKG_OK &&
               skg_mesh_positions_get(b, positions + 3 * vertices, 3) == SKG_OK &&
               memcmp(positions, positions + 3 * vertices, (size_t)(3 * vertices) * sizeof *positions) == 0;
    free(positions);
    return same;
}

enum { NOT_ROUND, SPHERE, CYLINDER };
static const char *const keys[] = {NULL, "Sphere", "Cylinder"};

/* The number of triangles of a sphere of skg_mesh_create_sphere. */
static int64_t triangles_of_sphere(int64_t sectors) {
    const int64_t bands = sectors / 2 < 2 ? 2 : sectors / 2;
    return 2 * (bands - 1) * sectors;
}

/* SPHERE or CYLINDER and the number of sectors, if the mesh equals the one that the library makes bit for
 * bit. */
static int is_round(const skg_mesh *mesh, int64_t *sectors) {
    const char *name = NULL;
    skg_mesh_health health;
    skg_mesh *made = NULL;
    skg_status status = SKG_ERR_MESH;
    skg_mesh_health_init(&health);
    if (skg_mesh_name_get(mesh, &name) != SKG_OK || skg_mesh_health_get(mesh, &health) != SKG_OK)
        return NOT_ROUND;
    const int shape = strcmp(name, "sphere") == 0     ? SPHERE
                      : strcmp(name, "cylinder") == 0 ? CYLINDER
                                                      : NOT_ROUND;
    const double *high = health.bounds + 3;
    *sectors = health.triangles / 4;
    if (shape == CYLINDER) status = skg_mesh_create_cylinder(high[0], 2 * high[2], *sectors, &made);
    if (shape == SPHERE) {
        for (*sectors = 3; triangles_of_sphere(*sectors) < health.triangles; (*sectors)++) {
        }
        status = skg_mesh_create_sphere(high[2], *sectors, &made);
    }
    const int same = status == SKG_OK && has_same_positions(mesh, made);
    skg_mesh_release(&made);
    return same ? shape : NOT_ROUND;
}

static int64_t scaled(int64_t sectors, double factor) {
    return (int64_t)fmin(fmax(round((double)sectors * factor), FEWEST_SECTORS), SECTORS_MAX);
}

/* The settings that multiply all sectors by a factor. *triangles: of the scene with these settings. */
static skg_status scale_sectors(const cost_study *study, double factor, cost_meshing *meshing,
                                int64_t *triangles) {
    int64_t parts = 0;
    skg_status status = skg_scene_part_count(study->session.scene, &parts);
    *triangles = study->subject.triangles;
    meshing->settings = calloc((size_t)parts, sizeof *meshing->settings);
    if (!meshing->settings) return SKG_ERR_MEMORY;
    for (int64_t i = 0; i < parts && status == SKG_OK; i++) {
        int64_t sectors = 0;
        skg_part part;
        skg_part_init(&part);
        status = skg_scene_part_get(study->session.scene, i, &part);
        const int shape = status == SKG_OK ? is_round(part.mesh, &sectors) : NOT_ROUND;
        if (shape == NOT_ROUND || sectors < FEWEST_SECTORS) continue; /* may be meant as a prism */
        const int64_t wanted = scaled(sectors, factor);
        *triangles += shape == CYLINDER ? 4 * (wanted - sectors)
                                        : triangles_of_sphere(wanted) - triangles_of_sphere(sectors);
        char *setting = cost_part_setting(&part, i, "%s.0=%" PRId64, keys[shape], wanted);
        if (!setting) return SKG_ERR_MEMORY;
        meshing->settings[meshing->setting_count++] = setting;
    }
    return status;
}

/* Reads the scene with the meshing's settings. SKG_ERR_SCENE: it has another number of triangles than
 * expected. */
static skg_status load_round(const cost_study *study, int64_t triangles, cost_meshing *meshing) {
    skg_setup *setup = NULL;
    skg_status status =
        cost_load(study, meshing->setting_count, (const char *const *)meshing->settings, &setup);
    if (status == SKG_OK) status = skg_setup_scene_get(setup, &meshing->scene);
    if (status == SKG_OK) status = skg_scene_retain(meshing->scene);
    if (status != SKG_OK) meshing->scene = NULL;
    skg_setup_release(&setup);
    if (status == SKG_OK) status = cost_count_triangles(meshing->scene, &meshing->triangles);
    return status == SKG_OK && meshing->triangles != triangles ? SKG_ERR_SCENE : status;
}

/* Keeps a meshing if it has more triangles than the one before. */
static skg_status add_round(cost_study *study, double factor) {
    cost_meshing meshing = {0};
    int64_t triangles = 0;
    skg_status status = scale_sectors(study, factor, &meshing, &triangles);
    const int64_t before = study->meshing_count ? study->meshings[study->meshing_count - 1].triangles : 0;
    int keep =
        status == SKG_OK && meshing.setting_count > 0 && triangles > before && triangles <= TRIANGLES_MAX;
    if (keep) status = load_round(study, triangles, &meshing);
    if (keep && status == SKG_OK)
        study->meshings[study->meshing_count++] = meshing;
    else
        cost_meshing_free(&meshing);
    return status;
}

skg_status cost_find_round(cost_study *study) {
    static const double factors[] = {0.25, 0.5, 1, 2, 4, 8, 16, 32};
    skg_status status = SKG_OK;
    for (int i = 0; i < (study->quick ? 5 : 8) && status == SKG_OK; i++)
        status = add_round(study, factors[i]);
    return status;
}

int64_t cost_count_unknown(const cost_study *study, const char **label) {
    int64_t parts = 0, unknown = 0;
    skg_scene_part_count(study->session.scene, &parts);
    for (int64_t i = 0; i < parts; i++) {
        int64_t sectors;
        const char *name = "";
        skg_part part;
        skg_part_init(&part);
        if (skg_scene_part_get(study->session.scene, i, &part) != SKG_OK) continue;
        if (skg_mesh_name_get(part.mesh, &name) != SKG_OK) continue;
        if (part.volume) continue; /* its cells are the body */
        if (strcmp(name, "cube") == 0 || strcmp(name, "cuboid") == 0 || strcmp(name, "step wedge") == 0 ||
            is_round(part.mesh, &sectors))
            continue;
        if (unknown++ == 0) *label = part.label;
    }
    return unknown;
}
