/* Surfaces of tubes along curves. */
#include "phantom/shapes.h"

#include "core/maths.h"
#include "phantom/contacts.h"

#include <string.h>

static void unit(double *v) {
    skg_scale_vector(1 / skg_length(v), v, v);
}

typedef struct {
    int64_t rings;
    const skg_tube_ring *ring;
    double pole;
    int upright; /* 1: height is measured along y. One choice for all rings, or they would be twisted. */
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
    if (t->upright) up[1] = 1, up[2] = 0;
    skg_cross(up, along, across);
    unit(across);
    skg_cross(along, across, up);
    if (r == 0 || r == t->rings + 1) {
        skg_add_scaled(ring->centre, r == 0 ? -t->pole : t->pole, along, point);
        return;
    }
    skg_add_scaled(ring->centre, ring->width * cos(2 * SKG_PI * azimuth), across, point);
    skg_add_scaled(point, ring->height * sin(2 * SKG_PI * azimuth), up, point);
}

skg_status skg_shape_tube(const char *name, int64_t rings, const skg_tube_ring *ring, double pole,
                          int64_t around, skg_mesh_arrays *arrays) {
    int64_t *counts;
    SKG_TRY(skg_alloc(rings + 2, sizeof *counts, name, &counts));
    for (int64_t r = 0; r < rings + 2; r++) counts[r] = r == 0 || r == rings + 1 ? 1 : around;
    double way[3];
    skg_add_scaled(ring[rings - 1].centre, -1, ring[0].centre, way);
    /* Within acos 0.93, 22 degrees, of the z axis, the z axis is of no use as the direction of height. */
    const tube t = {rings, ring, pole, fabs(way[2]) > 0.93 * skg_length(way)};
    skg_status status = skg_shape_rings(name, rings + 2, counts, tube_place, &t, arrays);
    skg_free(&counts);
    return status;
}

static const double end_taper = 0.75; /* of the first and the last ring: rounds the ends */

/* The centre of ring number i of a tube along a curve, mirrored where side is -1. */
static void centre_at(const double (*curve)[3], int64_t points, int64_t i, int64_t rings, double side,
                      double point[3]) {
    double at = (double)i * (double)(points - 1) / (double)(rings - 1);
    int64_t low = (int64_t)at < points - 1 ? (int64_t)at : points - 2;
    double w = at - (double)low;
    for (int k = 0; k < 3; k++)
        point[k] = (k == 0 ? side : 1) * ((1 - w) * curve[low][k] + w * curve[low + 1][k]);
}

skg_status skg_shape_cord(const char *name, const double (*curve)[3], int64_t points, double height,
                          double width, double side, int64_t rings, int64_t around, skg_mesh_arrays *arrays) {
    skg_tube_ring *ring;
    SKG_TRY(skg_alloc(rings, sizeof *ring, name, &ring));
    for (int64_t i = 0; i < rings; i++) {
        double taper = i == 0 || i == rings - 1 ? end_taper : 1;
        centre_at(curve, points, i, rings, side, ring[i].centre);
        ring[i].height = taper * height, ring[i].width = taper * width;
    }
    skg_status status = skg_shape_tube(name, rings, ring, 0.5 * fmin(height, width), around, arrays);
    if (status == SKG_OK) status = skg_shape_unfold(name, arrays);
    skg_free(&ring);
    return status;
}

/* A ring of a hose: its centre and two vectors that span it. */
typedef struct {
    double centre[3], across[3], up[3], along[3], radius;
} hose_ring;

typedef struct {
    int64_t rings;
    const hose_ring *ring;
} hose;

static void hose_place(const void *shape, int64_t r, double azimuth, double point[3]) {
    const hose *h = shape;
    const int64_t last = h->rings - 1, i = r == 0 ? 0 : r - 1 > last ? last : r - 1;
    const hose_ring *ring = h->ring + i;
    if (r == 0 || r == h->rings + 1) {
        skg_add_scaled(ring->centre, (r == 0 ? -0.5 : 0.5) * ring->radius, ring->along, point);
        return;
    }
    skg_add_scaled(ring->centre, ring->radius * cos(2 * SKG_PI * azimuth), ring->across, point);
    skg_add_scaled(point, ring->radius * sin(2 * SKG_PI * azimuth), ring->up, point);
}

/* Each ring takes the directions of the one before it, as far as its own direction allows, so that the tube is not
 * twisted. */
static void turn_rings(int64_t rings, hose_ring *ring) {
    double across[3] = {1, 0, 0};
    for (int64_t i = 0; i < rings; i++) {
        double *along = ring[i].along;
        skg_add_scaled(ring[i + 1 < rings ? i + 1 : i].centre, -1, ring[i > 0 ? i - 1 : 0].centre, along);
        unit(along);
        if (i == 0 && fabs(along[0]) > 0.7) across[0] = 0, across[1] = 1;
        skg_add_scaled(across, -skg_dot(across, along), along, across);
        unit(across);
        memcpy(ring[i].across, across, sizeof across);
        skg_cross(along, across, ring[i].up);
    }
}

skg_status skg_shape_hose(const char *name, const double (*curve)[3], int64_t points, double first,
                          double last, double side, int64_t rings, int64_t around, skg_mesh_arrays *arrays) {
    hose_ring *ring = NULL;
    int64_t *counts = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(rings, sizeof *ring, name, &ring));
    SKG_TRY_CLEANUP(skg_alloc(rings + 2, sizeof *counts, name, &counts));
    for (int64_t i = 0; i < rings; i++) {
        const double t = (double)i / (double)(rings - 1), taper = i == 0 || i == rings - 1 ? end_taper : 1;
        centre_at(curve, points, i, rings, side, ring[i].centre);
        ring[i].radius = taper * (first + t * (last - first));
    }
    turn_rings(rings, ring);
    for (int64_t r = 0; r < rings + 2; r++) counts[r] = r == 0 || r == rings + 1 ? 1 : around;
    SKG_TRY_CLEANUP(skg_shape_rings(name, rings + 2, counts, hose_place, &(hose){rings, ring}, arrays));
cleanup:
    skg_free(&ring);
    skg_free(&counts);
    return status;
}
