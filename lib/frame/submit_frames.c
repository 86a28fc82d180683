/* Submits the frames of a job: gives them to the device, all at once or one after another, long ones in steps. */
#include "frame/jobs.h"

#include "frame/frames.h"
#include "plan/decisions.h"

#include <limits.h>

/* --- steps */

/* Enqueues steps until number `end`: of small frames as many as one launch draws, else one after another. */
static skg_status submit_steps(skg_job *job, const skg_frame *frames, int64_t end) {
    const double **poses = NULL;
    skg_status status = SKG_OK;
    skg_view view;
    skg_frame frame;
    if (job->enqueued >= end) return SKG_OK;
    SKG_TRY(skg_alloc(job->recipe->scene->count, sizeof *poses, "poses", &poses));
    while (job->enqueued < end && !skg_job_is_cancelled(job)) {
        const int64_t index = job->enqueued / job->steps;
        int64_t submitted = 0;
        if (job->together) SKG_TRY_CLEANUP(skg_submit_together(job, frames, poses, end, &submitted));
        if (submitted > 0) continue;
        if (job->enqueued == 0) job->together = 0; /* nor will others be */
        skg_frame_work work = {.view = &view, .poses = poses, .frame = &frame};
        SKG_TRY_CLEANUP(skg_held_frame_read(job, frames, index, &frame, &view, poses, &work.noise));
        if (job->enqueued % job->steps == 0 &&
            !job->kind->begin) /* what came before was projected for the first step, too */
            skg_geometry_begin_frame(&job->machine->geometry, index, 0);
        SKG_TRY_CLEANUP(skg_job_step(job, end, &work));
    }
cleanup:
    skg_free(&poses);
    return status;
}

/* --- how many */

/* A device is given work for about this long before it is asked how far it is, s. The caller may be away as long; and so long a
 * cancelled job takes to end. */
static const double AHEAD_S = 0.5;

/* A frame of more than half of that is given in steps of about this long, and the device has four of them, s. */
static const double STEP_S = 0.05;
enum { STEPS_AHEAD = 4 };

/* Orders of magnitude of a processor's core for a ray and a triangle, and of a GPU's compute unit over one. */
static const double RAY_S = 20e-9, TRIANGLE_S = 200e-9, GPU_UNIT = 20;

/* About how long a pass takes, s. */
static double pass_time(const skg_job *job) {
    const skg_recipe *recipe = job->recipe;
    const skg_device_info *device = &job->machine->context->device->info;
    const double fine = (double)recipe->samples.fine;
    const double rays = (double)(recipe->view.rows * recipe->view.columns) * fine * fine;
    const double units = (double)device->compute_units * (device->cpu ? 1 : GPU_UNIT);
    return (RAY_S * rays + TRIANGLE_S * (double)skg_scene_triangles(recipe->scene)) / units;
}

/* How many steps are under way at once: at least two, so that the device does not wait for the host. */
static int64_t steps_ahead(const skg_job *job) {
    if (job->kind->begin) return 1;
    if (job->each) return STEPS_AHEAD;
    const double passes = (double)(skg_samples_passes(&job->recipe->samples) * job->output_count);
    const double frames = AHEAD_S / (passes * pass_time(job));
    return frames > 2 ? (frames < (double)job->count ? (int64_t)frames : job->count) : 2;
}

/* How many frames are drawn side by side, if the device is given all of them at once, or two launches' worth; 0: each by itself. */
static int32_t together_of(const skg_job *job, int64_t ahead) {
    const int64_t all = skg_job_steps(job), enough = 2 * skg_together_most(job->machine);
    if (job->kind->begin || job->each || job->output_count != 1 || (ahead < all && ahead < enough)) return 0;
    return skg_together_side(job->recipe, job->machine, job->count, &job->outputs->to);
}

/* Divides long frames of many passes into steps. Passes that a raster draws together (skg_passes_choose) stay together. */
static skg_status divide(skg_job *job) {
    const skg_recipe *recipe = job->recipe;
    const int64_t passes = skg_samples_passes(&recipe->samples);
    const int64_t together = SKG_SIDE_MAX * (int64_t)job->machine->context->device->info.compute_units;
    const double pass_s = pass_time(job);
    if (!skg_recipe_averages(recipe) || (double)passes * pass_s * (double)job->output_count < AHEAD_S / 2)
        return SKG_OK;
    const double wanted = STEP_S / pass_s;
    int64_t each = wanted > 1 ? wanted < (double)passes ? (int64_t)wanted : passes : 1;
    if (job->machine->context->device->info.cpu) each = (each + together - 1) / together * together;
    if (each >= passes) return SKG_OK;
    int64_t steps = 0;
    for (int64_t o = 0; o < job->output_count; o++)
        steps += skg_frame_steps(recipe, job->outputs[o].to.kind, each);
    job->each = each;
    return skg_job_divide(job, steps);
}

/* Whether frames may be enqueued later, so that the job can be cancelled. Not if they write a buffer of the caller, whose commands may
 * follow; nor with leaky parts, whose repair reads the meshes on the host; nor with scatter, which is waited for in each frame. */
static int is_for_later(const skg_job *job) {
    for (int64_t o = 0; o < job->output_count; o++)
        if (job->outputs[o].to.buffer) return 0;
    return job->recipe->leaky_count == 0 && !job->recipe->options.scatter;
}

/* --- jobs */

static skg_status clear_counters(skg_job *job) {
    const cl_int none = 0;
    skg_machine *machine = job->machine;
    SKG_CL_TRY(clEnqueueFillBuffer(machine->context->device->queue, machine->negative.memory, &none,
                                   sizeof none, 0, 4 * sizeof none, 0, NULL, NULL));
    job->uncounted = 1;
    return job->kind->begin ? SKG_OK
                            : skg_geometry_clear_bad(machine->context, &machine->geometry, job->count);
}

/* Enqueues the read of the bad vertices of all frames that were enqueued. */
static skg_status read_bad(skg_job *job) {
    const skg_geometry *geometry = &job->machine->geometry;
    const int64_t frames = job->results.frames;
    const size_t first =
        job->kind->begin ? (size_t)geometry->frame : 0; /* its frame may be taken over from another job */
    if (frames == 0) return SKG_OK;
    SKG_CL_TRY(clEnqueueReadBuffer(job->machine->context->device->queue, geometry->bad.memory, CL_FALSE,
                                   first * sizeof(cl_int), (size_t)frames * sizeof(cl_int),
                                   job->results.bad_vertex, 0, NULL, NULL));
    return SKG_OK;
}

/* Enqueues the read of which vertices have left the bounds that the caller gave with their positions. Meshes whose positions
 * are those of the host again are left out. */
static skg_status read_outside(skg_job *job) {
    const skg_plan_meshes *meshes = &job->recipe->meshes;
    const skg_placement *placement = &job->machine->placement;
    int32_t **outside = &job->results.outside;
    for (int64_t m = 0; m < meshes->count; m++) {
        const skg_mesh *mesh = job->then.meshes ? &job->then.meshes[m] : meshes->meshes[m];
        if (!skg_placement_of(placement, mesh, m)) continue;
        if (!*outside) {
            SKG_TRY(
                skg_staging_take(&job->staging, meshes->count, sizeof **outside, "vertex check", outside));
            for (int64_t n = 0; n < meshes->count; n++) (*outside)[n] = INT32_MAX;
        }
        SKG_CL_TRY(clEnqueueReadBuffer(job->machine->context->device->queue, placement->outside.memory,
                                       CL_FALSE, (size_t)m * sizeof **outside, sizeof **outside, *outside + m,
                                       0, NULL, NULL));
    }
    return SKG_OK;
}

skg_status skg_submission_finish(skg_job *job) {
    const skg_machine *machine = job->machine;
    skg_results *results = &job->results;
    cl_command_queue queue = machine->context->device->queue;
    if (machine->context->held == job) machine->context->held = NULL;
    if (job->last) return SKG_OK;
    results->frames = job->enqueued / job->steps;
    SKG_TRY(read_bad(job));
    if (job->main.raster) /* scatter alone has none */
        SKG_TRY(skg_raster_read_listed(job->main.raster, results->listed));
    SKG_TRY(read_outside(job));
    SKG_CL_TRY(clEnqueueReadBuffer(queue, machine->negative.memory, CL_FALSE, 0,
                                   4 * sizeof *results->negative, results->negative, 0, NULL, &job->last));
    return skg_queue_flush(machine->context);
}

static skg_status begin(skg_job *job, const skg_frame *frames) {
    const double **poses = NULL;
    SKG_TRY(skg_alloc(job->recipe->scene->count, sizeof *poses, "poses", &poses));
    const skg_status status = job->kind->begin(job, frames, poses);
    skg_free(&poses);
    return status;
}

skg_status skg_submit_frames(skg_job **made, const skg_frame *frames, int at_once) {
    skg_job *job = *made;
    skg_status status = SKG_OK;
    const int begins = job->kind->begin != NULL, is_whole = !begins && (at_once || !is_for_later(job));
    if (begins)
        SKG_TRY_CLEANUP(begin(job, frames));
    else if (!is_whole)
        SKG_TRY_CLEANUP(divide(job));
    /* Of a frame in steps the caller would see sums of some. */
    for (int64_t o = 0; o < job->output_count && !begins && !job->each; o++)
        skg_frame_output_share(&job->outputs[o], &job->recipe->view, job->machine, job->count);
    const int64_t all = skg_job_steps(job), ahead = is_whole ? all : begins ? 0 : steps_ahead(job);
    SKG_TRY_CLEANUP(clear_counters(job));
    job->together = together_of(job, ahead);
    SKG_TRY_CLEANUP(submit_steps(job, frames, ahead < all ? ahead : all));
    if (job->enqueued == all) {
        status = skg_submission_finish(job);
        goto cleanup;
    }
    SKG_TRY_CLEANUP(skg_held_frames_copy(job, frames));
    SKG_TRY_CLEANUP(skg_queue_flush(job->machine->context));
    job->machine->context->held = job;
cleanup:
    if (status != SKG_OK) skg_job_end(made);
    return status;
}

static skg_status submit_held(skg_job *job, int64_t end) {
    const int64_t all = skg_job_steps(job);
    SKG_TRY(submit_steps(job, job->then.frames, end < all ? end : all));
    if (job->enqueued == all) return skg_submission_finish(job);
    return skg_queue_flush(job->machine->context);
}

/* Enqueues steps that were held back, up to number `end`. Their failure is that of the job. */
static void hand_over(skg_job *job, int64_t end) {
    if (job->last || job->failure != SKG_OK || skg_job_is_cancelled(job)) return;
    job->failure = submit_held(job, end);
    if (job->failure != SKG_OK) (void)skg_copy_text(skg_last_error(), &job->sentence);
}

/* Frames that are drawn together wait until there are as many as that. */
void skg_submission_continue(skg_job *job) {
    const int64_t all = skg_job_steps(job), end = job->done + steps_ahead(job);
    if (job->together && end < all && end - job->enqueued < skg_job_room(job)) return;
    hand_over(job, end);
}

void skg_submission_flush(const skg_context *context) {
    skg_job *job = context->held;
    if (!job) return;
    hand_over(job, skg_job_steps(job));
    const skg_status status = skg_submission_finish(job);
    if (job->failure == SKG_OK) job->failure = status;
}
