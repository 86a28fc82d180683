/* The public calls about scatter: that of a series of frames, and what a plan is to expect of it. */
#include "core/clock.h"
#include "core/text.h"
#include "device/device.h"
#include "frame/frames.h"
#include "frame/plans.h"

#include <inttypes.h>
#include <stdatomic.h>

void skg_scatter_series_report_init_sized(void *report, int32_t size) {
    const skg_scatter_series_report defaults = {0};
    skg_struct_init(report, size, &defaults, sizeof defaults);
}

/* How the caller describes frames. */
typedef struct {
    skg_plan *plan;
    skg_scatter_series_function function;
    void *user;
    skg_view view;
    const double **poses; /* [parts] */
    double *matter;
} describing;

/* A skg_series_frame. */
static skg_status describe(int64_t index, skg_scatter_work *work, void *user) {
    describing *d = user;
    const skg_recipe *recipe = d->plan->recipe;
    skg_frame frame;
    skg_frame_init(&frame);
    skg_free(&d->matter);
    SKG_TRY(d->function(index, &frame, d->user));
    d->view = recipe->view;
    for (int64_t p = 0; p < recipe->scene->count; p++) d->poses[p] = NULL;
    SKG_TRY(skg_held_frame_place(recipe, index, &frame, &d->view, d->poses));
    SKG_TRY(skg_frame_matter(recipe, &frame, &d->matter));
    work->view = &d->view;
    work->poses = d->poses;
    work->density = d->matter;
    work->fill = d->matter ? d->matter + recipe->scene->count : NULL;
    return SKG_OK;
}

static skg_status make(describing *d, int64_t count, skg_scatter_series **series) {
    static atomic_llong numbers;
    skg_scatter_series *made = NULL;
    int32_t is_smooth = 0;
    SKG_TRY(skg_alloc(d->plan->recipe->scene->count, sizeof *d->poses, "poses", &d->poses));
    SKG_TRY(skg_alloc(1, sizeof *made, "series", &made));
    skg_refs_init(&made->refs);
    made->number = ++numbers;
    if (!d->plan->scatterer.number) d->plan->scatterer.number = ++numbers;
    made->owner = d->plan->scatterer.number;
    made->recipe = skg_recipe_retain(d->plan->recipe);
    const skg_status status = skg_series_make(d->plan->context, count, describe, d, made, &is_smooth);
    if (status != SKG_OK || !is_smooth) skg_scatter_series_release(&made);
    *series = made;
    return status;
}

static void tell(const skg_context *context, int64_t count, const skg_scatter_series *series) {
    if (!series) {
        skg_log(context, SKG_LOG_NOTE,
                "scatter: the %" PRId64
                " frames are few or differ too much from one to the next; each has scatter of its "
                "own",
                count);
        return;
    }
    const skg_scatter_series_report *report = &series->report;
    skg_log(context, SKG_LOG_NOTE,
            "scatter of %" PRId64 " frames from %" PRId64 " of them: +- %.2g %% of itself; %" PRId64
            " histories in %.2g s",
            count, report->followed, 100 * report->error, report->histories, report->seconds);
}

static skg_status create(skg_plan *plan, int64_t count, skg_scatter_series_function function, void *user,
                         skg_scatter_series **series) {
    SKG_PLAIN;
    SKG_NEEDS_OF("skg_scatter_series_create", series);
    *series = NULL;
    SKG_NEEDS_OF("skg_scatter_series_create", plan);
    SKG_NEEDS_OF("skg_scatter_series_create", function);
    SKG_TRY(skg_context_enter(plan->context));
    SKG_TRY(skg_plan_renew(plan));
    if (!plan->recipe->options.scatter) return SKG_OK;
    SKG_TRY(skg_frame_check_places(plan->recipe, &plan->machine));
    describing d = {.plan = plan, .function = function, .user = user};
    const skg_status status = make(&d, count, series);
    if (status == SKG_OK) tell(plan->context, count, *series);
    skg_free(&d.poses);
    skg_free(&d.matter);
    return status;
}

skg_status skg_scatter_series_create(skg_plan *plan, int64_t count, skg_scatter_series_function function,
                                     void *user, skg_scatter_series **series) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(begun, create(plan, count, function, user, series));
}

skg_status skg_scatter_series_retain(skg_scatter_series *series) {
    SKG_NEEDS(series);
    skg_ref(&series->refs);
    return SKG_OK;
}

void skg_scatter_series_release(skg_scatter_series **series) {
    if (!series || !*series) return;
    skg_scatter_series *last = *series;
    *series = NULL;
    if (!skg_unref(&last->refs)) return;
    skg_series_drop(last);
    skg_recipe_release(&last->recipe);
    skg_free(&last);
}

skg_status skg_scatter_series_report_get(const skg_scatter_series *series,
                                         skg_scatter_series_report *report) {
    SKG_NEEDS(series);
    skg_scatter_series_report ours = series->report;
    ours.size = sizeof ours;
    return skg_struct_write(&ours, sizeof ours, "skg_scatter_series_report", report);
}

/* --- a prediction */

/* A skg_scatter_render, by a plan of its own. user: the caller's plan */
static skg_status render(void *user, const skg_view *view, const skg_plan_options *options,
                         skg_scatter_rendering *r) {
    const skg_plan *plan = user;
    const skg_recipe *recipe = plan->recipe;
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
    SKG_TRY_CLEANUP(skg_plan_create(plan->context, recipe->scene, view, recipe->spectrum, options, &made));
    SKG_TRY_CLEANUP(skg_plan_channel_get(made, 0, &channel));
    r->open = channel.flat_field;
    SKG_TRY_CLEANUP(skg_plan_submit(made, 1, NULL, 2, outputs, &job));
    status = skg_job_wait(&job);
cleanup:
    skg_plan_release(&made);
    /* Path lengths outside the verified range matter to no ratio. */
    return status == SKG_RANGE ? SKG_OK : status;
}

/* Predicts without a log: its warnings about the scene were given when the plan was made. */
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
    const skg_status status = skg_scatter_predict(plan->recipe, render, plan, &ours);
    plan->context->log = logger;
    if (status != SKG_OK) return status;
    ours.seconds = skg_seconds() - begun;
    return skg_struct_write(&ours, sizeof ours, "skg_scatter_prediction", prediction);
}

skg_status skg_plan_scatter_predict(skg_plan *plan, skg_scatter_prediction *prediction) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(begun, predict_silently(plan, prediction));
}
