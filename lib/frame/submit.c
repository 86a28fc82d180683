/* Frames: submitted, split, read back. */
#include "frame/frame.h"

#include <skiagraph/opencl.h>

#include <inttypes.h>
#include <limits.h>
#include <string.h>

/* What one submission is to do, checked. */
typedef struct {
    skg_plan *plan;
    int64_t count;
    const skg_frame *frames; /* as the caller gave them; NULL: as the scene stands */
    skg_output output;       /* strides filled in */
    int64_t channels;
    int64_t lengths_of; /* -1: images */
    int32_t kind;
    cl_mem buffer; /* NULL: host memory */
    int64_t first; /* element of the buffer */
} submission;

void skg_frame_init_sized(void *frame, int32_t size) {
    const skg_frame defaults = {0};
    skg_struct_init(frame, size, &defaults, sizeof defaults);
}

void skg_output_init_sized(void *output, int32_t size) {
    const skg_output defaults = {0};
    skg_struct_init(output, size, &defaults, sizeof defaults);
}

static int64_t element_size(const skg_output *output) {
    return output->type == SKG_TYPE_FLOAT64 ? (int64_t)sizeof(double) : (int64_t)sizeof(float);
}

/* So large that products of strides and counts stay numbers. */
static const int64_t LARGEST_STRIDE = (int64_t)1 << 40;

static skg_status check_strides(submission *s) {
    skg_output *output = &s->output;
    const int64_t columns = s->plan->view.columns, rows = s->plan->view.rows;
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

static skg_status check_output(submission *s, const skg_output *output) {
    skg_output_init(&s->output);
    if (!output) return skg_fail(SKG_ERR_ARGUMENT, "there is no output to put images into");
    SKG_TRY(skg_struct_read(output, "skg_output", &s->output, sizeof s->output));
    if (s->output.type != SKG_TYPE_FLOAT32 && s->output.type != SKG_TYPE_FLOAT64)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "output type %" PRId32 " is unknown; SKG_TYPE_FLOAT32 or SKG_TYPE_FLOAT64",
                        s->output.type);
    if (s->output.type == SKG_TYPE_FLOAT64 && !s->plan->context->device->info.has_double)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s has no fp64, so it cannot write doubles; take SKG_TYPE_FLOAT32",
                        s->plan->context->device->info.name);
    if (!s->buffer && !s->output.data)
        return skg_fail(SKG_ERR_ARGUMENT, "the output has no memory: its data is NULL");
    return check_strides(s);
}

/* Same parts in the same places as when the plan was made; materials may have changed. */
static skg_status check_stale(skg_plan *plan) {
    if (plan->scene->structure == plan->structure) return skg_plan_renew_model(plan);
    return skg_fail(
        SKG_STALE, "parts of the scene were added or put elsewhere since the plan was made; make a new plan");
}

static skg_status check_submission(submission *s, const skg_output *output) {
    if (s->count < 1)
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " frames were asked for; at least one", s->count);
    s->channels = s->lengths_of >= 0 ? 1 : s->plan->model.channels;
    SKG_TRY(check_output(s, output));
    return check_stale(s->plan);
}

/* A frame, its view into `view`, its poses into poses ([parts], NULL: the scene's), and the key of its noise.
 */
static skg_status read_frame(const submission *s, int64_t index, skg_frame *frame, skg_view *view,
                             const double **poses, skg_noise_args *noise) {
    const skg_plan *plan = s->plan;
    skg_frame_init(frame);
    *view = plan->view;
    *noise = skg_noise_key(plan->options.noise_seed, index);
    memset(poses, 0, (size_t)plan->scene->count * sizeof *poses);
    if (!s->frames) return SKG_OK;
    SKG_TRY(skg_struct_read_at(s->frames, index, "skg_frame", frame, sizeof *frame));
    *noise = skg_noise_key((int64_t)((uint64_t)plan->options.noise_seed + (uint64_t)frame->noise_seed),
                           frame->index);
    if (frame->view) {
        SKG_TRY(skg_view_check(frame->view));
        skg_view_init(view);
        SKG_TRY(skg_struct_read(frame->view, "skg_view", view, sizeof *view));
        SKG_TRY(skg_plan_check_size(plan, view));
    }
    if (frame->pose_count < 0 || (frame->pose_count > 0 && (!frame->pose_parts || !frame->poses)))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "frame %" PRId64 " has %" PRId64 " posed parts, but no ids or poses", index,
                        frame->pose_count);
    for (int64_t k = 0; k < frame->pose_count; k++) {
        const int64_t part = frame->pose_parts[k];
        if (part < 0 || part >= plan->scene->count)
            return skg_fail(SKG_ERR_ARGUMENT, "frame %" PRId64 " poses part %" PRId64 " of %" PRId64, index,
                            part, plan->scene->count);
        SKG_TRY(skg_scene_check_pose(plan->scene->parts[part].label, frame->poses + 16 * k));
        poses[part] = frame->poses + 16 * k;
    }
    return SKG_OK;
}

/* Device memory for one image on its way to the host. */
static skg_status place_image(submission *s, int64_t index, skg_image_place *place) {
    skg_plan *plan = s->plan;
    const skg_output *output = &s->output;
    *place = (skg_image_place){.memory = s->buffer,
                               .output_double = output->type == SKG_TYPE_FLOAT64,
                               .offset = s->first + index * output->frame_stride,
                               .row_stride = output->row_stride,
                               .channel_stride = output->channel_stride};
    if (s->buffer) return SKG_OK;
    const int64_t size = plan->view.rows * plan->view.columns;
    SKG_TRY(skg_buffer_reserve(plan->context, &plan->image, s->channels * size * element_size(output),
                               CL_MEM_READ_WRITE, "image"));
    place->memory = plan->image.memory;
    place->offset = 0;
    place->row_stride = plan->view.columns;
    place->channel_stride = size;
    return SKG_OK;
}

/* One channel with a row stride of its own. OpenCL wants strides of channels to be multiples of those of
 * rows: each channel is read by itself. */
static skg_status read_channel(const submission *s, int64_t channel, char *to, skg_job *job) {
    const skg_plan *plan = s->plan;
    const size_t element = (size_t)element_size(&s->output), rows = (size_t)plan->view.rows;
    const size_t columns = (size_t)plan->view.columns * element,
                 stride = (size_t)s->output.row_stride * element;
    const size_t from[3] = {0, (size_t)channel * rows, 0}, at[3] = {0, 0, 0}, region[3] = {columns, rows, 1};
    cl_event event = NULL, *wanted = skg_stage_event(&job->log, &event);
    to += (size_t)(channel * s->output.channel_stride) * element;
    SKG_CL_TRY(clEnqueueReadBufferRect(plan->context->device->queue, plan->image.memory, CL_FALSE, from, at,
                                       region, columns, 0, stride, 0, to, 0, NULL, wanted));
    return skg_stage_log_add(&job->log, "read back", event);
}

static skg_status read_back(const submission *s, int64_t index, skg_job *job) {
    const skg_plan *plan = s->plan;
    const skg_output *output = &s->output;
    const int64_t size = plan->view.rows * plan->view.columns, element = element_size(output);
    char *to = (char *)output->data + index * output->frame_stride * element;
    cl_event event = NULL, *wanted = skg_stage_event(&job->log, &event);
    if (output->row_stride != plan->view.columns || (s->channels > 1 && output->channel_stride != size)) {
        for (int64_t c = 0; c < s->channels; c++) SKG_TRY(read_channel(s, c, to, job));
        return SKG_OK;
    }
    SKG_CL_TRY(clEnqueueReadBuffer(plan->context->device->queue, plan->image.memory, CL_FALSE, 0,
                                   (size_t)(s->channels * size * element), to, 0, NULL, wanted));
    return skg_stage_log_add(&job->log, "read back", event);
}

static skg_status enqueue_frame(submission *s, int64_t index, const double **poses, skg_job *job) {
    skg_view view;
    skg_frame frame;
    skg_frame_work work = {
        .view = &view, .poses = poses, .frame = &frame, .lengths_of = s->lengths_of, .kind = s->kind};
    SKG_TRY(read_frame(s, index, &frame, &view, poses, &work.noise));
    SKG_TRY(place_image(s, index, &work.place));
    SKG_TRY(skg_frame_enqueue(s->plan, job, &work));
    return s->buffer ? SKG_OK : read_back(s, index, job);
}

/* What is told when the job is done; then the marker that is waited for. */
static skg_status finish(const submission *s, skg_job *job) {
    skg_plan *plan = s->plan;
    cl_command_queue queue = plan->context->device->queue;
    SKG_TRY(skg_job_read(job, plan->negative.memory, 2 * sizeof *job->negative, job->negative));
    SKG_TRY(skg_job_read(job, plan->geometry.bad.memory, sizeof *job->broken, job->broken));
    SKG_TRY(skg_raster_read_listed(plan->main, job->listed));
    SKG_CL_TRY(clEnqueueMarkerWithWaitList(queue, 0, NULL, &job->last));
    SKG_CL_TRY(clFlush(queue));
    return SKG_OK;
}

static skg_status clear_counters(skg_plan *plan) {
    const cl_int none = 0;
    SKG_CL_TRY(clEnqueueFillBuffer(plan->context->device->queue, plan->negative.memory, &none, sizeof none, 0,
                                   2 * sizeof none, 0, NULL, NULL));
    return SKG_OK;
}

static skg_status submit(submission *s, skg_job **job) {
    skg_plan *plan = s->plan;
    const double **poses = NULL;
    skg_job *made = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_job_create(plan, &made));
    SKG_TRY_CLEANUP(skg_alloc(plan->scene->count, sizeof *poses, "poses", &poses));
    SKG_TRY_CLEANUP(skg_job_stage(made, 2, sizeof *made->negative, "counters", &made->negative));
    SKG_TRY_CLEANUP(skg_job_stage(made, 2, sizeof *made->listed, "counters", &made->listed));
    SKG_TRY_CLEANUP(skg_job_stage(made, 1, sizeof *made->broken, "counters", &made->broken));
    SKG_TRY_CLEANUP(
        skg_job_stage(made, plan->open_count, sizeof *made->bad_open, "bad pixels", &made->bad_open));
    SKG_TRY_CLEANUP(skg_job_stage(made, plan->open_count * (1 + SKG_FIRST_BAD), sizeof *made->bad,
                                  "bad pixels", &made->bad));
    SKG_TRY_CLEANUP(clear_counters(plan));
    for (int64_t i = 0; i < s->count; i++) SKG_TRY_CLEANUP(enqueue_frame(s, i, poses, made));
    SKG_TRY_CLEANUP(finish(s, made));
    *job = made;
    made = NULL;
cleanup:
    skg_free(&poses);
    skg_job_release(&made);
    return status;
}

static skg_status begin(const char *call, skg_plan *plan, skg_job **job) {
    if (!plan) return skg_fail(SKG_ERR_ARGUMENT, "%s: no plan", call);
    if (!job) return skg_fail(SKG_ERR_ARGUMENT, "%s: nowhere to put the job", call);
    *job = NULL;
    return skg_context_enter(plan->context);
}

skg_status skg_plan_submit(skg_plan *plan, int64_t count, const skg_frame *frames, const skg_output *output,
                           skg_job **job) {
    SKG_TRY(begin("skg_plan_submit", plan, job));
    submission s = {.plan = plan, .count = count, .frames = frames, .lengths_of = -1};
    SKG_TRY(check_submission(&s, output));
    return submit(&s, job);
}

skg_status skg_plan_image(skg_plan *plan, const skg_output *output) {
    skg_job *job = NULL;
    SKG_TRY(begin("skg_plan_image", plan, &job));
    submission s = {.plan = plan, .count = 1, .lengths_of = -1};
    SKG_TRY(check_submission(&s, output));
    SKG_TRY(submit(&s, &job));
    return skg_job_wait(&job);
}

skg_status skg_plan_lengths(skg_plan *plan, int64_t part, int32_t kind, int64_t count,
                            const skg_frame *frames, const skg_output *output, skg_job **job) {
    SKG_TRY(begin("skg_plan_lengths", plan, job));
    if (part < 0 || part >= plan->scene->count)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_lengths: part %" PRId64 " of %" PRId64, part,
                        plan->scene->count);
    if (kind != SKG_LENGTHS_NET && kind != SKG_LENGTHS_SURFACE)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "lengths of kind %" PRId32 " are unknown; SKG_LENGTHS_NET or SKG_LENGTHS_SURFACE",
                        kind);
    submission s = {.plan = plan, .count = count, .frames = frames, .lengths_of = part, .kind = kind};
    SKG_TRY(check_submission(&s, output));
    return submit(&s, job);
}

/* --- into the caller's device memory
 * ------------------------------------------------------------------------------ */

static skg_status check_buffer(submission *s, int64_t offset) {
    const skg_output *output = &s->output;
    const int64_t element = element_size(output);
    size_t bytes = 0;
    SKG_CL_TRY(clGetMemObjectInfo(s->buffer, CL_MEM_SIZE, sizeof bytes, &bytes, NULL));
    if (offset < 0 || offset % element)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "an offset of %" PRId64 " bytes is no multiple of an element's %" PRId64, offset,
                        element);
    s->first = offset / element;
    const int64_t last = (s->count - 1) * output->frame_stride + (s->channels - 1) * output->channel_stride +
                         (s->plan->view.rows - 1) * output->row_stride + s->plan->view.columns;
    if ((s->first + last) * element > (int64_t)bytes)
        return skg_fail(SKG_ERR_ARGUMENT, "the images end at byte %" PRId64 ", the buffer at %" PRId64,
                        (s->first + last) * element, (int64_t)bytes);
    return SKG_OK;
}

skg_status skg_plan_submit_cl(skg_plan *plan, int64_t count, const skg_frame *frames,
                              const skg_output *output, cl_mem buffer, int64_t offset, int32_t waits,
                              const cl_event *wait_list, cl_event *done, skg_job **job) {
    SKG_TRY(begin("skg_plan_submit_cl", plan, job));
    submission s = {.plan = plan, .count = count, .frames = frames, .lengths_of = -1, .buffer = buffer};
    if (done) *done = NULL;
    if (!buffer) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_submit_cl: no buffer");
    if (waits < 0 || (waits > 0 && !wait_list))
        return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_submit_cl: %" PRId32 " events to wait for, but no list",
                        waits);
    SKG_TRY(check_submission(&s, output));
    SKG_TRY(check_buffer(&s, offset));
    if (waits > 0)
        SKG_CL_TRY(
            clEnqueueBarrierWithWaitList(plan->context->device->queue, (cl_uint)waits, wait_list, NULL));
    SKG_TRY(submit(&s, job));
    if (done) {
        SKG_CL_TRY(clRetainEvent((*job)->last));
        *done = (*job)->last;
    }
    return SKG_OK;
}
