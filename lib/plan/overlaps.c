/* Overlaps of parts as a plan reports them. */
#include "geometry/overlaps.h"
#include "core/context.h"
#include "core/text.h"
#include "core/threads.h"
#include "geometry/priority.h"
#include "plan/decisions.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { WORST = 3, LONGEST_WORST = 1024 };

/* Appends "; then A with B, 3 ml". */
static void add_next(char text[LONGEST_WORST], const skg_scene *scene, const skg_overlap_pair *pair) {
    const size_t used = strlen(text);
    snprintf(text + used, LONGEST_WORST - used, "; then %s %s %s, %.3g ml", scene->parts[pair->part].label,
             pair->kind == SKG_OVERLAP_SIBLINGS ? "with" : "leaves", scene->parts[pair->other].label,
             pair->volume / 1000);
}

/* Whether a pair is of parts of a volume, which loses the cells that are there and no others. */
static int is_in_cells(const skg_scene *scene, const skg_overlap_pair *pair) {
    const int64_t parent = pair->kind == SKG_OVERLAP_SIBLINGS ? scene->parts[pair->part].inside : pair->other;
    return parent >= 0 && scene->parts[parent].volume != NULL;
}

/* Warns of the pairs that nothing settles: of all of them at once, with the worst three. */
static void warn(const skg_recipe *recipe, const skg_context *context, const skg_outcome *outcome) {
    const skg_overlap_pair *worst = NULL;
    const skg_scene *scene = recipe->scene;
    char others[LONGEST_WORST] = "";
    double volume = 0;
    int64_t count = 0;
    int in_cells = 0;
    for (int64_t i = 0; i < outcome->overlap_count; i++) {
        const skg_overlap_pair *pair = &outcome->overlaps[i];
        if (skg_priority_settles(scene, skg_priority_rules(recipe->options.clip, 0), pair)) continue;
        if (!worst)
            worst = pair;
        else if (count < WORST)
            add_next(others, scene, pair);
        volume += pair->volume;
        in_cells |= is_in_cells(scene, pair);
        count++;
    }
    if (!worst) return;
    skg_log(
        context, SKG_LOG_WARNING,
        "%" PRId64 " %s, %.3g ml in all; worst: %s %s %s, %.3g ml, up to "
        "%.3g mm along z at (%.1f, %.1f, %.1f) mm%s; their lengths add (or subtract the parent), nothing is clamped%s",
        count,
        skg_plural(count, "pair of parts overlaps, or a part leaves its parent",
                   "pairs of parts overlap or leave their parent"),
        volume / 1000, scene->parts[worst->part].label,
        worst->kind == SKG_OVERLAP_SIBLINGS ? "with" : "leaves", scene->parts[worst->other].label,
        worst->volume / 1000, worst->longest, worst->place[0], worst->place[1], worst->place[2], others,
        in_cells ? " but the cells of a volume, which are cut out once, where there are any" : "");
}

/* The state that threads share. */
typedef struct {
    const skg_recipe *recipe;
    skg_plan_overlaps *found;
    skg_solid *solids;  /* [parts] */
    double **positions; /* [parts] */
} checking;

static skg_status check_overlaps(checking *c) {
    const skg_scene *scene = c->recipe->scene;
    if (scene->count < 2) return SKG_OK;
    for (int64_t i = 0; i < scene->count; i++)
        SKG_TRY(skg_solid_place(scene->parts[i].mesh, scene->parts[i].pose, scene->parts[i].inside,
                                &c->solids[i], &c->positions[i]));
    return skg_overlaps_find(scene->count, c->solids, &c->found->side, &c->found->pair_count,
                             &c->found->pairs);
}

static skg_status check_mesh(void *user, int64_t mesh) {
    checking *c = user;
    return skg_nesting_find(c->recipe->meshes.meshes[mesh], &c->found->nestings[mesh], NULL);
}

skg_status skg_plan_overlaps_find(const skg_recipe *recipe, skg_plan_overlaps *found) {
    const skg_scene *scene = recipe->scene;
    const int64_t meshes = recipe->meshes.count;
    checking c = {.recipe = recipe, .found = found};
    skg_status status = SKG_OK;
    *found = (skg_plan_overlaps){0};
    if (!recipe->options.overlaps) return SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(meshes, sizeof *found->nestings, "overlap check", &found->nestings));
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *c.solids, "overlap check", &c.solids));
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *c.positions, "overlap check", &c.positions));
    SKG_TRY_CLEANUP(skg_parallel(meshes, check_mesh, &c));
    SKG_TRY_CLEANUP(check_overlaps(&c));
cleanup:
    for (int64_t i = 0; c.positions && i < scene->count; i++) skg_free(&c.positions[i]);
    skg_free(&c.positions);
    skg_free(&c.solids);
    return status;
}

void skg_plan_overlaps_release(skg_plan_overlaps *found) {
    skg_free(&found->pairs);
    skg_free(&found->nestings);
}

skg_status skg_plan_overlaps_take(const skg_recipe *recipe, const skg_context *context,
                                  skg_plan_overlaps *found, skg_outcome *outcome) {
    if (!found->nestings) return SKG_OK;
    outcome->overlap_side = found->side;
    outcome->overlap_count = found->pair_count;
    outcome->overlaps = found->pairs, found->pairs = NULL;
    SKG_TRY(skg_plan_meshes_warn(&recipe->meshes, found->nestings, recipe->scene, recipe->options.unite,
                                 context));
    warn(recipe, context, outcome);
    return SKG_OK;
}
