/* What a frame shows: its passes, in one step or in several, and what follows the last one. */
#include "frame/frames.h"
#include "plan/decisions.h"

/* The steps of the passes of an image. */
static int64_t steps_of(const skg_recipe *recipe, int64_t each) {
    return each ? (skg_samples_passes(&recipe->samples) + each - 1) / each : 1;
}

int64_t skg_frame_steps(const skg_recipe *recipe, int32_t shows, int64_t each) {
    if (!each || shows == SKG_OUTPUT_LENGTHS || skg_output_is_scatter(shows)) return 1;
    const int twice = shows == SKG_OUTPUT_VARIANCE && skg_decide_late_logarithm(recipe);
    return (twice ? 2 : 1) * steps_of(recipe, each);
}

static int is_last_step(const skg_job *job, const skg_frame_work *work) {
    return work->step + 1 >= steps_of(job->recipe, work->each);
}

/* Enqueues a step of what arrives at the detector, primary and, with the last, scattered; layers: result: where it is put. */
static skg_status render_layers(skg_job *job, const skg_frame_work *work, skg_image_place *layers) {
    const skg_recipe *recipe = job->recipe;
    const int64_t first = skg_frame_first_pass(recipe);
    skg_frame_work layered = *work;
    SKG_TRY(skg_layers_place(job->machine->context, &job->machine->layers, skg_frame_layers(job, work),
                             &work->place, recipe->view.columns, recipe->view.rows, recipe->model.channels,
                             layers));
    layered.place = *layers;
    const int64_t passes = first < 0 ? 0 : skg_samples_passes(&recipe->samples),
                  begin = work->step * work->each;
    const int is_last = is_last_step(job, work);
    SKG_TRY(skg_frame_draw_passes(job, &layered, first < 0 ? first : begin,
                                  is_last ? passes : begin + work->each));
    return is_last && skg_frame_scatters(job) ? skg_frame_add_scatter(job, work, layers) : SKG_OK;
}

/* Enqueues a step of what is shown, before its logarithm. */
static skg_status render_values(skg_job *job, const skg_frame_work *work) {
    skg_image_place layers;
    SKG_TRY(render_layers(job, work, &layers));
    return is_last_step(job, work) ? skg_frame_detect(job, work, &layers) : SKG_OK;
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
    other.shows = SKG_OUTPUT_MEAN;
    other.place = (skg_image_place){.memory = *mean,
                                    .output_double = work->place.output_double,
                                    .row_stride = recipe->view.columns,
                                    .channel_stride = size};
    return render_values(job, &other);
}

/* With steps, those of the mean come first. */
static skg_status render_variance(skg_job *job, const skg_frame_work *work) {
    skg_image_place layers;
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
    SKG_TRY(render_layers(job, &own, &layers));
    return is_last_step(job, &own) ? skg_frame_detect_variance(job, &own, &layers, mean) : SKG_OK;
}

skg_status skg_frame_render(skg_job *job, const skg_frame_work *work) {
    const skg_recipe *recipe = job->recipe;
    if (work->shows == SKG_OUTPUT_LENGTHS) return skg_frame_draw_passes(job, work, -1, 0);
    if (skg_output_is_scatter(work->shows)) return skg_frame_show_scatter(job, work);
    if (work->shows == SKG_OUTPUT_VARIANCE) return render_variance(job, work);
    SKG_TRY(render_values(job, work));
    return is_last_step(job, work) && skg_decide_late_logarithm(recipe) ? skg_frame_take_logarithm(job, work)
                                                                        : SKG_OK;
}
