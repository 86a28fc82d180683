/* Effects of the beam, and of what stands in it beside the parts. */
#include "beam/bowtie.h"
#include "beam/grid.h"
#include "core/log.h"
#include "core/maths.h"
#include "core/text.h"
#include "geometry/optics.h"
#include "plan/decisions.h"
#include "plan/rules.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static const double degree = 180 / SKG_PI; /* of a radian */

/* Why a shade that is asked for is off; NULL: it is on. shades: how many it has. */
static const char *why_off(const skg_recipe *recipe, int needs_point, int32_t shades) {
    if (needs_point && recipe->view.projection != SKG_PROJECTION_POINT) return "the beam is parallel";
    return shades ? NULL : "one energy over its flat field does not show it";
}

static int has_world(const skg_recipe *recipe) {
    return recipe->options.world != NULL;
}

static void find_world(const skg_effect_facts *f, skg_effect_state *state) {
    const char *world = "vacuum";
    const int on = has_world(f->recipe) && skg_material_name_get(f->recipe->options.world, &world) == SKG_OK;
    skg_effect_set(state, on, "the parts stand in %s", world);
}

static double cost_world(const skg_effect_facts *f) {
    const double nodes = f->recipe->model.nodes;
    skg_attenuation shape;
    skg_decide_attenuation(f->recipe, &shape);
    return f->counts.passes * (SKG_COST_RAY + (shape.ratio ? nodes * (1 + SKG_COST_EXPONENTIAL) : 0));
}

static skg_status check_falloff(const skg_plan_options *options) {
    return options->falloff == SKG_FALLOFF_AUTO ? SKG_OK : skg_check_flag("falloff", options->falloff);
}

static void find_falloff(const skg_effect_facts *f, skg_effect_state *state) {
    skg_attenuation shape;
    skg_decide_attenuation(f->recipe, &shape);
    if (!shape.falloff)
        skg_effect_set(state, 0,
                       f->recipe->options.falloff ? "ratios to the flat field do not show it"
                                                  : "photons are counted per pixel");
    else if (f->recipe->view.projection != SKG_PROJECTION_POINT)
        skg_effect_set(state, 0, "the beam is parallel: its intensity is the same everywhere");
    else
        skg_effect_set(
            state, 1,
            "inverse square and obliquity, from the foot of the source's perpendicular on the detector's "
            "plane on");
}

static double cost_falloff(const skg_effect_facts *f) {
    return f->counts.passes * SKG_COST_RAY;
}

void skg_heel_init_sized(void *heel, int32_t size) {
    const skg_heel defaults = {.anode = 74, .angle_deg = 12, .bin_kev = 1};
    skg_struct_init(heel, size, &defaults, sizeof defaults);
}

static skg_status copy_heel(skg_recipe *recipe) {
    const skg_heel **heel = &recipe->options.heel;
    if (!*heel) return SKG_OK;
    return skg_copies_struct(&recipe->copies, *heel, "skg_heel", sizeof **heel, skg_heel_init_sized, heel);
}

static int has_heel(const skg_recipe *recipe) {
    return recipe->options.heel != NULL;
}

static void find_heel(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_shades *shades = &f->recipe->model.shades;
    const skg_shade_extent *extent = &shades->heel_extent;
    const char *off = has_heel(f->recipe) ? why_off(f->recipe, 1, shades->heel)
                                          : "not asked for: the spectrum is the same everywhere";
    if (off)
        skg_effect_set(state, 0, "%s", off);
    else
        skg_effect_set(
            state, 1,
            "photons leave the anode at %.3g to %.3g degrees; %" PRId32 " %s, to %.1g of the logarithm",
            asin(extent->middle - extent->half) * degree, asin(extent->middle + extent->half) * degree,
            shades->heel, skg_plural(shades->heel, "shade", "shades"), shades->heel_error);
}

static double cost_heel(const skg_effect_facts *f) {
    const skg_model *model = &f->recipe->model;
    return f->counts.passes * (SKG_COST_RAY + model->shades.heel * (SKG_SHADE_TERMS + (double)model->nodes));
}

static skg_status copy_bowtie(skg_recipe *recipe) {
    skg_copies *copies = &recipe->copies;
    skg_bowtie *ours = NULL;
    if (!recipe->options.bowtie) return SKG_OK;
    SKG_TRY(skg_copies_struct(copies, recipe->options.bowtie, "skg_bowtie", sizeof *ours,
                              skg_bowtie_init_sized, &ours));
    SKG_TRY(skg_bowtie_check(ours));
    SKG_TRY(skg_copies_array(copies, ours->count, "bow-tie", &ours->angle_deg));
    SKG_TRY(skg_copies_array(copies, ours->count, "bow-tie", &ours->path_mm));
    recipe->options.bowtie = ours;
    return skg_copies_material(copies, ours->material);
}

static int has_bowtie(const skg_recipe *recipe) {
    return recipe->options.bowtie != NULL;
}

static void find_bowtie(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_shades *shades = &f->recipe->model.shades;
    const skg_bowtie *bowtie = f->recipe->options.bowtie;
    const char *off = bowtie ? why_off(f->recipe, 1, shades->bowtie) : "none is given", *name = "";
    if (off || skg_material_name_get(bowtie->material, &name) != SKG_OK)
        skg_effect_set(state, 0, "%s", off);
    else
        skg_effect_set(state, 1, "of %s, %" PRId64 " rows; rays cross it at %.3g to %.3g degrees in the fan",
                       name, bowtie->count, shades->fan_angle[0] * degree, shades->fan_angle[1] * degree);
}

static double cost_bowtie(const skg_effect_facts *f) {
    return f->counts.passes * (2 * SKG_COST_RAY + SKG_COST_LOOKED_UP + (double)f->recipe->model.nodes);
}

static skg_status copy_collimation(skg_recipe *recipe) {
    const skg_collimation **collimation = &recipe->options.collimation;
    if (!*collimation) return SKG_OK;
    SKG_TRY(skg_copies_struct(&recipe->copies, *collimation, "skg_collimation", sizeof **collimation,
                              skg_collimation_init_sized, collimation));
    return skg_collimation_check(*collimation);
}

/* The share of the pixels that the middle of the source reaches past the jaws. */
static double find_share(const skg_recipe *recipe) {
    const skg_view *view = &recipe->view;
    skg_field field;
    skg_camera camera;
    int32_t window[4] = {0};
    if (skg_field_make(recipe->options.collimation, view, &field) == SKG_OK &&
        skg_camera_make(view, NULL, 0, 0, &camera) == SKG_OK)
        (void)skg_field_window(&field, &camera, window); /* the frame that is prepared has found its field */
    const double columns = fmax(0, window[1] - window[0]), rows = fmax(0, window[3] - window[2]);
    return columns * rows / ((double)view->columns * (double)view->rows);
}

/* The field that the jaws leave, in words. */
static void describe_jaws(const skg_recipe *recipe, char *text, size_t size) {
    const skg_collimation *collimation = recipe->options.collimation;
    char distance[48] = "";
    if (collimation->kind == SKG_COLLIMATION_DETECTOR) {
        snprintf(text, size, "the field is %g mm smaller than the detector on each side",
                 -collimation->margin_mm);
        return;
    }
    if (recipe->view.projection == SKG_PROJECTION_POINT)
        snprintf(distance, sizeof distance, ", %g mm from the source", collimation->distance_mm);
    snprintf(text, size, "jaws leave %g x %g mm%s", collimation->high[0] - collimation->low[0],
             collimation->high[1] - collimation->low[1], distance);
}

static void find_collimation(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_collimation *collimation = f->recipe->options.collimation;
    char jaws[160];
    if (!skg_collimation_limits(collimation)) {
        skg_effect_set(state, 0, "%s",
                       collimation && collimation->kind == SKG_COLLIMATION_DETECTOR
                           ? "the field holds the whole detector"
                           : "no jaws limit the beam");
        return;
    }
    const double share = find_share(f->recipe);
    describe_jaws(f->recipe, jaws, sizeof jaws);
    skg_effect_set(state, 1, "%s; %.3g %% of the pixels see the middle of the source", jaws, 100 * share);
    if (!(share > 0))
        skg_log(
            f->context, SKG_LOG_WARNING,
            "no ray from the middle of the source to a pixel passes the jaws, so the image is dark: %s; check the "
            "place and the size of the rectangle",
            jaws);
}

/* Four comparisons and a choice for each ray. */
static double cost_collimation(const skg_effect_facts *f) {
    return 5 * f->counts.passes;
}

static skg_status copy_grid(skg_recipe *recipe) {
    skg_copies *copies = &recipe->copies;
    skg_grid *ours = NULL;
    if (!recipe->options.grid) return SKG_OK;
    SKG_TRY(skg_copies_struct(copies, recipe->options.grid, "skg_grid", sizeof *ours, skg_grid_init_sized,
                              &ours));
    SKG_TRY(skg_grid_check(ours));
    recipe->options.grid = ours;
    SKG_TRY(skg_copies_material(copies, ours->strip));
    return skg_copies_material(copies, ours->interspace);
}

static int has_grid(const skg_recipe *recipe) {
    return recipe->options.grid != NULL;
}

static void find_grid(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_shades *shades = &f->recipe->model.shades;
    const skg_grid *grid = f->recipe->options.grid;
    const char *off = grid ? why_off(f->recipe, 0, shades->grid) : "none is given";
    char focus[64] = "parallel strips";
    if (off) {
        skg_effect_set(state, 0, "%s", off);
        return;
    }
    if (grid->focus_mm > 0) snprintf(focus, sizeof focus, "focus at %g mm", grid->focus_mm);
    skg_effect_set(state, 1,
                   "ratio %g, %g strips per cm, %s; rays lean across the strips by up to %.2g of the width "
                   "between them; %" PRId32 " shades, to %.1g of the logarithm",
                   grid->ratio, grid->lines_per_cm, focus, shades->grid_lean * grid->ratio, shades->grid,
                   shades->grid_error);
}

static double cost_grid(const skg_effect_facts *f) {
    const skg_model *model = &f->recipe->model;
    return f->counts.passes *
           (2 * SKG_COST_RAY + model->shades.grid * (SKG_COST_LOOKED_UP + (double)model->nodes));
}

static skg_status refuse_world(const char *call, const skg_recipe *recipe, int by_view) {
    if (!by_view || !has_world(recipe)) return SKG_OK;
    if (skg_quantity_is_ratio(&recipe->options))
        return skg_effect_no_view_gradient(call, "a ratio to the flat field of a world");
    return recipe->view.projection == SKG_PROJECTION_PARALLEL
               ? skg_effect_no_view_gradient(call, "a world in a parallel beam")
               : SKG_OK;
}

static void leave_out_world(skg_plan_options *options) {
    options->world = NULL;
}

const skg_effect_row skg_effect_world = {
    .name = "world material",
    .key = "World",
    .refuses_half = has_world,
    .refuses_gradient = refuse_world,
    .adjoint = "add_ray_lengths",
    .leave_out = leave_out_world,
    .find = find_world,
    .cost = cost_world,
};

static void leave_out_falloff(skg_plan_options *options) {
    options->falloff = SKG_FALLOFF_OFF;
}

const skg_effect_row skg_effect_falloff = {
    .name = "falloff",
    .key = "Falloff",
    .check = check_falloff,
    .adjoint = "add_distance",
    .leave_out = leave_out_falloff,
    .find = find_falloff,
    .cost = cost_falloff,
};

static skg_status refuse_heel(const char *call, const skg_recipe *recipe, int by_view) {
    return by_view && recipe->options.heel ? skg_effect_no_view_gradient(call, "the heel effect") : SKG_OK;
}

static void leave_out_heel(skg_plan_options *options) {
    options->heel = NULL;
}

const skg_effect_row skg_effect_heel = {
    .name = "heel effect",
    .key = "Heel",
    .self_test = SKG_SELF_TEST_HEEL,
    .copy = copy_heel,
    .refuses_half = has_heel,
    .refuses_gradient = refuse_heel,
    .adjoint = "weights.cl",
    .leave_out = leave_out_heel,
    .find = find_heel,
    .cost = cost_heel,
};

static skg_status refuse_bowtie(const char *call, const skg_recipe *recipe, int by_view) {
    return by_view && recipe->options.bowtie ? skg_effect_no_view_gradient(call, "a bow-tie filter") : SKG_OK;
}

static void leave_out_bowtie(skg_plan_options *options) {
    options->bowtie = NULL;
}

const skg_effect_row skg_effect_bowtie = {
    .name = "bow-tie filter",
    .key = "Bowtie",
    .self_test = SKG_SELF_TEST_SHADES,
    .copy = copy_bowtie,
    .refuses_half = has_bowtie,
    .refuses_gradient = refuse_bowtie,
    .adjoint = "weights.cl",
    .leave_out = leave_out_bowtie,
    .find = find_bowtie,
    .cost = cost_bowtie,
};

static skg_status refuse_collimation(const char *call, const skg_recipe *recipe, int by_view) {
    const int limits = skg_collimation_limits(recipe->options.collimation);
    return by_view && limits ? skg_effect_no_view_gradient(call, "a collimator") : SKG_OK;
}

static void leave_out_collimation(skg_plan_options *options) {
    options->collimation = NULL;
}

const skg_effect_row skg_effect_collimation = {
    .name = "collimation",
    .key = "Collimation",
    .self_test = SKG_SELF_TEST_SHADES,
    .copy = copy_collimation,
    .refuses_gradient = refuse_collimation,
    .adjoint = "weights.cl",
    .leave_out = leave_out_collimation,
    .predicted = 1,
    .find = find_collimation,
    .cost = cost_collimation,
};

static skg_status refuse_grid(const char *call, const skg_recipe *recipe, int by_view) {
    return by_view && recipe->options.grid ? skg_effect_no_view_gradient(call, "an anti-scatter grid")
                                           : SKG_OK;
}

static void leave_out_grid(skg_plan_options *options) {
    options->grid = NULL;
}

const skg_effect_row skg_effect_grid = {
    .name = "anti-scatter grid",
    .key = "Grid",
    .self_test = SKG_SELF_TEST_SHADES,
    .copy = copy_grid,
    .refuses_half = has_grid,
    .refuses_gradient = refuse_grid,
    .adjoint = "weights.cl",
    .leave_out = leave_out_grid,
    .predicted = 1,
    .find = find_grid,
    .cost = cost_grid,
};
