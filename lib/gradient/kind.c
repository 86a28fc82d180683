/* The two kinds of jobs of this room: the gradient of a loss, and the derivatives of an image along directions. A step is a pass, which
 * is waited for, because device and host alternate. */
#include "gradient/kind.h"

#include "frame/frames.h"
#include "frame/jobs.h"
#include "gradient/adjoint.h"
#include "gradient/density.h"
#include "gradient/direction_pass.h"
#include "gradient/direction_rates.h"
#include "gradient/direction_results.h"
#include "gradient/pass.h"
#include "stage/volumes.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* --- what comes before the first pass */

/* Enqueues the sums of a pass, which is drawn by itself; release it with skg_pass_release, also after a failure. */
static skg_status draw(skg_job *job, const skg_frame_work *work, int64_t number, skg_pass *pass) {
    SKG_TRY(skg_pass_begin(job, work, number, 1, pass));
    skg_pass_note(job, pass);
    return skg_draw_sums(job, work, pass);
}

/* Enqueues the image, if it has to be known, or the sums of the first pass, which finds them where they stand. */
static skg_status begin(skg_job *job, const skg_frame *frames, const double **poses) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    skg_machine *machine = job->machine;
    skg_frame frame;
    skg_pass pass;
    skg_frame_work work = {.view = &gradient->of_frame, .poses = poses, .frame = &frame, .reuses = 1};
    SKG_TRY(skg_held_frame_read(job, frames, 0, &frame, &gradient->of_frame, poses, &work.noise));
    if (gradient->image) {
        SKG_TRY(skg_geometry_reset_bad(machine->context, &machine->geometry));
        SKG_TRY(skg_render_output(job, &gradient->shown, 0, &work));
    } else {
        SKG_TRY(skg_geometry_continue(machine->context, &machine->geometry));
        const skg_status status = draw(job, &work, skg_frame_first_pass(job->recipe), &pass);
        skg_pass_release(&pass);
        SKG_TRY(status);
    }
    SKG_CL_TRY(clEnqueueMarkerWithWaitList(machine->context->device->queue, 0, NULL, &gradient->ready));
    return SKG_OK;
}

/* Clears what is wanted of vertices, which is added to. */
static void clear_vertices(const skg_scene *scene, const skg_gradient *wanted) {
    for (int64_t p = 0; wanted->vertices && p < scene->count; p++)
        if (wanted->vertices[p])
            memset(wanted->vertices[p], 0,
                   3 * (size_t)scene->parts[p].mesh->vertices * sizeof **wanted->vertices);
}

/* The image was read in the type of the output. */
static void widen_image(const skg_job *job) {
    double *image = skg_gradient_of(job)->image;
    const int64_t count = job->recipe->model.channels * job->recipe->view.rows * job->recipe->view.columns;
    if (!image || skg_gradient_of(job)->shown.to.type == SKG_TYPE_FLOAT64) return;
    for (int64_t i = count - 1; i >= 0; i--) image[i] = (double)((const float *)image)[i];
}

/* Waits for what was read before the first pass. */
static skg_status take_first(skg_job *job) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    const int is_read = gradient->raw || gradient->image;
    const cl_int code = is_read ? skg_event_wait(gradient->ready) : CL_SUCCESS;
    if (code != CL_SUCCESS) return skg_cl_fail(code, "clWaitForEvents", __FILE__, __LINE__);
    widen_image(job);
    return SKG_OK;
}

/* --- a pass */

/* The density of a part by its path lengths, or that of a volume by what its cells add to a plane. */
static skg_status add_density(skg_job *job, const skg_frame_work *work, int64_t number, int64_t part,
                              int32_t plane) {
    skg_pass pass;
    skg_status status =
        skg_draw_lengths(job, work, number, part, plane, &skg_gradient_of(job)->memory->lengths, &pass);
    if (status == SKG_OK) status = skg_gradient_add_density(job, &pass, part, plane);
    skg_pass_release(&pass);
    return status;
}

/* The densities of all parts that need path lengths. */
static skg_status add_densities(skg_job *job, const skg_frame_work *work, int64_t number) {
    const skg_gradient_work *gradient = skg_gradient_of(job);
    for (int64_t p = 0; p < job->recipe->scene->count; p++) {
        const skg_placed_volume *volume = skg_volumes_find(&job->machine->volumes, p);
        if (!gradient->needs_lengths[p]) continue;
        if (!volume) SKG_TRY(add_density(job, work, number, p, 0));
        for (int64_t k = 0; volume && k < volume->plane_count; k++)
            SKG_TRY(add_density(job, work, number, p, volume->planes[k]));
    }
    return SKG_OK;
}

/* The share of a pass in a gradient or in derivatives: skg_gradient_add_pass, skg_derivative_add_pass. */
typedef skg_status (*share_function)(skg_job *job, const skg_frame_work *work, int64_t number,
                                     const skg_pass *pass, const skg_sums *sums, double factor);

/* Draws a pass, and adds its share. */
static skg_status add_pass(skg_job *job, const skg_frame_work *work, int64_t number, share_function add) {
    skg_pass pass;
    skg_sums sums;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(draw(job, work, number, &pass));
    SKG_TRY_CLEANUP(skg_frame_sums(job, &pass, 0, &sums));
    status = add(job, work, number, &pass, &sums, skg_frame_factor(job->recipe, work, &pass));
cleanup:
    skg_pass_release(&pass);
    return status;
}

/* Returns the number of the pass that a step is. */
static int64_t find_pass(const skg_job *job, int64_t step, skg_frame_work *work) {
    work->reuses = 1;
    return skg_frame_first_pass(job->recipe) + step;
}

static skg_status step_gradient(skg_job *job, int64_t frame, int64_t step, skg_frame_work *work) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    const int64_t number = find_pass(job, step, work);
    (void)frame; /* there is one */
    if (step == 0) {
        SKG_TRY(take_first(job));
        clear_vertices(job->recipe->scene, &gradient->wanted);
        SKG_TRY(skg_adjoint_take(job));
        SKG_TRY(skg_adjoint_of_intensities(job, &gradient->of_frame, gradient->image, &gradient->adjoint));
    }
    SKG_TRY(add_pass(job, work, number, skg_gradient_add_pass));
    return add_densities(job, work, number);
}

static skg_status step_directions(skg_job *job, int64_t frame, int64_t step, skg_frame_work *work) {
    const int64_t number = find_pass(job, step, work);
    (void)frame; /* there is one */
    if (step == 0) {
        SKG_TRY(take_first(job));
        skg_direction_results_clear(job);
    }
    /* Derivatives by path lengths are a pass by itself, before this one, whose memory it shares. */
    skg_derivative_clear_rates(job);
    SKG_TRY(add_densities(job, work, number));
    return add_pass(job, work, number, skg_derivative_add_pass);
}

/* --- results */

static skg_status finish_gradient(skg_job *job) {
    const skg_scene *scene = job->recipe->scene;
    const skg_gradient_work *work = skg_gradient_of(job);
    const skg_gradient *wanted = &work->wanted;
    for (int64_t p = 0; wanted->poses && p < scene->count; p++)
        for (int k = 0; k < 6; k++)
            wanted->poses[6 * p + k] = scene->parts[p].volume ? (double)NAN : work->poses[6 * p + k];
    if (wanted->densities)
        memcpy(wanted->densities, work->densities, (size_t)scene->count * sizeof *work->densities);
    for (int64_t i = 0; wanted->attenuations && i < scene->count * work->node_count; i++)
        wanted->attenuations[i] =
            scene->parts[i / work->node_count].volume ? (double)NAN : SKG_PER_MM * work->attenuations[i];
    if (wanted->source) memcpy(wanted->source, work->view, 3 * sizeof *work->view);
    if (wanted->detector) memcpy(wanted->detector, work->view + 3, 6 * sizeof *work->view);
    for (int64_t p = 0; wanted->vertices && p < scene->count; p++)
        if (wanted->vertices[p]) SKG_TRY(skg_forces_share(scene->parts[p].mesh, wanted->vertices[p]));
    return SKG_OK;
}

static skg_status finish_directions(skg_job *job) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    for (int64_t d = 0; d < gradient->direction_count; d++) {
        SKG_TRY(skg_derivative_of_image(job, &gradient->of_frame, gradient->image,
                                        gradient->directions[d].image));
        SKG_TRY(skg_direction_results_put(job, d));
        if (gradient->saturated) gradient->saturated[d] = gradient->directions[d].saturated;
    }
    return SKG_OK;
}

static skg_status fail_cancelled(const skg_job *job) {
    return skg_fail(SKG_ERR_CANCELLED,
                    "the job was cancelled: %" PRId64 " of %" PRId64
                    " passes were made, and the results are not in place",
                    job->enqueued, job->steps);
}

static void release(void **state) {
    skg_gradient_work *work = *state;
    skg_gradient_work_release(&work);
    *state = NULL;
}

const skg_job_kind skg_job_gradient = {.begin = begin,
                                       .step = step_gradient,
                                       .finish = finish_gradient,
                                       .cancelled = fail_cancelled,
                                       .release = release};
const skg_job_kind skg_job_directions = {.begin = begin,
                                         .step = step_directions,
                                         .finish = finish_directions,
                                         .cancelled = fail_cancelled,
                                         .release = release};
