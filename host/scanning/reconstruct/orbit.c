/* How the views of a scan go about its axis, and how much each ray counts. */
#include "reconstruct/orbit.h"

#include "core/maths.h"
#include "scene/curve.h"

#include <math.h>
#include <string.h>

/* For helical scans, laminography and tables. */
#define SKG_OTHER_TOOLS                                                                                                               \
    "; for other scans, `skiagraph scan SCENE --geometry FILE` writes .xml for RTK, .csv for ASTRA, .tigre.py for TIGRE and .cil.py " \
    "for CIL"

/* The sine of the largest angle by which rows, detector or beam lean against the plane across the axis, 5.74 degrees: the mean of
 * a ball of 80 mm before a source at 400 mm is then 0.7 % too low; at 15 degrees 3.6 %. */
static const double max_lean = 0.1;

static void normalise(double *v) {
    skg_scale_vector(1 / skg_length(v), v, v);
}

/* The direction from the source to the axis, and their distance. */
static skg_status find_forward(const skg_fdk_options *o, const double *axis, int64_t index,
                               skg_orbit_pose *pose) {
    const skg_view *view = &pose->view;
    double *to = pose->forward;
    pose->is_parallel = view->projection != SKG_PROJECTION_POINT;
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        skg_scale_vector(1, view->source, to);
    else
        skg_add_scaled(pose->is_parallel ? view->centre : o->centre, -1, view->source, to);
    skg_add_scaled(to, -skg_dot(to, axis), axis, to);
    pose->radius = pose->is_parallel ? 0 : skg_length(to);
    if (!(skg_length(to) > 0))
        return skg_fail(SKG_ERR_UNSUPPORTED, "projection %lld: the beam runs along the axis",
                        (long long)index);
    normalise(to);
    memcpy(pose->centre, o->centre, sizeof pose->centre);
    return SKG_OK;
}

/* The sine of the angle between a direction and the plane across the axis. */
static double lean_of(const double *axis, const double *direction) {
    return skg_dot(axis, direction) / skg_length(direction);
}

/* The lean of the ray that is nearest to the plane across the axis: 0 if some rows of the detector are on each side. */
static double lean_of_beam(const double *axis, const skg_orbit_pose *pose) {
    const skg_view *view = &pose->view;
    double first[3], last[3], beam[3];
    if (pose->is_parallel) {
        const int is_infinite = view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY;
        skg_scale_vector(1, is_infinite ? view->source : view->centre, beam);
        if (!is_infinite) skg_add_scaled(beam, -1, view->source, beam);
        return lean_of(axis, beam);
    }
    skg_orbit_ray(pose, 0, view->columns / 2, first);
    skg_orbit_ray(pose, view->rows - 1, view->columns / 2, last);
    const double one = lean_of(axis, first), other = lean_of(axis, last);
    return one * other <= 0 ? 0 : fmin(fabs(one), fabs(other));
}

static skg_status check_lean(double lean, const char *what, int64_t index) {
    if (fabs(lean) <= max_lean) return SKG_OK;
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "projection %lld: %s by %.3g degrees; the method of Feldkamp takes up to %.3g" SKG_OTHER_TOOLS,
        (long long)index, what, asin(fmin(fabs(lean), 1)) * 180 / SKG_PI, asin(max_lean) * 180 / SKG_PI);
}

/* Refuses an axis that leans against the detector or the beam. */
static skg_status check_leans(const double *axis, int64_t index, const skg_orbit_pose *pose) {
    const skg_view *view = &pose->view;
    double normal[3];
    skg_cross(view->column_step, view->row_step, normal);
    SKG_TRY(check_lean(lean_of(axis, view->column_step),
                       "the rows of the detector do not run across the axis of rotation but lean", index));
    if (!pose->is_parallel)
        SKG_TRY(check_lean(lean_of(axis, normal), "the axis of rotation leans out of the detector's plane",
                           index));
    return check_lean(lean_of_beam(axis, pose), "the beam passes the plane across the axis of rotation",
                      index);
}

/* The angle of a column of a curved detector, whose axis has to go through the source: only then columns are at equal angles. */
static skg_status find_fan(int64_t index, skg_orbit_pose *pose) {
    static const double OFF = 1e-6; /* of the radius */
    skg_curvature curve;
    pose->fan_step = 0;
    if (!(pose->view.radius > 0)) return SKG_OK;
    skg_curvature_find(&pose->view, NULL, &curve);
    if (curve.parallel || hypot(curve.distance - curve.radius, curve.side) > OFF * curve.radius)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "projection %lld: the axis of the curved detector does not go through the source, so that its "
            "columns are not at equal angles; only such ones are reconstructed",
            (long long)index);
    pose->fan_step = curve.angle;
    return SKG_OK;
}

/* How the rows of a flat detector run past the source: seen along the axis, each row is a straight line across `depth`, whatever angle the
 * detector is turned by about the axis. */
static skg_status find_rows(const double *axis, int64_t index, skg_orbit_pose *pose) {
    const skg_view *view = &pose->view;
    double to_detector[3], along_row[3];
    skg_add_scaled(view->column_step, -skg_dot(view->column_step, axis), axis, along_row);
    skg_cross(axis, along_row, pose->depth);
    normalise(pose->depth);
    const int is_behind = skg_dot(pose->depth, pose->forward) < 0;
    skg_scale_vector(is_behind ? -1 : 1, pose->depth, pose->depth);
    skg_add_scaled(view->centre, -1, view->source, to_detector);
    pose->spacing = skg_length(along_row);
    if (skg_dot(to_detector, pose->forward) > 0 && skg_dot(to_detector, pose->depth) > 0) return SKG_OK;
    return skg_fail(SKG_ERR_UNSUPPORTED, "projection %lld: the detector is not behind the axis",
                    (long long)index);
}

/* The distance of the columns. */
static skg_status find_spacing(const double *axis, int64_t index, skg_orbit_pose *pose) {
    SKG_TRY(find_fan(index, pose));
    SKG_TRY(check_leans(axis, index, pose));
    pose->spacing = fabs(skg_dot(pose->view.column_step, pose->across));
    if (!pose->is_parallel) SKG_TRY(find_rows(axis, index, pose));
    if (pose->fan_step > 0) pose->spacing = pose->radius * pose->fan_step;
    return SKG_OK;
}

skg_status skg_orbit_pose_get(skg_scan *scan, const skg_fdk_options *o, const skg_orbit *orbit, int64_t index,
                              skg_orbit_pose *pose) {
    skg_orbit_pose first = {0};
    double turned[3];
    pose->index = index;
    skg_view_init(&pose->view);
    skg_view_init(&first.view);
    SKG_TRY(skg_scan_view_get(scan, index, &pose->view));
    SKG_TRY(skg_scan_view_get(scan, 0, &first.view));
    SKG_TRY(find_forward(o, orbit->axis, 0, &first));
    SKG_TRY(find_forward(o, orbit->axis, index, pose));
    skg_cross(orbit->axis, pose->forward, pose->across);
    skg_cross(first.forward, pose->forward, turned);
    pose->angle = atan2(skg_dot(turned, orbit->axis), skg_dot(first.forward, pose->forward));
    if (pose->angle < -1e-9) pose->angle += 2 * SKG_PI;
    return find_spacing(orbit->axis, index, pose);
}

void skg_orbit_ray(const skg_orbit_pose *pose, int64_t row, int64_t column, double *ray) {
    const skg_view *view = &pose->view;
    if (pose->is_parallel) {
        skg_scale_vector(1, pose->forward, ray);
        return;
    }
    if (pose->fan_step > 0) {
        skg_view_pixel(view, (double)column, (double)row, ray);
    } else {
        skg_add_scaled(view->centre, (double)column - 0.5 * (double)(view->columns - 1), view->column_step,
                       ray);
        skg_add_scaled(ray, (double)row - 0.5 * (double)(view->rows - 1), view->row_step, ray);
    }
    skg_add_scaled(ray, -1, view->source, ray);
}

static double fan_angle(const skg_orbit_pose *pose, const double *ray) {
    return atan2(skg_dot(ray, pose->across), skg_dot(ray, pose->forward));
}

double skg_orbit_place(const skg_orbit_pose *pose, int64_t row, int64_t column) {
    const skg_view *view = &pose->view;
    double ray[3];
    if (!pose->is_parallel) {
        skg_orbit_ray(pose, row, column, ray);
        return fan_angle(pose, ray);
    }
    skg_add_scaled(view->centre, (double)column - 0.5 * (double)(view->columns - 1), view->column_step, ray);
    skg_add_scaled(ray, (double)row - 0.5 * (double)(view->rows - 1), view->row_step, ray);
    skg_add_scaled(ray, -1, pose->centre, ray);
    return skg_dot(ray, pose->across);
}

double skg_orbit_radius(const skg_orbit_pose *pose, double place) {
    return fabs(pose->is_parallel ? place : pose->radius * sin(place));
}

/* The widest fan of a projection, from the corners of its detector. */
static double widest(const skg_orbit_pose *pose) {
    double angle = 0, ray[3];
    for (int corner = 0; corner < 4; corner++) {
        skg_orbit_ray(pose, corner & 1 ? pose->view.rows - 1 : 0, corner & 2 ? pose->view.columns - 1 : 0,
                      ray);
        angle = fmax(angle, fabs(fan_angle(pose, ray)));
    }
    return angle;
}

/* Which way round: the axis is turned so that the second projection is less than half a turn on. */
static skg_status orient(skg_scan *scan, const skg_fdk_options *o, skg_orbit *orbit, int64_t count) {
    skg_orbit_pose pose = {0};
    skg_scale_vector(1 / skg_length(o->axis), o->axis, orbit->axis);
    if (count < 2) return skg_fail(SKG_ERR_UNSUPPORTED, "a reconstruction needs two or more projections");
    SKG_TRY(skg_orbit_pose_get(scan, o, orbit, 1, &pose));
    if (pose.angle > SKG_PI) {
        skg_scale_vector(-1, orbit->axis, orbit->axis);
        SKG_TRY(skg_orbit_pose_get(scan, o, orbit, 1, &pose));
    }
    orbit->step = pose.angle;
    orbit->range = pose.angle * (double)(count - 1);
    orbit->fan = widest(&pose);
    if (!(orbit->step > 0)) return skg_fail(SKG_ERR_UNSUPPORTED, "the scan does not turn about the axis");
    return SKG_OK;
}

/* How far up the axis the ray to the middle of the detector crosses it. row: result: the height of a row there; both mm */
static double find_height(const skg_orbit_pose *pose, const double *axis, double *row) {
    const skg_view *view = &pose->view;
    double to_detector[3];
    *row = fabs(skg_dot(view->row_step, axis));
    if (pose->is_parallel) return skg_dot(view->centre, axis);
    skg_add_scaled(view->centre, -1, view->source, to_detector);
    const double share = pose->radius / skg_dot(to_detector, pose->forward);
    *row *= share;
    return skg_dot(view->source, axis) + share * skg_dot(to_detector, axis);
}

/* Refuses helices. Each mm along the axis takes as much from the slices that all projections see: of 48 rows, 0.8 mm high at the
 * axis, the slice 15 mm from the middle of a cylinder of 0.2 per cm has 0.200 in a circle, and 0.126, 0.084 and 0.051 with a pitch of 6, 9
 * and 15 mm. range: of the heights so far */
static skg_status check_height(const skg_orbit *orbit, const skg_orbit_pose *pose, int64_t index,
                               double range[2]) {
    static const double SHARE = 0.02; /* of all rows: what tables of a circle that wobbles may have */
    double row = 0;
    const double height = find_height(pose, orbit->axis, &row);
    const double most = row * fmax(1, SHARE * (double)pose->view.rows);
    range[0] = fmin(range[0], height), range[1] = fmax(range[1], height);
    if (range[1] - range[0] <= most) return SKG_OK;
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "projection %lld: the source leaves its circle: the scan has moved by %.3g mm along the axis of rotation, and up to "
        "%.3g mm are taken (a row, or 2 %% of all rows, as seen at the axis), for slices that some projections do not see "
        "are wrong" SKG_OTHER_TOOLS,
        (long long)index, range[1] - range[0], most);
}

/* Equal steps, and a source that stays in its plane. */
static skg_status check_circle(skg_scan *scan, const skg_fdk_options *o, const skg_orbit *orbit,
                               int64_t count) {
    double from[3], heights[2] = {HUGE_VAL, -HUGE_VAL};
    for (int64_t k = 0; k < count; k++) {
        skg_orbit_pose pose = {0};
        SKG_TRY(skg_orbit_pose_get(scan, o, orbit, k, &pose));
        SKG_TRY(check_height(orbit, &pose, k, heights));
        const double expected = fmod((double)k * orbit->step, 2 * SKG_PI);
        double off = fabs(pose.angle - expected);
        off = fmin(off, 2 * SKG_PI - off);
        skg_view first;
        skg_view_init(&first);
        SKG_TRY(skg_scan_view_get(scan, 0, &first));
        skg_add_scaled(pose.view.source, -1, first.source, from);
        const double lift = pose.is_parallel ? 0 : fabs(skg_dot(from, orbit->axis));
        if (off > 0.5 * orbit->step || lift > 0.05 * pose.radius)
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "projection %lld: the source leaves its circle, or angles are not evenly spaced; only "
                "circular scans are reconstructed" SKG_OTHER_TOOLS,
                (long long)k);
    }
    return SKG_OK;
}

/* Whether the detector of a full turn is displaced, and sees the axis. */
static skg_status find_displacement(skg_scan *scan, const skg_fdk_options *o, skg_orbit *orbit) {
    skg_orbit_pose pose = {0};
    SKG_TRY(skg_orbit_pose_get(scan, o, orbit, 0, &pose));
    const int64_t row = pose.view.rows / 2, last = pose.view.columns - 1;
    const double ends[2] = {skg_orbit_place(&pose, row, 0), skg_orbit_place(&pose, row, last)};
    orbit->low = fmin(ends[0], ends[1]), orbit->high = fmax(ends[0], ends[1]);
    const double column = (orbit->high - orbit->low) / fmax((double)last, 1), lean = orbit->low + orbit->high;
    orbit->displaced = !orbit->is_full || fabs(lean) <= column ? 0 : lean > 0 ? 1 : -1;
    if (!orbit->displaced || (-orbit->low > 2 * column && orbit->high > 2 * column)) return SKG_OK;
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "the detector does not see the axis of rotation with two columns beyond it, so that lines are missing; displace "
        "it less");
}

/* How often the scan sees its lines. A projection stands for half a step before and after it. */
static skg_status find_times(skg_scan *scan, const skg_fdk_options *o, skg_orbit *orbit) {
    static const double ROUNDING = 1e-6; /* of a step: angles of a table have some ten digits */
    skg_orbit_pose pose = {0};
    SKG_TRY(skg_orbit_pose_get(scan, o, orbit, 0, &pose));
    const double seen = orbit->range + orbit->step, close = 0.5 * orbit->step;
    orbit->is_parker = !orbit->is_full && !pose.is_parallel;
    orbit->period = pose.is_parallel && !orbit->displaced ? SKG_PI : 2 * SKG_PI;
    orbit->times = fmax(1, floor((seen + close) / orbit->period));
    orbit->excess = seen - orbit->times * orbit->period;
    if (orbit->excess < ROUNDING * orbit->step)
        orbit->excess = 0; /* up to half a step less: steps are stretched */
    return SKG_OK;
}

skg_status skg_orbit_find(skg_scan *scan, const skg_fdk_options *o, skg_orbit *orbit) {
    int64_t count = 0;
    SKG_TRY(skg_scan_projection_count(scan, &count));
    SKG_TRY(orient(scan, o, orbit, count));
    SKG_TRY(check_circle(scan, o, orbit, count));
    orbit->is_full = orbit->range + 1.5 * orbit->step > 2 * SKG_PI;
    const double least = SKG_PI + 2 * orbit->fan;
    if (!orbit->is_full && orbit->range + 1.5 * orbit->step < least)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "the scan has a range of %.4g degrees; a reconstruction needs 180 degrees plus the fan, %.4g" SKG_OTHER_TOOLS,
            orbit->range * 180 / SKG_PI, least * 180 / SKG_PI);
    SKG_TRY(find_displacement(scan, o, orbit));
    return find_times(scan, o, orbit);
}

/* The weight of a displaced detector: it rises from 0 at the near edge to 1 at the same distance on the wide side. */
static double displaced_share(const skg_orbit *orbit, double place) {
    const double overlap = fmin(-orbit->low, orbit->high), at = orbit->displaced * place / overlap;
    if (at <= -1) return 0;
    if (at >= 1) return 1;
    const double root = sin(SKG_PI / 4 * (1 + at));
    return root * root;
}

/* The integral up to an angle of a share that rises from 0 to 1 over the excess as the square of a sine. */
static double risen(double excess, double angle) {
    if (angle <= 0) return 0;
    if (angle >= excess) return angle - 0.5 * excess;
    return 0.5 * angle - 0.5 * excess / SKG_PI * sin(SKG_PI * angle / excess);
}

/* The share of a projection among those of its direction: where a scan goes on beyond a whole number of periods, the first and the last
 * ones share what both see. It is the mean over the projection's step, so that the shares of all add up exactly. */
static double share_of(const skg_orbit *orbit, int64_t index) {
    const double from_first = orbit->step * (double)index, from_last = orbit->range - from_first;
    const double near = fmin(from_first, from_last), one = SKG_PI / (orbit->period * orbit->times);
    if (!(orbit->excess > 0)) return SKG_PI / (orbit->range + orbit->step);
    return one * (risen(orbit->excess, near + orbit->step) - risen(orbit->excess, near)) / orbit->step;
}

/* Parker's weight. */
static double parker(const skg_orbit *orbit, const skg_orbit_pose *pose, const double *ray) {
    const double gamma = fan_angle(pose, ray), beta = pose->angle;
    const double delta = fmax(0.5 * (orbit->range - SKG_PI), fabs(gamma) + 1e-6);
    double share = 1;
    if (beta < 2 * (delta - gamma)) share = sin(SKG_PI / 4 * beta / (delta - gamma));
    if (beta > SKG_PI - 2 * gamma) share = sin(SKG_PI / 4 * (SKG_PI + 2 * delta - beta) / (delta + gamma));
    return share > 0 ? share * share : 0;
}

double skg_orbit_weight(const skg_orbit *orbit, const skg_orbit_pose *pose, const double *ray, double place) {
    if (orbit->is_parker) return parker(orbit, pose, ray);
    const double share = share_of(orbit, pose->index);
    return orbit->displaced ? 2 * share * displaced_share(orbit, place) : share;
}
