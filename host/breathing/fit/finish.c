/* Results after the search: distances before and after, and how well the targets determine the parameters. */
#include "core/maths.h"
#include "core/text.h"
#include "fit/types.h"
#include "scene/scene.h"

#include <skiagraph/distance.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Error in mm below which surfaces are not known: segmentations follow voxels of about 1 mm (a choice). */
static const double RESOLUTION = 0.1;

/* By which share of its range a parameter is changed to see what follows. Large enough that vertices pass the tendon's
 * plane, and that links come and go (a choice). */
static const double CHANGE = 0.02;

static skg_status measure(const skg_mesh *from, const skg_mesh *to, skg_distance *distance) {
    skg_distance_options options;
    skg_distance_options_init(&options);
    skg_distance_init(distance);
    return skg_distance_measure(from, to, &options, distance);
}

/* The distances from the posed organs, into before or after. */
static skg_status measure_all(skg_fit *fit, skg_fit_body *model, int after) {
    for (int64_t g = 0; g < fit->goal_count; g++) {
        const skg_goal *goal = fit->goals + g;
        skg_fit_target *target = fit->targets + g;
        skg_distance d;
        SKG_TRY(skg_fit_body_pose(model, goal));
        SKG_TRY(measure(model->meshes[goal->part], goal->mesh, &d));
        *(after ? &target->after_mean_mm : &target->before_mean_mm) = d.mean_mm;
        *(after ? &target->after_rms_mm : &target->before_rms_mm) = d.rms_mm;
        *(after ? &target->after_max_mm : &target->before_max_mm) = d.max_mm;
        if (after) continue;
        SKG_TRY(measure(fit->setup->scene->parts[goal->part].mesh, goal->mesh, &d));
        target->motion_mm = d.mean_mm;
    }
    return SKG_OK;
}

/* Where the samples of a goal are with some parameters, rows of x, y, z. */
static skg_status place(const skg_fit *fit, skg_fit_body *model, const skg_goal *goal, const double *values,
                        double *places) {
    SKG_TRY(skg_fit_values_set(model->body, fit->chosen, values));
    SKG_TRY(skg_fit_body_pose(model, goal));
    const skg_body_organ *organ = model->body->organ + model->organ[goal->part];
    for (int64_t i = 0; i < goal->count; i++)
        skg_add_scaled(organ->rest + 3 * i * goal->step, 1, organ->moved + 3 * i * goal->step,
                       places + 3 * i);
    return SKG_OK;
}

/* The normal of the target at the point nearest to each sample. Distances change by a sample's motion along it. */
static skg_status find_normals(const skg_goal *goal, const double *places, double *normals) {
    int64_t vertices, triangles;
    double *positions = NULL;
    int32_t *corners = NULL;
    skg_status status;
    SKG_TRY_CLEANUP(skg_mesh_count(goal->mesh, &vertices, &triangles));
    SKG_TRY_CLEANUP(skg_alloc(3 * vertices, sizeof *positions, "fit", &positions));
    SKG_TRY_CLEANUP(skg_alloc(3 * triangles, sizeof *corners, "fit", &corners));
    SKG_TRY_CLEANUP(skg_mesh_positions_get(goal->mesh, positions, 0));
    SKG_TRY_CLEANUP(skg_mesh_triangles_get(goal->mesh, corners, 0));
    for (int64_t i = 0; i < goal->count; i++) {
        double e[3], f[3], *n = normals + 3 * i;
        int64_t triangle;
        skg_tree_nearest(&goal->tree, places + 3 * i, HUGE_VAL, &triangle);
        const int32_t *c = corners + 3 * triangle;
        skg_add_scaled(positions + 3 * (int64_t)c[1], -1, positions + 3 * (int64_t)c[0], e);
        skg_add_scaled(positions + 3 * (int64_t)c[2], -1, positions + 3 * (int64_t)c[0], f);
        skg_cross(e, f, n);
        const double length = skg_length(n);
        skg_scale_vector(length > 0 ? 1 / length : 0, n, n);
    }
cleanup:
    skg_free(&positions);
    skg_free(&corners);
    return status;
}

/* Scratch of one goal. */
typedef struct {
    double *places, *other, *normals, *slopes; /* slopes: [count][n] mm for the whole range */
} slopes_of;

static skg_status find_slopes(const skg_fit *fit, skg_fit_body *model, const skg_goal *goal, slopes_of *s) {
    const int64_t n = fit->search.dimensions;
    double best[BODY_PARAMETERS], values[BODY_PARAMETERS];
    int64_t k = 0;
    skg_fit_values_at(fit, fit->search.best, best);
    SKG_TRY(place(fit, model, goal, best, s->places));
    SKG_TRY(find_normals(goal, s->places, s->normals));
    for (int p = 0; p < BODY_PARAMETERS; p++) {
        if (!fit->chosen[p]) continue;
        const double range = fit->high[p] - fit->low[p];
        const double low = fmax(best[p] - CHANGE * range, fit->low[p]),
                     high = fmin(best[p] + CHANGE * range, fit->high[p]);
        memcpy(values, best, sizeof values);
        values[p] = low;
        SKG_TRY(place(fit, model, goal, values, s->places));
        values[p] = high;
        SKG_TRY(place(fit, model, goal, values, s->other));
        for (int64_t i = 0; i < goal->count; i++) {
            double moved[3];
            skg_add_scaled(s->other + 3 * i, -1, s->places + 3 * i, moved);
            s->slopes[n * i + k] = skg_dot(moved, s->normals + 3 * i) * range / (high - low);
        }
        k++;
    }
    return SKG_OK;
}

/* Adds what one goal knows of the parameters: the mean over its surface of the products of slopes, over the square of the
 * resolution. */
static skg_status add_information(const skg_fit *fit, skg_fit_body *model, const skg_goal *goal,
                                  double *matrix) {
    const int64_t n = fit->search.dimensions;
    const double resolution = fmax(skg_fit_error(fit), RESOLUTION);
    slopes_of s = {0};
    skg_status status;
    SKG_TRY_CLEANUP(skg_alloc(3 * goal->count, sizeof(double), "fit", &s.places));
    SKG_TRY_CLEANUP(skg_alloc(3 * goal->count, sizeof(double), "fit", &s.other));
    SKG_TRY_CLEANUP(skg_alloc(3 * goal->count, sizeof(double), "fit", &s.normals));
    SKG_TRY_CLEANUP(skg_alloc(n * goal->count, sizeof(double), "fit", &s.slopes));
    SKG_TRY_CLEANUP(find_slopes(fit, model, goal, &s));
    for (int64_t i = 0; i < goal->count; i++)
        for (int64_t e = 0; e < n * n; e++)
            matrix[e] += goal->weights[i] * s.slopes[n * i + e / n] * s.slopes[n * i + e % n] /
                         (resolution * resolution);
cleanup:
    skg_free(&s.places);
    skg_free(&s.other);
    skg_free(&s.normals);
    skg_free(&s.slopes);
    return status;
}

/* Inverts a positive definite matrix in place (Gauss and Jordan). */
static void invert(int64_t n, double *a) {
    for (int64_t p = 0; p < n; p++) {
        const double pivot = a[n * p + p];
        a[n * p + p] = 1;
        for (int64_t c = 0; c < n; c++) a[n * p + c] /= pivot;
        for (int64_t r = 0; r < n; r++) {
            const double factor = a[n * r + p];
            if (r == p) continue;
            a[n * r + p] = 0;
            for (int64_t c = 0; c < n; c++) a[n * r + c] -= factor * a[n * p + c];
        }
    }
}

/* The covariance is that of a normal distribution which knows the targets and, of each parameter, its range: 1/12 of its
 * square is the variance of a uniform distribution. */
static skg_status find_covariance(skg_fit *fit, skg_fit_body *model) {
    const int64_t n = fit->search.dimensions;
    double ranges[BODY_PARAMETERS], *matrix = fit->covariance;
    int64_t k = 0;
    memset(matrix, 0, sizeof fit->covariance);
    for (int64_t g = 0; g < fit->goal_count; g++)
        SKG_TRY(add_information(fit, model, fit->goals + g, matrix));
    for (int64_t d = 0; d < n; d++) matrix[(n + 1) * d] += 12;
    invert(n, matrix);
    for (int p = 0; p < BODY_PARAMETERS; p++) {
        fit->sigma[p] = 0;
        if (!fit->chosen[p]) continue;
        ranges[k] = fit->high[p] - fit->low[p];
        fit->sigma[p] = ranges[k] * sqrt(matrix[(n + 1) * k]);
        k++;
    }
    for (int64_t e = 0; e < n * n; e++) matrix[e] *= ranges[e / n] * ranges[e % n];
    return SKG_OK;
}

static skg_status finish(skg_fit *fit, skg_fit_body *model) {
    double values[BODY_PARAMETERS];
    SKG_TRY(measure_all(fit, model, 0));
    skg_fit_values_at(fit, fit->search.best, values);
    SKG_TRY(skg_fit_values_set(model->body, fit->chosen, values));
    SKG_TRY(measure_all(fit, model, 1));
    return find_covariance(fit, model);
}

skg_status skg_fit_finish(skg_fit *fit) {
    SKG_PLAIN;
    skg_fit_body model;
    SKG_NEEDS(fit);
    SKG_TRY(skg_fit_begin(fit));
    /* A body as the scene has it: those of the search have the parameters of their last point. */
    SKG_TRY(skg_fit_body_create(NULL, fit->setup, fit->goals, fit->goal_count, &model));
    const skg_status status = finish(fit, &model);
    skg_fit_body_free(&model);
    fit->finished = status == SKG_OK;
    return status;
}

skg_status skg_fit_covariance_get(const skg_fit *fit, int64_t size, double *covariance) {
    SKG_NEEDS(fit);
    SKG_NEEDS(covariance);
    if (!fit->finished) return skg_fail(SKG_ERR_ARGUMENT, "fit: call skg_fit_finish first");
    const int64_t n = fit->search.dimensions;
    if (size != n)
        return skg_fail(SKG_ERR_ARGUMENT, "fit: the covariance is of %" PRId64 " parameters, not %" PRId64, n,
                        size);
    memcpy(covariance, fit->covariance, (size_t)(n * n) * sizeof *covariance);
    return SKG_OK;
}
