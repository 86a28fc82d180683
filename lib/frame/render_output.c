/* Renders an output of a frame: what its kind shows, in one step or in several, and the read of it. */
#include "frame/frames.h"
#include "plan/decisions.h"

#include <inttypes.h>

/* The steps of the passes of an image. */
static int64_t steps_of(const skg_recipe *recipe, int64_t each) {
    return each ? (skg_samples_passes(&recipe->samples) + each - 1) / each : 1;
}

int64_t skg_frame_steps(const skg_recipe *recipe, int32_t kind, int64_t each) {
    if (!each || kind == SKG_OUTPUT_LENGTHS || skg_output_is_scatter(kind)) return 1;
    const int twice = kind == SKG_OUTPUT_VARIANCE && skg_decide_late_logarithm(recipe);
    return (twice ? 2 : 1) * steps_of(recipe, each);
}

static int is_last_step(const skg_job *job, const skg_frame_work *work) {
    return work->step + 1 >= steps_of(job->recipe, work->each);
}

/* Enqueues a step of what arrives at the detector, primary and, with the last, scattered, and then what the detector makes of it. mean: of
 * the variance of a logarithm: of its argument; else NULL */
static skg_status render_intensities(skg_job *job, const skg_frame_work *work, cl_mem mean) {
    const skg_recipe *recipe = job->recipe;
    const int64_t first = skg_frame_first_pass(recipe), begin = work->step * work->each;
    const int64_t passes = first < 0 ? 0 : skg_samples_passes(&recipe->samples);
    const int is_last = is_last_step(job, work);
    skg_image_place layers;
    skg_frame_work layered = *work;
    SKG_TRY(skg_layers_place(job->machine->context, &job->machine->layers, skg_frame_layers(job, work),
                             &work->place, recipe->view.columns, recipe->view.rows, recipe->model.channels,
                             &layers));
    layered.place = layers;
    SKG_TRY(skg_draw_passes(job, &layered, first < 0 ? first : begin, is_last ? passes : begin + work->each));
    if (!is_last) return SKG_OK;
    if (skg_frame_scatters(job)) SKG_TRY(skg_frame_add_scatter(job, work, &layers));
    return work->kind == SKG_OUTPUT_VARIANCE ? skg_frame_detect_variance(job, work, &layers, mean)
                                             : skg_frame_detect(job, work, &layers);
}

/* The variance of a logarithm needs the mean of its argument. */
static skg_status render_mean(skg_job *job, const skg_frame_work *work, cl_mem *mean) {
    const skg_recipe *recipe = job->recipe;
    skg_machine *machine = job->machine;
    const int64_t size = recipe->view.rows * recipe->view.columns;
    skg_frame_work other = *work;
    SKG_TRY(
        skg_buffer_reserve(machine->context, &machine->mean,
                           recipe->model.channels * size *
                               (int64_t)(work->place.output_double ? sizeof(cl_double) : sizeof(cl_float)),
                           CL_MEM_READ_WRITE, "mean"));
    *mean = machine->mean.memory;
    other.kind = SKG_OUTPUT_MEAN;
    other.place = (skg_image_place){.memory = *mean,
                                    .output_double = work->place.output_double,
                                    .row_stride = recipe->view.columns,
                                    .channel_stride = size};
    return render_intensities(job, &other, NULL);
}

/* With steps, those of the mean come first. */
static skg_status render_variance(skg_job *job, const skg_frame_work *work) {
    skg_frame_work own = *work;
    cl_mem mean = NULL;
    if (skg_decide_late_logarithm(job->recipe)) {
        const int64_t steps = work->each ? steps_of(job->recipe, work->each) : 0;
        if (work->step < steps) return render_mean(job, work, &mean);
        if (steps)
            mean = job->machine->mean.memory;
        else
            SKG_TRY(render_mean(job, work, &mean));
        own.step -= steps;
    }
    return render_intensities(job, &own, mean);
}

skg_status skg_render_output(skg_job *job, const skg_frame_output *output, int64_t index,
                             skg_frame_work *work) {
    const skg_recipe *recipe = job->recipe;
    const int32_t kind = output->to.kind;
    SKG_ASSERT(0 <= index && index < job->count && 0 <= work->step &&
               work->step < skg_frame_steps(recipe, kind, work->each));
    work->kind = kind;
    work->part = output->to.part;
    work->which = kind == SKG_OUTPUT_LENGTHS ? output->to.lengths : output->to.component;
    work->reuses = kind == SKG_OUTPUT_MEAN || kind == SKG_OUTPUT_VARIANCE;
    SKG_TRY(skg_frame_output_place(output, &recipe->view, job->machine, index, &work->place));
    if (kind == SKG_OUTPUT_LENGTHS) {
        SKG_TRY(skg_draw_passes(job, work, -1, 0));
    } else if (skg_output_is_scatter(kind)) {
        SKG_TRY(skg_frame_show_scatter(job, work));
    } else if (kind == SKG_OUTPUT_VARIANCE) {
        SKG_TRY(render_variance(job, work));
    } else {
        SKG_TRY(render_intensities(job, work, NULL));
        if (is_last_step(job, work) && skg_decide_late_logarithm(recipe))
            SKG_TRY(skg_frame_take_logarithm(job, work));
    }
    if (work->step + 1 < skg_frame_steps(recipe, kind, work->each)) return SKG_OK;
    if (work->end && *work->end) clReleaseEvent(*work->end);
    if (work->end) *work->end = NULL;
    return skg_frame_output_read_back(output, &recipe->view, job->machine, index, &job->staging.log,
                                      work->end);
}

/* Enqueues a step of a frame, or all its outputs. What is reported of a frame is that of its last output: images come last. */
static skg_status render_frame(skg_job *job, int64_t index, int64_t step, skg_frame_work *work) {
    work->each = job->each;
    for (int images = 0; images < 2; images++)
        for (int64_t o = 0; o < job->output_count; o++) {
            const int32_t kind = job->outputs[o].to.kind;
            if ((kind == SKG_OUTPUT_IMAGE) != images) continue;
            const int64_t steps = skg_frame_steps(job->recipe, kind, job->each);
            work->step = job->each ? step : 0;
            if (!job->each || (step >= 0 && step < steps))
                SKG_TRY(skg_render_output(job, &job->outputs[o], index, work));
            step -= steps;
        }
    return SKG_OK;
}

/* Says how many frames of a job that was cancelled are in place. */
static skg_status fail_cancelled(const skg_job *job) {
    return skg_fail(SKG_ERR_CANCELLED,
                    "the job was cancelled: %" PRId64 " of %" PRId64 " frames are in place",
                    job->enqueued / job->steps, job->count);
}

const skg_job_kind skg_job_images = {.step = render_frame, .cancelled = fail_cancelled};
