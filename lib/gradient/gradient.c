/* Gradients of a plan: the public calls. */
#include "core/text.h"
#include "device/self_tests.h"
#include "frame/jobs.h"
#include "gradient/adjoint.h"
#include "gradient/refusals.h"
#include "gradient/submit.h"

#include <string.h>

void skg_gradient_init_sized(void *gradient, int32_t size) {
    const skg_gradient defaults = {0};
    skg_struct_init(gradient, size, &defaults, sizeof defaults);
}

/* The array of arrays may be the caller's for the call alone. */
static skg_status copy_targets(skg_job *job) {
    double *const **vertices = &skg_gradient_of(job)->wanted.vertices;
    const int64_t parts = job->recipe->scene->count;
    double **copy = NULL;
    if (!*vertices) return SKG_OK;
    SKG_TRY(skg_staging_take(&job->staging, parts, sizeof *copy, "gradient", &copy));
    memcpy(copy, *vertices, (size_t)parts * sizeof *copy);
    *vertices = copy;
    return SKG_OK;
}

static skg_status allocate_results(const skg_recipe *recipe, skg_gradient_work *work) {
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
    skg_gradient_work *work = NULL;
    skg_job *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS_OF(call, plan);
    SKG_NEEDS_OF(call, adjoint);
    SKG_NEEDS_OF(call, gradient);
    SKG_NEEDS_OF(call, job);
    SKG_TRY(skg_gradient_begin(call, plan, job, &work));
    skg_adjoint_init(&work->given);
    SKG_TRY_CLEANUP(skg_struct_read(gradient, "skg_gradient", &work->wanted, sizeof work->wanted));
    SKG_TRY_CLEANUP(skg_struct_read(adjoint, "skg_adjoint", &work->given, sizeof work->given));
    SKG_TRY_CLEANUP(skg_gradient_check(call, plan, frame, &work->wanted));
    SKG_TRY_CLEANUP(skg_gradient_self_test(plan));
    if (work->wanted.densities) SKG_TRY_CLEANUP(skg_self_test_need(plan->context, SKG_SELF_TEST_DENSITIES));
    SKG_TRY_CLEANUP(allocate_results(plan->recipe, work));
    SKG_TRY_CLEANUP(skg_gradient_make_job(plan, &skg_job_gradient, &work, &made));
    SKG_TRY_CLEANUP(copy_targets(made));
    SKG_TRY_CLEANUP(skg_adjoint_read(made));
    status = skg_gradient_start(plan, frame, &made, job);
cleanup:
    skg_job_end(&made);
    skg_gradient_work_release(&work);
    return status;
}

skg_status skg_plan_gradient_submit(skg_plan *plan, const skg_frame *frame, const skg_adjoint *adjoint,
                                    const skg_gradient *gradient, skg_job **job) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(
        begun, skg_feeder_start(
                   submit_gradient("skg_plan_gradient_submit", plan, frame, adjoint, gradient, job), job));
}

skg_status skg_plan_gradient(skg_plan *plan, const skg_frame *frame, const skg_adjoint *adjoint,
                             const skg_gradient *gradient) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    skg_job *job = NULL;
    const skg_status status = submit_gradient("skg_plan_gradient", plan, frame, adjoint, gradient, &job);
    return skg_call_end(begun, skg_gradient_wait(status, &job));
}
