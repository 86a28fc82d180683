/* Effects of meshes and of where they lie. */
#include "core/text.h"
#include "plan/decisions.h"
#include "plan/rules.h"
#include "spectral/compression.h"

#include <inttypes.h>
#include <stdio.h>

static void find_nesting(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_scene *scene = f->recipe->scene;
    int64_t nested = 0;
    for (int64_t i = 0; i < scene->count; i++) nested += scene->parts[i].inside >= 0;
    if (nested)
        skg_effect_set(state, 1, "%" PRId64 " %s a parent: differences of mu, no pass", nested,
                       skg_plural(nested, "part displaces", "parts displace"));
    else
        skg_effect_set(state, 0, "no part names a parent");
}

static int has_leaky(const skg_recipe *recipe) {
    return recipe->leaky_count > 0;
}

static void find_leaky(const skg_effect_facts *f, skg_effect_state *state) {
    const int64_t count = f->recipe->leaky_count;
    if (count)
        skg_effect_set(state, 1, "%" PRId64 " %s not closed: each has a plane and a count of its own", count,
                       skg_plural(count, "part is", "parts are"));
    else
        skg_effect_set(state, 0, "every mesh is closed: signed hits cancel exactly");
}

static double cost_leaky(const skg_effect_facts *f) {
    return f->counts.passes * (double)f->recipe->leaky_count * 2 * SKG_COST_OF_PLANE;
}

static skg_status check_repair(const skg_plan_options *options) {
    return skg_check_choice("repair", options->repair, SKG_REPAIR_EXACT,
                            "SKG_REPAIR_NONE, _NEIGHBOURS or _EXACT");
}

static void find_repair(const skg_effect_facts *f, skg_effect_state *state) {
    static const char *const repairs[] = {
        [SKG_REPAIR_NONE] = "not asked for: bad pixels are left out",
        [SKG_REPAIR_NEIGHBOURS] = "bad pixels of a part get the mean of its nearest valid ones",
        [SKG_REPAIR_EXACT] =
            "rays of bad pixels are traced again on the host, through meshes with their holes capped",
    };
    const int32_t repair = f->recipe->options.repair;
    const int leaky = has_leaky(f->recipe);
    skg_effect_set(state, leaky && repair != SKG_REPAIR_NONE, "%s",
                   leaky ? repairs[repair] : "every mesh is closed");
}

static double cost_repair(const skg_effect_facts *f) {
    return f->counts.passes * (double)f->recipe->leaky_count * SKG_COST_REPAIRED;
}

static void find_source_plane(const skg_effect_facts *f, skg_effect_state *state) {
    if (f->near_source)
        skg_effect_set(state, 1, "%" PRId64 " %s the plane where rays start", f->near_source,
                       skg_plural(f->near_source, "part reaches", "parts reach"));
    else
        skg_effect_set(state, 0, "no part reaches the plane where rays start");
}

static skg_status check_overlaps(const skg_plan_options *options) {
    return skg_check_flag("overlaps", options->overlaps);
}

static void find_overlaps(const skg_effect_facts *f, skg_effect_state *state) {
    const int64_t count = f->overlap_count, side = f->overlap_side;
    char grid[128] = "";
    if (side > 0 && side < SKG_OVERLAP_SIDE)
        snprintf(grid, sizeof grid,
                 "; looked for along %" PRId64 " x %" PRId64
                 " columns instead of %d x %d, which would meet more than 10^7 surfaces",
                 side, side, (int)SKG_OVERLAP_SIDE, (int)SKG_OVERLAP_SIDE);
    if (!f->recipe->options.overlaps)
        skg_effect_set(state, 0, "not asked for");
    else
        skg_effect_set(state, 1, "%" PRId64 " %s%s", count,
                       skg_plural(count, "pair of parts overlaps, or a part leaves its parent",
                                  "pairs of parts overlap or leave their parent"),
                       grid);
}

static skg_status check_clip(const skg_plan_options *options) {
    SKG_TRY(skg_check_flag("unite", options->unite));
    return skg_check_flag("clip", options->clip);
}

static int has_priority(const skg_recipe *recipe) {
    return recipe->priority_possible;
}

static void find_priority(const skg_effect_facts *f, skg_effect_state *state) {
    if (!has_priority(f->recipe))
        skg_effect_set(state, 0, "no two parts of one parent differ in priority, and none is clipped");
    else if (f->competing == 0)
        skg_effect_set(state, 0, "parts of different priority keep apart in the plan's view");
    else
        skg_effect_set(state, 1, "the hits of %" PRId64 " %s are listed: they %s%s", f->competing,
                       skg_plural(f->competing, "part", "parts"),
                       f->recipe->options.unite ? "are united, and may compete" : "may compete",
                       f->recipe->options.clip ? ", or leave their parents" : "");
}

static double cost_priority(const skg_effect_facts *f) {
    return f->counts.passes * f->counts.listed * SKG_COST_LISTED;
}

const skg_effect_row skg_effect_nesting = {
    .name = "nesting",
    .key = "Parent",
    .adjoint = "skg_gradient_find_surroundings",
    .find = find_nesting,
};

static skg_status refuse_leaky(const char *call, const skg_recipe *recipe, int by_view) {
    (void)by_view;
    if (!has_leaky(recipe)) return SKG_OK;
    return skg_fail(SKG_ERR_UNSUPPORTED,
                    "%s: the mesh of part %s is not closed, and its repair has no gradient; close the mesh",
                    call, recipe->scene->parts[recipe->leaky[0]].label);
}

const skg_effect_row skg_effect_leaky = {
    .name = "leaky meshes",
    .self_test = SKG_SELF_TEST_LEAKY,
    .refuses_half = has_leaky,
    .refuses_gradient = refuse_leaky,
    .find = find_leaky,
    .cost = cost_leaky,
};

const skg_effect_row skg_effect_repair = {
    .name = "repair",
    .key = "Repair",
    .check = check_repair,
    .find = find_repair,
    .cost = cost_repair,
};

const skg_effect_row skg_effect_source_plane = {
    .name = "source plane",
    .self_test = SKG_SELF_TEST_SOURCE_PLANE,
    .find = find_source_plane,
};

static void leave_out_overlaps(skg_plan_options *options) {
    options->overlaps = 0;
}

const skg_effect_row skg_effect_overlaps = {
    .name = "overlap check",
    .check = check_overlaps,
    .leave_out = leave_out_overlaps,
    .find = find_overlaps,
};

static skg_status refuse_union(const char *call, const skg_recipe *recipe, int by_view) {
    (void)by_view;
    return recipe->options.unite
               ? skg_effect_no_gradient(call, "the union of components",
                                        "make the plan without unite, of meshes that do not overlap")
               : SKG_OK;
}

const skg_effect_row skg_effect_priority = {
    .name = "priority",
    .key = "Priority",
    .self_test = SKG_SELF_TEST_PRIORITY,
    .check = check_clip,
    .refuses_half = has_priority,
    .refuses_gradient = refuse_union,
    .adjoint = "slopes.cl",
    .find = find_priority,
    .cost = cost_priority,
};
