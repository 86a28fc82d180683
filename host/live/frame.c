/* Images of a page: the scene posed as its wish says, rendered, and dropped when nobody wants them any more. */
#include "live/plans.h"

#include "core/clock.h"
#include "core/log.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <time.h>

/* Images that take longer are asked about while they are made, because a newer wish may have come. */
static const double LONG_MS = 60;

void skg_live_frame_init_sized(void *frame, int32_t size) {
    const skg_live_frame defaults = {.scatter_s = (double)NAN};
    skg_struct_init(frame, size, &defaults, sizeof defaults);
}

/* Waits for the image, and cancels what the device was not given yet when nobody wants it any more. */
static skg_status wait_for(skg_job **job, const skg_live_rendering *how, int *is_dropped) {
    static const struct timespec pause = {.tv_nsec = 2000000};
    int64_t total = 1; /* above 1: passes of a frame that takes long */
    int32_t is_done = !how->progress || (how->frame_ms < LONG_MS &&
                                         skg_job_progress(*job, NULL, &total) == SKG_OK && total == 1);
    while (!is_done && skg_job_test(*job, &is_done) == SKG_OK && !is_done) {
        if (skg_progress_step(how->progress, 0, 0) != SKG_OK) {
            *is_dropped = 1;
            (void)skg_job_cancel(*job);
            break;
        }
        nanosleep(&pause, NULL);
    }
    return skg_job_wait(job);
}

skg_status skg_live_render(const skg_live_subject *subject, const skg_live_message *wish,
                           const skg_live_rendering *how, int *is_dropped) {
    skg_live_moves moves;
    skg_frame frame;
    skg_job *job = NULL;
    skg_frame_init(&frame);
    *is_dropped = 0;
    skg_status status = skg_live_moves_list(subject, wish, &moves);
    if (status == SKG_OK && subject->motion && !isnan(wish->asked.phase))
        status = skg_motion_fill(subject->motion, &frame);
    frame.view = how->view;
    frame.pose_count = moves.count;
    frame.pose_parts = moves.parts;
    frame.poses = moves.poses;
    if (subject->options->scatter) frame.progress = how->progress;
    if (status == SKG_OK)
        status = skg_plan_submit(how->plan, 1, &frame, how->output_count, how->outputs, &job);
    if (job) status = wait_for(&job, how, is_dropped);
    if (status == SKG_ERR_CANCELLED && frame.progress) *is_dropped = 1;
    if (status == SKG_ERR_CANCELLED && *is_dropped) status = SKG_OK;
    skg_live_moves_free(&moves);
    return status;
}

/* Notes how long the scatter of an image took, and what the next step is. */
static void note_scatter(skg_live_plans *plans, const skg_live_subject *subject, skg_live_frame *frame) {
    skg_scatter_report report;
    skg_scatter_report_init(&report);
    if (!subject->options->scatter) return;
    const int has = skg_plan_scatter_report_get(plans->shown_plan, &report) == SKG_OK;
    if (plans->step == SKG_LIVE_STEPS)
        frame->scatter_s = has ? report.seconds : 0;
    else if (has && report.sigma <= 2 * subject->options->scatter->tolerance * report.mean)
        plans->step = SKG_LIVE_STEPS; /* half of the error needs four times as many photons, as a step more */
    else
        plans->step++;
}

/* Keeps what the frame of the image says of it. */
static void note(skg_live_plans *plans, const skg_live_subject *subject, const skg_live_message *wish,
                 const skg_live_rendering *how, skg_status status, skg_live_frame *frame) {
    const int refines = !frame->draft && how->plan != plans->whole;
    skg_channel channel; /* of the band that is shown, and of the draft's pixel, which is larger */
    skg_channel_init(&channel);
    if (skg_plan_channel_get(how->plan, wish->asked.channel, &channel) != SKG_OK) channel = plans->channel;
    if (how->plan == plans->whole && plans->images++ > 0) plans->frame_ms = frame->ms;
    plans->header = (skg_live_header){.mark = {'S', 'K', 'L', 'F'},
                                      .wish = (uint32_t)wish->asked.number,
                                      .columns = (uint16_t)how->view->columns,
                                      .rows = (uint16_t)how->view->rows,
                                      .flat_field = channel.flat_field,
                                      .ms = (float)frame->ms,
                                      .factor = (uint16_t)(frame->draft ? plans->factor : 1),
                                      .quantity = (uint8_t)wish->asked.quantity,
                                      .notes = (uint8_t)((frame->draft ? SKG_LIVE_DRAFT : 0) |
                                                         (status == SKG_RANGE ? SKG_LIVE_RANGE : 0) |
                                                         (refines ? SKG_LIVE_REFINES : 0))};
    plans->is_shown = 1;
    plans->shown_plan = how->plan;
    plans->shown = *how->view;
    plans->shown_channel = wish->asked.channel;
    plans->ms = frame->ms;
    if (!wish->asked.drag) note_scatter(plans, subject, frame);
    frame->again = (refines && !wish->asked.drag) || (plans->images == 1 && !subject->options->scatter);
    frame->channels = plans->channels;
    frame->columns = how->view->columns, frame->rows = how->view->rows;
    frame->values = plans->values;
}

/* Chooses the plan of an image. */
static skg_status choose(skg_live_plans *plans, const skg_live_subject *subject, const skg_live_message *wish,
                         skg_live_rendering *how, skg_view *view, skg_live_frame *frame) {
    frame->draft = wish->asked.drag && plans->draft;
    how->plan = plans->draft;
    if (wish->asked.channel >= plans->channels)
        return skg_fail(SKG_ERR_SCENE, "\"channel\": the image has no band %" PRId64, wish->asked.channel);
    if (!frame->draft) SKG_TRY(skg_live_step(plans, subject, &how->plan));
    *view = *subject->shown;
    return frame->draft ? skg_live_view_coarsen(plans->factor, view) : SKG_OK;
}

static skg_status make(skg_live_plans *plans, const skg_live_subject *subject, const skg_live_message *wish,
                       skg_progress *progress, skg_live_frame *frame) {
    const double start = skg_seconds();
    skg_view view;
    skg_output output;
    skg_live_rendering how = {.view = &view, .outputs = &output, .output_count = 1, .progress = progress};
    int is_dropped = 0;
    how.frame_ms = plans->frame_ms;
    SKG_TRY(skg_live_breathe(subject, wish));
    if (!isnan(wish->asked.phase) && !subject->posed) plans->is_posed = 1;
    SKG_TRY(choose(plans, subject, wish, &how, &view, frame));
    skg_output_init(&output);
    output.data = plans->values;
    plans->is_shown = 0;
    skg_status status = skg_live_render(subject, wish, &how, &is_dropped);
    if (status == SKG_STALE) {
        SKG_TRY(skg_live_anew(plans, subject, wish, subject->shown));
        SKG_TRY(choose(plans, subject, wish, &how, &view, frame));
        output.data = plans->values;
        status = skg_live_render(subject, wish, &how, &is_dropped);
    }
    if (status == SKG_STALE) {
        char sentence[512];
        snprintf(sentence, sizeof sentence, "%s", skg_last_error());
        return skg_fail(SKG_ERR_SCENE, "%s", sentence);
    }
    if (SKG_FAILED(status)) return status;
    frame->ms = 1000 * (skg_seconds() - start);
    frame->dropped = is_dropped;
    if (!is_dropped) note(plans, subject, wish, &how, status, frame);
    return SKG_OK;
}

skg_status skg_live_frame_make(skg_live_plans *plans, const skg_live_subject *theirs,
                               const skg_live_message *wish, skg_progress *progress, skg_live_frame *frame) {
    SKG_PLAIN;
    skg_live_subject subject;
    skg_live_frame made;
    SKG_NEEDS(plans);
    SKG_NEEDS(wish);
    SKG_TRY(skg_live_subject_read(theirs, &subject));
    skg_live_frame_init(&made);
    SKG_TRY(make(plans, &subject, wish, progress, &made));
    return skg_struct_write(&made, sizeof made, "skg_live_frame", frame);
}
