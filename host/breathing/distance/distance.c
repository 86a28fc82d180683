/* Distances between surfaces. */
#include "core/core.h"
#include "core/log.h"
#include "core/maths.h"
#include "core/text.h"
#include "core/threads.h"
#include "distance/nearest.h"
#include "distance/sample.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void skg_distance_options_init_sized(void *options, int32_t size) {
    const skg_distance_options defaults = {.sampling = SKG_DISTANCE_SURFACE};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

void skg_distance_init_sized(void *distance, int32_t size) {
    const skg_distance defaults = {0};
    skg_struct_init(distance, size, &defaults, sizeof defaults);
}

static skg_status check_options(const skg_distance_options *o) {
    if (o->sampling != SKG_DISTANCE_SURFACE && o->sampling != SKG_DISTANCE_VERTICES)
        return skg_fail(SKG_ERR_ARGUMENT, "distance: sampling %" PRId32 "; one of SKG_DISTANCE_",
                        o->sampling);
    if (!(o->spacing_mm >= 0 && isfinite(o->spacing_mm)))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "distance: a spacing of %g mm; give one above 0, or 0 for automatic", o->spacing_mm);
    return SKG_OK;
}

/* A distance and the weight of the sample that has it. */
typedef struct {
    double distance, weight;
} weighted;

static int by_distance(const void *a, const void *b) {
    const double x = ((const weighted *)a)->distance, y = ((const weighted *)b)->distance;
    return (x > y) - (x < y);
}

/* The distance that 95 % of the weight do not exceed. The list is sorted for it. */
static double percentile(int64_t count, weighted *list, double total) {
    double sum = 0;
    qsort(list, (size_t)count, sizeof *list, by_distance);
    for (int64_t i = 0; i < count; i++) {
        sum += list[i].weight;
        if (sum >= 0.95 * total) return list[i].distance;
    }
    return list[count - 1].distance;
}

/* Sums run in the order of the samples, so that threads do not change their rounding. */
static skg_status summarize(const skg_samples *samples, const double *distances, skg_distance *result) {
    double total = 0, sum = 0, squares = 0;
    int64_t farthest = 0;
    weighted *list;
    SKG_TRY(skg_alloc(samples->count, sizeof *list, "distances", &list));
    for (int64_t i = 0; i < samples->count; i++) {
        const double d = distances[i], weight = samples->weights[i];
        total += weight, sum += weight * d, squares += weight * d * d;
        if (d > distances[farthest]) farthest = i;
        list[i] = (weighted){d, weight};
    }
    result->samples = samples->count;
    result->spacing_mm = samples->spacing_mm;
    result->mean_mm = sum / total;
    result->rms_mm = sqrt(squares / total);
    result->p95_mm = percentile(samples->count, list, total);
    result->max_mm = distances[farthest];
    memcpy(result->max_position_mm, samples->points + 3 * farthest, sizeof result->max_position_mm);
    skg_free(&list);
    return SKG_OK;
}

static skg_status tree_of(const skg_mesh *mesh, skg_tree *tree) {
    skg_surface surface;
    SKG_TRY(skg_surface_create(mesh, &surface));
    const skg_status status =
        skg_tree_create(surface.name, surface.positions, surface.triangles, surface.corners, tree);
    skg_surface_free(&surface);
    return status;
}

/* Samples between two looks at the progress. */
enum { BLOCK = 1 << 14 };

static void find_distances(const skg_tree *tree, int64_t count, const double *points, double *distances) {
#pragma omp parallel for schedule(dynamic, 1024)
    for (int64_t i = 0; i < count; i++)
        distances[i] = sqrt(skg_tree_nearest(tree, points + 3 * i, HUGE_VAL, NULL));
}

static skg_status find_all(const skg_tree *tree, const skg_samples *samples, skg_progress *progress,
                           double *distances) {
    for (int64_t i = 0; i < samples->count; i += BLOCK) {
        const int64_t left = samples->count - i;
        SKG_TRY(skg_progress_step(progress, i, samples->count));
        find_distances(tree, left < BLOCK ? left : BLOCK, samples->points + 3 * i, distances + i);
    }
    (void)skg_progress_step(progress, samples->count, samples->count);
    return SKG_OK;
}

static skg_status measure(const skg_surface *from, const skg_tree *to, const skg_distance_options *options,
                          skg_distance *result) {
    skg_samples samples;
    double *distances = NULL;
    SKG_TRY(skg_samples_create(from, options, &samples));
    skg_status status = skg_alloc(samples.count, sizeof *distances, "distances", &distances);
    if (status == SKG_OK) status = find_all(to, &samples, options->progress, distances);
    if (status == SKG_OK) status = summarize(&samples, distances, result);
    skg_free(&distances);
    skg_samples_free(&samples);
    return status;
}

skg_status skg_distance_measure(const skg_mesh *from, const skg_mesh *to, const skg_distance_options *options,
                                skg_distance *distance) {
    SKG_PLAIN;
    skg_distance_options ours;
    skg_distance result;
    skg_surface surface;
    skg_tree tree;
    SKG_NEEDS(from);
    SKG_NEEDS(to);
    SKG_NEEDS(distance);
    SKG_TRY(skg_openmp_enter());
    skg_distance_options_init(&ours);
    skg_distance_init(&result);
    if (options) SKG_TRY(skg_struct_read(options, "skg_distance_options", &ours, sizeof ours));
    SKG_TRY(check_options(&ours));
    result.sampling = ours.sampling;
    SKG_TRY(skg_surface_create(from, &surface));
    skg_status status = tree_of(to, &tree);
    if (status == SKG_OK) {
        status = measure(&surface, &tree, &ours, &result);
        skg_tree_free(&tree);
    }
    skg_surface_free(&surface);
    return status == SKG_OK ? skg_struct_write(&result, sizeof result, "skg_distance", distance) : status;
}

skg_status skg_distance_of_points(const skg_mesh *to, int64_t count, const double *points,
                                  double *distances) {
    SKG_PLAIN;
    skg_tree tree;
    SKG_NEEDS(to);
    if (count < 0 || (count > 0 && (!points || !distances)))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "skg_distance_of_points: %" PRId64 " points, or an argument is NULL", count);
    for (int64_t i = 0; i < count; i++)
        if (!skg_all_finite(points + 3 * i, 3))
            return skg_fail(SKG_ERR_ARGUMENT, "skg_distance_of_points: point %" PRId64 " is not finite", i);
    SKG_TRY(skg_openmp_enter());
    SKG_TRY(tree_of(to, &tree));
    find_distances(&tree, count, points, distances);
    skg_tree_free(&tree);
    return SKG_OK;
}
