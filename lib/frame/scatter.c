/* Scattered photons of a frame. */
#include "frame/frames.h"

#include <inttypes.h>

int skg_frame_scatters(const skg_job *job) {
    return job->recipe->options.scatter && job->scatterer && !job->recipe->linear;
}

skg_status skg_frame_matter(const skg_recipe *recipe, const skg_frame *frame, double **matter) {
    const int64_t parts = recipe->scene->count;
    *matter = NULL;
    if (!frame || !frame->override_count) return SKG_OK;
    SKG_TRY(skg_alloc(2 * parts, sizeof **matter, "overrides of a frame", matter));
    const skg_status status = skg_overrides_matter(recipe, frame, *matter, *matter + parts);
    if (status != SKG_OK) skg_free(matter);
    return status;
}

skg_status skg_frame_check_places(const skg_recipe *recipe, const skg_machine *machine) {
    const skg_plan_meshes *meshes = &recipe->meshes;
    for (int64_t m = 0; m < meshes->count; m++)
        if (skg_placement_of(&machine->placement, meshes->meshes[m], m))
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "scatter: positions of %s were set on the device, where the cells of scattering are not made; set "
                "them with skg_mesh_positions_set",
                meshes->meshes[m]->name);
    return SKG_OK;
}

/* The scatter of a frame, by itself. component: -1: none */
static skg_status compute_own(skg_job *job, const skg_scatter_work *scatter, int component) {
    SKG_TRY(skg_scatterer_run(job->machine->context, job->scatterer, scatter));
    if (component < 0) return SKG_OK;
    return skg_scatterer_component(job->machine->context, job->scatterer, scatter, component);
}

/* From the series of the frame. */
static skg_status take(skg_job *job, const skg_scatter_work *scatter, const skg_frame *frame, int component) {
    const skg_scatter_series *series = frame->scatter_series;
    if (series->owner != job->scatterer->number || series->recipe->materials != scatter->recipe->materials)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "scatter: the series was made by another plan, or for other materials");
    if (!(frame->series_place >= 0 && frame->series_place <= (double)(series->report.frames - 1)))
        return skg_fail(SKG_ERR_ARGUMENT, "scatter: place %g in a series of %" PRId64 " frames",
                        frame->series_place, series->report.frames);
    if (component >= 0)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "scatter: a series does not have orders and kinds apart; leave out the series");
    return skg_scatterer_take(job->machine->context, job->scatterer, scatter, series, frame->series_place);
}

/* Computes the scatter, and the component that is asked for; -1: none. */
static skg_status compute(skg_job *job, const skg_frame_work *work, int component) {
    const skg_recipe *recipe = job->recipe;
    skg_scatter_work scatter = {.recipe = recipe, .view = work->view, .poses = work->poses};
    double *matter = NULL;
    skg_status status = SKG_OK;
    if (work->frame && work->frame->scatter_series) return take(job, &scatter, work->frame, component);
    SKG_TRY(skg_frame_check_places(recipe, job->machine));
    SKG_TRY(skg_frame_matter(recipe, work->frame, &matter));
    if (work->frame) scatter.progress = work->frame->progress;
    if (matter) scatter.density = matter, scatter.fill = matter + recipe->scene->count;
    status = compute_own(job, &scatter, component);
    skg_free(&matter);
    return status;
}

static skg_status run(skg_job *job, const skg_frame_work *work, const skg_scattered_image *what,
                      const skg_image_place *image) {
    const skg_view *view = work->view;
    return skg_scattered_run(job->machine->context, &job->scatterer->stage, what, &work->noise, image,
                             view->columns, view->rows, &job->staging.log);
}

skg_status skg_frame_add_scatter(skg_job *job, const skg_frame_work *work, const skg_image_place *image) {
    SKG_TRY(compute(job, work, -1));
    const skg_scatterer *s = job->scatterer;
    const skg_plan_options *options = &job->recipe->options;
    const int noise = options->noise && work->kind == SKG_OUTPUT_IMAGE;
    const int of_variance = work->kind == SKG_OUTPUT_VARIANCE;
    const skg_scattered_image what = {.mean = of_variance ? s->images.variance.memory : s->images.mean.memory,
                                      .variance = noise ? s->images.variance.memory : NULL,
                                      .channels = skg_model_sums(&job->recipe->model),
                                      .add = 1,
                                      .apart = noise && options->dqe,
                                      .scale = of_variance ? (float)work->noise.parts : 1};
    const int adds = s->report.mean > 0 && (!of_variance || options->noise);
    return adds ? run(job, work, &what, image) : SKG_OK;
}

skg_status skg_frame_show_scatter(skg_job *job, const skg_frame_work *work) {
    const int is_component = work->kind == SKG_OUTPUT_SCATTER_COMPONENT;
    SKG_TRY(compute(job, work, is_component ? work->which : -1));
    const skg_scatter_images *images = &job->scatterer->images;
    const skg_scattered_image what = {.mean = is_component                       ? images->component.memory
                                              : work->kind == SKG_OUTPUT_SCATTER ? images->shown.memory
                                                                                 : images->sigma.memory,
                                      .channels = job->recipe->model.channels,
                                      .scale = 1};
    return run(job, work, &what, &work->place);
}
