#include "plan/overlaps.h"
#include "core/names.h"
#include "geometry/priority.h"

#include <inttypes.h>

static skg_status place_solid(const skg_scene_part_data *part, skg_solid *solid, double **positions) {
    const skg_mesh *mesh = part->mesh;
    *solid = (skg_solid){.inside = part->inside};
    if (!mesh->closed) return SKG_OK;
    SKG_TRY(skg_alloc(mesh->vertices * 3, sizeof **positions, "overlap check", positions));
    for (int64_t v = 0; v < mesh->vertices; v++) {
        double at[3];
        skg_mesh_vertex(mesh, v, at);
        for (int k = 0; k < 3; k++) {
            const double *row = part->pose + 4 * k;
            (*positions)[3 * v + k] = row[0] * at[0] + row[1] * at[1] + row[2] * at[2] + row[3];
        }
    }
    *solid = (skg_solid){mesh->vertices, mesh->triangles, *positions, mesh->corners, part->inside};
    return SKG_OK;
}

/* Warns of the pairs that nothing settles. */
static void warn(const skg_recipe *recipe, const skg_context *context, const skg_outcome *outcome) {
    const skg_overlap_pair *worst = NULL;
    const skg_scene *scene = recipe->scene;
    double volume = 0;
    int64_t count = 0;
    for (int64_t i = 0; i < outcome->overlap_count; i++) {
        const skg_overlap_pair *pair = &outcome->overlaps[i];
        if (skg_priority_settles(scene, recipe->options.clip, pair)) continue;
        if (!worst) worst = pair;
        volume += pair->volume;
        count++;
    }
    if (!worst) return;
    skg_log(
        context, SKG_LOG_WARNING,
        "%" PRId64 " %s, %.3g ml in all; worst: %s %s %s, %.3g ml, up to "
        "%.3g mm along z at (%.1f, %.1f, %.1f) mm; their lengths add (or subtract the parent), nothing is clamped",
        count,
        skg_plural(count, "pair of parts overlaps, or a part leaves its parent",
                   "pairs of parts overlap or leave their parent"),
        volume / 1000, scene->parts[worst->part].label,
        worst->kind == SKG_OVERLAP_SIBLINGS ? "with" : "leaves", scene->parts[worst->other].label,
        worst->volume / 1000, worst->longest, worst->place[0], worst->place[1], worst->place[2]);
}

skg_status skg_plan_overlaps_find(const skg_recipe *recipe, skg_context *context, skg_outcome *outcome) {
    const skg_scene *scene = recipe->scene;
    skg_solid *solids = NULL;
    double **positions = NULL;
    skg_status status = SKG_OK;
    if (!recipe->options.overlaps) return SKG_OK;
    SKG_TRY(skg_plan_meshes_warn(&recipe->meshes, scene, context));
    if (scene->count < 2) return SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *solids, "overlap check", &solids));
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *positions, "overlap check", &positions));
    for (int64_t i = 0; i < scene->count; i++)
        SKG_TRY_CLEANUP(place_solid(&scene->parts[i], &solids[i], &positions[i]));
    SKG_TRY_CLEANUP(skg_overlaps_find(scene->count, solids, &outcome->overlap_count, &outcome->overlaps));
    warn(recipe, context, outcome);
cleanup:
    for (int64_t i = 0; positions && i < scene->count; i++) skg_free(&positions[i]);
    skg_free(&positions);
    skg_free(&solids);
    return status;
}
