/* Points of a surface and the areas that they stand for. */
#include "distance/sample.h"

#include "core/core.h"
#include "core/maths.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* WANTED: triangles for which automatic spacing stands; LIMIT: beyond it the samples would fill the memory. Choices. */
enum { WANTED = 200000, LIMIT = 1000000000 };

skg_status skg_surface_create(const skg_mesh *mesh, skg_surface *surface) {
    skg_status status;
    *surface = (skg_surface){0};
    SKG_TRY(skg_mesh_name_get(mesh, &surface->name));
    SKG_TRY(skg_mesh_count(mesh, &surface->vertices, &surface->triangles));
    SKG_TRY_CLEANUP(skg_alloc(3 * surface->vertices, sizeof(double), surface->name, &surface->positions));
    SKG_TRY_CLEANUP(skg_alloc(3 * surface->triangles, sizeof(int32_t), surface->name, &surface->corners));
    SKG_TRY_CLEANUP(skg_mesh_positions_get(mesh, surface->positions, 0));
    SKG_TRY_CLEANUP(skg_mesh_triangles_get(mesh, surface->corners, 0));
    for (int64_t i = 0; i < surface->vertices && status == SKG_OK; i++)
        if (!skg_all_finite(surface->positions + 3 * i, 3))
            status = skg_fail(SKG_ERR_MESH, "%s: vertex %" PRId64 " is not finite", surface->name, i);
cleanup:
    if (status != SKG_OK) skg_surface_free(surface);
    return status;
}

void skg_surface_free(skg_surface *surface) {
    skg_free(&surface->positions);
    skg_free(&surface->corners);
}

static void corners_of(const skg_surface *s, int64_t triangle, const double *p[3]) {
    for (int c = 0; c < 3; c++) p[c] = s->positions + 3 * (int64_t)s->corners[3 * triangle + c];
}

static double longest_side(const double *const p[3]) {
    double longest = 0, d[3];
    for (int c = 0; c < 3; c++) {
        skg_add_scaled(p[(c + 1) % 3], -1, p[c], d);
        longest = fmax(longest, skg_length(d));
    }
    return longest;
}

static double area_of(const double *const p[3]) {
    double e[3], f[3], n[3];
    skg_add_scaled(p[1], -1, p[0], e);
    skg_add_scaled(p[2], -1, p[0], f);
    skg_cross(e, f, n);
    return 0.5 * skg_length(n);
}

/* Into how many parts each side is divided. */
static double division(const double *const p[3], double spacing) {
    return fmax(1, ceil(longest_side(p) / spacing));
}

/* Number of small triangles at a spacing. */
static double count_at(const skg_surface *s, double spacing) {
    double count = 0;
    for (int64_t t = 0; t < s->triangles; t++) {
        const double *p[3];
        corners_of(s, t, p);
        const double k = division(p, spacing);
        count += k * k;
    }
    return count;
}

/* The spacing at which there are about WANTED triangles, within a factor of 1.2; no more than the longest side. */
static double automatic_spacing(const skg_surface *s) {
    double spacing = 0;
    for (int64_t t = 0; t < s->triangles; t++) {
        const double *p[3];
        corners_of(s, t, p);
        spacing = fmax(spacing, longest_side(p));
    }
    const double step = 1.1;
    while (spacing > 0 && count_at(s, spacing / step) <= WANTED) spacing /= step;
    return spacing;
}

/* The centres of k x k equal parts of a triangle: in row i, k - i that point like it, and between them k - i - 1 that
 * point the other way. */
static int64_t divide(const double *const p[3], int64_t k, double *points) {
    const double third = 1.0 / 3;
    int64_t count = 0;
    for (int64_t i = 0; i < k; i++)
        for (int64_t j = 0; j < 2 * (k - i) - 1; j++) {
            const double shift = j % 2 == 0 ? third : 2 * third;
            const double v = ((double)i + shift) / (double)k, w = ((double)(j / 2) + shift) / (double)k;
            for (int c = 0; c < 3; c++)
                points[3 * count + c] = p[0][c] + v * (p[1][c] - p[0][c]) + w * (p[2][c] - p[0][c]);
            count++;
        }
    return count;
}

static skg_status sample_surface(const skg_surface *s, double spacing, skg_samples *samples) {
    const double wanted = count_at(s, spacing) + (double)s->vertices;
    double total = 0;
    if (!(wanted <= LIMIT))
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "%s: a spacing of %g mm asks for %.3g samples, and the limit is %.3g; give a larger spacing",
            s->name, spacing, wanted, (double)LIMIT);
    SKG_TRY(skg_alloc(3 * (int64_t)wanted, sizeof(double), s->name, &samples->points));
    SKG_TRY(skg_alloc((int64_t)wanted, sizeof(double), s->name, &samples->weights));
    for (int64_t t = 0; t < s->triangles; t++) {
        const double *p[3];
        corners_of(s, t, p);
        const double side = longest_side(p), k = division(p, spacing), area = area_of(p);
        const int64_t added = divide(p, (int64_t)k, samples->points + 3 * samples->count);
        for (int64_t i = 0; i < added; i++) samples->weights[samples->count++] = area / (k * k);
        samples->spacing_mm = fmax(samples->spacing_mm, side / k);
        total += area;
    }
    memcpy(samples->points + 3 * samples->count, s->positions, (size_t)(3 * s->vertices) * sizeof(double));
    samples->count += s->vertices;
    if (total > 0) return SKG_OK;
    return skg_fail(SKG_ERR_MESH, "%s: its triangles have no area; sample its vertices", s->name);
}

static skg_status sample_vertices(const skg_surface *s, skg_samples *samples) {
    SKG_TRY(skg_alloc(3 * s->vertices, sizeof(double), s->name, &samples->points));
    SKG_TRY(skg_alloc(s->vertices, sizeof(double), s->name, &samples->weights));
    memcpy(samples->points, s->positions, (size_t)(3 * s->vertices) * sizeof(double));
    for (int64_t i = 0; i < s->vertices; i++) samples->weights[i] = 1;
    samples->count = s->vertices;
    return SKG_OK;
}

skg_status skg_samples_create(const skg_surface *s, const skg_distance_options *options,
                              skg_samples *samples) {
    *samples = (skg_samples){0};
    const double spacing = options->spacing_mm > 0 ? options->spacing_mm : automatic_spacing(s);
    const skg_status status = options->sampling == SKG_DISTANCE_VERTICES
                                  ? sample_vertices(s, samples)
                                  : sample_surface(s, spacing > 0 ? spacing : 1, samples);
    if (status != SKG_OK) skg_samples_free(samples);
    return status;
}

void skg_samples_free(skg_samples *samples) {
    skg_free(&samples->points);
    skg_free(&samples->weights);
}
