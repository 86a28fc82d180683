/* A frame for a page: the scene posed as its wish says, rendered, and dropped for a newer wish. */
#include "live/frame.h"

#include "common/interrupt.h"
#include "common/progress.h"
#include "core/maths.h"
#include "live/numbers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Images that take longer are asked about while they are made, because a newer wish may have come. */
static const double LONG_MS = 60;

static int fail(char *sentence) {
    snprintf(sentence, LIVE_SENTENCE, "%s", skg_last_error());
    return 0;
}

int live_frame_pose(live_scene *scene, const live_wish *wish, char *sentence) {
    if (isnan(wish->phase)) return 1;
    if (!scene->motion) {
        snprintf(sentence, LIVE_SENTENCE, "the scene does not breathe: it has no key Breathing");
        return 0;
    }
    scene->is_posed = 1;
    return skg_motion_pose_at_phase(scene->motion, wish->phase) == SKG_OK ? 1 : fail(sentence);
}

/* The poses of a frame, which the caller frees. */
typedef struct {
    int64_t *parts;
    double *poses;
    int64_t count;
} pose_list;

/* The pose of a part before the page moves it: of a scan in which parts move, that of the projection. */
static skg_status pose_of(const live_scene *scene, const live_wish *wish, int64_t part, double *pose) {
    skg_scan_record record;
    skg_part its;
    skg_part_init(&its);
    skg_scan_record_init(&record);
    skg_status status = skg_scene_part_get(scene->session.scene, part, &its);
    memcpy(pose, its.pose, 16 * sizeof *pose);
    if (status != SKG_OK || wish->projection < 0) return status;
    status = skg_setup_record_get(scene->setup, &record);
    for (int64_t i = 0; status == SKG_OK && i < record.moving_count; i++)
        if (record.moving_parts[i] == part)
            memcpy(pose, record.moving_poses + (wish->projection * record.moving_count + i) * 16,
                   16 * sizeof *pose);
    return status;
}

static int list_poses(const live_scene *scene, const live_wish *wish, pose_list *list, char *sentence) {
    const char *key;
    json_t *moved;
    list->parts = calloc((size_t)scene->parts + 1, sizeof *list->parts);
    list->poses = calloc(16 * ((size_t)scene->parts + 1), sizeof *list->poses);
    if (!list->parts || !list->poses) {
        snprintf(sentence, LIVE_SENTENCE, "out of host memory");
        return 0;
    }
    json_object_foreach(wish->poses, key, moved) {
        const int64_t part = strtoll(key, NULL, 10);
        double by[16], pose[16];
        if (part >= scene->parts) {
            snprintf(sentence, LIVE_SENTENCE, "the scene has no part %s", key);
            return 0;
        }
        for (size_t i = 0; i < 16; i++) by[i] = json_number_value(json_array_get(moved, i));
        if (list->count > scene->parts || pose_of(scene, wish, part, pose) != SKG_OK) return fail(sentence);
        skg_pose_multiply(by, pose, list->poses + 16 * list->count);
        list->parts[list->count++] = part;
    }
    return 1;
}

int live_frame_poses(const live_scene *scene, const live_wish *wish, double *poses, char *sentence) {
    pose_list list = {0};
    int is_made = list_poses(scene, wish, &list, sentence);
    for (int64_t i = 0; is_made && i < scene->parts; i++)
        if (pose_of(scene, wish, i, poses + 16 * i) != SKG_OK) is_made = fail(sentence);
    for (int64_t i = 0; is_made && i < list.count; i++)
        memcpy(poses + 16 * list.parts[i], list.poses + 16 * i, 16 * sizeof *poses);
    free(list.parts);
    free(list.poses);
    return is_made;
}

int live_frame_place(live_scene *scene, const live_wish *wish, char *sentence) {
    double *poses = calloc((size_t)scene->parts * 16 + 1, sizeof *poses);
    if (!poses) return snprintf(sentence, LIVE_SENTENCE, "out of host memory"), 0;
    int is_made = live_frame_pose(scene, wish, sentence) && live_frame_poses(scene, wish, poses, sentence);
    for (int64_t i = 0; is_made && i < scene->parts; i++)
        if (skg_scene_part_pose_set(scene->session.scene, i, poses + 16 * i) != SKG_OK)
            is_made = fail(sentence);
    free(poses);
    return is_made;
}

/* Waits for the image, and cancels what the device was not given yet when a newer wish comes. */
static skg_status wait_for(skg_job **job, live_hub *hub, double expected_ms, int *dropped) {
    static const struct timespec pause = {.tv_nsec = 2000000};
    int64_t total = 1; /* above 1: passes of a frame that takes long */
    int32_t is_done =
        !hub || (expected_ms < LONG_MS && skg_job_progress(*job, NULL, &total) == SKG_OK && total == 1);
    while (!is_done && skg_job_test(*job, &is_done) == SKG_OK && !is_done) {
        if (live_hub_has_news(hub) || cli_stop_asked()) {
            *dropped = 1;
            (void)skg_job_cancel(*job);
            break;
        }
        nanosleep(&pause, NULL);
    }
    return skg_job_wait(job);
}

/* Cancels the scatter of a frame when a newer wish has come, or the end. */
static int32_t is_outdated(int64_t done, int64_t total, void *user) {
    (void)done;
    (void)total;
    return cli_stop_asked() || live_hub_has_news(user);
}

/* Scatter is computed while its frame is submitted, so that the job cannot be cancelled. Only a frame that refines the one that is
 * shown may be dropped: wishes that follow each other fast would otherwise show nothing. */
static skg_status watch_scatter(const live_scene *scene, const live_wish *wish, live_hub *hub,
                                skg_frame *frame) {
    if (!hub || !scene->session.options.scatter || scene->shown_wish != wish->number) return SKG_OK;
    return skg_progress_create(is_outdated, hub, &frame->progress);
}

int live_frame_render(const live_scene *scene, const live_wish *wish, skg_plan *plan, const skg_view *view,
                      live_hub *hub, const skg_output *outputs, int64_t output_count, int *dropped,
                      int *is_outside, char *sentence) {
    pose_list list = {0};
    skg_frame frame;
    skg_job *job = NULL;
    skg_frame_init(&frame);
    *dropped = *is_outside = 0;
    int is_listed = list_poses(scene, wish, &list, sentence);
    skg_status status = SKG_OK;
    if (is_listed && scene->motion && !isnan(wish->phase)) status = skg_motion_fill(scene->motion, &frame);
    frame.view = view;
    frame.pose_count = list.count;
    frame.pose_parts = list.parts;
    frame.poses = list.poses;
    if (is_listed && status == SKG_OK) status = watch_scatter(scene, wish, hub, &frame);
    if (is_listed && status == SKG_OK) status = skg_plan_submit(plan, 1, &frame, output_count, outputs, &job);
    if (job) status = wait_for(&job, hub, scene->frame_ms, dropped);
    if (status == SKG_ERR_CANCELLED && frame.progress) *dropped = 1;
    if (status == SKG_ERR_CANCELLED && *dropped) status = SKG_OK;
    skg_progress_release(&frame.progress);
    *is_outside = status == SKG_RANGE;
    if (is_listed && status != SKG_OK && status != SKG_RANGE) is_listed = fail(sentence);
    free(list.parts);
    free(list.poses);
    return is_listed;
}

int live_frame_pack(const float *values, live_header *header, unsigned char **bytes, size_t *size) {
    const int64_t count = (int64_t)header->columns * header->rows;
    float low, high;
    if (!live_range_find(values, count, &low, &high)) header->notes |= LIVE_NOTE_INFINITE;
    header->low = (double)low;
    header->step = ((double)high - (double)low) / UINT16_MAX;
    *size = sizeof *header + (size_t)count * sizeof(uint16_t);
    *bytes = malloc(*size);
    if (!*bytes) return 0;
    uint16_t *numbers = (uint16_t *)(void *)(*bytes + sizeof *header);
    live_numbers_write(values, count, low, header->step, numbers);
    memcpy(*bytes, header, sizeof *header);
    return 1;
}

int live_frame_make(const live_base *base, live_scene *scene, const live_wish *wish, live_lag *lag,
                    live_hub *hub, int64_t number, live_shot *shot, char *sentence) {
    const double start = cli_now_ms();
    const int is_draft = wish->dragging && scene->draft;
    skg_plan *plan = scene->draft;
    skg_view view;
    skg_output output;
    int is_outside = 0;
    *shot = (live_shot){0};
    skg_output_init(&output);
    output.data = scene->values;
    if (!live_scene_view(base, scene, wish, &view, sentence) || !live_frame_pose(scene, wish, sentence))
        return 0;
    if (wish->channel >= scene->channels) {
        snprintf(sentence, LIVE_SENTENCE, "\"channel\": the image has no band %lld",
                 (long long)wish->channel);
        return 0;
    }
    if (!is_draft && !live_scene_step(scene, &plan, sentence)) return 0;
    shot->view = view;
    if (is_draft) live_view_coarsen(&view, scene->factor);
    scene->is_shown = 0;
    if (!live_frame_render(scene, wish, plan, &view, hub, &output, 1, &shot->is_dropped, &is_outside,
                           sentence))
        return 0;
    shot->ms = cli_now_ms() - start;
    if (shot->is_dropped) return 1;
    if (!is_draft &&
        !live_lag_show(lag, scene, scene->channels * view.columns * view.rows, scene->values, sentence))
        return 0;
    if (plan == scene->plan && scene->frames++ > 0) scene->frame_ms = shot->ms;
    live_header header = {.mark = {'S', 'K', 'L', 'F'},
                          .number = (uint32_t)number,
                          .wish = (uint32_t)wish->number,
                          .columns = (uint16_t)view.columns,
                          .rows = (uint16_t)view.rows,
                          .flat_field = scene->channel.flat_field,
                          .ms = (float)shot->ms,
                          .factor = (uint16_t)(is_draft ? scene->factor : 1),
                          .quantity = (uint8_t)scene->session.options.quantity,
                          .notes = (uint8_t)((is_draft ? LIVE_NOTE_DRAFT : 0) |
                                             (is_outside ? LIVE_NOTE_RANGE : 0) |
                                             (!is_draft && plan != scene->plan ? LIVE_NOTE_REFINES : 0))};
    /* of the band that is shown, and of the draft's pixel, which is larger */
    skg_channel channel;
    skg_channel_init(&channel);
    if (skg_plan_channel_get(plan, wish->channel, &channel) == SKG_OK) header.flat_field = channel.flat_field;
    scene->is_shown = 1;
    scene->shown_plan = plan;
    scene->shown = view;
    scene->shown_wish = wish->number;
    scene->shown_channel = wish->channel;
    scene->shown_flat = header.flat_field;
    if (live_frame_pack(scene->values + wish->channel * view.columns * view.rows, &header, &shot->bytes,
                        &shot->size))
        return 1;
    snprintf(sentence, LIVE_SENTENCE, "out of host memory for the frame");
    return 0;
}
