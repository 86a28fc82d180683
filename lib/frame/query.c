/* Questions that a plan answers about itself. */
#include "core/text.h"
#include "frame/plans.h"
#include "frame/quiet.h"
#include "plan/decisions.h"

#include <inttypes.h>
#include <string.h>

/* SKG_ERR_ARGUMENT for an index that does not exist. */
static skg_status check_index(const char *call, const char *what, int64_t index, int64_t count) {
    if (index >= 0 && index < count) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s: %s %" PRId64 " of %" PRId64, call, what, index, count);
}

void skg_plan_report_init_sized(void *report, int32_t size) {
    const skg_plan_report defaults = {0};
    skg_struct_init(report, size, &defaults, sizeof defaults);
}

skg_status skg_plan_report_get(const skg_plan *plan, skg_plan_report *report) {
    SKG_NEEDS(plan);
    skg_turn_take(plan->context->turn, NULL); /* frames that are handed over meanwhile write it */
    skg_plan_report ours = plan->outcome.report;
    ours.device_bytes = skg_machine_bytes(&plan->machine) + skg_scatterer_bytes(&plan->scatterer);
    skg_turn_give(plan->context->turn);
    return skg_struct_write(&ours, sizeof ours, "skg_plan_report", report);
}

skg_status skg_plan_precision_bound_get(const skg_plan *plan, double *bound) {
    SKG_PLAIN;
    SKG_NEEDS(plan);
    SKG_NEEDS(bound);
    const skg_recipe *recipe = plan->recipe;
    *bound = 0;
    return skg_plan_precision_bound(recipe, bound);
}

void skg_scatter_report_init_sized(void *report, int32_t size) {
    const skg_scatter_report defaults = {0};
    skg_struct_init(report, size, &defaults, sizeof defaults);
}

skg_status skg_plan_scatter_report_get(const skg_plan *plan, skg_scatter_report *report) {
    SKG_NEEDS(plan);
    const skg_scatterer *scatterer = &plan->scatterer;
    if (!plan->recipe->options.scatter)
        return skg_fail(SKG_ERR_ARGUMENT, "the plan has no scatter; set skg_plan_options.scatter (Scatter)");
    if (!scatterer->known)
        return skg_fail(SKG_ERR_ARGUMENT, "the scatter is known when a frame was submitted; none was yet");
    return skg_struct_write(&scatterer->report, sizeof scatterer->report, "skg_scatter_report", report);
}

void skg_channel_init_sized(void *channel, int32_t size) {
    const skg_channel defaults = {0};
    skg_struct_init(channel, size, &defaults, sizeof defaults);
}

skg_status skg_plan_channel_count(const skg_plan *plan, int64_t *count) {
    SKG_NEEDS(plan);
    SKG_NEEDS(count);
    *count = plan->recipe->model.channels;
    return SKG_OK;
}

/* Whether pixels get other values than I0 where there are no parts. */
static int is_uneven(const skg_recipe *recipe) {
    skg_attenuation shape;
    skg_decide_attenuation(recipe, &shape);
    return !skg_quantity_is_ratio(&recipe->options) &&
           (shape.falloff || shape.world_plane >= 0 || shape.shades->count > 0 || shape.collimated);
}

skg_status skg_plan_channel_get(const skg_plan *plan, int64_t index, skg_channel *channel) {
    SKG_NEEDS(plan);
    const skg_recipe *recipe = plan->recipe;
    SKG_TRY(check_index(__func__, "channel", index, recipe->model.channels));
    skg_channel ours = {.size = sizeof ours,
                        .uneven = is_uneven(recipe),
                        .name = recipe->channel_names[index].text,
                        .unit = skg_channel_unit(recipe->options.quantity)};
    SKG_TRY(skg_channel_flat_field(&recipe->options, &recipe->model, &recipe->view,
                                   skg_recipe_exposure(recipe, &recipe->view), index, &ours.flat_field));
    return skg_struct_write(&ours, sizeof ours, "skg_channel", channel);
}

skg_darkness skg_plan_darkness(const skg_plan *plan) {
    const skg_recipe *recipe = plan->recipe;
    const skg_plan_options *options = &recipe->options;
    const double exposure = skg_recipe_exposure(recipe, &recipe->view);
    skg_plan_options energy = *options;
    double kev = 0, shown = 0;
    energy.quantity = SKG_QUANTITY_ENERGY;
    const int known =
        skg_channel_flat_field(&energy, &recipe->model, &recipe->view, exposure, 0, &kev) == SKG_OK &&
        skg_channel_flat_field(options, &recipe->model, &recipe->view, exposure, 0, &shown) == SKG_OK;
    const double unit = known && kev > 0 ? shown / kev : 0;
    return (skg_darkness){unit * options->electronic_kev, unit * options->quantum_step_kev,
                          options->noise_seed};
}

skg_status skg_plan_node_count(const skg_plan *plan, int64_t *count) {
    SKG_NEEDS(plan);
    SKG_NEEDS(count);
    *count = plan->recipe->model.nodes;
    return SKG_OK;
}

skg_status skg_plan_node_get(const skg_plan *plan, int64_t index, double *energy_kev, double *photons,
                             double *weights) {
    SKG_NEEDS(plan);
    const skg_recipe *recipe = plan->recipe;
    const skg_model *model = &recipe->model;
    SKG_TRY(check_index(__func__, "node", index, model->nodes));
    if (energy_kev) *energy_kev = model->node_kev[index];
    if (photons) *photons = model->node_photons[index] * skg_recipe_exposure(recipe, &recipe->view);
    for (int32_t c = 0; weights && c < model->channels; c++) {
        weights[c] = 0;
        for (int32_t l = 0; l < model->layers; l++)
            weights[c] += model->weights[(index * model->layers + l) * model->channels + c];
    }
    return SKG_OK;
}

void skg_effect_init_sized(void *effect, int32_t size) {
    const skg_effect defaults = {0};
    skg_struct_init(effect, size, &defaults, sizeof defaults);
}

skg_status skg_plan_effect_count(const skg_plan *plan, int64_t *count) {
    SKG_NEEDS(plan);
    SKG_NEEDS(count);
    *count = SKG_EFFECTS;
    return SKG_OK;
}

skg_status skg_plan_effect_get(const skg_plan *plan, int64_t index, skg_effect *effect) {
    SKG_NEEDS(plan);
    SKG_TRY(check_index(__func__, "effect", index, SKG_EFFECTS));
    const skg_effect_state *state = &plan->outcome.effects[index];
    const skg_effect ours = {.size = sizeof ours,
                             .on = state->on,
                             .name = skg_effect_row_get(index)->name,
                             .cost = state->cost,
                             .reason = state->reason};
    return skg_struct_write(&ours, sizeof ours, "skg_effect", effect);
}

void skg_overlap_init_sized(void *overlap, int32_t size) {
    const skg_overlap defaults = {0};
    skg_struct_init(overlap, size, &defaults, sizeof defaults);
}

skg_status skg_plan_overlap_count(const skg_plan *plan, int64_t *count) {
    SKG_NEEDS(plan);
    SKG_NEEDS(count);
    *count = plan->outcome.overlap_count;
    return SKG_OK;
}

skg_status skg_plan_overlap_get(const skg_plan *plan, int64_t index, skg_overlap *overlap) {
    SKG_NEEDS(plan);
    SKG_TRY(check_index(__func__, "pair", index, plan->outcome.overlap_count));
    const skg_overlap_pair *pair = &plan->outcome.overlaps[index];
    skg_overlap ours = {.size = sizeof ours,
                        .protrudes = pair->kind == SKG_OVERLAP_PROTRUDES,
                        .part = pair->part,
                        .other = pair->other,
                        .volume = pair->volume,
                        .longest = pair->longest};
    memcpy(ours.place, pair->place, sizeof ours.place);
    return skg_struct_write(&ours, sizeof ours, "skg_overlap", overlap);
}

void skg_stage_init_sized(void *stage, int32_t size) {
    const skg_stage defaults = {0};
    skg_struct_init(stage, size, &defaults, sizeof defaults);
}

skg_status skg_plan_stage_count(const skg_plan *plan, int64_t *count) {
    SKG_NEEDS(plan);
    SKG_NEEDS(count);
    *count = plan->outcome.stage_count;
    return SKG_OK;
}

skg_status skg_plan_stage_get(const skg_plan *plan, int64_t index, skg_stage *stage) {
    SKG_NEEDS(plan);
    SKG_TRY(check_index(__func__, "stage", index, plan->outcome.stage_count));
    const skg_stage_time *time = &plan->outcome.stages[index];
    const skg_stage ours = {.size = sizeof ours, .name = time->name, .ns = time->ns};
    return skg_struct_write(&ours, sizeof ours, "skg_stage", stage);
}
