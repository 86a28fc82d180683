/* The generated thorax as the scene of a study, with any number of triangles. */
#include "cost/dials.h"

#include <math.h>
#include <strings.h>

#include "common/progress.h"

enum { FINEST_TRIANGLES = 672000, COARSEST_TRIANGLES = FINEST_TRIANGLES / 64 };

/* The time to generate a thorax has a fixed part, which is that of this number of triangles. Measured on one core: 3.9, 4.6, 6.7,
 * 11.6 and 38 s for 21,000, 42,000, 84,000, 168,000 and 672,000 triangles. */
static const double FIXED_TRIANGLES = 68000;

/* The thorax's mesh with this label, or NULL. */
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

/* Whether two closed meshes have about the same bounds. A scanned organ with the same label has others. */
static int has_same_bounds(const skg_mesh *a, const skg_mesh *b) {
    static const double max_mm =
        10; /* more than the number of triangles changes the bounds of a coarse part */
    skg_mesh_health healths[2];
    skg_mesh_health_init(&healths[0]);
    skg_mesh_health_init(&healths[1]);
    if (skg_mesh_health_get(a, &healths[0]) != SKG_OK || skg_mesh_health_get(b, &healths[1]) != SKG_OK)
        return 0;
    if (!healths[0].closed || !healths[1].closed) return 0;
    for (int k = 0; k < 6; k++)
        if (!(fabs(healths[0].bounds[k] - healths[1].bounds[k]) < max_mm)) return 0;
    return 1;
}

static skg_status make_thorax(int simple, int64_t triangles, skg_thorax **thorax) {
    skg_thorax_options options;
    skg_thorax_options_init(&options);
    options.simple = simple;
    options.triangles = triangles;
    return skg_thorax_create(&options, thorax);
}

/* Whether the scene is the thorax that `skiagraph thorax --triangles N` makes, or one with about as many. */
static int is_this_thorax(cost_study *study, int64_t triangles) {
    int64_t parts = 0, id = 0, same = 0;
    skg_thorax *thorax = NULL;
    skg_thorax_part generated;
    skg_part part;
    skg_thorax_part_init(&generated);
    skg_part_init(&part);
    const double begun = cli_now_ms();
    if (make_thorax(study->subject.thorax_is_simple, triangles, &thorax) == SKG_OK)
        skg_thorax_part_count(thorax, &parts);
    study->subject.thorax_ms = cli_now_ms() - begun;
    study->subject.thorax_made = triangles;
    for (int64_t i = 0; i < parts; i++)
        same += skg_thorax_part_get(thorax, i, &generated) == SKG_OK &&
                skg_scene_part_find(study->session.scene, generated.label, &id) == SKG_OK &&
                skg_scene_part_get(study->session.scene, id, &part) == SKG_OK &&
                has_same_bounds(part.mesh, generated.mesh);
    skg_thorax_release(&thorax);
    return parts > 0 && same == parts;
}

/* Copies the scene, with the thorax's mesh for every part that the thorax has. */
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
        status = skg_scene_part_add(scene, &part, NULL);
    }
    return status;
}

int cost_may_be_thorax(cost_study *study) {
    int64_t id = 0;
    if (skg_scene_part_find(study->session.scene, "common bile duct", &id) != SKG_OK)
        return 0; /* most scenes end here, without generating a thorax */
    study->subject.thorax_is_simple = skg_scene_part_find(study->session.scene, "muscle", &id) != SKG_OK;
    return 1;
}

int cost_is_thorax(cost_study *study) {
    int64_t usual =
        COARSEST_TRIANGLES; /* the scene's total is some per cent above N, and bounds differ with N */
    while (usual < FINEST_TRIANGLES && 3 * usual < 2 * study->subject.triangles) usual *= 2;
    return is_this_thorax(study, usual) || is_this_thorax(study, study->subject.triangles);
}

skg_status cost_make_thorax(const cost_study *study, cost_meshing *meshing) {
    skg_thorax *thorax = NULL;
    skg_status status = make_thorax(study->subject.thorax_is_simple, meshing->thorax, &thorax);
    if (status == SKG_OK) status = skg_scene_create(NULL, &meshing->scene);
    if (status == SKG_OK) status = take_thorax(study, thorax, meshing->scene);
    if (status == SKG_OK) status = cost_count_triangles(meshing->scene, &meshing->triangles);
    if (status != SKG_OK) skg_scene_release(&meshing->scene);
    skg_thorax_release(&thorax);
    return status;
}

double cost_making_ms(const cost_study *study, const cost_meshing *meshing) {
    if (meshing->scene || !meshing->thorax) return 0;
    return study->subject.thorax_ms * (FIXED_TRIANGLES + (double)meshing->thorax) /
           (FIXED_TRIANGLES + (double)study->subject.thorax_made);
}

void cost_list_thorax(cost_study *study) {
    const int64_t finest = study->quick ? FINEST_TRIANGLES / 4 : FINEST_TRIANGLES;
    for (int64_t n = COARSEST_TRIANGLES; n <= finest; n *= 2)
        study->meshings[study->meshing_count++] = (cost_meshing){.thorax = n, .triangles = n};
}
