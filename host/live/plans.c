/* Which plan makes an image of a page: for whole images, for those while something is dragged, and for scatter step by step. */
#include "live/plans.h"

#include "core/clock.h"
#include "core/maths.h"
#include "core/text.h"

#include <math.h>

/* Photons of the first image with scatter; each further step has four times as many. */
static const int64_t FIRST_HISTORIES = 16384;

/* s: scatter that takes longer is shown step by step. */
static const double LONG_S = 0.25;

/* ms that an image may take while something is dragged, and the fewest pixels that it then has. */
static const double FLUENT = 40, FEWEST = 4096;

void skg_live_subject_init_sized(void *subject, int32_t size) {
    const skg_live_subject defaults = {0};
    skg_struct_init(subject, size, &defaults, sizeof defaults);
}

skg_status skg_live_subject_read(const skg_live_subject *theirs, skg_live_subject *subject) {
    skg_live_subject_init(subject);
    SKG_TRY(skg_struct_read(theirs, "skg_live_subject", subject, sizeof *subject));
    if (!subject->context || !subject->scene || !subject->spectrum || !subject->options || !subject->view)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "skg_live_subject: it needs context, scene, spectrum, options and view");
    if (!subject->shown) subject->shown = subject->view;
    return SKG_OK;
}

skg_status skg_live_options(const skg_live_subject *subject, const skg_live_message *wish,
                            skg_plan_options *options) {
    skg_plan_options_init(options);
    SKG_TRY(skg_struct_read(subject->options, "skg_plan_options", options, sizeof *options));
    options->quantity = wish->asked.quantity;
    options->profile = 1;
    options->bands = wish->asked.bands;
    options->band_kev = wish->asked.bands > 0 ? wish->asked.band_kev : NULL;
    return SKG_OK;
}

static void release_plans(skg_live_plans *plans) {
    for (int i = 0; i < SKG_LIVE_STEPS; i++) skg_plan_release(plans->steps + i);
    skg_plan_release(&plans->draft);
    skg_plan_release(&plans->whole);
    skg_free(&plans->values);
    plans->is_drafted = plans->is_shown = 0;
    plans->factor = 1;
    plans->shown_plan = NULL;
    plans->step = SKG_LIVE_STEPS;
}

void skg_live_plans_release(skg_live_plans **plans) {
    if (!plans || !*plans) return;
    release_plans(*plans);
    skg_live_message_release(&(*plans)->wish);
    skg_free(plans);
}

skg_status skg_live_anew(skg_live_plans *plans, const skg_live_subject *subject, const skg_live_message *wish,
                         const skg_view *view) {
    skg_plan_options options;
    const double start = skg_seconds();
    release_plans(plans);
    plans->view = *view;
    SKG_TRY(skg_live_options(subject, wish, &options));
    SKG_TRY(
        skg_plan_create(subject->context, subject->scene, view, subject->spectrum, &options, &plans->whole));
    skg_channel_init(&plans->channel);
    SKG_TRY(skg_plan_channel_get(plans->whole, 0, &plans->channel));
    SKG_TRY(skg_plan_channel_count(plans->whole, &plans->channels));
    plans->plan_ms = 1000 * (skg_seconds() - start);
    return skg_alloc(view->columns * view->rows * plans->channels, sizeof *plans->values, "image of the page",
                     &plans->values);
}

static skg_status need_wish(const skg_live_message *wish) {
    const char *text;
    return skg_live_message_text_get(wish, &text);
}

skg_status skg_live_plans_create(const skg_live_subject *theirs, const skg_live_message *wish,
                                 skg_live_plans **plans) {
    SKG_PLAIN;
    skg_live_plans *made = NULL;
    skg_live_subject subject;
    SKG_NEEDS(plans);
    *plans = NULL;
    SKG_TRY(need_wish(wish));
    SKG_TRY(skg_live_subject_read(theirs, &subject));
    SKG_TRY(skg_alloc(1, sizeof *made, "plans of the page", &made));
    made->wish = (skg_live_message *)(uintptr_t)wish; /* messages never change but for their owners */
    skg_status status = skg_live_message_retain(made->wish);
    if (status == SKG_OK) status = skg_live_anew(made, &subject, wish, subject.view);
    if (status != SKG_OK) skg_live_plans_release(&made);
    *plans = made;
    return status;
}

skg_status skg_live_plans_whole_get(const skg_live_plans *plans, skg_plan **plan) {
    SKG_NEEDS(plans);
    SKG_NEEDS(plan);
    *plan = plans->whole;
    return SKG_OK;
}

skg_status skg_live_plans_fit(const skg_live_plans *plans, const skg_live_subject *theirs,
                              const skg_live_message *wish, int32_t *fits) {
    int32_t moved = 0, other = 0;
    skg_live_subject subject;
    SKG_NEEDS(plans);
    SKG_NEEDS(fits);
    SKG_TRY(skg_live_subject_read(theirs, &subject));
    SKG_TRY(skg_live_wish_compare(plans->wish, wish, &moved, &other));
    /* Tables over the rays of a view are made anew with another view. */
    const skg_plan_options *options = subject.options;
    if (options->grid || options->oblique || options->heel || options->bowtie) other |= moved;
    *fits = plans->whole && !other && !(plans->is_posed && isnan(wish->asked.phase));
    return SKG_OK;
}

skg_status skg_live_view_coarsen(int64_t factor, skg_view *view) {
    SKG_NEEDS(view);
    if (factor < 1) return skg_fail(SKG_ERR_ARGUMENT, "live: pixels are made larger 1 time or more");
    const int64_t columns = view->columns / factor > 1 ? view->columns / factor : 1,
                  rows = view->rows / factor > 1 ? view->rows / factor : 1;
    skg_scale_vector((double)view->columns / (double)columns, view->column_step, view->column_step);
    skg_scale_vector((double)view->rows / (double)rows, view->row_step, view->row_step);
    view->columns = columns;
    view->rows = rows;
    return SKG_OK;
}

skg_status skg_live_plans_draft(skg_live_plans *plans, const skg_live_subject *theirs) {
    SKG_PLAIN;
    skg_live_subject subject;
    skg_plan_options options;
    SKG_NEEDS(plans);
    SKG_TRY(skg_live_subject_read(theirs, &subject));
    SKG_TRY(skg_live_options(&subject, plans->wish, &options));
    skg_view view = plans->view;
    const int has_scatter = options.scatter != NULL;
    const double pixels = (double)(view.columns * view.rows);
    int64_t factor = 1;
    if (plans->is_drafted || (plans->frame_ms <= FLUENT && !has_scatter)) return SKG_OK;
    plans->is_drafted = 1;
    /* what an image takes goes about with its pixels; with scatter the time of the rest is not known */
    while (plans->frame_ms / (double)(factor * factor) > FLUENT &&
           pixels / (double)(factor * factor) > FEWEST)
        factor++;
    if (has_scatter || options.counter) factor = 1; /* what counts has pixels of its own */
    SKG_TRY(skg_live_view_coarsen(factor, &view));
    options.scatter = NULL;
    if (factor > 1)
        options.blur = NULL, options.depth_blur = NULL; /* less than a pixel of these, as a rule */
    SKG_TRY(
        skg_plan_create(subject.context, subject.scene, &view, subject.spectrum, &options, &plans->draft));
    plans->factor = factor;
    return SKG_OK;
}

skg_status skg_live_plans_refine(skg_live_plans *plans, double seconds) {
    SKG_NEEDS(plans);
    plans->step = seconds == 0 || seconds > LONG_S ? 0 : SKG_LIVE_STEPS;
    return SKG_OK;
}

skg_status skg_live_step(skg_live_plans *plans, const skg_live_subject *subject, skg_plan **plan) {
    skg_plan_options options;
    SKG_TRY(skg_live_options(subject, plans->wish, &options));
    const skg_scatter *asked = options.scatter;
    const int64_t histories = plans->step < SKG_LIVE_STEPS ? FIRST_HISTORIES << 2 * plans->step : 0;
    if (!asked || (asked->histories > 0 && asked->histories <= histories)) plans->step = SKG_LIVE_STEPS;
    *plan = plans->whole;
    if (plans->step == SKG_LIVE_STEPS) return SKG_OK;
    if (!plans->steps[plans->step]) {
        skg_scatter rough = *asked;
        rough.tolerance = 0;
        rough.histories = histories;
        options.scatter = &rough;
        SKG_TRY(skg_plan_create(subject->context, subject->scene, &plans->view, subject->spectrum, &options,
                                plans->steps + plans->step));
    }
    *plan = plans->steps[plans->step];
    return SKG_OK;
}
