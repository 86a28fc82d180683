/* A fit as a handle. */
#include "core/log.h"
#include "core/text.h"
#include "fit/types.h"
#include "scene/scene.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

void skg_fit_options_init_sized(void *options, int32_t size) {
    const skg_fit_options defaults = {.evaluations = 4000, .seed = 1, .enough_mm = 0.001};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

void skg_fit_parameter_init_sized(void *parameter, int32_t size) {
    const skg_fit_parameter defaults = {0};
    skg_struct_init(parameter, size, &defaults, sizeof defaults);
}

void skg_fit_target_init_sized(void *target, int32_t size) {
    const skg_fit_target defaults = {0};
    skg_struct_init(target, size, &defaults, sizeof defaults);
}

static skg_status check_options(const skg_fit_options *o) {
    if (o->method != SKG_FIT_METHOD_CMA && o->method != SKG_FIT_METHOD_DE)
        return skg_fail(SKG_ERR_ARGUMENT, "fit: method %" PRId32 "; one of SKG_FIT_METHOD_", o->method);
    if (o->evaluations < 1 || o->evaluations > 1000000000)
        return skg_fail(SKG_ERR_ARGUMENT, "fit: %" PRId64 " evaluations; the range is 1 to 1e9",
                        o->evaluations);
    if (o->seed < 0 || !(o->enough_mm >= 0))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "fit: the seed is %" PRId64 ", enough_mm %g; neither may be below 0", o->seed,
                        o->enough_mm);
    return SKG_OK;
}

/* Takes what was chosen: of a group, what has an effect on this body. SKG_ERR_ARGUMENT: nothing has, or a name has not. */
static skg_status take_choice(skg_fit *fit, const int32_t *chosen) {
    int32_t taken[BODY_PARAMETERS];
    int any = 0, first = -1;
    for (int p = 0; p < BODY_PARAMETERS; p++) {
        if (chosen[p] == BODY_BY_NAME) SKG_TRY(skg_parameter_check_coupling(p, fit->coupling));
        if (chosen[p] && first < 0) first = p;
        taken[p] = chosen[p] && skg_parameter_is_of(p, fit->coupling);
        any |= taken[p];
    }
    if (!any && first >= 0) return skg_parameter_check_coupling(first, fit->coupling);
    if (!any) return skg_fail(SKG_ERR_ARGUMENT, "fit: no parameter is chosen");
    memcpy(fit->chosen, taken, sizeof taken);
    return SKG_OK;
}

/* Applies the scene's key Fit: the chosen parameters and their ranges. */
static skg_status take_section(skg_fit *fit) {
    const skg_body_fit_section *said = &fit->setup->breathing.fit;
    for (int p = 0; p < BODY_PARAMETERS; p++) {
        const int is_of = skg_parameter_is_of(p, fit->coupling);
        fit->chosen[p] = is_of && (fit->coupling == SKG_COUPLING_PAPER || skg_parameter_kinds[p].by_default);
        if (said->has_range[p]) {
            SKG_TRY(skg_parameter_check_coupling(p, fit->coupling));
            fit->low[p] = said->low[p], fit->high[p] = said->high[p];
        }
    }
    return said->chooses ? take_choice(fit, said->chosen) : SKG_OK;
}

/* Starts and ranges. A range that nobody gave is widened to hold the start. */
static skg_status find_ranges(skg_fit *fit, const skg_body *body) {
    for (int64_t o = 0; o < body->organs; o++) {
        const skg_body_organ *organ = body->organ + o;
        if (organ->role != ROLE_DIAPHRAGM) continue;
        memcpy(fit->bounds, organ->bounds, sizeof fit->bounds);
        skg_fit_values_get(body, fit->start);
        for (int p = 0; p < BODY_PARAMETERS; p++) {
            const skg_parameter_kind *kind = skg_parameter_kinds + p;
            const double unit = p == BODY_OFFSET ? fit->bounds[5] - fit->bounds[2] : 1;
            fit->low[p] = fmin(unit * kind->low, fit->start[p]);
            fit->high[p] = fmax(unit * kind->high, fit->start[p]);
        }
        fit->coupling = organ->coupled ? SKG_COUPLING_ANATOMICAL : SKG_COUPLING_PAPER;
        return take_section(fit);
    }
    return skg_fail(SKG_ERR_BREATHING, "fit: the scene has no diaphragm, whose motion is fitted");
}

static skg_status create(skg_context *context, const skg_setup *setup, const skg_fit_options *options,
                         skg_fit **result) {
    SKG_PLAIN;
    skg_fit *fit;
    skg_fit_options ours;
    skg_fit_body model;
    SKG_NEEDS_OF("skg_fit_create", setup);
    SKG_NEEDS_OF("skg_fit_create", result);
    *result = NULL;
    skg_fit_options_init(&ours);
    if (options) SKG_TRY(skg_struct_read(options, "skg_fit_options", &ours, sizeof ours));
    SKG_TRY(check_options(&ours));
    SKG_TRY(skg_alloc(1, sizeof *fit, "fit", &fit));
    fit->setup = setup;
    fit->options = ours;
    skg_progress_keep(ours.progress);
    skg_status status = context ? skg_context_retain(context) : SKG_OK;
    if (status == SKG_OK) {
        fit->context = context;
        status = skg_fit_body_create(context, setup, NULL, 0, &model);
    }
    if (status == SKG_OK) {
        status = find_ranges(fit, model.body);
        skg_fit_body_free(&model);
    }
    if (status != SKG_OK)
        skg_fit_release(&fit);
    else
        *result = fit;
    return status;
}

skg_status skg_fit_create(skg_context *context, const skg_setup *setup, const skg_fit_options *options,
                          skg_fit **fit) {
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, create(context, setup, options, fit));
}

void skg_fit_release(skg_fit **fit) {
    if (!fit || !*fit) return;
    for (int64_t g = 0; g < (*fit)->goal_count; g++) skg_goal_free((*fit)->goals + g);
    for (int64_t m = 0; m < (*fit)->model_count; m++) skg_fit_body_free((*fit)->models + m);
    skg_search_free(&(*fit)->search);
    skg_free(&(*fit)->goals);
    skg_free(&(*fit)->targets);
    skg_free(&(*fit)->models);
    skg_progress_release(&(*fit)->options.progress);
    skg_context_release(&(*fit)->context);
    skg_free(fit);
}

static skg_status check_not_begun(const skg_fit *fit) {
    if (fit->began) return skg_fail(SKG_ERR_ARGUMENT, "fit: it has begun; this is set before the first step");
    return SKG_OK;
}

skg_status skg_fit_target_add(skg_fit *fit, int64_t part, double phase, skg_mesh *mesh) {
    SKG_PLAIN;
    SKG_NEEDS(fit);
    SKG_NEEDS(mesh);
    SKG_TRY(check_not_begun(fit));
    const skg_scene *scene = fit->setup->scene;
    if (part < 0 || part >= scene->count)
        return skg_fail(SKG_ERR_ARGUMENT, "fit: no part %" PRId64 "; parts are 0 to %" PRId64, part,
                        scene->count - 1);
    if (!(phase >= 0 && phase < 1))
        return skg_fail(SKG_ERR_ARGUMENT, "fit: phase %g; the range is 0 to below 1", phase);
    SKG_TRY(skg_realloc(fit->goal_count + 1, sizeof *fit->goals, "fit", &fit->goals));
    SKG_TRY(skg_realloc(fit->goal_count + 1, sizeof *fit->targets, "fit", &fit->targets));
    skg_goal *goal = fit->goals + fit->goal_count;
    skg_fit_target *target = fit->targets + fit->goal_count;
    *goal = (skg_goal){.part = part};
    skg_breath_state_init(&goal->state);
    SKG_TRY(skg_breath_state_at_phase(&fit->setup->breathing.breath, phase, &goal->state));
    skg_fit_target_init(target);
    target->part = part;
    target->label = scene->parts[part].label;
    target->phase = phase;
    SKG_TRY(skg_mesh_retain(mesh));
    goal->mesh = mesh;
    fit->goal_count++; /* from here on it is freed with the fit */
    const skg_status status = skg_goal_prepare(fit->setup, goal);
    if (status != SKG_OK) skg_goal_free(fit->goals + --fit->goal_count);
    return status;
}

skg_status skg_fit_parameters_choose(skg_fit *fit, const char *names) {
    char *copy = NULL, *rest = NULL;
    int32_t chosen[BODY_PARAMETERS] = {0};
    SKG_NEEDS(fit);
    SKG_NEEDS(names);
    SKG_TRY(check_not_begun(fit));
    SKG_TRY(skg_copy_text(names, &copy));
    skg_status status = SKG_OK;
    for (char *word = strtok_r(copy, ", ", &rest); word && status == SKG_OK;
         word = strtok_r(NULL, ", ", &rest))
        status = skg_parameters_choose(word, chosen);
    skg_free(&copy);
    return status == SKG_OK ? take_choice(fit, chosen) : status;
}

skg_status skg_fit_bounds_set(skg_fit *fit, const char *name, double low, double high) {
    int p;
    SKG_NEEDS(fit);
    SKG_NEEDS(name);
    SKG_TRY(check_not_begun(fit));
    SKG_TRY(skg_parameter_find(name, &p));
    SKG_TRY(skg_parameter_check_coupling(p, fit->coupling));
    SKG_TRY(skg_parameter_check_range(p, low, high));
    fit->low[p] = low, fit->high[p] = high;
    return SKG_OK;
}

skg_status skg_fit_parameter_count(const skg_fit *fit, int64_t *count) {
    SKG_NEEDS(fit);
    SKG_NEEDS(count);
    *count = BODY_PARAMETERS;
    return SKG_OK;
}

skg_status skg_fit_parameter_get(const skg_fit *fit, int64_t index, skg_fit_parameter *parameter) {
    double values[BODY_PARAMETERS];
    SKG_NEEDS(fit);
    SKG_NEEDS(parameter);
    if (index < 0 || index >= BODY_PARAMETERS)
        return skg_fail(SKG_ERR_ARGUMENT, "fit: no parameter %" PRId64 "; they are 0 to %d", index,
                        BODY_PARAMETERS - 1);
    memcpy(values, fit->start, sizeof values);
    if (fit->began) skg_fit_values_at(fit, fit->search.best, values);
    skg_fit_parameter ours = {.chosen = fit->chosen[index],
                              .name = skg_parameter_kinds[index].name,
                              .unit = skg_parameter_kinds[index].unit,
                              .start = fit->start[index],
                              .low = fit->low[index],
                              .high = fit->high[index],
                              .value = values[index],
                              .sigma = fit->sigma[index]};
    ours.determined = fit->finished && ours.chosen && ours.sigma <= 0.2 * (ours.high - ours.low);
    return skg_struct_write(&ours, sizeof ours, "skg_fit_parameter", parameter);
}

skg_status skg_fit_target_count(const skg_fit *fit, int64_t *count) {
    SKG_NEEDS(fit);
    SKG_NEEDS(count);
    *count = fit->goal_count;
    return SKG_OK;
}

static skg_status check_target(const skg_fit *fit, int64_t index) {
    if (index >= 0 && index < fit->goal_count) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "fit: no target %" PRId64 "; there are %" PRId64, index,
                    fit->goal_count);
}

skg_status skg_fit_target_get(const skg_fit *fit, int64_t index, skg_fit_target *target) {
    SKG_NEEDS(fit);
    SKG_NEEDS(target);
    SKG_TRY(check_target(fit, index));
    return skg_struct_write(fit->targets + index, sizeof *fit->targets, "skg_fit_target", target);
}

skg_status skg_fit_target_mesh_get(const skg_fit *fit, int64_t index, skg_mesh **mesh) {
    SKG_NEEDS(fit);
    SKG_NEEDS(mesh);
    SKG_TRY(check_target(fit, index));
    *mesh = fit->goals[index].mesh;
    return SKG_OK;
}
