#include "scene/view.h"

#include "scene/vector.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { LARGEST_SIDE = 32768 };

/* Sines and relative distances below this are degenerate: single precision could not tell the pixels apart
 * long before. */
static const double DEGENERATE = 1e-9;

/* mm: 1000 km, far beyond any set-up and far below what squares and products of lengths can hold. */
static const double LARGEST_LENGTH = 1e9;

void skg_view_init(skg_view *view) {
    if (view) *view = (skg_view){.size = sizeof *view};
}

static skg_status check_vector(const char *what, const double *v) {
    if (!skg_all_finite(v, 3)) return skg_fail(SKG_ERR_SCENE, "the %s is not finite", what);
    for (int k = 0; k < 3; k++)
        if (fabs(v[k]) > LARGEST_LENGTH)
            return skg_fail(SKG_ERR_SCENE,
                            "the %s has an entry of %g mm, which is too large; %g is the limit", what, v[k],
                            LARGEST_LENGTH);
    return SKG_OK;
}

static skg_status check_numbers(const skg_view *view) {
    if (view->projection != SKG_POINT && view->projection != SKG_PARALLEL &&
        view->projection != SKG_PARALLEL_FROM_INFINITY)
        return skg_fail(SKG_ERR_SCENE, "the view's projection is %" PRId32 "; SKG_POINT is %d",
                        view->projection, SKG_POINT);
    if (view->columns < 1 || view->rows < 1 || view->columns > LARGEST_SIDE || view->rows > LARGEST_SIDE)
        return skg_fail(SKG_ERR_SCENE,
                        "the detector has %" PRId64 " columns and %" PRId64
                        " rows; 1 to %d of each can be imaged",
                        view->columns, view->rows, LARGEST_SIDE);
    if (view->projection != SKG_PARALLEL_FROM_INFINITY)
        SKG_TRY(check_vector("source's position", view->source));
    else if (!skg_all_finite(view->source, 3))
        return skg_fail(SKG_ERR_SCENE, "the beam's direction is not finite");
    SKG_TRY(check_vector("detector's position", view->centre));
    SKG_TRY(check_vector("detector's column step", view->column_step));
    SKG_TRY(check_vector("detector's row step", view->row_step));
    return SKG_OK;
}

/* Steps, pixel (0, 0) and normal (not yet turned away from the source). */
static skg_status prepare_detector(const skg_view *view, skg_view_frame *frame) {
    memcpy(frame->du, view->column_step, sizeof frame->du);
    memcpy(frame->dv, view->row_step, sizeof frame->dv);
    double width = skg_length(frame->du), height = skg_length(frame->dv);
    if (!(width > 0) || !(height > 0))
        return skg_fail(SKG_ERR_SCENE,
                        "the detector has no size: its pixels are %g mm wide and %g mm high; both have to be "
                        "above 0",
                        width, height);
    skg_cross(frame->du, frame->dv, frame->normal);
    double area = skg_length(frame->normal);
    if (!(area > DEGENERATE * width * height))
        return skg_fail(
            SKG_ERR_SCENE,
            "the detector's rows and columns run in the same direction (%g, %g, %g); up and right "
            "must not be parallel",
            frame->du[0] / width, frame->du[1] / width, frame->du[2] / width);
    skg_scale_vector(1 / area, frame->normal, frame->normal);
    skg_add_scaled(view->centre, -0.5 * (double)(view->columns - 1), frame->du, frame->pixel0);
    skg_add_scaled(frame->pixel0, -0.5 * (double)(view->rows - 1), frame->dv, frame->pixel0);
    return SKG_OK;
}

/* How far the farthest corner pixel is from a point. */
static double farthest_corner(const skg_view_frame *frame, const double *from) {
    double farthest = 0;
    for (int k = 0; k < 4; k++) {
        double corner[3];
        skg_add_scaled(frame->pixel0, k & 1 ? (double)(frame->columns - 1) : 0, frame->du, corner);
        skg_add_scaled(corner, k & 2 ? (double)(frame->rows - 1) : 0, frame->dv, corner);
        skg_add_scaled(corner, -1, from, corner);
        farthest = fmax(farthest, skg_length(corner));
    }
    return farthest;
}

static skg_status prepare_point(const skg_view *view, skg_view_frame *frame) {
    memcpy(frame->origin, view->source, sizeof frame->origin);
    skg_add_scaled(frame->pixel0, -1, view->source, frame->d0);
    double distance = fabs(skg_dot(frame->normal, frame->d0));
    if (!(distance > DEGENERATE * farthest_corner(frame, view->source)))
        return skg_fail(SKG_ERR_SCENE,
                        "the source (%g, %g, %g) mm lies on the detector or in its plane; move it out of the "
                        "plane",
                        view->source[0], view->source[1], view->source[2]);
    return SKG_OK;
}

static skg_status prepare_parallel(const skg_view *view, skg_view_frame *frame) {
    int from_infinity = view->projection == SKG_PARALLEL_FROM_INFINITY;
    double direction[3];
    if (from_infinity)
        memcpy(direction, view->source, sizeof direction);
    else
        skg_add_scaled(view->centre, -1, view->source, direction);
    /* Scaled first: a direction may be of any length, and its square need not be a number. */
    double largest = fmax(fabs(direction[0]), fmax(fabs(direction[1]), fabs(direction[2])));
    if (largest > 0) skg_scale_vector(1 / largest, direction, direction);
    double length = skg_length(direction);
    if (!(length > 0))
        return skg_fail(SKG_ERR_SCENE,
                        from_infinity ? "the beam's direction is (0, 0, 0); give it a length"
                                      : "the source is at the detector's centre, so the parallel beam has "
                                        "no direction; move it away");
    frame->parallel = 1;
    skg_scale_vector(1 / length, direction, frame->d0);
    memcpy(frame->origin, frame->pixel0, sizeof frame->origin);
    if (!(fabs(skg_dot(frame->normal, frame->d0)) > DEGENERATE))
        return skg_fail(
            SKG_ERR_SCENE,
            "the detector stands edge-on to the beam, which runs along (%g, %g, %g); turn it towards the beam",
            frame->d0[0], frame->d0[1], frame->d0[2]);
    if (from_infinity) {
        frame->start[0] = -HUGE_VAL;
        return SKG_OK;
    }
    double way[3];
    skg_add_scaled(frame->pixel0, -1, view->source, way);
    frame->start[0] = -skg_dot(way, frame->d0);
    frame->start[1] = -skg_dot(frame->du, frame->d0);
    frame->start[2] = -skg_dot(frame->dv, frame->d0);
    return SKG_OK;
}

/* Rows of the inverse of [a b c] are b x c, c x a, a x b over the determinant. */
static skg_status invert(skg_view_frame *frame) {
    skg_cross(frame->dv, frame->d0, frame->m);
    skg_cross(frame->d0, frame->du, frame->m + 3);
    skg_cross(frame->du, frame->dv, frame->m + 6);
    double determinant = skg_dot(frame->m + 6, frame->d0);
    for (int k = 0; k < 9; k++) frame->m[k] /= determinant;
    if (!skg_all_finite(frame->m, 9))
        return skg_fail(SKG_ERR_SCENE, "the detector's pixels are too small to compute with; give mm");
    return SKG_OK;
}

skg_status skg_view_prepare(const skg_view *view, skg_view_frame *frame) {
    skg_view ours;
    skg_view_init(&ours);
    SKG_TRY(skg_struct_read(view, "skg_view", &ours, sizeof ours));
    *frame = (skg_view_frame){.columns = ours.columns, .rows = ours.rows};
    SKG_TRY(check_numbers(&ours));
    SKG_TRY(prepare_detector(&ours, frame));
    if (ours.projection == SKG_POINT)
        SKG_TRY(prepare_point(&ours, frame));
    else
        SKG_TRY(prepare_parallel(&ours, frame));
    if (skg_dot(frame->normal, frame->d0) < 0) skg_scale_vector(-1, frame->normal, frame->normal);
    return invert(frame);
}

skg_status skg_view_check(const skg_view *view) {
    skg_view_frame frame;
    return skg_view_prepare(view, &frame);
}

void skg_view_project(const skg_view_frame *frame, const double *x, double *h) {
    double v[3];
    skg_add_scaled(x, -1, frame->origin, v);
    for (int k = 0; k < 3; k++) h[k] = skg_dot(frame->m + 3 * k, v);
}

double skg_view_distance(const skg_view_frame *frame, double i, double j) {
    if (frame->parallel) return 1;
    double d[3];
    skg_add_scaled(frame->d0, i, frame->du, d);
    skg_add_scaled(d, j, frame->dv, d);
    return skg_length(d);
}

double skg_view_start(const skg_view_frame *frame, double i, double j) {
    return frame->start[0] + i * frame->start[1] + j * frame->start[2];
}
