/* Straight fibres through a box. */
#include "core/maths.h"
#include "core/text.h"
#include "mesh/mesh.h"
#include "mesh/pieces.h"

#include <skiagraph/bodies.h>

#include <inttypes.h>
#include <math.h>

static const char *const shape = "fibres";

enum { TRIES = 5000, FIBRES_MAX = 100000 };

void skg_fibres_init_sized(void *fibres, int32_t size) {
    const skg_fibres defaults = {.box = {20, 20, 20}, .radius_mm = 0.5, .count = 50, .segments = 16};
    skg_struct_init(fibres, size, &defaults, sizeof defaults);
}

/* Where the axis of a fibre is at the middle of the box, and how x and y change along z. */
typedef struct {
    double at[2], slope[2];
} axis;

/* The square of the distance between two axes, inside the box: along z their horizontal difference is linear. */
static double square_between(const axis *a, const axis *b, double half) {
    double d[2], s[2];
    for (int k = 0; k < 2; k++) d[k] = a->at[k] - b->at[k], s[k] = a->slope[k] - b->slope[k];
    const double steep = s[0] * s[0] + s[1] * s[1];
    double z = steep > 0 ? -(d[0] * s[0] + d[1] * s[1]) / steep : 0;
    z = fmin(fmax(z, -half), half);
    const double x = d[0] + s[0] * z, y = d[1] + s[1] * z;
    return x * x + y * y;
}

/* The horizontal reach of a fibre: its ring lies across z, and is an ellipse that is longer along the slope. */
static double reach(const axis *one, double radius) {
    return radius * sqrt(1 + one->slope[0] * one->slope[0] + one->slope[1] * one->slope[1]);
}

static int draw_axis(const skg_fibres *f, uint64_t *state, axis *one) {
    const double turn = 2 * SKG_PI * skg_draw(state), most = tan(f->tilt_deg * SKG_PI / 180);
    const double steep = most * sqrt(skg_draw(state)), half = 0.5 * f->box[2];
    one->slope[0] = steep * cos(turn), one->slope[1] = steep * sin(turn);
    for (int k = 0; k < 2; k++) {
        const double room = 0.5 * f->box[k] - reach(one, f->radius_mm) - fabs(one->slope[k]) * half;
        if (!(room > 0)) return 0;
        one->at[k] = (2 * skg_draw(state) - 1) * room;
    }
    return 1;
}

static int fits(const skg_fibres *f, const axis *placed, int64_t count, const axis *one) {
    for (int64_t i = 0; i < count; i++) {
        const double least = reach(one, f->radius_mm) + reach(placed + i, f->radius_mm) + f->gap_mm;
        if (square_between(one, placed + i, 0.5 * f->box[2]) < least * least) return 0;
    }
    return 1;
}

static skg_status place(const skg_fibres *f, axis *axes) {
    uint64_t state = (uint64_t)f->seed;
    for (int64_t i = 0; i < f->count; i++) {
        int found = 0;
        for (int attempt = 0; attempt < TRIES && !found; attempt++)
            found = draw_axis(f, &state, axes + i) && fits(f, axes, i, axes + i);
        if (!found)
            return skg_fail(SKG_ERR_MESH,
                            "fibres: no place is left after %" PRId64 " of %" PRId64
                            "; give fewer or thinner ones, or a smaller "
                            "tilt",
                            i, f->count);
    }
    return SKG_OK;
}

/* A tube whose ends lie in the faces of the box. Its section across the axis is a circle. */
static void add_fibre(const skg_fibres *f, const axis *one, skg_mesh_arrays *arrays) {
    const int64_t first = arrays->vertices, n = f->segments;
    const double steep = hypot(one->slope[0], one->slope[1]), longer = sqrt(1 + steep * steep);
    const double u[2] = {steep > 0 ? one->slope[0] / steep : 1, steep > 0 ? one->slope[1] / steep : 0};
    for (int end = -1; end <= 1; end += 2) {
        const double z = 0.5 * end * f->box[2], x = one->at[0] + one->slope[0] * z,
                     y = one->at[1] + one->slope[1] * z;
        skg_add_vertex(arrays, x, y, z);
        for (int64_t s = 0; s < n; s++) {
            const double angle = 2 * SKG_PI * (double)s / (double)n;
            const double along = f->radius_mm * longer * cos(angle), across = f->radius_mm * sin(angle);
            skg_add_vertex(arrays, x + along * u[0] - across * u[1], y + along * u[1] + across * u[0], z);
        }
    }
    const int64_t upper = first + n + 1;
    skg_add_fan(arrays, first, first + 1, n, 0);
    skg_add_wall(arrays, first + 1, upper + 1, n);
    skg_add_fan(arrays, upper, upper + 1, n, 1);
}

skg_status skg_mesh_create_fibres(const skg_fibres *fibres, skg_mesh **mesh) {
    SKG_PLAIN;
    skg_fibres ours;
    axis *axes = NULL;
    skg_mesh_arrays arrays = {0};
    skg_fibres_init(&ours);
    SKG_NEEDS(fibres);
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(skg_struct_read(fibres, "skg_fibres", &ours, sizeof ours));
    for (int k = 0; k < 3; k++) SKG_TRY(skg_check_length(shape, "edge of the box", ours.box[k]));
    SKG_TRY(skg_check_length(shape, "radius", ours.radius_mm));
    SKG_TRY(skg_check_count(shape, "fibres", ours.count, 1, FIBRES_MAX));
    SKG_TRY(skg_check_count(shape, "segments", ours.segments, 3, 1000));
    if (!(ours.gap_mm >= 0 && isfinite(ours.gap_mm)))
        return skg_fail(SKG_ERR_ARGUMENT, "fibres: gap %g mm: 0 or more", ours.gap_mm);
    if (!(ours.tilt_deg >= 0 && ours.tilt_deg <= 60))
        return skg_fail(SKG_ERR_ARGUMENT, "fibres: tilt %g degrees: 0 to 60", ours.tilt_deg);
    SKG_TRY(skg_alloc(ours.count, sizeof *axes, shape, &axes));
    skg_status status = place(&ours, axes);
    SKG_TRY_CLEANUP(status);
    SKG_TRY_CLEANUP(skg_pieces_start(shape, ours.count * 2 * (ours.segments + 1),
                                     ours.count * 4 * ours.segments, &arrays));
    for (int64_t i = 0; i < ours.count; i++) add_fibre(&ours, axes + i, &arrays);
    status = skg_mesh_adopt(NULL, shape, &arrays, mesh);
cleanup:
    skg_free(&axes);
    return status;
}
