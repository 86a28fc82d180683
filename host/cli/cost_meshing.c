/* skiagraph cost: the scene with other numbers of triangles, where it is known what they stand for: spheres,
 * cylinders, and the parts of the generated thorax. */
#include "cost.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { FEWEST_SECTORS = 8, MOST_SECTORS = 26000, MOST_TRIANGLES = 1500000, THORAX_FINEST = 672000 };

void cost_meshing_free(cost_meshing *meshing) {
    skg_scene_release(&meshing->scene);
    for (int64_t i = 0; i < meshing->setting_count; i++) free(meshing->settings[i]);
    free(meshing->settings);
    *meshing = (cost_meshing){0};
}

static skg_status count_triangles(const skg_scene *scene, int64_t *triangles) {
    int64_t parts = 0, vertices, its;
    skg_status status = skg_scene_part_count(scene, &parts);
    *triangles = 0;
    for (int64_t i = 0; i < parts && status == SKG_OK; i++) {
        skg_part part;
        skg_part_init(&part);
        status = skg_scene_part_get(scene, i, &part);
        if (status == SKG_OK) status = skg_mesh_count(part.mesh, &vertices, &its);
        if (status == SKG_OK) *triangles += its;
    }
    return status;
}

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

/* --- spheres and cylinders ------------------------------------------------------------------------------ */

enum { NOT_ROUND, SPHERE, CYLINDER };
static const char *const keys[] = {NULL, "Sphere", "Cylinder"};

/* Triangles of a sphere of so many sectors, as skg_mesh_create_sphere makes it. */
static int64_t triangles_of_sphere(int64_t sectors) {
    const int64_t bands = sectors / 2 < 2 ? 2 : sectors / 2;
    return 2 * (bands - 1) * sectors;
}

/* SPHERE or CYLINDER, with the sectors around, if the mesh is what the maker gives, bit for bit. */
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
    return (int64_t)fmin(fmax(round((double)sectors * factor), FEWEST_SECTORS), MOST_SECTORS);
}

/* "Samples.bone.Sphere.0=128"; a part without a label has its mesh's name, and is told by its number. */
static char *setting_of(const skg_part *part, int64_t number, int shape, int64_t sectors) {
    char *text = NULL;
    size_t size = 0;
    const char *name = "";
    FILE *stream = open_memstream(&text, &size);
    if (!stream || skg_mesh_name_get(part->mesh, &name) != SKG_OK) return NULL;
    if (strcmp(part->label, name) == 0)
        fprintf(stream, "Samples.%" PRId64 ".", number);
    else
        fprintf(stream, "Samples.%s.", part->label);
    fprintf(stream, "%s.0=%" PRId64, keys[shape], sectors);
    if (fclose(stream) == 0) return text;
    free(text);
    return NULL;
}

/* The settings for a factor on all sectors; *triangles: of the whole scene, then. */
static skg_status scale_sectors(const cost_study *study, double factor, cost_meshing *meshing,
                                int64_t *triangles) {
    int64_t parts = 0;
    skg_status status = skg_scene_part_count(study->session.scene, &parts);
    *triangles = study->triangles;
    meshing->settings = calloc((size_t)parts, sizeof *meshing->settings);
    if (!meshing->settings) return SKG_ERR_MEMORY;
    for (int64_t i = 0; i < parts && status == SKG_OK; i++) {
        int64_t sectors = 0;
        skg_part part;
        skg_part_init(&part);
        status = skg_scene_part_get(study->session.scene, i, &part);
        const int shape = status == SKG_OK ? is_round(part.mesh, &sectors) : NOT_ROUND;
        if (shape == NOT_ROUND || sectors < FEWEST_SECTORS) continue; /* a prism, for all that is known */
        const int64_t wanted = scaled(sectors, factor);
        *triangles += shape == CYLINDER ? 4 * (wanted - sectors)
                                        : triangles_of_sphere(wanted) - triangles_of_sphere(sectors);
        char *setting = setting_of(&part, i, shape, wanted);
        if (!setting) return SKG_ERR_MEMORY;
        meshing->settings[meshing->setting_count++] = setting;
    }
    return status;
}

/* Reads the scene with the meshing's settings. SKG_ERR_SCENE: it has not got the triangles that it should. */
static skg_status load_round(const cost_study *study, int64_t triangles, cost_meshing *meshing) {
    skg_setup *setup = NULL;
    skg_status status =
        cost_load(study, meshing->setting_count, (const char *const *)meshing->settings, &setup);
    if (status == SKG_OK) status = skg_setup_scene_get(setup, &meshing->scene);
    if (status == SKG_OK) status = skg_scene_retain(meshing->scene);
    if (status != SKG_OK) meshing->scene = NULL;
    skg_setup_release(&setup);
    if (status == SKG_OK) status = count_triangles(meshing->scene, &meshing->triangles);
    return status == SKG_OK && meshing->triangles != triangles ? SKG_ERR_SCENE : status;
}

/* Keeps a meshing unless it has as many triangles as the one before. */
static skg_status add_round(cost_study *study, double factor) {
    cost_meshing meshing = {0};
    int64_t triangles = 0;
    skg_status status = scale_sectors(study, factor, &meshing, &triangles);
    const int64_t before = study->meshing_count ? study->meshings[study->meshing_count - 1].triangles : 0;
    int keep =
        status == SKG_OK && meshing.setting_count > 0 && triangles > before && triangles <= MOST_TRIANGLES;
    if (keep) status = load_round(study, triangles, &meshing);
    if (keep && status == SKG_OK)
        study->meshings[study->meshing_count++] = meshing;
    else
        cost_meshing_free(&meshing);
    return status;
}

static skg_status find_round(cost_study *study) {
    static const double factors[] = {0.25, 0.5, 1, 2, 4, 8, 16, 32};
    skg_status status = SKG_OK;
    for (int i = 0; i < (study->quick ? 5 : 8) && status == SKG_OK; i++)
        status = add_round(study, factors[i]);
    return status;
}

/* --- the generated thorax ------------------------------------------------------------------------------- */

/* The thorax's mesh of this label, or NULL. */
static skg_mesh *mesh_of(const skg_thorax *thorax, const char *label) {
    int64_t parts = 0;
    skg_thorax_part part;
    skg_thorax_part_init(&part);
    if (skg_thorax_part_count(thorax, &parts) != SKG_OK) return NULL;
    for (int64_t i = 0; i < parts; i++)
        if (skg_thorax_part_get(thorax, i, &part) == SKG_OK && strcasecmp(part.label, label) == 0)
            return part.mesh;
    return NULL;
}

/* Whether two closed meshes fill about the same box: that of a real organ of this name does not. */
static int has_same_bounds(const skg_mesh *a, const skg_mesh *b) {
    static const double most_mm = 10; /* what some per cent more triangles change where they are few */
    skg_mesh_health healths[2];
    skg_mesh_health_init(&healths[0]);
    skg_mesh_health_init(&healths[1]);
    if (skg_mesh_health_get(a, &healths[0]) != SKG_OK || skg_mesh_health_get(b, &healths[1]) != SKG_OK)
        return 0;
    if (!healths[0].closed || !healths[1].closed) return 0;
    for (int k = 0; k < 6; k++)
        if (!(fabs(healths[0].bounds[k] - healths[1].bounds[k]) < most_mm)) return 0;
    return 1;
}

static skg_status make_thorax(int64_t triangles, skg_thorax **thorax) {
    skg_thorax_options options;
    skg_thorax_options_init(&options);
    options.triangles = triangles;
    return skg_thorax_create(&options, thorax);
}

/* Whether every part of the thorax of as many triangles is in the scene, in its place. */
static int is_thorax(const cost_study *study) {
    int64_t parts = 0, id = 0, same = 0;
    skg_thorax *thorax = NULL;
    skg_thorax_part generated;
    skg_part part;
    skg_thorax_part_init(&generated);
    skg_part_init(&part);
    if (skg_scene_find(study->session.scene, "common bile duct", &id) != SKG_OK)
        return 0; /* saves the time */
    if (make_thorax(study->triangles, &thorax) == SKG_OK) skg_thorax_part_count(thorax, &parts);
    for (int64_t i = 0; i < parts; i++)
        same += skg_thorax_part_get(thorax, i, &generated) == SKG_OK &&
                skg_scene_find(study->session.scene, generated.label, &id) == SKG_OK &&
                skg_scene_part_get(study->session.scene, id, &part) == SKG_OK &&
                has_same_bounds(part.mesh, generated.mesh);
    skg_thorax_release(&thorax);
    return parts > 0 && same == parts;
}

/* The scene with every part that the thorax has too from there. */
static skg_status take_thorax(const cost_study *study, const skg_thorax *thorax, skg_scene *scene) {
    int64_t parts = 0;
    skg_status status = skg_scene_part_count(study->session.scene, &parts);
    for (int64_t i = 0; i < parts && status == SKG_OK; i++) {
        skg_part part;
        skg_part_init(&part);
        status = skg_scene_part_get(study->session.scene, i, &part);
        if (status != SKG_OK) break;
        skg_mesh *mesh = mesh_of(thorax, part.label);
        if (mesh) part.mesh = mesh;
        status = skg_scene_add(scene, &part, NULL);
    }
    return status;
}

static skg_status add_thorax(cost_study *study, int64_t wanted) {
    cost_meshing meshing = {.thorax = wanted};
    skg_thorax *thorax = NULL;
    skg_status status = make_thorax(wanted, &thorax);
    if (status == SKG_OK) status = skg_scene_create(NULL, &meshing.scene);
    if (status == SKG_OK) status = take_thorax(study, thorax, meshing.scene);
    if (status == SKG_OK) status = count_triangles(meshing.scene, &meshing.triangles);
    if (status == SKG_OK)
        study->meshings[study->meshing_count++] = meshing;
    else
        cost_meshing_free(&meshing);
    skg_thorax_release(&thorax);
    return status;
}

static skg_status find_thorax(cost_study *study) {
    const int64_t finest = study->quick ? THORAX_FINEST / 4 : THORAX_FINEST;
    skg_status status = SKG_OK;
    for (int64_t n = THORAX_FINEST / 64; n <= finest && status == SKG_OK; n *= 2)
        status = add_thorax(study, n);
    return status;
}

int cost_find_meshings(cost_study *study) {
    skg_status status = is_thorax(study) ? find_thorax(study) : find_round(study);
    if (status == SKG_ERR_MEMORY) return cli_fail(status);
    if (status != SKG_OK) cost_note(study, "triangles are not swept: %s", skg_last_error());
    const int64_t most = study->meshing_count ? study->meshings[study->meshing_count - 1].triangles : 0;
    if (status == SKG_OK && study->meshing_count && most < 2 * study->triangles)
        cost_note(study, "triangles are not swept: the scene has %" PRId64 ", and none finer is made",
                  study->triangles);
    else if (status == SKG_OK)
        return CLI_DONE;
    while (study->meshing_count) cost_meshing_free(&study->meshings[--study->meshing_count]);
    return CLI_DONE;
}
