#include "frame/submission.h"
#include "frame/frame.h"

#include <inttypes.h>
#include <limits.h>
#include <string.h>

void skg_frame_init_sized(void *frame, int32_t size) {
    const skg_frame defaults = {0};
    skg_struct_init(frame, size, &defaults, sizeof defaults);
}

void skg_output_init_sized(void *output, int32_t size) {
    const skg_output defaults = {0};
    skg_struct_init(output, size, &defaults, sizeof defaults);
}

int64_t skg_submission_element(const skg_submission *submission) {
    return submission->output.type == SKG_TYPE_FLOAT64 ? (int64_t)sizeof(double) : (int64_t)sizeof(float);
}

/* --- checks */

/* Below this products of strides and counts do not overflow. */
static const int64_t LARGEST_STRIDE = (int64_t)1 << 40;

static skg_status check_strides(skg_submission *s) {
    skg_output *output = &s->output;
    const int64_t columns = s->recipe->view.columns, rows = s->recipe->view.rows;
    if (output->row_stride > LARGEST_STRIDE || output->channel_stride > LARGEST_STRIDE ||
        output->frame_stride > LARGEST_STRIDE)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "strides of %" PRId64 ", %" PRId64 " and %" PRId64 " elements; at most 2^40",
                        output->row_stride, output->channel_stride, output->frame_stride);
    if (!output->row_stride) output->row_stride = columns;
    if (output->row_stride < columns)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "a row stride of %" PRId64 " elements does not hold %" PRId64 " columns",
                        output->row_stride, columns);
    if (!output->channel_stride) output->channel_stride = rows * output->row_stride;
    if (output->channel_stride < rows * output->row_stride)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "a channel stride of %" PRId64 " elements does not hold %" PRId64 " rows",
                        output->channel_stride, rows);
    if (!output->frame_stride) output->frame_stride = s->channels * output->channel_stride;
    if (s->count > 1 && output->frame_stride < s->channels * output->channel_stride)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "a frame stride of %" PRId64 " elements does not hold %" PRId64 " channels",
                        output->frame_stride, s->channels);
    return SKG_OK;
}

static skg_status check_output(skg_submission *s, const skg_output *output) {
    skg_output_init(&s->output);
    if (!output) return skg_fail(SKG_ERR_ARGUMENT, "there is no output to put images into");
    SKG_TRY(skg_struct_read(output, "skg_output", &s->output, sizeof s->output));
    if (s->output.type != SKG_TYPE_FLOAT32 && s->output.type != SKG_TYPE_FLOAT64)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "output type %" PRId32 " is unknown; SKG_TYPE_FLOAT32 or SKG_TYPE_FLOAT64",
                        s->output.type);
    if (s->output.type == SKG_TYPE_FLOAT64 && !s->machine->context->device->info.has_double)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s has no fp64, so it cannot write doubles; take SKG_TYPE_FLOAT32",
                        s->machine->context->device->info.name);
    if (!s->buffer && !s->output.data)
        return skg_fail(SKG_ERR_ARGUMENT, "the output has no memory: its data is NULL");
    return check_strides(s);
}

skg_status skg_submission_check(skg_submission *s, const skg_output *output) {
    if (s->count < 1)
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " frames were asked for; at least one", s->count);
    s->channels = s->lengths_of >= 0 ? 1 : s->recipe->model.channels;
    return check_output(s, output);
}

/* Reads and checks a frame: itself, its view, its poses ([parts], NULL: the scene's) and the key of its noise. */
static skg_status read_frame(const skg_submission *s, int64_t index, skg_frame *frame, skg_view *view,
                             const double **poses, skg_noise_args *noise) {
    const skg_recipe *recipe = s->recipe;
    skg_frame_init(frame);
    *view = recipe->view;
    *noise = skg_noise_key(recipe->options.noise_seed, index, 1);
    memset(poses, 0, (size_t)recipe->scene->count * sizeof *poses);
    if (!s->frames) return SKG_OK;
    SKG_TRY(skg_struct_read_at(s->frames, index, "skg_frame", frame, sizeof *frame));
    *noise = skg_noise_key((int64_t)((uint64_t)recipe->options.noise_seed + (uint64_t)frame->noise_seed),
                           frame->index, frame->subframes);
    if (frame->subframes < 0)
        return skg_fail(SKG_ERR_ARGUMENT, "frame %" PRId64 ": it is one of %" PRId32 " sub-frames", index,
                        frame->subframes);
    if (frame->view) {
        SKG_TRY(skg_view_check(frame->view));
        skg_view_init(view);
        SKG_TRY(skg_struct_read(frame->view, "skg_view", view, sizeof *view));
        SKG_TRY(skg_recipe_check_view(recipe, view));
    }
    if (frame->pose_count < 0 || (frame->pose_count > 0 && (!frame->pose_parts || !frame->poses)))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "frame %" PRId64 " has %" PRId64 " posed parts, but no ids or poses", index,
                        frame->pose_count);
    for (int64_t k = 0; k < frame->pose_count; k++) {
        const int64_t part = frame->pose_parts[k];
        if (part < 0 || part >= recipe->scene->count)
            return skg_fail(SKG_ERR_ARGUMENT, "frame %" PRId64 " poses part %" PRId64 " of %" PRId64, index,
                            part, recipe->scene->count);
        SKG_TRY(skg_scene_check_pose(recipe->scene->parts[part].label, frame->poses + 16 * k));
        poses[part] = frame->poses + 16 * k;
    }
    return SKG_OK;
}

/* --- images */

/* Where the image goes: the caller's buffer, or device memory from which it is read back. */
static skg_status place_image(const skg_submission *s, int64_t index, skg_image_place *place) {
    const skg_view *view = &s->recipe->view;
    skg_machine *machine = s->machine;
    const skg_output *output = &s->output;
    *place = (skg_image_place){.memory = s->buffer,
                               .output_double = output->type == SKG_TYPE_FLOAT64,
                               .offset = s->first + index * output->frame_stride,
                               .row_stride = output->row_stride,
                               .channel_stride = output->channel_stride};
    if (s->buffer) return SKG_OK;
    const int64_t size = view->rows * view->columns;
    SKG_TRY(skg_buffer_reserve(machine->context, &machine->image,
                               s->channels * size * skg_submission_element(s), CL_MEM_READ_WRITE, "image"));
    place->memory = machine->image.memory;
    place->offset = 0;
    place->row_stride = view->columns;
    place->channel_stride = size;
    return SKG_OK;
}

/* Reads one channel back, with a row stride of its own. OpenCL requires the strides of channels to be multiples of those
 * of rows, so each channel is read by itself. */
static skg_status read_channel(const skg_submission *s, int64_t channel, char *to, skg_job *job) {
    const skg_view *view = &s->recipe->view;
    skg_machine *machine = s->machine;
    const size_t element = (size_t)skg_submission_element(s), rows = (size_t)view->rows;
    const size_t columns = (size_t)view->columns * element, stride = (size_t)s->output.row_stride * element;
    const size_t from[3] = {0, (size_t)channel * rows, 0}, at[3] = {0, 0, 0}, region[3] = {columns, rows, 1};
    cl_event event = NULL, *wanted = skg_stage_event(&job->staging.log, &event);
    to += (size_t)(channel * s->output.channel_stride) * element;
    SKG_CL_TRY(clEnqueueReadBufferRect(machine->context->device->queue, machine->image.memory, CL_FALSE, from,
                                       at, region, columns, 0, stride, 0, to, 0, NULL, wanted));
    return skg_stage_log_add(&job->staging.log, "read back", event);
}

static skg_status read_back(const skg_submission *s, int64_t index, skg_job *job) {
    const skg_view *view = &s->recipe->view;
    skg_machine *machine = s->machine;
    const skg_output *output = &s->output;
    const int64_t size = view->rows * view->columns, element = skg_submission_element(s);
    char *to = (char *)output->data + index * output->frame_stride * element;
    cl_event event = NULL, *wanted = skg_stage_event(&job->staging.log, &event);
    if (output->row_stride != view->columns || (s->channels > 1 && output->channel_stride != size)) {
        for (int64_t c = 0; c < s->channels; c++) SKG_TRY(read_channel(s, c, to, job));
        return SKG_OK;
    }
    SKG_CL_TRY(clEnqueueReadBuffer(machine->context->device->queue, machine->image.memory, CL_FALSE, 0,
                                   (size_t)(s->channels * size * element), to, 0, NULL, wanted));
    return skg_stage_log_add(&job->staging.log, "read back", event);
}

/* --- enqueueing */

static skg_status enqueue_frame(const skg_submission *s, int64_t index, const double **poses, skg_job *job,
                                skg_raster_pin *main) {
    skg_machine *machine = s->machine;
    int32_t *bad_vertex = job->results.bad_vertex + index;
    const skg_frame_means means = {.recipe = s->recipe,
                                   .machine = machine,
                                   .outcome = s->outcome,
                                   .staging = &job->staging,
                                   .results = &job->results,
                                   .main = main};
    skg_view view;
    skg_frame frame;
    skg_frame_work work = {
        .view = &view, .poses = poses, .frame = &frame, .lengths_of = s->lengths_of, .kind = s->kind};
    SKG_TRY(read_frame(s, index, &frame, &view, poses, &work.noise));
    SKG_TRY(place_image(s, index, &work.place));
    SKG_TRY(skg_geometry_reset_bad(machine->context, &machine->geometry));
    SKG_TRY(skg_frame_enqueue(&means, &work));
    SKG_TRY(skg_staging_read(&job->staging, machine->geometry.bad.memory, sizeof *bad_vertex, bad_vertex));
    return s->buffer ? SKG_OK : read_back(s, index, job);
}

static skg_status clear_counters(const skg_machine *machine) {
    const cl_int none = 0;
    SKG_CL_TRY(clEnqueueFillBuffer(machine->context->device->queue, machine->negative.memory, &none,
                                   sizeof none, 0, 3 * sizeof none, 0, NULL, NULL));
    return SKG_OK;
}

/* Enqueues the read of which vertices have left the bounds that the caller gave with their positions. Meshes whose positions
 * are those of the host again are left out. */
static skg_status read_outside(const skg_submission *s, skg_job *job) {
    const skg_plan_meshes *meshes = &s->recipe->meshes;
    const skg_placement *placement = &s->machine->placement;
    int32_t **outside = &job->results.outside;
    for (int64_t m = 0; m < meshes->count; m++) {
        if (!skg_placement_of(placement, meshes->meshes[m], m)) continue;
        if (!*outside) {
            SKG_TRY(
                skg_staging_take(&job->staging, meshes->count, sizeof **outside, "vertex check", outside));
            for (int64_t n = 0; n < meshes->count; n++) (*outside)[n] = INT32_MAX;
        }
        SKG_CL_TRY(clEnqueueReadBuffer(s->machine->context->device->queue, placement->outside.memory,
                                       CL_FALSE, (size_t)m * sizeof **outside, sizeof **outside, *outside + m,
                                       0, NULL, NULL));
    }
    return SKG_OK;
}

/* Enqueues the reads of what is reported, then the marker that is waited for. */
static skg_status finish(const skg_submission *s, const skg_raster_pin *main, skg_job *job) {
    const skg_machine *machine = s->machine;
    const skg_results *results = &job->results;
    cl_command_queue queue = machine->context->device->queue;
    SKG_TRY(skg_staging_read(&job->staging, machine->negative.memory, 3 * sizeof *results->negative,
                             results->negative));
    SKG_TRY(skg_raster_read_listed(main->raster, results->listed));
    SKG_TRY(read_outside(s, job));
    SKG_CL_TRY(clEnqueueMarkerWithWaitList(queue, 0, NULL, &job->last));
    SKG_CL_TRY(clFlush(queue));
    return SKG_OK;
}

skg_status skg_submission_enqueue(const skg_submission *s, skg_job **job) {
    const double **poses = NULL;
    skg_raster_pin main = {0};
    skg_job *made = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_job_create(s->recipe, s->machine, s->outcome, s->count, &made));
    SKG_TRY_CLEANUP(skg_alloc(s->recipe->scene->count, sizeof *poses, "poses", &poses));
    SKG_TRY_CLEANUP(clear_counters(s->machine));
    for (int64_t i = 0; i < s->count; i++) SKG_TRY_CLEANUP(enqueue_frame(s, i, poses, made, &main));
    SKG_TRY_CLEANUP(finish(s, &main, made));
    *job = made;
    made = NULL;
cleanup:
    skg_raster_pin_release(&main);
    skg_free(&poses);
    skg_job_release(&made);
    return status;
}
