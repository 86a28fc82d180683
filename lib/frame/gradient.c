#include "core/text.h"
#include "device/self_tests.h"
#include "frame/adjoint.h"
#include "frame/gradient_work.h"
#include "frame/submission.h"
#include "frame/wait.h"
#include "geometry/optics.h"
#include "plan/decisions.h"
#include "spectral/model.h"

#include <inttypes.h>
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
        return refuse(call, "a ratio to a flat field that differs from pixel to pixel, with noise or steps",
                      "make the plan without noise and steps");
    if (wanted->attenuations && machine->images.ratio)
        return refuse(call,
                      "a ratio to a flat field that differs from ray to ray, under attenuation coefficients,",
                      "make the plan of energies or photons");
    return wanted->source || wanted->detector ? check_view(call, recipe) : SKG_OK;
}

/* --- the call */

/* The image of the frame as it is shown. */
static skg_status make_image(skg_plan *plan, const skg_frame *frame, double **image) {
    const skg_recipe *recipe = plan->recipe;
    const int64_t count = recipe->model.channels * recipe->view.rows * recipe->view.columns;
    skg_output output;
    skg_job *job = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(count, sizeof **image, "gradient", image));
    skg_output_init(&output);
    output.data = *image;
    if (plan->context->device->info.double_precision) output.type = SKG_TYPE_FLOAT64;
    SKG_TRY_CLEANUP(skg_plan_submit(plan, 1, frame, &output, &job));
    status = skg_job_wait(&job);
    if (status == SKG_RANGE) status = SKG_OK; /* the image is in place */
    if (status != SKG_OK) goto cleanup;
    for (int64_t i = count - 1; output.type == SKG_TYPE_FLOAT32 && i >= 0; i--)
        (*image)[i] = (double)((float *)output.data)[i];
cleanup:
    if (status != SKG_OK) skg_free(image);
    return status;
}

/* The view of a frame. Densities of parts that are filled in part have no gradient. */
static skg_status view_of(const char *call, const skg_plan *plan, const skg_frame *frame,
                          const skg_gradient *wanted, skg_view *view) {
    skg_frame ours;
    skg_frame_init(&ours);
    *view = plan->recipe->view;
    if (!frame) return SKG_OK;
    SKG_TRY(skg_struct_read(frame, "skg_frame", &ours, sizeof ours));
    if (wanted->densities && ours.fill_fractions)
        return refuse(call, "a density beside fill fractions", "leave one of the two out");
    if (!ours.view) return SKG_OK;
    skg_view_init(view);
    SKG_TRY(skg_view_check(ours.view));
    return skg_struct_read(ours.view, "skg_view", view, sizeof *view);
}

static skg_status find_adjoint(const char *call, skg_plan *plan, const skg_frame *frame,
                               const skg_adjoint *adjoint, const skg_gradient *wanted, double **values) {
    double *image = NULL;
    skg_view view;
    skg_status status = SKG_OK;
    SKG_TRY(skg_adjoint_read(call, plan, adjoint, values));
    SKG_TRY_CLEANUP(view_of(call, plan, frame, wanted, &view));
    if (skg_adjoint_needs_image(plan)) SKG_TRY_CLEANUP(make_image(plan, frame, &image));
    status = skg_adjoint_of_intensities(plan, &view, image, values);
cleanup:
    skg_free(&image);
    return status;
}

/* Renders the frame as far as its sums, and adds up what its passes give. */
static skg_status run(skg_plan *plan, const skg_frame *frame, struct skg_gradient_work *work) {
    skg_output nowhere;
    skg_job *job = NULL;
    skg_output_init(&nowhere);
    nowhere.data = work->view; /* is not written */
    SKG_TRY(skg_job_create("skg_plan_gradient", plan->recipe, &plan->machine, &plan->outcome, 1, 1, &nowhere,
                           &job));
    job->gradient = work;
    SKG_TRY(skg_submission_enqueue(&job, frame, 1));
    return skg_job_complete(&job);
}

/* Clears what is wanted of vertices, which is added to. */
static void clear_vertices(const skg_scene *scene, const skg_gradient *wanted) {
    for (int64_t p = 0; wanted->vertices && p < scene->count; p++)
        if (wanted->vertices[p])
            memset(wanted->vertices[p], 0,
                   3 * (size_t)scene->parts[p].mesh->vertices * sizeof **wanted->vertices);
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

/* --- along a direction */

void skg_direction_init_sized(void *direction, int32_t size) {
    const skg_direction defaults = {0};
    skg_struct_init(direction, size, &defaults, sizeof defaults);
}

static skg_status derive(const char *call, skg_plan *plan, const skg_frame *frame,
                         struct skg_gradient_work *work) {
    const skg_recipe *recipe = plan->recipe;
    const int64_t count = recipe->model.channels * recipe->view.rows * recipe->view.columns;
    double *image = NULL;
    skg_view view;
    skg_status status = SKG_OK;
    SKG_TRY(check_wanted(call, recipe, &plan->machine, &work->wanted));
    if (recipe->model.layers > 1)
        return refuse(call, "a blur that depends on depth, along a direction,", "take skg_plan_gradient");
    SKG_TRY(view_of(call, plan, frame, &work->wanted, &view));
    SKG_TRY(skg_alloc(count, sizeof *work->derivative, "derivative", &work->derivative));
    SKG_TRY(skg_alloc(count, sizeof *work->adjoint, "derivative", &work->adjoint));
    if (skg_adjoint_needs_image(plan)) SKG_TRY(make_image(plan, frame, &image));
    status = run(plan, frame, work);
    if (status == SKG_OK) status = skg_derivative_of_image(plan, &view, image, &work->derivative);
    skg_free(&image);
    return status;
}

static skg_status make_derivative(skg_plan *plan, const skg_frame *frame, const skg_direction *direction,
                                  double *derivative, int64_t *saturated) {
    SKG_PLAIN;
    static const char call[] = "skg_plan_derivative";
    struct skg_gradient_work work = {.forward = 1};
    double any[6];
    SKG_NEEDS_OF(call, plan);
    SKG_NEEDS_OF(call, direction);
    SKG_NEEDS_OF(call, derivative);
    SKG_TRY(skg_context_enter(plan->context));
    skg_submission_flush(plan->context);
    SKG_TRY(skg_struct_read(direction, "skg_direction", &work.direction, sizeof work.direction));
    SKG_TRY(skg_plan_renew(plan));
    const skg_recipe *recipe = plan->recipe;
    const int64_t count = recipe->model.channels * recipe->view.rows * recipe->view.columns;
    SKG_TRY(skg_self_test_need(plan->context, SKG_SELF_TEST_GRADIENT));
    if (work.direction.source || work.direction.detector) work.wanted.source = any; /* for the checks */
    const skg_status status = derive(call, plan, frame, &work);
    if (status == SKG_OK) memcpy(derivative, work.derivative, (size_t)count * sizeof *derivative);
    if (saturated) *saturated = work.saturated;
    skg_free(&work.adjoint);
    skg_free(&work.derivative);
    return status;
}

skg_status skg_plan_derivative(skg_plan *plan, const skg_frame *frame, const skg_direction *direction,
                               double *derivative, int64_t *saturated) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(handler, make_derivative(plan, frame, direction, derivative, saturated));
}

/* --- by everything */

/* Materials that were changed may have other energies, which the caller's memory has no place for. */
static skg_status check_nodes(const char *call, int64_t count, const skg_gradient *wanted) {
    if (!wanted->attenuations || wanted->nodes == count) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT,
                    "%s: the attenuations have memory for %" PRId64 " energies, and the plan has %" PRId64
                    "; set `nodes` to what skg_plan_node_count says now",
                    call, wanted->nodes, count);
}

static skg_status make_gradient(skg_plan *plan, const skg_frame *frame, const skg_adjoint *adjoint,
                                const skg_gradient *gradient) {
    SKG_PLAIN;
    static const char call[] = "skg_plan_gradient";
    struct skg_gradient_work work = {0};
    skg_status status = SKG_OK;
    SKG_NEEDS_OF(call, plan);
    SKG_NEEDS_OF(call, adjoint);
    SKG_NEEDS_OF(call, gradient);
    SKG_TRY(skg_context_enter(plan->context));
    skg_submission_flush(plan->context);
    SKG_TRY(skg_struct_read(gradient, "skg_gradient", &work.wanted, sizeof work.wanted));
    SKG_TRY(skg_plan_renew(plan));
    const skg_scene *scene = plan->recipe->scene;
    SKG_TRY(check_wanted(call, plan->recipe, &plan->machine, &work.wanted));
    SKG_TRY(check_nodes(call, plan->recipe->model.nodes, &work.wanted));
    SKG_TRY(skg_self_test_need(plan->context, SKG_SELF_TEST_GRADIENT));
    SKG_TRY_CLEANUP(skg_alloc(6 * scene->count, sizeof *work.poses, "gradient", &work.poses));
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *work.densities, "gradient", &work.densities));
    work.node_count = plan->recipe->model.nodes;
    if (work.wanted.attenuations)
        SKG_TRY_CLEANUP(skg_alloc(scene->count * work.node_count, sizeof *work.attenuations, "gradient",
                                  &work.attenuations));
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *work.needs_lengths, "gradient", &work.needs_lengths));
    SKG_TRY_CLEANUP(find_adjoint(call, plan, frame, adjoint, &work.wanted, &work.adjoint));
    clear_vertices(scene, &work.wanted);
    SKG_TRY_CLEANUP(run(plan, frame, &work));
    status = hand_out(scene, &work);
cleanup:
    skg_free(&work.adjoint);
    skg_free(&work.poses);
    skg_free(&work.densities);
    skg_free(&work.needs_lengths);
    skg_free(&work.planes);
    skg_free(&work.attenuations);
    skg_free(&work.nodes);
    return status;
}

skg_status skg_plan_gradient(skg_plan *plan, const skg_frame *frame, const skg_adjoint *adjoint,
                             const skg_gradient *gradient) {
    const skg_error_handler handler = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(handler, make_gradient(plan, frame, adjoint, gradient));
}
