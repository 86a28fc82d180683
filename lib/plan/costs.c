/* Counts operations, from which the costs of effects are estimated. */
#include "plan/decisions.h"
#include "plan/rules.h"
#include "spectral/compression.h"

#include <math.h>

/* Hits per pixel in a window: a closed part covers about its rectangle, front and back. */
static double hits_of(const skg_extent *extent, const double window[4], double pixels) {
    const skg_scale_part *r = &extent->scale;
    if (!extent->on_detector) return 0;
    const double width = fmin(r->high_column, window[3]) - fmax(r->low_column, window[2]);
    const double height = fmin(r->high_row, window[1]) - fmax(r->low_row, window[0]);
    return 2 * fmax(width, 0) * fmax(height, 0) / pixels;
}

double skg_cost_of_attenuation(const skg_model *model, double nodes, double planes) {
    return planes * SKG_COST_OF_PLANE + nodes * (planes + SKG_COST_EXPONENTIAL + model->channels);
}

static double contributions_per_part(const skg_model *model, int64_t parts) {
    int64_t adding = 0;
    for (int64_t p = 0; p < parts; p++)
        adding += model->first_contribution[p + 1] > model->first_contribution[p];
    return adding ? (double)model->first_contribution[parts] / (double)adding : 1;
}

skg_cost_counts skg_costs_count(const skg_recipe *recipe, const skg_extent *extents,
                                const skg_priority *priority) {
    const skg_model *model = &recipe->model;
    const skg_view *view = &recipe->view;
    const int64_t parts = recipe->scene->count;
    const double pixels = (double)view->columns * (double)view->rows;
    const double all[4] = {0, (double)view->rows, 0, (double)view->columns};
    const double window[4] = {priority->window[0], priority->window[1], priority->window[2],
                              priority->window[3]};
    skg_cost_counts c = {.passes = (double)skg_samples_count(&recipe->samples),
                         .set_up = SKG_COST_TRIANGLE * (double)skg_scene_triangles(recipe->scene) / pixels};
    double hits = 0;
    for (int64_t p = 0; p < parts; p++)
        if (model->first_contribution[p + 1] > model->first_contribution[p])
            hits += hits_of(&extents[p], all, pixels);
    for (int64_t s = 0; s < priority->count; s++)
        c.listed += hits_of(&extents[priority->parts[s]], window, pixels);
    c.plain = c.set_up + hits * SKG_COST_OF_CONTRIBUTION + skg_cost_of_attenuation(model, 1, 1);
    c.pass = c.set_up + hits * SKG_COST_OF_CONTRIBUTION * contributions_per_part(model, parts) +
             skg_cost_of_attenuation(model, model->nodes, model->planes);
    return c;
}
