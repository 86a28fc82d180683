/* A batch of projections in flight. */
#include "scan/slot.h"

#include "core/core.h"
#include "core/log.h"
#include "scan/block.h"
#include "scan/format.h"

#include <math.h>
#include <string.h>

skg_status skg_scan_work_init(skg_scan_work *work) {
    skg_plan_report report;
    skg_view view;
    int64_t channels = 0;
    skg_plan_report_init(&report);
    skg_view_init(&view);
    SKG_TRY(skg_plan_report_get(work->plan, &report));
    SKG_TRY(skg_plan_channel_count(work->plan, &channels));
    SKG_TRY(skg_scan_view_get(work->scan, 0, &view));
    SKG_TRY(skg_scan_projection_count(work->scan, &work->projections));
    work->image_elements = channels * view.columns * view.rows;
    work->is_logarithm = report.quantity == SKG_QUANTITY_ATTENUATION;
    return SKG_OK;
}

/* By how much the images of a batch begin behind a whole block, if those of the file all do so alike: then the disk takes
 * them without a copy (direct.c). */
static int64_t shift_of(const skg_scan_file *file, int64_t image_bytes) {
    enum { CACHE_LINE = 64 }; /* OpenCL copies well to such places only */
    if (!file || image_bytes % SKG_SCAN_BLOCK != 0 || file->data_at % CACHE_LINE != 0) return 0;
    return file->data_at % SKG_SCAN_BLOCK;
}

skg_status skg_scan_slot_init(const skg_scan_work *work, skg_scan_slot *slot, int64_t batch) {
    const int64_t subframes = work->options.subframes, frames = batch * subframes;
    SKG_TRY(skg_alloc(batch, sizeof *slot->indices, "batch of projections", &slot->indices));
    SKG_TRY(skg_alloc(batch, sizeof *slot->phases, "batch of projections", &slot->phases));
    SKG_TRY(skg_alloc(batch, sizeof *slot->amplitudes, "batch of projections", &slot->amplitudes));
    SKG_TRY(skg_alloc(frames, sizeof *slot->jobs, "batch of projections", &slot->jobs));
    SKG_TRY(skg_alloc(frames, sizeof *slot->frames, "batch of projections", &slot->frames));
    SKG_TRY(skg_alloc(frames, sizeof *slot->views, "batch of projections", &slot->views));
    const int64_t image = work->image_elements * skg_element_bytes(work->options.type);
    return skg_scan_block_make(frames * image, shift_of(work->options.file, image), &slot->block,
                               &slot->images);
}

static skg_status wait_for_jobs(skg_scan_slot *slot) {
    skg_status status = SKG_OK;
    for (int64_t j = 0; j < slot->job_count; j++) {
        const skg_status its = skg_job_wait(&slot->jobs[j]);
        if (status == SKG_OK || (status == SKG_RANGE && SKG_FAILED(its))) status = its;
    }
    slot->job_count = 0;
    return status;
}

void skg_scan_slot_free(skg_scan_slot *slot) {
    for (int64_t j = 0; slot->jobs && j < slot->job_count; j++) skg_job_cancel(slot->jobs[j]);
    if (slot->jobs) wait_for_jobs(slot);
    skg_free(&slot->indices);
    skg_free(&slot->phases);
    skg_free(&slot->amplitudes);
    skg_free(&slot->jobs);
    skg_free(&slot->frames);
    skg_free(&slot->views);
    skg_free(&slot->block);
}

/* The moment that is a share of the exposure behind its middle: its position in the scan, in projections, and its time. */
static skg_status find_moment(const skg_scan_work *work, int64_t index, double from_middle, double *position,
                              double *time_s) {
    double middle = 0, exposure = 0, next = 0;
    SKG_TRY(skg_scan_time_get(work->scan, index, &middle, &exposure));
    *time_s = middle + from_middle * exposure;
    *position = (double)index;
    if (work->projections < 2 || from_middle == 0) return SKG_OK;
    const int64_t neighbour = index + 1 < work->projections ? index + 1 : index - 1;
    SKG_TRY(skg_scan_time_get(work->scan, neighbour, &next, NULL));
    const double interval = fabs(next - middle);
    if (interval > 0) *position += from_middle * exposure / interval;
    return SKG_OK;
}

static skg_status submit_job(const skg_scan_work *work, skg_scan_slot *slot, int64_t first, int64_t count) {
    skg_output output;
    skg_output_init(&output);
    output.type = work->options.type;
    output.data = (char *)slot->images + first * work->image_elements * skg_element_bytes(output.type);
    SKG_TRY(
        skg_plan_submit(work->plan, count, slot->frames + first, 1, &output, &slot->jobs[slot->job_count]));
    slot->job_count++;
    return SKG_OK;
}

/* Sub-frames have random numbers of their own, the first one those of a projection without sub-frames. */
static int64_t seed_of(const skg_scan_work *work, int64_t subframe) {
    static const uint64_t apart = 0x9E3779B97F4A7C15u; /* odd: no two are equal */
    return (int64_t)((uint64_t)work->options.noise_seed + (uint64_t)subframe * apart);
}

/* Describes a moment of a projection; with motion it poses the scene for it. */
static skg_status describe(const skg_scan_work *work, int64_t index, double from_middle, skg_view *view,
                           skg_frame *frame) {
    const skg_scan_run_options *o = &work->options;
    double position = 0, time = 0;
    SKG_TRY(find_moment(work, index, from_middle, &position, &time));
    skg_view_init(view);
    SKG_TRY(skg_scan_view_at(work->scan, position, view));
    skg_frame_init(frame);
    frame->view = view;
    frame->subframes = (int32_t)o->subframes;
    frame->index = index;
    frame->pose_count = o->moving_count;
    frame->pose_parts = o->moving_parts;
    if (o->moving_count > 0) frame->poses = o->moving_poses + index * o->moving_count * 16;
    frame->scatter_series = work->series;
    frame->series_place = fmin(fmax(position, 0), (double)(work->projections - 1));
    if (!o->motion) return SKG_OK;
    SKG_TRY(skg_motion_pose_at_time(o->motion, time));
    return skg_motion_fill(o->motion, frame);
}

/* Data for the series of a scan's scatter, which asks for the frames. */
typedef struct {
    const skg_scan_work *work;
    skg_view view;
} asking;

/* A skg_scatter_series_function: the middle of an exposure. */
static skg_status describe_middle(int64_t index, skg_frame *frame, void *user) {
    asking *a = user;
    SKG_TRY(skg_progress_step(a->work->options.progress, 0, a->work->projections));
    return describe(a->work, index, 0, &a->view, frame);
}

skg_status skg_scan_work_series(skg_scan_work *work) {
    asking a = {.work = work};
    return skg_scatter_series_create(work->plan, work->projections, describe_middle, &a, &work->series);
}

static skg_status prepare_frame(const skg_scan_work *work, skg_scan_slot *slot, int64_t f) {
    const int64_t subframes = work->options.subframes, p = f / subframes;
    const double from_middle = ((double)(f % subframes) + 0.5) / (double)subframes - 0.5;
    SKG_TRY(describe(work, slot->indices[p], from_middle, &slot->views[f], &slot->frames[f]));
    slot->frames[f].noise_seed = seed_of(work, f % subframes);
    if (work->options.motion && f % subframes == subframes / 2) {
        skg_motion_state state;
        skg_motion_state_init(&state);
        SKG_TRY(skg_motion_state_get(work->options.motion, &state));
        slot->phases[p] = state.phase;
        slot->amplitudes[p] = state.amplitude;
    }
    return SKG_OK;
}

skg_status skg_scan_slot_submit(const skg_scan_work *work, skg_scan_slot *slot, const int64_t *indices,
                                int64_t count) {
    const int64_t frames = count * work->options.subframes;
    memcpy(slot->indices, indices, (size_t)count * sizeof *indices);
    slot->count = count;
    for (int64_t f = 0; f < frames; f++) {
        SKG_TRY(prepare_frame(work, slot, f));
        if (work->options.motion) SKG_TRY(submit_job(work, slot, f, 1));
    }
    return work->options.motion ? SKG_OK : submit_job(work, slot, 0, frames);
}

static double element(const skg_scan_work *work, const void *images, int64_t at) {
    return work->options.type == SKG_TYPE_FLOAT64 ? ((const double *)images)[at]
                                                  : (double)((const float *)images)[at];
}

/* The mean of each projection takes the place of a frame that was read before. */
static void take_means(const skg_scan_work *work, skg_scan_slot *slot) {
    const int64_t n = work->options.subframes, elements = work->image_elements;
    for (int64_t p = 0; p < slot->count; p++)
        for (int64_t i = 0; i < elements; i++) {
            double sum = 0;
            for (int64_t s = 0; s < n; s++) {
                const double value = element(work, slot->images, (p * n + s) * elements + i);
                sum += work->is_logarithm ? exp(-value) : value;
            }
            const double mean = work->is_logarithm ? -log(sum / (double)n) : sum / (double)n;
            if (work->options.type == SKG_TYPE_FLOAT64)
                ((double *)slot->images)[p * elements + i] = mean;
            else
                ((float *)slot->images)[p * elements + i] = (float)mean;
        }
}

skg_status skg_scan_slot_wait(const skg_scan_work *work, skg_scan_slot *slot) {
    const skg_status status = wait_for_jobs(slot);
    if (!SKG_FAILED(status) && work->options.subframes > 1) take_means(work, slot);
    return status;
}
