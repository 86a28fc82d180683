#include "plan/costs.h"
#include "plan/decide.h"
#include "spectral/compress.h"

#include <math.h>

/* Rough numbers of multiply-adds. */
static const double EXPONENTIAL = 12; /* an exponential */
static const double TRIANGLE = 100;   /* setting up a triangle */
static const double DEVIATE = 100;    /* a random deviate with its random words */
static const double RAY = 10;         /* the length of a ray */
static const double REPAIRED = 30;    /* a pixel of a repair */
static const double LISTED = 200;     /* a hit that is listed and sorted */
static const double LOOKED_UP = 10;   /* two rows of a table */

typedef struct {
    const skg_recipe *recipe;
    const skg_layers *layers;
    double pixels;
    double hits;   /* of a pass, per pixel */
    double listed; /* of these, hits that are listed for priorities */
    double passes; /* rays of a pixel */
    double set_up; /* of triangles, in a pass */
} counts;

/* Hits per pixel of the detector: a closed part covers about its rectangle, front and back. */
static double hits_of(const counts *c, const skg_extent *extent) {
    const skg_scale_part *r = &extent->scale;
    const skg_view *view = &c->recipe->view;
    if (!extent->on_detector) return 0;
    const double width = fmin(r->high_column, (double)view->columns) - fmax(r->low_column, 0);
    const double height = fmin(r->high_row, (double)view->rows) - fmax(r->low_row, 0);
    return 2 * fmax(width, 0) * fmax(height, 0) / c->pixels;
}

/* The same, in the window of a priority. */
static double listed_of(const counts *c, const skg_extent *extent, const int32_t window[4]) {
    const skg_scale_part *r = &extent->scale;
    if (!extent->on_detector) return 0;
    const double width = fmin(r->high_column, window[3]) - fmax(r->low_column, window[2]);
    const double height = fmin(r->high_row, window[1]) - fmax(r->low_row, window[0]);
    return 2 * fmax(width, 0) * fmax(height, 0) / c->pixels;
}

static counts count(const skg_recipe *recipe, const skg_layers *layers, const skg_extent *extents,
                    const skg_priority *priority) {
    counts c = {.recipe = recipe,
                .layers = layers,
                .pixels = (double)recipe->view.columns * (double)recipe->view.rows,
                .passes = (double)skg_samples_count(&recipe->samples)};
    for (int64_t p = 0; p < recipe->scene->count; p++)
        if (recipe->model.first_contribution[p + 1] > recipe->model.first_contribution[p])
            c.hits += hits_of(&c, &extents[p]);
    for (int64_t s = 0; s < priority->count; s++)
        c.listed += listed_of(&c, &extents[priority->parts[s]], priority->window);
    return c;
}

/* Planes, and exponentials for every channel, of one pass. */
static double attenuation(const skg_model *model, double nodes, double planes) {
    return planes * SKG_COST_OF_PLANE + nodes * (planes + EXPONENTIAL + model->channels);
}

static double contributions_per_part(const skg_model *model, int64_t parts) {
    int64_t adding = 0;
    for (int64_t p = 0; p < parts; p++)
        adding += model->first_contribution[p + 1] > model->first_contribution[p];
    return adding ? (double)model->first_contribution[parts] / (double)adding : 1;
}

/* Samples of the blurs of all layers, or of the last one alone. */
static double blur_samples(const counts *c, int last) {
    double samples = 0;
    for (int32_t l = last ? c->layers->count - 1 : 0; l < c->layers->count; l++)
        samples += (double)skg_blur_samples(c->layers->blurs[l]);
    return samples;
}

/* Multiply-adds per pixel of a frame that an effect costs. plain: those of a pass without effects; pass: of a pass. */
static double cost_of(const counts *c, int effect, double plain, double pass) {
    const skg_recipe *recipe = c->recipe;
    const skg_model *model = &recipe->model;
    const double nodes = model->nodes, planes = model->planes, channels = model->channels;
    const double shifts = (double)(recipe->samples.shifts * recipe->samples.shifts);
    skg_attenuation shape;
    skg_decide_attenuation(recipe, &shape);
    switch (effect) {
    case SKG_EFFECT_ENERGIES:
        return pass - plain;
    case SKG_EFFECT_COMPRESSION:
        return attenuation(model, nodes, planes) - attenuation(model, model->bins, model->materials);
    case SKG_EFFECT_SOURCE:
        return (c->passes / shifts - 1) * pass;
    case SKG_EFFECT_SUPERSAMPLING:
        return (c->passes - c->passes / shifts) * (recipe->samples.fine > 1 ? pass - c->set_up : pass);
    case SKG_EFFECT_WORLD:
        return c->passes * (RAY + (shape.ratio ? nodes * (1 + EXPONENTIAL) : 0));
    case SKG_EFFECT_FALLOFF:
        return c->passes * RAY;
    case SKG_EFFECT_HEEL:
        return c->passes * (RAY + model->shades.heel * (SKG_SHADE_TERMS + nodes));
    case SKG_EFFECT_OBLIQUE:
        return c->passes * (RAY + model->shades.oblique * (SKG_SHADE_TERMS + nodes));
    case SKG_EFFECT_BOWTIE:
        return c->passes * (2 * RAY + LOOKED_UP + nodes);
    case SKG_EFFECT_GRID:
        return c->passes * (2 * RAY + model->shades.grid * (LOOKED_UP + nodes));
    case SKG_EFFECT_LEAKY:
        return c->passes * (double)recipe->leaky_count * 2 * SKG_COST_OF_PLANE;
    case SKG_EFFECT_REPAIR:
        return c->passes * (double)recipe->leaky_count * REPAIRED;
    case SKG_EFFECT_PRIORITY:
        return c->passes * c->listed * LISTED;
    case SKG_EFFECT_NOISE:
        return c->passes * channels * (nodes + DEVIATE);
    case SKG_EFFECT_BLUR:
        return channels * (double)skg_blur_samples(c->layers->blurs[0]);
    case SKG_EFFECT_DEPTHS:
    case SKG_EFFECT_DQE:
        return channels * blur_samples(c, effect == SKG_EFFECT_DQE) + c->passes * nodes * (model->layers - 1);
    case SKG_EFFECT_ELECTRONIC:
        return channels * DEVIATE;
    case SKG_EFFECT_QUANTISATION:
        return channels;
    default: /* part of what is done anyway, or done when the plan is made */
        return 0;
    }
}

void skg_costs_estimate(const skg_recipe *recipe, const skg_layers *layers, const skg_extent *extents,
                        const skg_priority *priority, skg_outcome *outcome) {
    const skg_model *model = &recipe->model;
    counts c = count(recipe, layers, extents, priority);
    const double set_up = TRIANGLE * (double)outcome->report.triangles / c.pixels;
    c.set_up = set_up;
    const double plain = set_up + c.hits * SKG_COST_OF_CONTRIBUTION + attenuation(model, 1, 1);
    const double pass =
        set_up + c.hits * SKG_COST_OF_CONTRIBUTION * contributions_per_part(model, recipe->scene->count) +
        attenuation(model, model->nodes, model->planes);
    for (int e = 0; e < SKG_EFFECTS; e++) {
        skg_effect_state *effect = &outcome->effects[e];
        effect->cost = effect->on ? cost_of(&c, e, plain, pass) / plain : 0;
    }
}
