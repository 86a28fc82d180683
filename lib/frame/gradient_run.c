#include "frame/gradient_run.h"

#include "frame/adjoint.h"
#include "geometry/forces.h"

#include <string.h>

/* Clears what is wanted of vertices, which is added to. */
static void clear_vertices(const skg_scene *scene, const skg_gradient *wanted) {
    for (int64_t p = 0; wanted->vertices && p < scene->count; p++)
        if (wanted->vertices[p])
            memset(wanted->vertices[p], 0,
                   3 * (size_t)scene->parts[p].mesh->vertices * sizeof **wanted->vertices);
}

/* Clears the images along directions, which passes are added to. */
static void clear_images(const skg_job *job) {
    const skg_recipe *recipe = job->recipe;
    const int64_t count = recipe->model.channels * recipe->view.rows * recipe->view.columns;
    memset(job->gradient->results, 0,
           (size_t)(job->gradient->direction_count * count) * sizeof *job->gradient->results);
}

/* The image was read in the type of the output. */
static void widen_image(const skg_job *job) {
    double *image = job->gradient->image;
    const int64_t count = job->recipe->model.channels * job->recipe->view.rows * job->recipe->view.columns;
    if (!image || job->gradient->shown.to.type == SKG_TYPE_FLOAT64) return;
    for (int64_t i = count - 1; i >= 0; i--) image[i] = (double)((const float *)image)[i];
}

skg_status skg_gradient_begin(skg_job *job) {
    struct skg_gradient_work *gradient = job->gradient;
    const int is_read = gradient->raw || gradient->image;
    const cl_int code = is_read ? skg_event_wait(gradient->ready) : CL_SUCCESS;
    if (code != CL_SUCCESS) return skg_cl_fail(code, "clWaitForEvents", __FILE__, __LINE__);
    widen_image(job);
    if (gradient->direction_count) {
        clear_images(job);
        return SKG_OK;
    }
    clear_vertices(job->recipe->scene, &gradient->wanted);
    SKG_TRY(skg_adjoint_take(job));
    return skg_adjoint_of_intensities(job, &gradient->of_frame, gradient->image, &gradient->adjoint);
}

static skg_status hand_out(const skg_scene *scene, const struct skg_gradient_work *work) {
    const skg_gradient *wanted = &work->wanted;
    if (wanted->poses) memcpy(wanted->poses, work->poses, 6 * (size_t)scene->count * sizeof *work->poses);
    if (wanted->densities)
        memcpy(wanted->densities, work->densities, (size_t)scene->count * sizeof *work->densities);
    if (wanted->attenuations)
        memcpy(wanted->attenuations, work->attenuations,
               (size_t)(scene->count * work->node_count) * sizeof *work->attenuations);
    if (wanted->source) memcpy(wanted->source, work->view, 3 * sizeof *work->view);
    if (wanted->detector) memcpy(wanted->detector, work->view + 3, 6 * sizeof *work->view);
    for (int64_t p = 0; wanted->vertices && p < scene->count; p++)
        if (wanted->vertices[p]) SKG_TRY(skg_forces_share(scene->parts[p].mesh, wanted->vertices[p]));
    return SKG_OK;
}

skg_status skg_gradient_finish(skg_job *job) {
    struct skg_gradient_work *gradient = job->gradient;
    if (!gradient->direction_count) return hand_out(job->recipe->scene, gradient);
    for (int64_t d = 0; d < gradient->direction_count; d++) {
        SKG_TRY(skg_derivative_of_image(job, &gradient->of_frame, gradient->image,
                                        gradient->directions[d].image));
        if (gradient->saturated) gradient->saturated[d] = gradient->directions[d].saturated;
    }
    return SKG_OK;
}
