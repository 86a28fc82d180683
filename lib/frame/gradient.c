/* Derivatives and gradients of a plan: the public calls, what they refuse, and how a job of them is submitted. */
#include "core/text.h"
#include "device/self_tests.h"
#include "frame/adjoint.h"
#include "frame/gradient_work.h"
#include "frame/submission.h"
#include "geometry/optics.h"
#include "plan/decisions.h"
#include "spectral/model.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void skg_gradient_init_sized(void *gradient, int32_t size) {
    const skg_gradient defaults = {0};
    skg_struct_init(gradient, size, &defaults, sizeof defaults);
}

/* --- what has no gradient */

static skg_status refuse(const char *call, const char *what, const char *mend) {
    return skg_fail(SKG_ERR_UNSUPPORTED, "%s: %s has no gradient; %s", call, what, mend);
}

/* Source and detector. */
static skg_status check_view(const char *call, const skg_recipe *recipe) {
    static const char mend[] = "take it of poses, vertices or densities alone, or leave the effect out";
    const skg_plan_options *options = &recipe->options;
    if (options->heel) return refuse(call, "the heel effect under source and detector", mend);
    if (options->bowtie) return refuse(call, "a bow-tie filter under source and detector", mend);
    if (options->grid) return refuse(call, "an anti-scatter grid under source and detector", mend);
    if (options->oblique) return refuse(call, "an oblique scintillator under source and detector", mend);
    if (skg_collimation_limits(options->collimation))
        return refuse(call, "a collimator under source and detector", mend);
    if (options->world && skg_quantity_is_ratio(options))
        return refuse(call, "a ratio to the flat field of a world under source and detector", mend);
    if (options->world && recipe->view.projection == SKG_PROJECTION_PARALLEL)
        return refuse(call, "a world in a parallel beam under source and detector", mend);
    return SKG_OK;
}

/* Refuses by name what has no gradient. call: the name of the public function. */
static skg_status check_wanted(const char *call, const skg_recipe *recipe, const skg_machine *machine,
                               const skg_gradient *wanted) {
    const skg_plan_options *options = &recipe->options;
    const skg_plan_meshes *meshes = &recipe->meshes;
    double factors[SKG_CHANNELS_MAX];
    skg_detection detection;
    int32_t detects = 0;
    if (options->precision == SKG_PRECISION_HALF)
        return refuse(call, "precision half", "take single or double");
    if (options->scatter) return refuse(call, "scatter", "make the plan without it");
    if (options->unite)
        return refuse(call, "the union of components",
                      "make the plan without unite, of meshes that do not overlap");
    if (recipe->leaky_count)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: the mesh of part %s is not closed, and its repair has no gradient; close the mesh", call,
            recipe->scene->parts[recipe->leaky[0]].label);
    for (int64_t m = 0; m < meshes->count; m++)
        if (skg_placement_of(&machine->placement, meshes->meshes[m], m))
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "%s: positions of %s were set on the device, where gradients do not find them; set them "
                "with skg_mesh_positions_set",
                call, meshes->meshes[m]->name);
    SKG_TRY(skg_decide_detection(recipe, &detection, factors, &detects));
    if (detects && detection.over_flat_field)
        return refuse(call,
                      "a ratio to a flat field that differs from pixel to pixel, with noise, steps or a blur",
                      "make the plan without them");
    if (wanted->attenuations && machine->images.ratio)
        return refuse(call,
                      "a ratio to a flat field that differs from ray to ray, under attenuation coefficients,",
                      "make the plan of energies or photons");
    return wanted->source || wanted->detector ? check_view(call, recipe) : SKG_OK;
}

/* --- jobs */

/* Densities of parts that are filled in part have no gradient. */
static skg_status check_frame(const char *call, const skg_frame *frame, const skg_gradient *wanted) {
    skg_frame ours;
    skg_frame_init(&ours);
    if (!frame) return SKG_OK;
    SKG_TRY(skg_struct_read(frame, "skg_frame", &ours, sizeof ours));
    if (wanted->densities && ours.fill_fractions)
        return refuse(call, "a density beside fill fractions", "leave one of the two out");
    return SKG_OK;
}

/* Materials that were changed may have other energies, which the caller's memory has no place for. */
static skg_status check_nodes(const char *call, int64_t count, const void *attenuations, int64_t given) {
    if (!attenuations || given == count) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT,
                    "%s: the attenuations have memory for %" PRId64 " energies, and the plan has %" PRId64
                    "; set `nodes` to what skg_plan_node_count says now",
                    call, given, count);
}

/* Memory for the image, where it has to be known. */
static skg_status place_image(const skg_plan *plan, struct skg_gradient_work *work) {
    const skg_recipe *recipe = plan->recipe;
    skg_output output;
    if (!skg_adjoint_needs_image(recipe)) return SKG_OK;
    SKG_TRY(skg_alloc(recipe->model.channels * recipe->view.rows * recipe->view.columns, sizeof *work->image,
                      "gradient", &work->image));
    skg_output_init(&output);
    output.data = work->image;
    if (plan->context->device->info.double_precision) output.type = SKG_TYPE_FLOAT64;
    return skg_frame_output_read(work->call, recipe, &plan->machine, 1, &output, 0, &work->shown);
}

/* Makes a job of the passes of a frame, which takes over the work. */
static skg_status make_job(skg_plan *plan, struct skg_gradient_work **work, skg_job **job) {
    const skg_recipe *recipe = plan->recipe;
    const int64_t passes = skg_recipe_averages(recipe) ? skg_samples_passes(&recipe->samples) : 1;
    skg_output nowhere;
    skg_output_init(&nowhere);
    nowhere.data = (*work)->view; /* is not written */
    SKG_TRY(place_image(plan, *work));
    SKG_TRY(skg_alloc(recipe->scene->count, 1, "gradient", &(*work)->needs_lengths));
    SKG_TRY(skg_job_create((*work)->call, recipe, &plan->machine, &plan->outcome, passes, 1, &nowhere, job));
    (*job)->gradient = *work;
    *work = NULL;
    return SKG_OK;
}

/* --- along directions */

void skg_direction_init_sized(void *direction, int32_t size) {
    const skg_direction defaults = {0};
    skg_struct_init(direction, size, &defaults, sizeof defaults);
}

/* Replaces numbers of a direction by a copy that the job frees. number: of the direction */
static skg_status copy_numbers(skg_job *job, int64_t number, const char *what, int64_t count,
                               const double **numbers) {
    const struct skg_gradient_work *work = job->gradient;
    double *copy = NULL;
    char which[32] = "the direction";
    if (!*numbers) return SKG_OK;
    if (work->direction_count > 1) snprintf(which, sizeof which, "direction %" PRId64, number);
    for (int64_t i = 0; i < count; i++)
        if (!isfinite((*numbers)[i]))
            return skg_fail(SKG_ERR_ARGUMENT, "%s: number %" PRId64 " of %s's %s is %g; it has to be finite",
                            work->call, i, which, what, (*numbers)[i]);
    SKG_TRY(skg_staging_take(&job->staging, count, sizeof *copy, "direction", &copy));
    memcpy(copy, *numbers, (size_t)count * sizeof *copy);
    *numbers = copy;
    return SKG_OK;
}

static skg_status copy_vertices(skg_job *job, int64_t number, skg_direction *direction) {
    const skg_scene *scene = job->recipe->scene;
    const double **copies = NULL;
    if (!direction->vertices) return SKG_OK;
    SKG_TRY(skg_staging_take(&job->staging, scene->count, sizeof *copies, "direction", &copies));
    for (int64_t p = 0; p < scene->count; p++) {
        copies[p] = direction->vertices[p];
        SKG_TRY(copy_numbers(job, number, "vertices", 3 * scene->parts[p].mesh->vertices, &copies[p]));
    }
    direction->vertices = copies;
    return SKG_OK;
}

/* Parts whose matter changes. */
static void find_needs(const skg_job *job, const skg_direction *direction, uint8_t *needs) {
    const int64_t nodes = job->recipe->model.nodes;
    for (int64_t p = 0; p < job->recipe->scene->count; p++) {
        needs[p] |= direction->densities && direction->densities[p] != 0;
        for (int64_t n = 0; n < nodes && direction->attenuations; n++)
            needs[p] |= direction->attenuations[p * nodes + n] != 0;
    }
}

static skg_status copy_directions(skg_job *job) {
    struct skg_gradient_work *work = job->gradient;
    const int64_t parts = job->recipe->scene->count;
    for (int64_t d = 0; d < work->direction_count; d++) {
        skg_direction *direction = &work->directions[d].direction;
        SKG_TRY(copy_numbers(job, d, "poses", 6 * parts, &direction->poses));
        SKG_TRY(copy_numbers(job, d, "source", 3, &direction->source));
        SKG_TRY(copy_numbers(job, d, "detector", 6, &direction->detector));
        SKG_TRY(copy_numbers(job, d, "densities", parts, &direction->densities));
        SKG_TRY(copy_numbers(job, d, "attenuations", parts * direction->nodes, &direction->attenuations));
        SKG_TRY(copy_vertices(job, d, direction));
        find_needs(job, direction, work->needs_lengths);
    }
    return SKG_OK;
}

/* What the checks of a gradient would find wanted. */
static skg_gradient wanted_of(const skg_direction *direction, double *any) {
    skg_gradient wanted;
    skg_gradient_init(&wanted);
    if (direction->source || direction->detector) wanted.source = any;
    if (direction->densities) wanted.densities = any;
    if (direction->attenuations) wanted.attenuations = any;
    return wanted;
}

static skg_status check_directions(skg_plan *plan, const skg_frame *frame,
                                   const struct skg_gradient_work *work) {
    double any[9];
    const skg_recipe *recipe = plan->recipe;
    for (int64_t d = 0; d < work->direction_count; d++) {
        const skg_direction *direction = &work->directions[d].direction;
        const skg_gradient wanted = wanted_of(direction, any);
        SKG_TRY(check_wanted(work->call, recipe, &plan->machine, &wanted));
        SKG_TRY(check_nodes(work->call, recipe->model.nodes, direction->attenuations, direction->nodes));
        SKG_TRY(check_frame(work->call, frame, &wanted));
    }
    if (recipe->model.layers > 1)
        return refuse(work->call, "a blur that depends on depth, along a direction,",
                      "take skg_plan_gradient");
    return SKG_OK;
}

/* What both submissions begin with. */
static skg_status begin(const char *call, skg_plan *plan, skg_job **job, struct skg_gradient_work **work) {
    *job = NULL;
    SKG_TRY(skg_context_enter(plan->context));
    skg_submission_flush(plan->context);
    SKG_TRY(skg_alloc(1, sizeof **work, "gradient", work));
    (*work)->call = call;
    return SKG_OK;
}

/* Starts a job that is complete but for its device. */
static skg_status start(skg_plan *plan, const skg_frame *frame, skg_job **made, skg_job **job) {
    SKG_TRY(skg_submission_enqueue(made, frame, 0));
    skg_ref(&plan->refs);
    (*made)->plan = plan;
    *job = *made;
    *made = NULL;
    return SKG_OK;
}

/* Takes the directions over as they are. */
static skg_status read_directions(struct skg_gradient_work *work, int64_t count,
                                  const skg_direction *directions) {
    if (count < 1)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: %" PRId64 " directions; at least 1", work->call, count);
    SKG_TRY(skg_alloc(count, sizeof *work->directions, "direction", &work->directions));
    work->direction_count = count;
    for (int64_t d = 0; d < count; d++)
        SKG_TRY(skg_struct_read_at(directions, d, "skg_direction", &work->directions[d].direction,
                                   sizeof work->directions[d].direction));
    return SKG_OK;
}

/* Where results go, and memory for what they are made from. */
static skg_status place_results(const skg_recipe *recipe, struct skg_gradient_work *work, double *derivatives,
                                int64_t *saturated) {
    const int64_t count = recipe->model.channels * recipe->view.rows * recipe->view.columns;
    int nodes = 0;
    work->results = derivatives;
    work->saturated = saturated;
    for (int64_t d = 0; d < work->direction_count; d++) {
        work->directions[d].image = derivatives + d * count;
        nodes |= work->directions[d].direction.attenuations != NULL;
    }
    return nodes ? skg_alloc(count, sizeof *work->adjoint, "derivative", &work->adjoint) : SKG_OK;
}

static skg_status submit_derivatives(const char *call, skg_plan *plan, const skg_frame *frame, int64_t count,
                                     const skg_direction *directions, double *derivatives, int64_t *saturated,
                                     skg_job **job) {
    SKG_PLAIN;
    struct skg_gradient_work *work = NULL;
    skg_job *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS_OF(call, plan);
    SKG_NEEDS_OF(call, directions);
    SKG_NEEDS_OF(call, derivatives);
    SKG_NEEDS_OF(call, job);
    SKG_TRY(begin(call, plan, job, &work));
    SKG_TRY_CLEANUP(read_directions(work, count, directions));
    SKG_TRY_CLEANUP(skg_plan_renew(plan));
    SKG_TRY_CLEANUP(check_directions(plan, frame, work));
    SKG_TRY_CLEANUP(skg_self_test_need(plan->context, SKG_SELF_TEST_GRADIENT));
    SKG_TRY_CLEANUP(place_results(plan->recipe, work, derivatives, saturated));
    SKG_TRY_CLEANUP(make_job(plan, &work, &made));
    SKG_TRY_CLEANUP(copy_directions(made));
    status = start(plan, frame, &made, job);
cleanup:
    skg_job_end(&made);
    skg_gradient_work_release(&work);
    return status;
}

/* Waits for a job that a call has started. */
static skg_status finish(skg_status status, skg_job **job) {
    return status == SKG_OK ? skg_job_wait(job) : status;
}

skg_status skg_plan_derivatives_submit(skg_plan *plan, const skg_frame *frame, int64_t count,
                                       const skg_direction *directions, double *derivatives,
                                       int64_t *saturated, skg_job **job) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(handler, submit_derivatives("skg_plan_derivatives_submit", plan, frame, count,
                                                    directions, derivatives, saturated, job));
}

skg_status skg_plan_derivatives(skg_plan *plan, const skg_frame *frame, int64_t count,
                                const skg_direction *directions, double *derivatives, int64_t *saturated) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    skg_job *job = NULL;
    const skg_status status = submit_derivatives("skg_plan_derivatives", plan, frame, count, directions,
                                                 derivatives, saturated, &job);
    return skg_call_end(handler, finish(status, &job));
}

skg_status skg_plan_derivative_submit(skg_plan *plan, const skg_frame *frame, const skg_direction *direction,
                                      double *derivative, int64_t *saturated, skg_job **job) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(handler, submit_derivatives("skg_plan_derivative_submit", plan, frame, 1, direction,
                                                    derivative, saturated, job));
}

skg_status skg_plan_derivative(skg_plan *plan, const skg_frame *frame, const skg_direction *direction,
                               double *derivative, int64_t *saturated) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    skg_job *job = NULL;
    const skg_status status =
        submit_derivatives("skg_plan_derivative", plan, frame, 1, direction, derivative, saturated, &job);
    return skg_call_end(handler, finish(status, &job));
}

/* --- by everything */

/* The array of arrays may be the caller's for the call alone. */
static skg_status copy_targets(skg_job *job) {
    double *const **vertices = &job->gradient->wanted.vertices;
    const int64_t parts = job->recipe->scene->count;
    double **copy = NULL;
    if (!*vertices) return SKG_OK;
    SKG_TRY(skg_staging_take(&job->staging, parts, sizeof *copy, "gradient", &copy));
    memcpy(copy, *vertices, (size_t)parts * sizeof *copy);
    *vertices = copy;
    return SKG_OK;
}

static skg_status allocate_results(const skg_recipe *recipe, struct skg_gradient_work *work) {
    const int64_t parts = recipe->scene->count;
    work->node_count = recipe->model.nodes;
    SKG_TRY(skg_alloc(6 * parts, sizeof *work->poses, "gradient", &work->poses));
    SKG_TRY(skg_alloc(parts, sizeof *work->densities, "gradient", &work->densities));
    if (!work->wanted.attenuations) return SKG_OK;
    return skg_alloc(parts * work->node_count, sizeof *work->attenuations, "gradient", &work->attenuations);
}

static skg_status submit_gradient(const char *call, skg_plan *plan, const skg_frame *frame,
                                  const skg_adjoint *adjoint, const skg_gradient *gradient, skg_job **job) {
    SKG_PLAIN;
    struct skg_gradient_work *work = NULL;
    skg_job *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS_OF(call, plan);
    SKG_NEEDS_OF(call, adjoint);
    SKG_NEEDS_OF(call, gradient);
    SKG_NEEDS_OF(call, job);
    SKG_TRY(begin(call, plan, job, &work));
    skg_adjoint_init(&work->given);
    SKG_TRY_CLEANUP(skg_struct_read(gradient, "skg_gradient", &work->wanted, sizeof work->wanted));
    SKG_TRY_CLEANUP(skg_struct_read(adjoint, "skg_adjoint", &work->given, sizeof work->given));
    SKG_TRY_CLEANUP(skg_plan_renew(plan));
    SKG_TRY_CLEANUP(check_wanted(call, plan->recipe, &plan->machine, &work->wanted));
    SKG_TRY_CLEANUP(
        check_nodes(call, plan->recipe->model.nodes, work->wanted.attenuations, work->wanted.nodes));
    SKG_TRY_CLEANUP(check_frame(call, frame, &work->wanted));
    SKG_TRY_CLEANUP(skg_self_test_need(plan->context, SKG_SELF_TEST_GRADIENT));
    if (work->wanted.densities) SKG_TRY_CLEANUP(skg_self_test_need(plan->context, SKG_SELF_TEST_DENSITIES));
    SKG_TRY_CLEANUP(allocate_results(plan->recipe, work));
    SKG_TRY_CLEANUP(make_job(plan, &work, &made));
    SKG_TRY_CLEANUP(copy_targets(made));
    SKG_TRY_CLEANUP(skg_adjoint_read(made));
    status = start(plan, frame, &made, job);
cleanup:
    skg_job_end(&made);
    skg_gradient_work_release(&work);
    return status;
}

skg_status skg_plan_gradient_submit(skg_plan *plan, const skg_frame *frame, const skg_adjoint *adjoint,
                                    const skg_gradient *gradient, skg_job **job) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(handler,
                        submit_gradient("skg_plan_gradient_submit", plan, frame, adjoint, gradient, job));
}

skg_status skg_plan_gradient(skg_plan *plan, const skg_frame *frame, const skg_adjoint *adjoint,
                             const skg_gradient *gradient) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    skg_job *job = NULL;
    const skg_status status = submit_gradient("skg_plan_gradient", plan, frame, adjoint, gradient, &job);
    return skg_call_end(handler, finish(status, &job));
}
