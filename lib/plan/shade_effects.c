/* Which of heel, bow-tie, grid, oblique scintillator and K escape are on, and why. */
#include "plan/shade_effects.h"

#include "core/maths.h"
#include "core/names.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static const double degree = 180 / SKG_PI; /* of a radian */

/* Why a shade that is asked for is off; NULL: it is on. shades: how many it has. */
static const char *why_off(const skg_recipe *recipe, int needs_point, int32_t shades) {
    if (needs_point && recipe->view.projection != SKG_PROJECTION_POINT) return "the beam is parallel";
    return shades ? NULL : "one energy over its flat field does not show it";
}

static void find_heel(const skg_recipe *recipe, skg_outcome *outcome) {
    const skg_shades *shades = &recipe->model.shades;
    const skg_shade_extent *extent = &shades->heel_extent;
    const char *off = recipe->options.heel ? why_off(recipe, 1, shades->heel)
                                           : "not asked for: the spectrum is the same everywhere";
    if (off)
        skg_effect_set(outcome, SKG_EFFECT_HEEL, 0, "%s", off);
    else
        skg_effect_set(
            outcome, SKG_EFFECT_HEEL, 1,
            "photons leave the anode at %.3g to %.3g degrees; %" PRId32 " %s, to %.1g of the logarithm",
            asin(extent->middle - extent->half) * degree, asin(extent->middle + extent->half) * degree,
            shades->heel, skg_plural(shades->heel, "shade", "shades"), shades->heel_error);
}

static void find_bowtie(const skg_recipe *recipe, skg_outcome *outcome) {
    const skg_shades *shades = &recipe->model.shades;
    const skg_bowtie *bowtie = recipe->options.bowtie;
    const char *off = bowtie ? why_off(recipe, 1, shades->bowtie) : "none is given", *name = "";
    if (off || skg_material_name_get(bowtie->material, &name) != SKG_OK)
        skg_effect_set(outcome, SKG_EFFECT_BOWTIE, 0, "%s", off);
    else
        skg_effect_set(outcome, SKG_EFFECT_BOWTIE, 1,
                       "of %s, %" PRId64 " rows; rays cross it at %.3g to %.3g degrees in the fan", name,
                       bowtie->count, shades->fan_angle[0] * degree, shades->fan_angle[1] * degree);
}

static void find_grid(const skg_recipe *recipe, skg_outcome *outcome) {
    const skg_shades *shades = &recipe->model.shades;
    const skg_grid *grid = recipe->options.grid;
    const char *off = grid ? why_off(recipe, 0, shades->grid) : "none is given";
    char focus[64] = "parallel strips";
    if (off) {
        skg_effect_set(outcome, SKG_EFFECT_GRID, 0, "%s", off);
        return;
    }
    if (grid->focus_mm > 0) snprintf(focus, sizeof focus, "focus at %g mm", grid->focus_mm);
    skg_effect_set(outcome, SKG_EFFECT_GRID, 1,
                   "ratio %g, %g strips per cm, %s; rays lean across the strips by up to %.2g of the width "
                   "between them; %" PRId32 " shades, to %.1g of the logarithm",
                   grid->ratio, grid->lines_per_cm, focus, shades->grid_lean * grid->ratio, shades->grid,
                   shades->grid_error);
}

static void find_oblique(const skg_recipe *recipe, skg_outcome *outcome) {
    const skg_shades *shades = &recipe->model.shades;
    const skg_shade_extent *extent = &shades->oblique_extent;
    if (!recipe->options.oblique)
        skg_effect_set(outcome, SKG_EFFECT_OBLIQUE, 0,
                       recipe->options.response ? "not asked for: photons cross the layer straight"
                                                : "the detector is ideal");
    else if (extent->half > 0 && shades->oblique == 0)
        skg_effect_set(outcome, SKG_EFFECT_OBLIQUE, 0, "every ray crosses the layer straight");
    else if (shades->oblique == 0)
        skg_effect_set(outcome, SKG_EFFECT_OBLIQUE, 0, "one energy over its flat field does not show it");
    else
        skg_effect_set(outcome, SKG_EFFECT_OBLIQUE, 1,
                       "paths through the layer are up to %.4g times its thickness; %" PRId32
                       " %s, to %.1g of the logarithm",
                       1 / (extent->middle - extent->half), shades->oblique,
                       skg_plural(shades->oblique, "shade", "shades"), shades->oblique_error);
}

static void find_escape(const skg_recipe *recipe, skg_outcome *outcome) {
    const skg_response *response = recipe->options.response;
    if (skg_response_escapes(response))
        skg_effect_set(
            outcome, SKG_EFFECT_ESCAPE, 1,
            "K fluorescence leaves the scintillator: recorded energies and Swank factors are those "
            "of its pulse heights");
    else
        skg_effect_set(outcome, SKG_EFFECT_ESCAPE, 0, "%s",
                       !response ? "the detector is ideal"
                       : skg_response_is_layer(response)
                           ? "not asked for: every photon that interacts is absorbed"
                           : "the response is a table");
}

void skg_effects_find_shades(const skg_recipe *recipe, skg_outcome *outcome) {
    find_heel(recipe, outcome);
    find_bowtie(recipe, outcome);
    find_grid(recipe, outcome);
    find_oblique(recipe, outcome);
    find_escape(recipe, outcome);
}
