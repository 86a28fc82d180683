/* The scatter of a plan's images from few histories, on a coarse detector, by a plan of its own. */
#include "core/clock.h"
#include "core/text.h"
#include "frame/plans.h"
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

/* Primary and scatter, and the open beam. */
typedef struct {
    float *image, *scatter; /* [count] all photons, and the scattered ones */
    double open;
} rendering;

static skg_status render(const skg_plan *plan, const skg_plan_options *options, rendering *r) {
    const skg_recipe *recipe = plan->recipe;
    const skg_view view = coarse_view(&recipe->view);
    skg_plan *made = NULL;
    skg_job *job = NULL;
    skg_channel channel;
    skg_output outputs[2];
    skg_status status = SKG_OK;
    skg_channel_init(&channel);
    for (int k = 0; k < 2; k++) {
        skg_output_init(&outputs[k]);
        outputs[k].data = k ? r->scatter : r->image;
    }
    outputs[1].kind = SKG_OUTPUT_SCATTER;
    SKG_TRY_CLEANUP(skg_plan_create(plan->context, recipe->scene, &view, recipe->spectrum, options, &made));
    SKG_TRY_CLEANUP(skg_plan_channel_get(made, 0, &channel));
    r->open = channel.flat_field;
    SKG_TRY_CLEANUP(skg_plan_outputs_submit(made, 1, NULL, 2, outputs, &job));
    status = skg_job_wait(&job);
cleanup:
    skg_plan_release(&made);
    /* Path lengths outside the verified range matter to no ratio. */
    return status == SKG_RANGE ? SKG_OK : status;
}

static double primary_at(const rendering *r, int64_t i) {
    return (double)r->image[i] - (double)r->scatter[i];
}

static double ratio_of(double a, double b) {
    return b > 0 ? a / b : a > 0 ? HUGE_VAL : 0;
}

/* bare: without the grid, which takes some of the open beam, too */
static void sum_up(int64_t count, const rendering *r, const rendering *bare,
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

/* What the grid passes. */
static void compare(int64_t count, const rendering *r, const rendering *bare,
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

static skg_status predict(skg_plan *plan, skg_scatter_prediction *prediction) {
    const skg_recipe *recipe = plan->recipe;
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
    rendering own = {images, images + count, 0}, bare = {images + 2 * count, images + 3 * count, 0};
    SKG_TRY_CLEANUP(render(plan, &options, &own));
    skg_effect_grid.leave_out(&options);
    if (has_grid) SKG_TRY_CLEANUP(render(plan, &options, &bare));
    sum_up(count, &own, has_grid ? &bare : &own, prediction);
    if (has_grid) compare(count, &own, &bare, prediction);
    prediction->called_for = prediction->ratio > recipe->options.tolerance;
cleanup:
    skg_free(&images);
    return status;
}

/* What the caller was told of the scene is not told again. */
static skg_status predict_silently(skg_plan *plan, skg_scatter_prediction *prediction) {
    SKG_PLAIN;
    SKG_NEEDS_OF("skg_plan_scatter_predict", plan);
    SKG_NEEDS_OF("skg_plan_scatter_predict", prediction);
    SKG_TRY(skg_context_enter(plan->context));
    SKG_TRY(skg_plan_renew(plan));
    const skg_logger logger = plan->context->log;
    const double begun = skg_seconds();
    skg_scatter_prediction ours = {
        .size = sizeof ours, .grid_primary = 1, .grid_scatter = 1, .grid_total = 1};
    plan->context->log = (skg_logger){0};
    const skg_status status = predict(plan, &ours);
    plan->context->log = logger;
    if (status != SKG_OK) return status;
    ours.seconds = skg_seconds() - begun;
    return skg_struct_write(&ours, sizeof ours, "skg_scatter_prediction", prediction);
}

skg_status skg_plan_scatter_predict(skg_plan *plan, skg_scatter_prediction *prediction) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(begun, predict_silently(plan, prediction));
}
