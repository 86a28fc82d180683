/* The scatter of a plan's images from few histories, on a coarse detector, by a plan of its own. */
#include "core/clock.h"
#include "core/plain.h"
#include "frame/plan.h"

#include <math.h>

enum { SIDE = 64, HISTORIES = 8192 };

/* The error of energies: far below what so few histories make. */
static const double TOLERANCE = 0.01;

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
    options.falloff = SKG_FALLOFF_OFF;
    options.tile = options.overlaps = options.profile = options.noise = options.oblique = 0;
    options.bands = options.view_count = 0;
    options.supersampling = 1;
    options.spot = NULL, options.blur = NULL, options.world = NULL, options.heel = NULL;
    options.bowtie = NULL, options.depth_blur = NULL, options.dqe = NULL, options.views = NULL;
    options.band_kev = NULL;
    options.electronic_kev = options.quantum_step_kev = 0;
    options.tolerance = fmax(options.tolerance, TOLERANCE);
    options.scatter = scatter;
    return options;
}

/* Renders the image, and the scatter in it if `scatter` is not NULL. flat_field: of the open beam */
static skg_status render(const skg_plan *plan, const skg_plan_options *options, float *image, float *scatter,
                         double *flat_field) {
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
        outputs[k].data = k ? scatter : image;
    }
    outputs[1].kind = SKG_OUTPUT_SCATTER;
    SKG_TRY_CLEANUP(skg_plan_create(plan->context, recipe->scene, &view, recipe->spectrum, options, &made));
    SKG_TRY_CLEANUP(skg_plan_channel_get(made, 0, &channel));
    *flat_field = channel.flat_field;
    SKG_TRY_CLEANUP(skg_plan_outputs_submit(made, 1, NULL, scatter ? 2 : 1, outputs, &job));
    status = skg_job_wait(&job);
cleanup:
    skg_plan_release(&made);
    /* Path lengths outside the verified range matter to no ratio. */
    return status == SKG_RANGE ? SKG_OK : status;
}

/* From an image and the scatter in it. open: the beam where nothing stands; through: [count] primary over open beam, NULL: from the
 * image */
static void sum_up(int64_t count, const float *image, const float *scatter, const float *through, double open,
                   skg_scatter_prediction *prediction) {
    double scattered = 0, primary = 0, square = 0;
    for (int64_t i = 0; i < count; i++) {
        const double s = (double)scatter[i], p = (double)image[i] - s;
        const double passed = through ? (double)through[i] : p / open;
        square += s * s / (double)count;
        prediction->max = fmax(prediction->max, s / open);
        if (!(passed < SHADOW)) continue;
        scattered += s;
        primary += p;
    }
    prediction->rms = sqrt(square) / open;
    prediction->ratio = primary > 0 ? scattered / primary : scattered > 0 ? HUGE_VAL : 0;
}

static skg_status predict(skg_plan *plan, skg_scatter_prediction *prediction) {
    const skg_recipe *recipe = plan->recipe;
    const skg_view view = coarse_view(&recipe->view);
    const int64_t count = view.rows * view.columns;
    float *images = NULL, *through = NULL;
    double open = 0, alone = 0;
    skg_scatter scatter;
    skg_status status = SKG_OK;
    skg_scatter_init(&scatter);
    scatter.histories = HISTORIES;
    skg_plan_options options = coarse_options(recipe, &scatter);
    SKG_TRY_CLEANUP(skg_alloc(3 * count, sizeof *images, "prediction of scatter", &images));
    SKG_TRY_CLEANUP(render(plan, &options, images, images + count, &open));
    if (options.grid) { /* which takes some of the open beam, too */
        options.grid = NULL, options.scatter = NULL;
        options.quantity = SKG_QUANTITY_TRANSMISSION;
        through = images + 2 * count;
        SKG_TRY_CLEANUP(render(plan, &options, through, NULL, &alone));
    }
    sum_up(count, images, images + count, through, open, prediction);
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
    skg_scatter_prediction ours = {.size = sizeof ours};
    plan->context->log = (skg_logger){0};
    const skg_status status = predict(plan, &ours);
    plan->context->log = logger;
    if (status != SKG_OK) return status;
    ours.seconds = skg_seconds() - begun;
    return skg_struct_write(&ours, sizeof ours, "skg_scatter_prediction", prediction);
}

skg_status skg_plan_scatter_predict(skg_plan *plan, skg_scatter_prediction *prediction) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(handler, predict_silently(plan, prediction));
}
