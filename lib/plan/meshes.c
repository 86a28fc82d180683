/* The meshes of a plan's scene, each once, and warnings about them. */
#include "plan/inputs.h"

#include "core/context.h"

#include <inttypes.h>
#include <stdlib.h>

typedef struct {
    const skg_mesh *mesh;
    int64_t part;
} mesh_of_part;

static int by_mesh(const void *a, const void *b) {
    const mesh_of_part *left = a, *right = b;
    if (left->mesh != right->mesh) return left->mesh < right->mesh ? -1 : 1;
    return left->part < right->part ? -1 : 1;
}

/* Gives each part the number of its mesh. Meshes are numbered in the order of the first part that uses them. */
static skg_status find_distinct(const skg_scene *scene, skg_plan_meshes *meshes) {
    mesh_of_part *sorted = NULL;
    int64_t *first = NULL; /* [parts] the first part with the same mesh */
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *sorted, "meshes", &sorted));
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *first, "meshes", &first));
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *meshes->of_part, "meshes", &meshes->of_part));
    for (int64_t i = 0; i < scene->count; i++) sorted[i] = (mesh_of_part){scene->parts[i].mesh, i};
    qsort(sorted, (size_t)scene->count, sizeof *sorted, by_mesh);
    for (int64_t i = 0; i < scene->count; i++)
        first[sorted[i].part] =
            i > 0 && sorted[i].mesh == sorted[i - 1].mesh ? first[sorted[i - 1].part] : sorted[i].part;
    for (int64_t i = 0; i < scene->count; i++) meshes->count += first[i] == i;
    SKG_TRY_CLEANUP(skg_alloc(meshes->count, sizeof *meshes->meshes, "meshes", &meshes->meshes));
    int64_t number = 0;
    for (int64_t i = 0; i < scene->count; i++) {
        if (first[i] == i) meshes->meshes[number] = scene->parts[i].mesh;
        meshes->of_part[i] = first[i] == i ? number++ : meshes->of_part[first[i]];
    }
cleanup:
    skg_free(&sorted);
    skg_free(&first);
    return status;
}

skg_status skg_plan_meshes_create(const skg_scene *scene, skg_plan_meshes *meshes) {
    *meshes = (skg_plan_meshes){0};
    return find_distinct(scene, meshes);
}

void skg_plan_meshes_release(skg_plan_meshes *meshes) {
    skg_free(&meshes->meshes);
    skg_free(&meshes->of_part);
}

skg_status skg_plan_meshes_check(const skg_plan_meshes *meshes, const skg_scene *scene) {
    for (int64_t i = 0; i < meshes->count; i++) {
        const skg_mesh *mesh = meshes->meshes[i];
        if (mesh->first_bad < 0) continue;
        int64_t part = 0;
        while (meshes->of_part[part] != i) part++;
        return skg_fail(SKG_ERR_MESH,
                        "part %s: vertex %" PRId64 " of mesh %s is not finite; no image was made",
                        scene->parts[part].label, mesh->first_bad, mesh->name);
    }
    return SKG_OK;
}

/* Triangles that a mesh lists more than once: they were one surface when it was made. */
static void warn_of_duplicates(const skg_mesh *mesh, const char *label, int32_t unite,
                               const skg_context *context) {
    const int64_t count = mesh->health.duplicate_triangles;
    if (count == 0 || (unite && mesh->closed)) return;
    skg_log(
        context, SKG_LOG_WARNING,
        "part %s: %" PRId64 " of %" PRId64
        " triangles are duplicates of others: lengths through them count twice, or cancel where they face each other. "
        "Remove them where the mesh is made%s",
        label, count, mesh->triangles,
        mesh->closed ? ", or \"Repair\": \"union\" in a scene file counts them once" : "");
}

/* Surfaces that cross themselves without being of several components, which nestings compare. Small folds are left out. */
static void warn_of_crossing(const skg_mesh *mesh, const skg_mesh_nesting *nesting, const char *label,
                             const skg_context *context) {
    static const double FOLDS = 1e-3;
    if (!mesh->closed || mesh->twice_inside < FOLDS || mesh->health.duplicate_triangles > 0 ||
        nesting->inverted + nesting->overlapping + nesting->leaving > 0)
        return;
    skg_log(
        context, SKG_LOG_WARNING,
        "part %s: its surface crosses itself: about %.2g %% of its inside is inside more than once, where lengths count as often. "
        "\"Repair\": \"union\" in a scene file counts it once",
        label, 100 * mesh->twice_inside);
}

skg_status skg_plan_meshes_warn(const skg_plan_meshes *meshes, const skg_mesh_nesting *nestings,
                                const skg_scene *scene, int32_t unite, const skg_context *context) {
    for (int64_t i = 0; i < meshes->count; i++) {
        char text[1024];
        int64_t part = 0;
        skg_mesh_nesting nesting = nestings[i];
        while (meshes->of_part[part] != i) part++;
        warn_of_duplicates(meshes->meshes[i], scene->parts[part].label, unite, context);
        if (!unite) warn_of_crossing(meshes->meshes[i], &nesting, scene->parts[part].label, context);
        if (unite) nesting.overlapping = nesting.leaving = 0; /* they are settled */
        SKG_TRY(skg_mesh_nesting_describe(&nesting, sizeof text, text));
        if (!*text) continue;
        skg_log(context, SKG_LOG_WARNING, "part %s: %s%s", scene->parts[part].label, text,
                nesting.inverted > 0
                    ? ". \"Repair\": \"orientation\" in a scene file turns inverted components"
                : nesting.overlapping > 0 ? ". \"Repair\": \"union\" in a scene file counts overlaps once"
                                          : "");
    }
    return SKG_OK;
}
