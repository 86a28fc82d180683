#include "phantom/shape.h"

#include "core/vector.h"

#include <string.h>

static const double pi = 3.14159265358979323846;

int64_t skg_shape_count(double resolution, double standard, int64_t fewest) {
    int64_t count = (int64_t)llround(resolution * standard);
    return count > fewest ? count : fewest;
}

static void stitch(int64_t low, int64_t m, int64_t high, int64_t n, skg_mesh_arrays *arrays) {
    int64_t i = 0, j = 0, steps = (m > 1 ? m : 0) + (n > 1 ? n : 0);
    for (int64_t s = 0; s < steps; s++) {
        /* the side whose next point comes first goes on: (i + 1)/m <= (j + 1)/n */
        int lower = n == 1 || (m > 1 && (i + 1) * n <= (j + 1) * m);
        int32_t *c = arrays->corners + 3 * arrays->triangles++;
        c[0] = (int32_t)(low + i % m);
        c[1] = (int32_t)(lower ? low + (i + 1) % m : high + (j + 1) % n);
        c[2] = (int32_t)(high + j % n);
        if (lower)
            i++;
        else
            j++;
    }
}

skg_status skg_shape_rings(const char *name, int64_t rings, const int64_t *counts, skg_ring_place place,
                           const void *shape, skg_mesh_arrays *arrays) {
    int64_t vertices = arrays->vertices, triangles = arrays->triangles;
    for (int64_t r = 0; r < rings; r++) {
        vertices += counts[r];
        triangles += (counts[r] > 1 ? counts[r] : 0) * (r > 0 && r + 1 < rings ? 2 : 1);
    }
    if (vertices > SKG_MESH_LIMIT || triangles > SKG_MESH_LIMIT)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: more triangles than a mesh may have", name);
    SKG_TRY(skg_realloc(3 * vertices, sizeof(double), name, &arrays->positions));
    SKG_TRY(skg_realloc(3 * triangles, sizeof(int32_t), name, &arrays->corners));
    int64_t below = 0;
    for (int64_t r = 0; r < rings; r++) {
        int64_t here = arrays->vertices;
        for (int64_t i = 0; i < counts[r]; i++)
            place(shape, r, (double)i / (double)counts[r], arrays->positions + 3 * arrays->vertices++);
        if (r > 0) stitch(below, counts[r - 1], here, counts[r], arrays);
        below = here;
    }
    return SKG_OK;
}

static void unit(double *v) {
    skg_scale_vector(1 / skg_length(v), v, v);
}

typedef struct {
    int64_t rings;
    const skg_tube_ring *ring;
    double pole;
    int upright; /* as a whole: one choice, or rings would turn against each other */
} tube;

static void tube_place(const void *shape, int64_t r, double azimuth, double point[3]) {
    const tube *t = shape;
    int64_t last = t->rings - 1, i = r == 0 ? 0 : r - 1 > last ? last : r - 1;
    const skg_tube_ring *ring = t->ring + i;
    const double *before = t->ring[i > 0 ? i - 1 : 0].centre,
                 *after = t->ring[i < last ? i + 1 : last].centre;
    double along[3], across[3], up[3] = {0, 0, 1};
    skg_add_scaled(after, -1, before, along);
    unit(along);
    if (t->upright) up[1] = 1, up[2] = 0; /* its height is to the back */
    skg_cross(up, along, across);
    unit(across);
    skg_cross(along, across, up);
    if (r == 0 || r == t->rings + 1) { /* pole */
        skg_add_scaled(ring->centre, r == 0 ? -t->pole : t->pole, along, point);
        return;
    }
    skg_add_scaled(ring->centre, ring->width * cos(2 * pi * azimuth), across, point);
    skg_add_scaled(point, ring->height * sin(2 * pi * azimuth), up, point);
}

skg_status skg_shape_tube(const char *name, int64_t rings, const skg_tube_ring *ring, double pole,
                          int64_t around, skg_mesh_arrays *arrays) {
    int64_t *counts;
    SKG_TRY(skg_alloc(rings + 2, sizeof *counts, name, &counts));
    for (int64_t r = 0; r < rings + 2; r++) counts[r] = r == 0 || r == rings + 1 ? 1 : around;
    double way[3];
    skg_add_scaled(ring[rings - 1].centre, -1, ring[0].centre, way);
    const tube t = {rings, ring, pole, fabs(way[2]) > 0.93 * skg_length(way)};
    skg_status status = skg_shape_rings(name, rings + 2, counts, tube_place, &t, arrays);
    skg_free(&counts);
    return status;
}

skg_status skg_shape_cord(const char *name, const double (*curve)[3], int64_t points, double height,
                          double width, double side, int64_t rings, int64_t around, skg_mesh_arrays *arrays) {
    skg_tube_ring *ring;
    SKG_TRY(skg_alloc(rings, sizeof *ring, name, &ring));
    for (int64_t i = 0; i < rings; i++) {
        double at = (double)i * (double)(points - 1) / (double)(rings - 1);
        int64_t low = (int64_t)at < points - 1 ? (int64_t)at : points - 2;
        double w = at - (double)low, taper = i == 0 || i == rings - 1 ? 0.75 : 1;
        for (int k = 0; k < 3; k++)
            ring[i].centre[k] = (k == 0 ? side : 1) * ((1 - w) * curve[low][k] + w * curve[low + 1][k]);
        ring[i].height = taper * height, ring[i].width = taper * width;
    }
    skg_status status = skg_shape_tube(name, rings, ring, 0.5 * fmin(height, width), around, arrays);
    if (status == SKG_OK) status = skg_shape_unfold(name, arrays);
    skg_free(&ring);
    return status;
}

double skg_shape_exit(skg_region region, const void *shape, const double from[3], const double direction[3],
                      double far) {
    double inside = 0, outside = 0, step = 2, point[3];
    while (outside < far) {
        outside = fmin(inside + step, far);
        skg_add_scaled(from, outside, direction, point);
        if (region(shape, point) > 0) break;
        inside = outside;
    }
    if (inside >= far) return far;
    for (int i = 0; i < 12; i++) { /* 2 mm / 2^12 */
        double middle = 0.5 * (inside + outside);
        skg_add_scaled(from, middle, direction, point);
        if (region(shape, point) > 0)
            outside = middle;
        else
            inside = middle;
    }
    return inside;
}

void skg_shape_smooth(double *radius, int64_t count, int passes) {
    for (int pass = 0; pass < passes; pass++) {
        double first = radius[0], before = radius[count - 1];
        for (int64_t i = 0; i < count; i++) {
            double here = radius[i], after = i + 1 < count ? radius[i + 1] : first;
            radius[i] = fmin(here, 0.25 * before + 0.5 * here + 0.25 * after);
            before = here;
        }
    }
}

void skg_shape_limit(double *radius, int64_t count, double slope) {
    double rise = 1 + slope * 2 * pi / (double)count;
    for (int64_t i = 1; i < 2 * count; i++) /* twice around, both ways: the ring is closed */
        radius[i % count] = fmin(radius[i % count], rise * radius[(i - 1) % count]);
    for (int64_t i = 2 * count - 1; i > 0; i--)
        radius[(i - 1) % count] = fmin(radius[(i - 1) % count], rise * radius[i % count]);
}

typedef struct {
    const double *centre;
    int64_t rings;
    const int64_t *counts, *first;
    const double *radius;
} star;

static void star_direction(int64_t rings, int64_t r, double azimuth, double direction[3]) {
    double polar = pi * (double)r / (double)(rings - 1), around = 2 * pi * azimuth;
    direction[0] = sin(polar) * cos(around);
    direction[1] = sin(polar) * sin(around);
    direction[2] = -cos(polar);
}

static void star_place(const void *shape, int64_t r, double azimuth, double point[3]) {
    const star *s = shape;
    double direction[3];
    star_direction(s->rings, r, azimuth, direction);
    int64_t i = llround(azimuth * (double)s->counts[r]);
    skg_add_scaled(s->centre, s->radius[s->first[r] + i], direction, point);
}

skg_status skg_shape_star(const char *name, skg_region region, const void *shape, const double centre[3],
                          double far, int64_t rings, skg_mesh_arrays *arrays) {
    int64_t *counts = NULL, *first = NULL, total = 0;
    double *radius = NULL;
    if (region(shape, centre) > 0) return skg_fail(SKG_ERR_INTERNAL, "%s: its centre is outside it", name);
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(rings, sizeof *counts, name, &counts));
    SKG_TRY_CLEANUP(skg_alloc(rings, sizeof *first, name, &first));
    for (int64_t r = 0; r < rings; r++) {
        int64_t around = llround(2 * (double)(rings - 1) * sin(pi * (double)r / (double)(rings - 1)));
        counts[r] = r == 0 || r == rings - 1 ? 1 : around > 5 ? around : 5;
        first[r] = total;
        total += counts[r];
    }
    SKG_TRY_CLEANUP(skg_alloc(total, sizeof *radius, name, &radius));
#pragma omp parallel for schedule(dynamic, 1)
    for (int64_t r = 0; r < rings; r++) {
        for (int64_t i = 0; i < counts[r]; i++) {
            double direction[3];
            star_direction(rings, r, (double)i / (double)counts[r], direction);
            radius[first[r] + i] = skg_shape_exit(region, shape, centre, direction, far);
        }
        skg_shape_limit(radius + first[r], counts[r], 4);
        skg_shape_smooth(radius + first[r], counts[r], 2);
    }
    SKG_TRY_CLEANUP(skg_shape_rings(name, rings, counts, star_place,
                                    &(star){centre, rings, counts, first, radius}, arrays));
cleanup:
    skg_free(&counts);
    skg_free(&first);
    skg_free(&radius);
    return status;
}

double skg_shape_curve(const double (*knots)[2], int count, double x) {
    if (x <= knots[0][0]) return knots[0][1];
    if (x >= knots[count - 1][0]) return knots[count - 1][1];
    int k = 0;
    while (x > knots[k + 1][0]) k++;
    int before = k > 0 ? k - 1 : 0, after = k + 2 < count ? k + 2 : count - 1;
    double width = knots[k + 1][0] - knots[k][0], t = (x - knots[k][0]) / width, s = 1 - t;
    double left = (knots[k + 1][1] - knots[before][1]) / (knots[k + 1][0] - knots[before][0]);
    double right = (knots[after][1] - knots[k][1]) / (knots[after][0] - knots[k][0]);
    return knots[k][1] * s * s * (1 + 2 * t) + knots[k + 1][1] * t * t * (3 - 2 * t) +
           width * (left * t * s * s - right * t * t * s);
}

/* Barry and Goldman's pyramid for four points with centripetal knots. */
static void spline_point(const double (*p)[3], const double knot[4], double t, double point[3]) {
    double row[4][3];
    memcpy(row, p, sizeof row);
    for (int level = 1; level < 4; level++)
        for (int i = 0; i + level < 4; i++) {
            int low = level == 3 ? 1 : i, high = level == 3 ? 2 : i + level; /* the last is over the middle */
            double width = knot[high] - knot[low], w = width > 0 ? (t - knot[low]) / width : 0;
            for (int k = 0; k < 3; k++) row[i][k] = (1 - w) * row[i][k] + w * row[i + 1][k];
        }
    memcpy(point, row[0], 3 * sizeof(double));
}

enum { SPLINE_STEPS = 64, SPLINE_POINTS = 16 };

static void spline_segment(const double (*points)[3], int count, int segment, double t, double point[3]) {
    double p[4][3], knot[4] = {0};
    for (int i = 0; i < 4; i++) {
        int n = segment - 1 + i;
        if (n < 0 || n >= count) { /* mirrored beyond the ends */
            int end = n < 0 ? 0 : count - 1, inner = n < 0 ? 1 : count - 2;
            for (int k = 0; k < 3; k++) p[i][k] = 2 * points[end][k] - points[inner][k];
        } else
            memcpy(p[i], points[n], sizeof p[i]);
    }
    for (int i = 1; i < 4; i++) {
        double d[3];
        skg_add_scaled(p[i], -1, p[i - 1], d);
        knot[i] = knot[i - 1] + sqrt(skg_length(d));
    }
    spline_point((const double(*)[3])p, knot, knot[1] + t * (knot[2] - knot[1]), point);
}

skg_status skg_shape_spline(const double (*points)[3], int count, int64_t samples, double (*curve)[3]) {
    if (count < 2 || count > SPLINE_POINTS || samples < 2)
        return skg_fail(SKG_ERR_INTERNAL, "curve through %d points", count);
    double fine[SPLINE_STEPS * SPLINE_POINTS][3], length[SPLINE_STEPS * SPLINE_POINTS] = {0};
    int total = (count - 1) * SPLINE_STEPS;
    for (int i = 0; i <= total; i++) {
        int segment = i < total ? i / SPLINE_STEPS : count - 2;
        spline_segment(points, count, segment, (double)(i - segment * SPLINE_STEPS) / SPLINE_STEPS, fine[i]);
        double d[3];
        if (i > 0) skg_add_scaled(fine[i], -1, fine[i - 1], d);
        if (i > 0) length[i] = length[i - 1] + skg_length(d);
    }
    for (int64_t s = 0, i = 0; s < samples; s++) {
        double at = length[total] * (double)s / (double)(samples - 1);
        while (i + 1 < total && length[i + 1] < at) i++;
        double w = (at - length[i]) / (length[i + 1] - length[i]);
        for (int k = 0; k < 3; k++) curve[s][k] = (1 - w) * fine[i][k] + w * fine[i + 1][k];
    }
    return SKG_OK;
}
