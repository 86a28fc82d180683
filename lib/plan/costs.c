/* What effects cost, estimated from what they do: counts of operations per pixel, over those of a frame
 * without any. */
#include "plan/report.h"
#include "spectral/compress.h"

#include <math.h>

/* Multiply-adds: an exponential; a triangle set up; what an effect does for a pixel (a deviate with its
 * random words, the ray's length, a pixel of a repair), and for a hit that is listed and sorted. Rough. */
static const double EXPONENTIAL = 12, TRIANGLE = 100, DEVIATE = 100, RAY = 10, MENDED = 30, LISTED = 200;

typedef struct {
    const skg_plan *plan;
    double pixels, hits; /* of a pass; hits per pixel that closed parts write */
    double passes;
} counts;

/* A closed part covers about its rectangle, front and back. */
static double hits_of(const counts *c, const skg_extent *extent) {
    const skg_scale_part *r = &extent->scale;
    const skg_view *view = &c->plan->view;
    if (!extent->on_detector) return 0;
    const double width = fmin(r->high_column, (double)view->columns) - fmax(r->low_column, 0);
    const double height = fmin(r->high_row, (double)view->rows) - fmax(r->low_row, 0);
    return 2 * fmax(width, 0) * fmax(height, 0) / c->pixels;
}

static counts count(const skg_plan *plan, const skg_extent *extents) {
    counts c = {.plan = plan,
                .pixels = (double)plan->view.columns * (double)plan->view.rows,
                .passes = (double)plan->report.samples};
    for (int64_t p = 0; p < plan->scene->count; p++)
        if (plan->model.first_contribution[p + 1] > plan->model.first_contribution[p])
            c.hits += hits_of(&c, &extents[p]);
    return c;
}

/* Planes, and exponentials for every channel, of one pass. */
static double attenuation(const skg_model *model, double nodes, double planes) {
    return planes * SKG_COST_OF_PLANE + nodes * (planes + EXPONENTIAL + model->channels);
}

static double writes_per_part(const skg_model *model, int64_t parts) {
    int64_t adding = 0;
    for (int64_t p = 0; p < parts; p++)
        adding += model->first_contribution[p + 1] > model->first_contribution[p];
    return adding ? (double)model->first_contribution[parts] / (double)adding : 1;
}

/* What of the plan's effects costs anything, in multiply-adds per pixel of a frame. plain: a pass without. */
static double cost_of(const counts *c, int effect, double plain, double pass) {
    const skg_plan *plan = c->plan;
    const skg_model *model = &plan->model;
    const double nodes = model->nodes, planes = model->planes, channels = model->channels;
    const double shifts = (double)(plan->samples.shifts * plan->samples.shifts);
    switch (effect) {
    case SKG_EFFECT_ENERGIES:
        return pass - plain;
    case SKG_EFFECT_COMPRESSION:
        return attenuation(model, nodes, planes) - attenuation(model, model->bins, model->materials);
    case SKG_EFFECT_SOURCE:
        return (c->passes / shifts - 1) * pass;
    case SKG_EFFECT_SUPERSAMPLING:
        return (c->passes - c->passes / shifts) * pass;
    case SKG_EFFECT_WORLD:
        return c->passes * (RAY + (plan->attenuation.ratio ? nodes * (1 + EXPONENTIAL) : 0));
    case SKG_EFFECT_FALLOFF:
        return c->passes * RAY;
    case SKG_EFFECT_OPEN:
        return c->passes * (double)plan->open_count * 2 * SKG_COST_OF_PLANE;
    case SKG_EFFECT_REPAIR:
        return c->passes * (double)plan->open_count * MENDED;
    case SKG_EFFECT_PRIORITY:
        return c->passes * c->hits * LISTED;
    case SKG_EFFECT_NOISE:
        return c->passes * channels * (nodes + DEVIATE);
    case SKG_EFFECT_BLUR:
        return channels * (double)skg_blur_samples(plan->blur);
    case SKG_EFFECT_ELECTRONIC:
        return channels * DEVIATE;
    case SKG_EFFECT_QUANTISATION:
        return channels;
    default: /* in what is done anyway, or when the plan is made */
        return 0;
    }
}

void skg_report_costs(skg_plan *plan, const skg_extent *extents) {
    const skg_model *model = &plan->model;
    const counts c = count(plan, extents);
    const double set_up = TRIANGLE * (double)plan->report.triangles / c.pixels;
    const double plain = set_up + c.hits * SKG_COST_OF_CONTRIBUTION + attenuation(model, 1, 1);
    const double pass = set_up +
                        c.hits * SKG_COST_OF_CONTRIBUTION * writes_per_part(model, plan->scene->count) +
                        attenuation(model, model->nodes, model->planes);
    for (int e = 0; e < SKG_EFFECTS; e++)
        plan->effects[e].cost = plan->effects[e].on ? cost_of(&c, e, plain, pass) / plain : 0;
}
