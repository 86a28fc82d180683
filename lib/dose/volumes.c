/* The volume of each part, without what lies inside it; of cells, what they weigh. */
#include "dose/figures.h"

#include "core/maths.h"
#include "core/threads.h"
#include "mesh/mesh.h"
#include "scene/scene.h"
#include "scene/volume.h"

#include <string.h>

/* Lines along each side, where parts compete: a volume is right to some 1e-3. */
enum { LINES = 384, TOGETHER = 48 };

/* Of surfaces: a mesh's times the pose's determinant, less those of the parts inside. */
static skg_status by_surfaces(const skg_scene *scene, double *volumes) {
    double *of = NULL;
    SKG_TRY(skg_alloc(scene->count, sizeof *of, "dose", &of));
    for (int64_t i = 0; i < scene->count; i++) {
        const skg_scene_part_data *part = &scene->parts[i];
        skg_mesh_health health;
        skg_mesh_health_init(&health);
        skg_mesh_measure(part->mesh, &health);
        of[i] = part->mesh->closed ? health.volume * fabs(skg_pose_determinant(part->pose)) : (double)NAN;
        volumes[i] = of[i];
    }
    for (int64_t i = 0; i < scene->count; i++)
        if (scene->parts[i].inside >= 0) volumes[scene->parts[i].inside] -= of[i];
    skg_free(&of);
    return SKG_OK;
}

/* Rows of lines that threads take together. */
typedef struct {
    const skg_forest *tree;
    skg_rules rules;
    int64_t parts, first;
    double *sums; /* [TOGETHER][parts] */
} rows_of_lines;

static void add_pieces(const skg_way *way, double area, double *sums) {
    for (int64_t p = 0; p < way->piece_count; p++)
        for (int64_t k = way->pieces[p].first; k < way->pieces[p].first + way->pieces[p].count; k++)
            if (way->presences[k].part >= 0)
                sums[way->presences[k].part] +=
                    way->presences[k].share * (way->pieces[p].to - way->pieces[p].from) * area;
}

static skg_status add_row(void *user, int64_t item) {
    const rows_of_lines *l = user;
    const skg_forest_node *box = &l->tree->nodes[0];
    const double along[3] = {0, 0, 1}, reach = 2 * (box->high[2] - box->low[2]) + 2;
    const double step[2] = {(box->high[0] - box->low[0]) / LINES, (box->high[1] - box->low[1]) / LINES};
    skg_way way = {0};
    skg_status status = SKG_OK;
    for (int i = 0; i < LINES && status == SKG_OK; i++) {
        /* Off the middles, so that faces along the axes are rarely met exactly. */
        const double from[3] = {box->low[0] + (i + 0.4142135623730951) * step[0],
                                box->low[1] + ((double)(l->first + item) + 0.7320508075688772) * step[1],
                                box->low[2] - 1};
        status = skg_way_find_cells(l->tree, &l->rules, from, along, reach, &way);
        if (status == SKG_OK) add_pieces(&way, step[0] * step[1], l->sums + item * l->parts);
    }
    skg_way_free(&way);
    return status;
}

/* Of the pieces of parallel lines: what priorities, clip and unite leave of each part. */
static skg_status by_lines(const skg_recipe *recipe, const skg_forest *tree, skg_progress *progress,
                           double *volumes) {
    const int64_t parts = recipe->scene->count;
    rows_of_lines l = {.tree = tree, .rules = skg_rules_of(recipe), .parts = parts};
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(TOGETHER * parts, sizeof *l.sums, "dose", &l.sums));
    for (l.first = 0; l.first < LINES && status == SKG_OK; l.first += TOGETHER) {
        memset(l.sums, 0, (size_t)(TOGETHER * parts) * sizeof *l.sums);
        status = skg_progress_step(progress, 0, 1);
        if (status == SKG_OK) status = skg_parallel(TOGETHER, add_row, &l);
        for (int64_t i = 0; i < TOGETHER * parts && status == SKG_OK; i++) volumes[i % parts] += l.sums[i];
    }
    skg_free(&l.sums);
    return status;
}

static int is_parent(const skg_scene *scene, int64_t part) {
    int64_t i = 0;
    while (i < scene->count && scene->parts[i].inside != part) i++;
    return i < scene->count;
}

/* Cells that nothing displaces weigh what they hold on average; which others are displaced, lines say. */
static skg_status weigh_cells(const skg_recipe *recipe, const skg_forest *tree, skg_progress *progress,
                              double *volumes) {
    const skg_scene *scene = recipe->scene;
    double *left = NULL;
    int64_t displaced = 0;
    for (int64_t i = 0; i < scene->count; i++) {
        if (!scene->parts[i].volume) continue;
        volumes[i] *= scene->parts[i].volume->mean_amount;
        displaced += is_parent(scene, i);
    }
    if (!displaced) return SKG_OK;
    SKG_TRY(skg_alloc(scene->count, sizeof *left, "dose", &left));
    const skg_status status = by_lines(recipe, tree, progress, left);
    for (int64_t i = 0; i < scene->count; i++)
        if (scene->parts[i].volume && is_parent(scene, i)) volumes[i] = left[i];
    skg_free(&left);
    return status;
}

/* Whether parts take away from others than those that they lie inside. */
static int has_competitors(const skg_recipe *recipe) {
    const skg_scene *scene = recipe->scene;
    int64_t p = 0;
    while (p < scene->count && scene->parts[p].priority == scene->parts[0].priority) p++;
    return recipe->priority_possible && (p < scene->count || recipe->options.clip || recipe->options.unite);
}

skg_status skg_dose_volumes(const skg_recipe *recipe, const skg_forest *tree, skg_progress *progress,
                            double *volumes) {
    if (has_competitors(recipe) && tree->count > 0) return by_lines(recipe, tree, progress, volumes);
    SKG_TRY(by_surfaces(recipe->scene, volumes));
    return weigh_cells(recipe, tree, progress, volumes);
}
