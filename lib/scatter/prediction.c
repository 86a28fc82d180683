/* Predicts the scatter of a plan's images from few histories, on a coarse detector. */
#include "scatter/scatterer.h"

#include "core/text.h"
#include "plan/decisions.h"
#include "plan/rules.h"

#include <math.h>

enum { SIDE = 64, HISTORIES = 8192 };

/* The error of energies: far below what so few histories make. */
static const double TOLERANCE = 0.01;

/* Of the cells: a third of what is promised. */
static const double CELLS = 0.05;

/* Primary over open beam below which a pixel lies in the shadow. */
static const double SHADOW = 0.99;

void skg_scatter_prediction_init_sized(void *prediction, int32_t size) {
    const skg_scatter_prediction defaults = {0};
    skg_struct_init(prediction, size, &defaults, sizeof defaults);
}

/* The detector in at most SIDE pixels along each side. */
static skg_view coarse_view(const skg_view *view) {
    skg_view coarse = *view;
    if (coarse.columns > SIDE) coarse.columns = SIDE;
    if (coarse.rows > SIDE) coarse.rows = SIDE;
    for (int k = 0; k < 3; k++) {
        coarse.column_step[k] *= (double)view->columns / (double)coarse.columns;
        coarse.row_step[k] *= (double)view->rows / (double)coarse.rows;
    }
    return coarse;
}

/* Without what changes the ratio little and scatter is not simulated with. */
static skg_plan_options coarse_options(const skg_recipe *recipe, const skg_scatter *scatter) {
    skg_plan_options options = recipe->options;
    options.strategy = SKG_STRATEGY_AUTO;
    options.precision = SKG_PRECISION_SINGLE;
    options.quantity = SKG_QUANTITY_ENERGY;
    options.tile = options.profile = 0;
    options.view_count = 0, options.views = NULL;
    skg_effects_leave_out(&options);
    options.tolerance = fmax(options.tolerance, TOLERANCE);
    options.scatter = scatter;
    return options;
}

static double primary_at(const skg_scatter_rendering *r, int64_t i) {
    return (double)r->image[i] - (double)r->scatter[i];
}

static double ratio_of(double a, double b) {
    return b > 0 ? a / b : a > 0 ? HUGE_VAL : 0;
}

/* bare: without the grid, which takes some of the open beam, too */
static void sum_up(int64_t count, const skg_scatter_rendering *r, const skg_scatter_rendering *bare,
                   skg_scatter_prediction *prediction) {
    double scattered = 0, primary = 0, square = 0;
    for (int64_t i = 0; i < count; i++) {
        const double s = (double)r->scatter[i];
        square += s * s / (double)count;
        prediction->max = fmax(prediction->max, s / r->open);
        if (!(primary_at(bare, i) / bare->open < SHADOW)) continue;
        scattered += s;
        primary += primary_at(r, i);
    }
    prediction->rms = sqrt(square) / r->open;
    prediction->ratio = ratio_of(scattered, primary);
}

/* Fills the grid's transmissions for primary, scatter and both. r: with the grid; bare: without */
static void compare(int64_t count, const skg_scatter_rendering *r, const skg_scatter_rendering *bare,
                    skg_scatter_prediction *prediction) {
    double primary[2] = {0}, scatter[2] = {0};
    for (int64_t i = 0; i < count; i++) {
        primary[0] += primary_at(r, i), scatter[0] += (double)r->scatter[i];
        primary[1] += primary_at(bare, i), scatter[1] += (double)bare->scatter[i];
    }
    prediction->grid_primary = ratio_of(primary[0], primary[1]);
    prediction->grid_scatter = ratio_of(scatter[0], scatter[1]);
    prediction->grid_total = ratio_of(primary[0] + scatter[0], primary[1] + scatter[1]);
}

skg_status skg_scatter_predict(const skg_recipe *recipe, skg_scatter_render render, void *user,
                               skg_scatter_prediction *prediction) {
    const skg_view view = coarse_view(&recipe->view);
    const int64_t count = view.rows * view.columns;
    float *images = NULL;
    skg_scatter scatter;
    skg_status status = SKG_OK;
    if (recipe->options.counter)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "a detector that counts (Counting) takes no scatter; leave Counting out to see how much "
            "arrives");
    skg_scatter_init(&scatter);
    scatter.histories = HISTORIES, scatter.tolerance = CELLS;
    skg_plan_options options = coarse_options(recipe, &scatter);
    const int has_grid = options.grid != NULL;
    SKG_TRY_CLEANUP(skg_alloc(4 * count, sizeof *images, "prediction of scatter", &images));
    skg_scatter_rendering own = {images, images + count, 0},
                          bare = {images + 2 * count, images + 3 * count, 0};
    SKG_TRY_CLEANUP(render(user, &view, &options, &own));
    skg_effect_grid.leave_out(&options);
    if (has_grid) SKG_TRY_CLEANUP(render(user, &view, &options, &bare));
    sum_up(count, &own, has_grid ? &bare : &own, prediction);
    if (has_grid) compare(count, &own, &bare, prediction);
    prediction->called_for = prediction->ratio > recipe->options.tolerance;
cleanup:
    skg_free(&images);
    return status;
}
