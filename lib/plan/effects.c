/* The table of effects: what goes over all rows. */
#include "plan/decisions.h"
#include "plan/rules.h"

#include <stdio.h>
#include <string.h>

static const skg_effect_row *const rows[SKG_EFFECTS] = {
#define SKG_EFFECT_ADDRESS(row) &skg_effect_##row,
    SKG_EFFECT_ROWS(SKG_EFFECT_ADDRESS)
#undef SKG_EFFECT_ADDRESS
};

const skg_effect_row *skg_effect_row_get(int64_t index) {
    return rows[index];
}

skg_status skg_effects_copy(skg_recipe *recipe) {
    for (int e = 0; e < SKG_EFFECTS; e++)
        if (rows[e]->copy) SKG_TRY(rows[e]->copy(recipe));
    return SKG_OK;
}

skg_status skg_effects_check(const skg_plan_options *options) {
    for (int e = 0; e < SKG_EFFECTS; e++)
        if (rows[e]->check) SKG_TRY(rows[e]->check(options));
    return SKG_OK;
}

int skg_effects_refuse_half(const skg_recipe *recipe, size_t size, char *names) {
    const char *found[SKG_EFFECTS];
    int count = 0;
    for (int e = 0; e < SKG_EFFECTS; e++)
        if (rows[e]->refuses_half && rows[e]->refuses_half(recipe)) found[count++] = rows[e]->name;
    names[0] = '\0';
    for (int k = 0; k < count; k++) {
        const size_t length = strlen(names);
        snprintf(names + length, size - length, "%s%s",
                 k == 0          ? ""
                 : k + 1 < count ? ", "
                                 : " and ",
                 found[k]);
    }
    return count;
}

skg_status skg_effects_check_gradient(const char *call, const skg_recipe *recipe, int by_view) {
    for (int e = 0; e < SKG_EFFECTS; e++)
        if (rows[e]->refuses_gradient) SKG_TRY(rows[e]->refuses_gradient(call, recipe, by_view));
    return SKG_OK;
}

void skg_effects_leave_out(skg_plan_options *options) {
    for (int e = 0; e < SKG_EFFECTS; e++)
        if (rows[e]->leave_out && !rows[e]->predicted) rows[e]->leave_out(options);
}

/* Facts that follow from where the parts lie. */
static skg_status find_places(skg_effect_facts *facts) {
    const skg_recipe *recipe = facts->recipe;
    const skg_scene *scene = recipe->scene;
    skg_camera camera;
    skg_extent *extents = NULL;
    skg_priority priority = {0};
    skg_status status = SKG_OK;
    SKG_TRY(skg_camera_make(&recipe->view, NULL, 0, 0, &camera));
    SKG_TRY(skg_alloc(scene->count, sizeof *extents, "effects", &extents));
    for (int64_t i = 0; i < scene->count; i++) {
        skg_extent_find(&camera, scene->parts[i].mesh, scene->parts[i].pose, skg_recipe_last_bit(recipe),
                        &extents[i]);
        facts->near_source += extents[i].near_source && extents[i].on_detector;
    }
    if (recipe->priority_possible)
        SKG_TRY_CLEANUP(skg_priority_find(scene,
                                          skg_priority_rules(recipe->options.clip, recipe->options.unite),
                                          &camera, extents, &priority));
    facts->competing = priority.count;
    facts->counts = skg_costs_count(recipe, extents, &priority);
cleanup:
    skg_priority_release(&priority);
    skg_free(&extents);
    return status;
}

skg_status skg_effects_find(const skg_recipe *recipe, const skg_context *context, const skg_layers *layers,
                            skg_outcome *outcome) {
    skg_effect_facts facts = {.recipe = recipe,
                              .context = context,
                              .layers = layers,
                              .sample_error = outcome->report.sample_error,
                              .overlap_count = outcome->overlap_count,
                              .overlap_side = outcome->overlap_side};
    SKG_TRY(find_places(&facts));
    for (int e = 0; e < SKG_EFFECTS; e++) {
        skg_effect_state *state = &outcome->effects[e];
        rows[e]->find(&facts, state);
        state->cost = state->on && rows[e]->cost ? rows[e]->cost(&facts) / facts.counts.plain : 0;
    }
    return SKG_OK;
}
