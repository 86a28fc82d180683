/* The knowledge of a plan's frames, from its making to its end. */
#include "plan/results.h"

void skg_outcome_renew(const skg_recipe *recipe, skg_outcome *outcome) {
    outcome->report.planes = recipe->model.planes;
    outcome->report.accumulators = skg_recipe_accumulators(recipe);
}

skg_status skg_outcome_create(const skg_recipe *recipe, skg_outcome *outcome) {
    skg_plan_report *report = &outcome->report;
    *outcome = (skg_outcome){.report = {.size = sizeof outcome->report}};
    report->precision = recipe->options.precision;
    report->quantity = recipe->options.quantity;
    report->parts = recipe->scene->count;
    for (int64_t i = 0; i < recipe->scene->count; i++)
        report->triangles += recipe->scene->parts[i].mesh->triangles;
    for (int64_t i = 0; i < recipe->meshes.count; i++) report->vertices += recipe->meshes.meshes[i]->vertices;
    report->leaky_parts = recipe->leaky_count;
    report->nodes = recipe->model.nodes;
    report->bins = recipe->model.bins;
    report->bound = recipe->model.bound;
    report->verified = recipe->model.verified;
    report->strategy = recipe->strategy;
    skg_outcome_renew(recipe, outcome);
    return skg_alloc(recipe->leaky_count, sizeof *outcome->warned_bad, "leaky parts", &outcome->warned_bad);
}

void skg_outcome_release(skg_outcome *outcome) {
    skg_free(&outcome->overlaps);
    skg_free(&outcome->warned_bad);
}
