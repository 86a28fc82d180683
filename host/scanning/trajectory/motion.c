/* How source and detector are displaced from the ideal rotation. */
#include "core/maths.h"
#include "core/text.h"
#include "scene/curve.h"
#include "trajectory/types.h"

#include <skiagraph/scene.h>

#include <inttypes.h>
#include <math.h>

void skg_scan_options_init_sized(void *options, int32_t size) {
    const skg_scan_options defaults = {.projections = 1, .axis = {0, 0, 1}};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

void skg_scan_turn(const double *axis, const double *centre, double angle, int is_detector_fixed,
                   skg_view *view) {
    double turn[16];
    double *points[] = {view->source, view->centre}, *steps[] = {view->column_step, view->row_step};
    skg_pose_rotation(angle, axis, turn);
    for (int k = 0; k < (is_detector_fixed ? 1 : 2); k++) {
        const int is_point = k == 1 || view->projection != SKG_PROJECTION_PARALLEL_FROM_INFINITY;
        if (is_point) skg_add_scaled(points[k], -1, centre, points[k]);
        skg_pose_point(turn, points[k], points[k]);
        if (is_point) skg_add_scaled(points[k], 1, centre, points[k]);
    }
    for (int k = 0; k < 2 && !is_detector_fixed; k++) skg_pose_point(turn, steps[k], steps[k]);
}

/* Moves the detector. The rays of a parallel beam go from the source to the detector's centre: a displaced detector does not turn
 * them, so the point that stands for the source goes along. */
static void move_detector(double factor, const double *way, skg_view *view) {
    skg_add_scaled(view->centre, factor, way, view->centre);
    if (view->projection == SKG_PROJECTION_PARALLEL) skg_add_scaled(view->source, factor, way, view->source);
}

/* Moves a curved detector along its cylinder, which stays where it is. */
static void slide_detector(double way, skg_view *view) {
    skg_curvature curve;
    double to[3];
    const double width = skg_length(view->column_step), angle = way / view->radius;
    skg_curvature_find(view, NULL, &curve);
    skg_view_pixel(view, 0.5 * (double)(view->columns - 1) + way / width, 0.5 * (double)(view->rows - 1), to);
    skg_add_scaled(to, -1, view->centre, to);
    move_detector(1, to, view);
    skg_scale_vector(width * cos(angle), curve.across, view->column_step);
    skg_add_scaled(view->column_step, width * sin(angle), curve.normal, view->column_step);
}

void skg_scan_displace_detector(const skg_scan_options *options, skg_view *view) {
    double axes[3][3], turn[16];
    skg_scale_vector(1 / skg_length(view->column_step), view->column_step, axes[0]);
    skg_scale_vector(1 / skg_length(view->row_step), view->row_step, axes[1]);
    skg_cross(axes[0], axes[1], axes[2]);
    skg_scale_vector(1 / skg_length(axes[2]), axes[2], axes[2]);
    if (view->radius > 0 && options->detector_offset_mm[0] != 0)
        slide_detector(options->detector_offset_mm[0], view);
    else
        move_detector(options->detector_offset_mm[0], axes[0], view);
    move_detector(options->detector_offset_mm[1], axes[1], view);
    if (options->detector_skew_rad != 0) {
        const double length = skg_length(view->row_step), lean = options->detector_skew_rad;
        skg_scale_vector(cos(lean), view->row_step, view->row_step);
        skg_add_scaled(view->row_step, length * sin(lean), axes[0], view->row_step);
    }
    for (int k = 0; k < 3; k++) {
        if (options->detector_tilt_rad[k] == 0) continue;
        skg_pose_rotation(options->detector_tilt_rad[k], axes[k], turn);
        skg_pose_point(turn, view->column_step, view->column_step);
        skg_pose_point(turn, view->row_step, view->row_step);
    }
}

/* A normal deviate of mean 0 and variance 1 (Box and Muller) for quantity `which` of a projection. */
static double normal(const skg_scan_options *options, int64_t index, int which) {
    enum { QUANTITIES = 8 };
    uint64_t state = (uint64_t)options->jitter_seed;
    state = (uint64_t)(skg_draw(&state) * 0x1p53) ^ ((uint64_t)index * QUANTITIES + (uint64_t)which) << 8;
    skg_draw(&state);
    const double u = 1 - skg_draw(&state), v = skg_draw(&state);
    return sqrt(-2 * log(u)) * cos(2 * SKG_PI * v);
}

double skg_scan_angle_error(const skg_scan_options *options, int64_t index) {
    return options->angle_jitter_rad > 0 ? options->angle_jitter_rad * normal(options, index, 6) : 0;
}

void skg_scan_disturb(const skg_scan_options *options, double position, int64_t index, skg_view *view) {
    const int has_point = view->projection != SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    const double share = options->projections > 1 ? position / (double)(options->projections - 1) : 0;
    const double travelled = options->projections > 1 ? share - 0.5 : 0;
    if (has_point) {
        skg_add_scaled(view->source, travelled, options->source_travel_mm, view->source);
        skg_add_scaled(view->source, share, options->source_drift_mm, view->source);
    }
    move_detector(share, options->detector_drift_mm, view);
    for (int k = 0; k < 3; k++) {
        if (options->source_jitter_mm > 0 && has_point)
            view->source[k] += options->source_jitter_mm * normal(options, index, k);
        const double axis[3] = {k == 0, k == 1, k == 2};
        if (options->detector_jitter_mm > 0)
            move_detector(options->detector_jitter_mm * normal(options, index, 3 + k), axis, view);
    }
}

skg_status skg_scan_check_options(const skg_scan_options *o) {
    const double *finite[] = {
        &o->start_rad, &o->step_rad, &o->pitch_mm, &o->detector_offset_mm[0], &o->detector_offset_mm[1],
        &o->start_s};
    int are_finite = skg_all_finite(o->axis, 3) && skg_all_finite(o->centre, 3) &&
                     skg_all_finite(o->source_travel_mm, 3) && skg_all_finite(o->source_drift_mm, 3) &&
                     skg_all_finite(o->detector_drift_mm, 3) && skg_all_finite(o->detector_tilt_rad, 3);
    for (size_t i = 0; i < sizeof finite / sizeof *finite; i++) are_finite &= isfinite(*finite[i]) != 0;
    if (!are_finite) return skg_fail(SKG_ERR_ARGUMENT, "scan: an angle, length or time is not finite");
    if (o->projections < 1 || o->projections > SKG_SCAN_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "scan: %" PRId64 " projections; give 1 to %d", o->projections,
                        SKG_SCAN_MAX);
    if (!(skg_length(o->axis) > 0)) return skg_fail(SKG_ERR_ARGUMENT, "scan: the axis has no length");
    if (!(fabs(o->detector_skew_rad) <= 1.2))
        return skg_fail(SKG_ERR_ARGUMENT, "scan: a skew of %g rad; give -1.2 to 1.2", o->detector_skew_rad);
    if (!(o->source_jitter_mm >= 0 && o->detector_jitter_mm >= 0 && o->angle_jitter_rad >= 0) ||
        isinf(o->source_jitter_mm + o->detector_jitter_mm + o->angle_jitter_rad))
        return skg_fail(SKG_ERR_ARGUMENT, "scan: a jitter is negative or not finite");
    if (!(o->interval_s >= 0) || isinf(o->interval_s))
        return skg_fail(SKG_ERR_ARGUMENT, "scan: %g s from one projection to the next; give 0 or more",
                        o->interval_s);
    if (!(o->exposure_s >= 0 && o->exposure_s <= o->interval_s))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "scan: an exposure of %g s; it may last from 0 to the %g s until the next projection",
                        o->exposure_s, o->interval_s);
    return SKG_OK;
}

/* Distance of a point from the axis. */
static double radius_of(const skg_scan_options *options, const double *axis, const double *point) {
    double from[3];
    skg_add_scaled(point, -1, options->centre, from);
    skg_add_scaled(from, -skg_dot(from, axis), axis, from);
    return skg_length(from);
}

skg_status skg_scan_short_range_get(const skg_view *view, const skg_scan_options *options,
                                    double *range_rad) {
    SKG_PLAIN;
    skg_scan_options o;
    skg_view v;
    double axis[3], to_axis[3], widest = 0;
    SKG_NEEDS(range_rad);
    skg_scan_options_init(&o);
    SKG_TRY(skg_struct_read(options, "skg_scan_options", &o, sizeof o));
    SKG_TRY(skg_scan_check_options(&o));
    SKG_TRY(skg_view_check(view));
    skg_view_init(&v);
    SKG_TRY(skg_struct_read(view, "skg_view", &v, sizeof v));
    skg_scan_displace_detector(&o, &v);
    skg_scale_vector(1 / skg_length(o.axis), o.axis, axis);
    if (v.projection != SKG_PROJECTION_POINT || !(radius_of(&o, axis, v.source) > 0))
        return skg_fail(SKG_ERR_SCENE, "a short scan needs a point source that is not on the axis");
    skg_add_scaled(o.centre, -1, v.source, to_axis);
    skg_add_scaled(to_axis, -skg_dot(to_axis, axis), axis, to_axis);
    for (int corner = 0; corner < 4; corner++) {
        double ray[3], across[3];
        skg_view_pixel(&v, corner & 1 ? (double)v.columns - 0.5 : -0.5,
                       corner & 2 ? (double)v.rows - 0.5 : -0.5, ray);
        skg_add_scaled(ray, -1, v.source, ray);
        skg_add_scaled(ray, -skg_dot(ray, axis), axis, ray);
        skg_cross(ray, to_axis, across);
        widest = fmax(widest, fabs(atan2(skg_dot(across, axis), skg_dot(ray, to_axis))));
    }
    *range_rad = SKG_PI + 2 * widest;
    return SKG_OK;
}
