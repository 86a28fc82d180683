/* A registration as a handle: options, parts, radiographs, and the run. */
#include "registration/types.h"

#include "core/clock.h"
#include "core/context.h"
#include "core/log.h"
#include "core/text.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static skg_status check_range(const char *name, double value, double low, double high) {
    if (value >= low && value <= high) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "registration: %s is %g; it has to be from %g to %g", name, value, low,
                    high);
}

static skg_status check_options(const skg_registration_options *o) {
    const int32_t geometry = SKG_REGISTRATION_FREE_SOURCE | SKG_REGISTRATION_FREE_DETECTOR;
    if (o->free != SKG_REGISTRATION_FREE_POSE && (o->free <= 0 || (o->free & ~geometry)))
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "registration: free is %" PRId32
            "; give the pose, or source or detector or both: a pose and the geometry of the views "
            "cannot be told apart",
            o->free);
    if (o->loss < SKG_REGISTRATION_LOSS_LSQ || o->loss > SKG_REGISTRATION_LOSS_GRADIENT_NCC)
        return skg_fail(SKG_ERR_ARGUMENT, "registration: loss %" PRId32 " is no SKG_REGISTRATION_LOSS_ value",
                        o->loss);
    if (o->free != SKG_REGISTRATION_FREE_POSE && o->restarts > 0)
        return skg_fail(SKG_ERR_ARGUMENT, "registration: restarts are of a pose, and it is not free");
    SKG_TRY(check_range("polish", o->polish, 0, 1));
    SKG_TRY(check_range("restarts", (double)o->restarts, 0, 10000));
    SKG_TRY(check_range("seed", (double)o->seed, 0, 0x1p63));
    SKG_TRY(check_range("spread_mm", o->spread_mm, 1e-6, 1000));
    SKG_TRY(check_range("spread_rad", o->spread_rad, 1e-9, SKG_PI));
    SKG_TRY(check_range("steps", (double)o->steps, 1, 1000));
    SKG_TRY(check_range("margin_mm", o->margin_mm, 1e-6, 1e6));
    SKG_TRY(check_range("need_mm", o->need_mm, 1e-9, 1e9));
    for (int k = 0; k < 6; k++) SKG_TRY(check_range("a number of start", o->start[k], -1e6, 1e6));
    return SKG_OK;
}

static skg_status create(skg_context *context, skg_scene *scene, skg_spectrum *spectrum,
                         const skg_plan_options *plan, const skg_registration_options *options,
                         skg_registration **registration) {
    SKG_PLAIN;
    skg_registration *r = NULL;
    SKG_NEEDS_OF("skg_registration_create", context);
    SKG_NEEDS_OF("skg_registration_create", scene);
    SKG_NEEDS_OF("skg_registration_create", spectrum);
    SKG_NEEDS_OF("skg_registration_create", registration);
    *registration = NULL;
    SKG_TRY(skg_alloc(1, sizeof *r, "registration", &r));
    skg_plan_options_init(&r->plan);
    skg_registration_options_init(&r->options);
    skg_registration_result_init(&r->result);
    skg_status status = SKG_OK;
    if (plan) status = skg_struct_read(plan, "skg_plan_options", &r->plan, sizeof r->plan);
    if (options && status == SKG_OK)
        status = skg_struct_read(options, "skg_registration_options", &r->options, sizeof r->options);
    if (status == SKG_OK) status = check_options(&r->options);
    if (status != SKG_OK) {
        skg_free(&r);
        return status;
    }
    skg_progress_keep(r->options.progress);
    if (skg_context_retain(context) == SKG_OK) r->context = context;
    if (skg_scene_retain(scene) == SKG_OK) r->scene = scene;
    if (skg_spectrum_retain(spectrum) == SKG_OK) r->spectrum = spectrum;
    if (r->plan.world) skg_material_retain(r->plan.world);
    if (r->plan.response) skg_response_retain(r->plan.response);
    *registration = r;
    return SKG_OK;
}

skg_status skg_registration_create(skg_context *context, skg_scene *scene, skg_spectrum *spectrum,
                                   const skg_plan_options *plan, const skg_registration_options *options,
                                   skg_registration **registration) {
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, create(context, scene, spectrum, plan, options, registration));
}

static void forget_run(skg_registration *r) {
    reg_levels_free(r);
    reg_scene_free(&r->body);
    skg_spectrum_release(&r->model);
    reg_state_free(&r->state);
    skg_free(&r->path);
    skg_free(&r->directions);
    skg_free(&r->names);
    r->path_count = 0;
    r->apart = 0;
    r->ended = 0;
}

void skg_registration_release(skg_registration **registration) {
    if (!registration || !*registration) return;
    skg_registration *r = *registration;
    forget_run(r);
    for (int64_t i = 0; i < r->image_count; i++) reg_image_free(&r->images[i]);
    skg_free(&r->images);
    skg_free(&r->parts);
    skg_progress_release(&r->options.progress);
    skg_material_release(&r->plan.world);
    skg_response_release(&r->plan.response);
    skg_spectrum_release(&r->spectrum);
    skg_scene_release(&r->scene);
    skg_context_release(&r->context);
    skg_free(registration);
}

skg_status skg_registration_part_add(skg_registration *registration, int64_t part) {
    skg_registration *r = registration;
    int64_t count = 0;
    SKG_NEEDS(registration);
    SKG_TRY(skg_scene_part_count(r->scene, &count));
    if (part < 0 || part >= count)
        return skg_fail(SKG_ERR_ARGUMENT, "registration: part %" PRId64 " is not below %" PRId64, part,
                        count);
    for (int64_t p = 0; p < r->part_count; p++)
        if (r->parts[p] == part)
            return skg_fail(SKG_ERR_ARGUMENT, "registration: part %" PRId64 " was added before", part);
    SKG_TRY(skg_realloc(r->part_count + 1, sizeof *r->parts, "parts of a registration", &r->parts));
    r->parts[r->part_count++] = part;
    return SKG_OK;
}

/* The last levels again, with the correlation of gradients. */
static skg_status polish(skg_registration *r) {
    skg_status status = SKG_OK;
    if (!r->options.polish || r->loss == SKG_REGISTRATION_LOSS_GRADIENT_NCC) return SKG_OK;
    r->loss = SKG_REGISTRATION_LOSS_GRADIENT_NCC;
    for (int64_t l = r->level_count > 1 ? r->level_count - 2 : 0; l < r->level_count && status == SKG_OK; l++)
        status = reg_search(r, &r->levels[l], &r->state, &r->result.loss);
    if (status == SKG_ERR_CANCELLED) r->loss = r->options.loss;
    return status;
}

static skg_status search(skg_registration *r) {
    int64_t first = 0;
    if (r->options.restarts > 0) {
        SKG_TRY(reg_starts_try(r));
        first = r->level_count - 1;
    }
    for (int64_t l = first; l < r->level_count; l++)
        SKG_TRY(reg_gain_search(r, &r->levels[l], &r->state, &r->result.loss));
    return polish(r);
}

/* Model less radiograph at the start, and the loss there. */
static skg_status look_before(skg_registration *r) {
    const reg_level *level = &r->levels[r->level_count - 1];
    float **images = NULL;
    reg_state start = {0};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(reg_images_create(r, level, &images));
    SKG_TRY_CLEANUP(reg_state_create(r, &start));
    SKG_TRY_CLEANUP(reg_render(r, level, &start, images));
    SKG_TRY_CLEANUP(reg_nuisances_find(r, level, &start, images));
    r->loss = r->options.polish ? SKG_REGISTRATION_LOSS_GRADIENT_NCC : r->options.loss;
    r->result.loss_start = reg_loss(r, level, &start, images);
    r->loss = SKG_REGISTRATION_LOSS_LSQ;
    SKG_TRY_CLEANUP(reg_nuisances_find(r, level, &start, images));
    for (int64_t i = 0; i < r->image_count; i++) {
        const reg_shrunk *s = &level->images[i];
        reg_model(r, level, &start, i, images[i], r->images[i].before);
        for (int64_t p = 0; p < s->rows * s->columns; p++)
            r->images[i].before[p] = s->mask[p] > 0 ? r->images[i].before[p] - s->fixed[p] : 0;
    }
cleanup:
    r->loss = r->options.loss;
    reg_images_free(r, &images);
    reg_state_free(&start);
    return status;
}

static void begin_again(skg_registration *r) {
    forget_run(r);
    skg_registration_result_init(&r->result);
    r->loss = r->options.loss;
    for (int64_t i = 0; i < r->image_count; i++) {
        const int64_t count = r->images[i].view.rows * r->images[i].view.columns;
        memcpy(r->images[i].mask, r->images[i].given, (size_t)count * sizeof(double));
        memset(r->images[i].rest, 0, (size_t)count * sizeof(double));
    }
}

skg_status skg_registration_run(skg_registration *registration) {
    SKG_PLAIN;
    skg_registration *r = registration;
    SKG_NEEDS(registration);
    begin_again(r);
    const double begin = skg_seconds();
    skg_status status = reg_prepare(r);
    if (status == SKG_OK) status = look_before(r);
    if (status != SKG_OK) return status;
    status = search(r);
    if (status != SKG_OK && status != SKG_ERR_CANCELLED) return status;
    int stopped = status == SKG_ERR_CANCELLED;
    SKG_TRY(reg_judge(r));
    status = stopped ? SKG_OK : reg_probe(r);
    if (status == SKG_ERR_CANCELLED) { /* the result stands without it */
        stopped = 1;
        SKG_TRY(reg_judge(r));
    } else if (status != SKG_OK) {
        return status;
    }
    r->ended = 1;
    r->result.seconds = skg_seconds() - begin;
    if (!stopped) return SKG_OK;
    r->result.verdict = SKG_REGISTRATION_VERDICT_STOPPED;
    snprintf(r->verdict, sizeof r->verdict, "stopped after %" PRId64 " steps: the best pose so far stands",
             r->path_count);
    return skg_fail(SKG_ERR_CANCELLED, "registration: %s", r->verdict);
}
