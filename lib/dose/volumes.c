/* The volume of each part, without what lies inside it; of cells, what they weigh. */
#include "dose/figures.h"

#include "core/maths.h"
#include "mesh/mesh.h"
#include "scene/scene.h"
#include "scene/volume.h"

/* Of surfaces: a mesh's times the pose's determinant, less those of the parts inside. Cells count by what they hold on average, all of
 * them. */
static skg_status by_surfaces(const skg_scene *scene, double *solid, double *volumes) {
    for (int64_t i = 0; i < scene->count; i++) {
        const skg_scene_part_data *part = &scene->parts[i];
        skg_mesh_health health;
        skg_mesh_health_init(&health);
        skg_mesh_measure(part->mesh, &health);
        solid[i] = part->mesh->closed ? health.volume * fabs(skg_pose_determinant(part->pose)) : (double)NAN;
        volumes[i] = part->volume ? solid[i] * part->volume->mean_amount : solid[i];
    }
    for (int64_t i = 0; i < scene->count; i++) {
        const int64_t parent = scene->parts[i].inside;
        if (parent >= 0 && !scene->parts[parent].volume) volumes[parent] -= solid[i];
    }
    return SKG_OK;
}

/* A part of which everything is displaced has no volume: the rest, which may be below 0, is the error of the lines. */
static void drop_rests(int64_t count, const double *solid, double *volumes, double *errors) {
    static const double ROUNDING = 1e-9;
    for (int64_t i = 0; i < count; i++) {
        errors[i] = sqrt(errors[i]);
        const int is_rest = fabs(volumes[i]) < fmax(ROUNDING * fabs(solid[i]), 3 * errors[i]);
        if (is_rest || (errors[i] > 0 && volumes[i] < 0)) volumes[i] = errors[i] = 0;
    }
}

skg_status skg_dose_volumes(const skg_recipe *recipe, const skg_forest *tree, skg_progress *progress,
                            double *volumes, double *errors) {
    const skg_rules rules = skg_rules_of(recipe);
    const int64_t parts = recipe->scene->count;
    skg_dose_window *windows = NULL;
    double *solid = NULL;
    int64_t count = 0;
    skg_status status = SKG_OK;
    for (int64_t i = 0; i < parts; i++) errors[i] = 0;
    SKG_TRY(skg_alloc(parts, sizeof *solid, "dose", &solid));
    SKG_TRY_CLEANUP(by_surfaces(recipe->scene, solid, volumes));
    SKG_TRY_CLEANUP(skg_dose_windows_find(&rules, tree, &count, &windows));
    SKG_TRY_CLEANUP(skg_dose_windows_add(&rules, tree, count, windows, progress, volumes, errors));
    drop_rests(parts, solid, volumes, errors);
cleanup:
    skg_free(&solid);
    skg_free(&windows);
    return status;
}
