/* Surfaces seen from one point: each direction leaves them once. */
#include "phantom/shapes.h"

#include "core/maths.h"

/* mm between the points at which a ray asks a region; what is narrower may be missed. */
static const double step = 2;

double skg_shape_exit(skg_region region, const void *shape, const double from[3], const double direction[3],
                      double far) {
    double inside = 0, outside = 0, point[3];
    while (outside < far) {
        outside = fmin(inside + step, far);
        skg_add_scaled(from, outside, direction, point);
        if (region(shape, point) > 0) break;
        inside = outside;
    }
    if (inside >= far) return far;
    for (int i = 0; i < 12; i++) { /* to step / 2^12: half a micrometre */
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
    double rise = 1 + slope * 2 * SKG_PI / (double)count;
    for (int64_t i = 1; i < 2 * count; i++) /* twice around in both directions, since the ring is closed */
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
    double polar = SKG_PI * (double)r / (double)(rings - 1), around = 2 * SKG_PI * azimuth;
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
        int64_t around = llround(2 * (double)(rings - 1) * sin(SKG_PI * (double)r / (double)(rings - 1)));
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
