/* How jobs of gradients and of derivatives are submitted. */
#include "gradient/submit.h"

#include "device/self_tests.h"
#include "frame/jobs.h"
#include "gradient/adjoint.h"

/* Memory for the image, where it has to be known. */
static skg_status place_image(const skg_plan *plan, skg_gradient_work *work) {
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

skg_status skg_gradient_self_test(const skg_plan *plan) {
    SKG_TRY(skg_self_test_need(plan->context, SKG_SELF_TEST_GRADIENT));
    return plan->recipe->volume_count > 0 ? skg_self_test_need(plan->context, SKG_SELF_TEST_CELLS) : SKG_OK;
}

skg_status skg_gradient_make_job(skg_plan *plan, const skg_job_kind *kind, skg_gradient_work **work,
                                 skg_job **job) {
    const skg_recipe *recipe = plan->recipe;
    const int64_t passes = skg_recipe_averages(recipe) ? skg_samples_passes(&recipe->samples) : 1;
    skg_output nowhere;
    skg_output_init(&nowhere);
    nowhere.data = (*work)->view; /* is not written */
    SKG_TRY(place_image(plan, *work));
    SKG_TRY(skg_alloc(recipe->scene->count, 1, "gradient", &(*work)->needs_lengths));
    SKG_TRY(skg_gradient_memory_get(&plan->machine, &(*work)->memory));
    SKG_TRY(skg_job_create((*work)->call, kind, recipe, &plan->machine, &plan->outcome, 1, 1, &nowhere, job));
    SKG_TRY(skg_job_divide(*job, passes));
    (*job)->state = *work;
    *work = NULL;
    return SKG_OK;
}

skg_status skg_gradient_begin(const char *call, skg_plan *plan, skg_job **job, skg_gradient_work **work) {
    *job = NULL;
    SKG_TRY(skg_context_enter(plan->context));
    skg_submission_flush(plan->context);
    SKG_TRY(skg_alloc(1, sizeof **work, "gradient", work));
    (*work)->call = call;
    const skg_status status = skg_plan_renew(plan);
    if (status != SKG_OK) skg_gradient_work_release(work);
    return status;
}

skg_status skg_gradient_start(skg_plan *plan, const skg_frame *frame, skg_job **made, skg_job **job) {
    SKG_TRY(skg_submit_frames(made, frame, 0));
    skg_ref(&plan->refs);
    (*made)->plan = plan;
    *job = *made;
    *made = NULL;
    return SKG_OK;
}

skg_status skg_gradient_wait(skg_status status, skg_job **job) {
    return status == SKG_OK ? skg_job_wait(job) : status;
}
