/* Evaluating generations. */
#include "core/log.h"
#include "core/text.h"
#include "core/threads.h"
#include "fit/types.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>

void skg_fit_state_init_sized(void *state, int32_t size) {
    const skg_fit_state defaults = {0};
    skg_struct_init(state, size, &defaults, sizeof defaults);
}

static skg_status make_models(skg_fit *fit) {
    const int64_t threads = omp_get_max_threads();
    SKG_TRY(skg_alloc(threads, sizeof *fit->models, "fit", &fit->models));
    for (int64_t m = 0; m < threads; m++) {
        SKG_TRY(skg_fit_body_create(NULL, fit->setup, fit->goals, fit->goal_count, fit->models + m));
        fit->model_count = m + 1;
    }
    return SKG_OK;
}

/* A target whose part does not move cannot be reached. */
static skg_status check_goals(const skg_fit *fit) {
    for (int64_t g = 0; g < fit->goal_count; g++) {
        const skg_fit_body *model = fit->models;
        const skg_body_organ *organ = model->body->organ + model->organ[fit->goals[g].part];
        if (organ->role == ROLE_STATIC)
            return skg_fail(SKG_ERR_BREATHING,
                            "fit: %s does not move with the breath, so it cannot be fitted",
                            fit->targets[g].label);
    }
    return SKG_OK;
}

static skg_status begin(skg_fit *fit) {
    double point[BODY_PARAMETERS];
    if (fit->goal_count == 0) return skg_fail(SKG_ERR_ARGUMENT, "fit: there is no target");
    if (fit->model_count == 0) SKG_TRY(make_models(fit));
    SKG_TRY(check_goals(fit));
    skg_fit_point_of(fit, fit->start, point);
    const int method = fit->options.method == SKG_FIT_METHOD_CMA ? SKG_SEARCH_CMA : SKG_SEARCH_DE;
    return skg_search_create(method, skg_fit_dimensions(fit), point, fit->options.seed, &fit->search);
}

skg_status skg_fit_begin(skg_fit *fit) {
    SKG_TRY(skg_openmp_enter());
    if (fit->began) return SKG_OK;
    const skg_status status = begin(fit);
    if (status != SKG_OK) { /* so that the next call begins anew */
        for (int64_t m = 0; m < fit->model_count; m++) skg_fit_body_free(fit->models + m);
        fit->model_count = 0;
        skg_free(&fit->models);
    }
    fit->began = status == SKG_OK;
    return status;
}

/* The mean square error at a point: it is nearly a quadratic function, which the search can model, and its root is not. */
static skg_status evaluate(const skg_fit *fit, skg_fit_body *model, const double *point, double *value) {
    SKG_PLAIN; /* of this thread */
    double values[BODY_PARAMETERS], square = 0;
    skg_fit_values_at(fit, point, values);
    SKG_TRY(skg_fit_values_set(model->body, fit->chosen, values));
    SKG_TRY(skg_fit_body_error(model, fit->goals, fit->goal_count, &square));
    *value = isfinite(square) ? square : HUGE_VAL;
    return SKG_OK;
}

/* Every thread has a model of its own, and no point knows of another, so that their order does not matter. */
static skg_status evaluate_all(skg_fit *fit, double *values) {
    const skg_search *search = &fit->search;
    const int64_t n = search->dimensions, points = search->counters[SEARCH_POPULATION];
    skg_status status = SKG_OK;
    char sentence[512] = "";
#pragma omp parallel for schedule(dynamic, 1) num_threads((int)fit->model_count)
    for (int64_t i = 0; i < points; i++) {
        const skg_status one =
            evaluate(fit, fit->models + omp_get_thread_num(), search->points + n * i, values + i);
#pragma omp critical(skg_fit_status)
        if (one != SKG_OK && status == SKG_OK) {
            status = one;
            snprintf(sentence, sizeof sentence, "%s", skg_last_error());
        }
    }
    return status == SKG_OK ? SKG_OK : skg_fail(status, "%s", sentence);
}

double skg_fit_error(const skg_fit *fit) {
    return sqrt(*fit->search.best_value);
}

static int is_done(const skg_fit *fit) {
    const skg_search *search = &fit->search;
    const int64_t next = search->counters[SEARCH_EVALUATIONS] + search->counters[SEARCH_POPULATION];
    return next > fit->options.evaluations || skg_fit_error(fit) <= fit->options.enough_mm;
}

static skg_status say_progress(const skg_fit *fit) {
    return skg_progress_step(fit->options.progress, fit->search.counters[SEARCH_EVALUATIONS],
                             fit->options.evaluations);
}

static skg_status step(skg_fit *fit) {
    double *values;
    SKG_TRY(say_progress(fit));
    SKG_TRY(skg_alloc(fit->search.max_points, sizeof *values, "fit", &values));
    skg_status status = skg_search_ask(&fit->search);
    if (status == SKG_OK) status = evaluate_all(fit, values);
    if (status == SKG_OK) status = skg_search_tell(&fit->search, values);
    skg_free(&values);
    return status;
}

skg_status skg_fit_step(skg_fit *fit, skg_fit_state *state) {
    SKG_PLAIN;
    SKG_NEEDS(fit);
    SKG_TRY(skg_fit_begin(fit));
    if (!is_done(fit)) SKG_TRY(step(fit));
    if (is_done(fit)) (void)say_progress(fit);
    const int64_t *counters = fit->search.counters;
    const skg_fit_state ours = {.done = is_done(fit),
                                .evaluations = counters[SEARCH_EVALUATIONS],
                                .generation = counters[SEARCH_GENERATION],
                                .restarts = counters[SEARCH_RESTARTS],
                                .best_mm = skg_fit_error(fit)};
    fit->finished = 0;
    return state ? skg_struct_write(&ours, sizeof ours, "skg_fit_state", state) : SKG_OK;
}
