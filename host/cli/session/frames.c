/* Timed frames: the first one, and then the warm ones that --repeat asks for. */
#include "session/frames.h"

#include "common/encode.h"
#include "common/progress.h"
#include "common/say.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static cli_stage_times *find_stage(cli_times *times, const char *name) {
    for (int i = 0; i < times->stage_count; i++)
        if (strcmp(times->stages[i].name, name) == 0) return &times->stages[i];
    if (times->stage_count == CLI_STAGES_MAX) return NULL;
    cli_stage_times *stage = &times->stages[times->stage_count];
    stage->ms = calloc((size_t)times->repeats, sizeof *stage->ms);
    if (!stage->ms) return NULL;
    snprintf(stage->name, sizeof stage->name, "%s", name);
    times->stage_count++;
    return stage;
}

static skg_status note_stages(const skg_plan *plan, cli_times *times) {
    int64_t count = 0;
    skg_status status = skg_plan_stage_count(plan, &count);
    for (int64_t i = 0; status == SKG_OK && i < count; i++) {
        skg_stage stage;
        skg_stage_init(&stage);
        status = skg_plan_stage_get(plan, i, &stage);
        cli_stage_times *place = status == SKG_OK ? find_stage(times, stage.name) : NULL;
        if (place && place->count < times->repeats) place->ms[place->count++] = stage.ns * 1e-6;
    }
    return status;
}

int cli_end_image(skg_status status, int *warned) {
    if (status == SKG_RANGE && !(warned && *warned) && !cli_was_warned(skg_last_error()))
        cli_warn("%s", skg_last_error());
    if (status == SKG_RANGE && warned) *warned = 1;
    return status == SKG_OK || status == SKG_RANGE ? CLI_DONE : cli_fail(status);
}

int cli_run_frames(skg_plan *plan, cli_frame frame, const skg_output *output, const void *user,
                   cli_times *times) {
    times->frame_ms = calloc((size_t)times->repeats + 1, sizeof *times->frame_ms);
    if (!times->frame_ms) return cli_error(CLI_DEVICE, "out of host memory");
    double start = cli_now_ms();
    cli_progress_begin("first image", 0);
    skg_status status = frame(plan, output, user);
    times->first_ms = cli_now_ms() - start;
    if (times->repeats) cli_progress_begin("frames", times->repeats);
    for (int64_t i = 0; !SKG_FAILED(status) && i < times->repeats; i++) {
        start = cli_now_ms();
        status = frame(plan, output, user);
        times->frame_ms[i] = cli_now_ms() - start;
        skg_status noted = SKG_FAILED(status) ? status : note_stages(plan, times);
        if (SKG_FAILED(noted)) status = noted;
        cli_progress_step(i + 1);
    }
    cli_progress_end();
    return cli_end_image(status, NULL);
}

void cli_times_free(cli_times *times) {
    free(times->frame_ms);
    for (int i = 0; i < times->stage_count; i++) free(times->stages[i].ms);
    *times = (cli_times){0};
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts the times. The median of an even number is the mean of the middle two. */
static void summarise(double *ms, int64_t count, double *least, double *median) {
    qsort(ms, (size_t)count, sizeof *ms, ascending);
    *least = ms[0];
    *median = 0.5 * (ms[(count - 1) / 2] + ms[count / 2]);
}

static json_t *summary_json(double *ms, int64_t count) {
    double least, median;
    if (count == 0) return json_null();
    summarise(ms, count, &least, &median);
    json_t *object = json_object();
    json_object_set_new(object, "min", cli_json_number(least));
    json_object_set_new(object, "median", cli_json_number(median));
    return object;
}

void cli_times_json(const cli_times *times, json_t *object) {
    json_t *stages = times->repeats ? json_object() : json_null();
    for (int i = 0; i < times->stage_count; i++)
        json_object_set_new(stages, times->stages[i].name,
                            summary_json(times->stages[i].ms, times->stages[i].count));
    json_object_set_new(object, "frame_ms", summary_json(times->frame_ms, times->repeats));
    json_object_set_new(object, "first_ms", cli_json_number(times->first_ms));
    json_object_set_new(object, "plan_ms", cli_json_number(times->plan_ms));
    json_object_set_new(object, "stages", stages);
}

static void print_summary(const char *name, double *ms, int64_t count) {
    double least, median;
    if (count == 0) return;
    summarise(ms, count, &least, &median);
    printf("  %-20s %10.3f %10.3f\n", name, least, median);
}

void cli_times_print(const cli_times *times) {
    printf("plan %.1f ms, first image %.1f ms\n", times->plan_ms, times->first_ms);
    if (!times->repeats) return;
    printf("  %-20s %10s %10s   (%" PRId64 " frames)\n", "ms", "minimum", "median", times->repeats);
    print_summary("frame", times->frame_ms, times->repeats);
    for (int i = 0; i < times->stage_count; i++)
        print_summary(times->stages[i].name, times->stages[i].ms, times->stages[i].count);
}
