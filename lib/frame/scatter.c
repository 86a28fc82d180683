#include "frame/scatter.h"

#include "frame/overrides.h"

int skg_frame_scatters(const skg_job *job) {
    return job->recipe->options.scatter && job->scatterer && !job->recipe->linear;
}

/* Positions that are on the device alone are not known here. */
static skg_status check_places(const skg_job *job) {
    const skg_plan_meshes *meshes = &job->recipe->meshes;
    for (int64_t m = 0; m < meshes->count; m++)
        if (skg_placement_of(&job->machine->placement, meshes->meshes[m], m))
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "scatter: positions of %s were set on the device, where the cells of scattering are not made; set "
                "them with skg_mesh_positions_set",
                meshes->meshes[m]->name);
    return SKG_OK;
}

/* Computes the scatter, and the component that is asked for; -1: none. */
static skg_status compute(skg_job *job, const skg_frame_work *work, int component) {
    const skg_recipe *recipe = job->recipe;
    skg_scatter_work scatter = {.recipe = recipe, .view = work->view, .poses = work->poses};
    double *matter = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(check_places(job));
    if (work->frame && work->frame->override_count) {
        SKG_TRY(skg_alloc(2 * recipe->scene->count, sizeof *matter, "overrides of a frame", &matter));
        scatter.density = matter;
        scatter.fill = matter + recipe->scene->count;
        SKG_TRY_CLEANUP(skg_overrides_matter(recipe, work->frame, matter, matter + recipe->scene->count));
    }
    SKG_TRY_CLEANUP(skg_scatterer_run(job->machine->context, job->scatterer, &scatter));
    if (component >= 0)
        status = skg_scatterer_component(job->machine->context, job->scatterer, &scatter, component);
cleanup:
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
    const skg_scattered_image what = {s->images.mean.memory,
                                      job->recipe->options.noise ? s->images.variance.memory : NULL, 1};
    return s->report.mean > 0 ? run(job, work, &what, image) : SKG_OK;
}

skg_status skg_frame_show_scatter(skg_job *job, const skg_frame_work *work) {
    const int is_component = work->shows == SKG_OUTPUT_SCATTER_COMPONENT;
    SKG_TRY(compute(job, work, is_component ? work->kind : -1));
    const skg_scatter_images *images = &job->scatterer->images;
    const skg_scattered_image what = {is_component                        ? images->component.memory
                                      : work->shows == SKG_OUTPUT_SCATTER ? images->shown.memory
                                                                          : images->sigma.memory,
                                      NULL, 0};
    return run(job, work, &what, &work->place);
}
