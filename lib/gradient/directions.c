/* Derivatives of a plan's image along directions: the public calls. */
#include "core/text.h"
#include "device/self_tests.h"
#include "frame/jobs.h"
#include "gradient/direction_results.h"
#include "gradient/refusals.h"
#include "gradient/submit.h"
#include "plan/rules.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void skg_direction_init_sized(void *direction, int32_t size) {
    const skg_direction defaults = {0};
    skg_struct_init(direction, size, &defaults, sizeof defaults);
}

/* Replaces numbers of a direction by a copy that the job frees. number: of the direction */
static skg_status copy_numbers(skg_job *job, int64_t number, const char *what, int64_t count,
                               const double **numbers) {
    const skg_gradient_work *work = skg_gradient_of(job);
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
    skg_gradient_work *work = skg_gradient_of(job);
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

/* The gradient whose checks hold for a direction, too. */
static skg_gradient wanted_of(const skg_direction *direction, double *any) {
    skg_gradient wanted;
    skg_gradient_init(&wanted);
    if (direction->source || direction->detector) wanted.source = any;
    if (direction->densities) wanted.densities = any;
    if (direction->attenuations) wanted.attenuations = any, wanted.nodes = direction->nodes;
    return wanted;
}

static skg_status check_directions(skg_plan *plan, const skg_frame *frame, const skg_gradient_work *work) {
    double any[9];
    for (int64_t d = 0; d < work->direction_count; d++) {
        const skg_direction *direction = &work->directions[d].direction;
        const skg_gradient wanted = wanted_of(direction, any);
        SKG_TRY(skg_gradient_check(work->call, plan, frame, &wanted));
        SKG_TRY(skg_gradient_check_cells(work->call, plan->recipe->scene, direction));
    }
    if (plan->recipe->model.layers > 1)
        return skg_effect_no_gradient(work->call, "a blur that depends on depth, along a direction,",
                                      "take skg_plan_gradient");
    return SKG_OK;
}

/* Takes the directions over as they are. */
static skg_status read_directions(skg_gradient_work *work, int64_t count, const skg_direction *directions) {
    if (count < 1)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: %" PRId64 " directions; at least 1", work->call, count);
    SKG_TRY(skg_alloc(count, sizeof *work->directions, "direction", &work->directions));
    work->direction_count = count;
    for (int64_t d = 0; d < count; d++)
        SKG_TRY(skg_struct_read_at(directions, d, "skg_direction", &work->directions[d].direction,
                                   sizeof work->directions[d].direction));
    return SKG_OK;
}

/* Memory for what attenuation coefficients take. */
static skg_status allocate_adjoint(const skg_recipe *recipe, skg_gradient_work *work) {
    int nodes = 0;
    for (int64_t d = 0; d < work->direction_count; d++)
        nodes |= work->directions[d].direction.attenuations != NULL;
    if (!nodes) return SKG_OK;
    return skg_alloc(recipe->model.channels * recipe->view.rows * recipe->view.columns, sizeof *work->adjoint,
                     "derivative", &work->adjoint);
}

static skg_status submit_derivatives(const char *call, skg_plan *plan, const skg_frame *frame, int64_t count,
                                     const skg_direction *directions, const skg_output *derivatives,
                                     int64_t *saturated, skg_job **job) {
    SKG_PLAIN;
    skg_gradient_work *work = NULL;
    skg_job *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS_OF(call, plan);
    SKG_NEEDS_OF(call, directions);
    SKG_NEEDS_OF(call, derivatives);
    SKG_NEEDS_OF(call, job);
    SKG_TRY(skg_gradient_begin(call, plan, job, &work));
    SKG_TRY_CLEANUP(read_directions(work, count, directions));
    SKG_TRY_CLEANUP(check_directions(plan, frame, work));
    SKG_TRY_CLEANUP(skg_gradient_self_test(plan));
    work->saturated = saturated;
    SKG_TRY_CLEANUP(skg_direction_results_place(plan->context, plan->recipe, derivatives, work));
    SKG_TRY_CLEANUP(allocate_adjoint(plan->recipe, work));
    SKG_TRY_CLEANUP(skg_gradient_make_job(plan, &skg_job_directions, &work, &made));
    SKG_TRY_CLEANUP(copy_directions(made));
    status = skg_gradient_start(plan, frame, &made, job);
cleanup:
    skg_job_end(&made);
    skg_gradient_work_release(&work);
    return status;
}

skg_status skg_plan_derivatives_submit(skg_plan *plan, const skg_frame *frame, int64_t count,
                                       const skg_direction *directions, const skg_output *derivatives,
                                       int64_t *saturated, skg_job **job) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(begun,
                        skg_feeder_start(submit_derivatives("skg_plan_derivatives_submit", plan, frame, count,
                                                            directions, derivatives, saturated, job),
                                         job));
}

skg_status skg_plan_derivatives(skg_plan *plan, const skg_frame *frame, int64_t count,
                                const skg_direction *directions, const skg_output *derivatives,
                                int64_t *saturated) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    skg_job *job = NULL;
    const skg_status status = submit_derivatives("skg_plan_derivatives", plan, frame, count, directions,
                                                 derivatives, saturated, &job);
    return skg_call_end(begun, skg_gradient_wait(status, &job));
}
