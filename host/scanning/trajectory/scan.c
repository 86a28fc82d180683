/* Scans as handles, and the view of a projection. */
#include "trajectory/types.h"

#include "core/maths.h"
#include "core/text.h"

#include <skiagraph/scene.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

static skg_status make(const skg_view *view, const skg_scan_options *options, skg_scan **result) {
    skg_scan_options ours;
    skg_view base;
    skg_scan_options_init(&ours);
    if (options) SKG_TRY(skg_struct_read(options, "skg_scan_options", &ours, sizeof ours));
    SKG_TRY(skg_scan_check_options(&ours));
    skg_view_init(&base);
    SKG_TRY(skg_struct_read(view, "skg_view", &base, sizeof base));
    SKG_TRY(skg_alloc(1, sizeof **result, "scan", result));
    skg_refs_init(&(*result)->refs);
    skg_scale_vector(1 / skg_length(ours.axis), ours.axis, ours.axis);
    (*result)->options = ours;
    (*result)->view = base;
    return SKG_OK;
}

skg_status skg_scan_create(const skg_view *view, const skg_scan_options *options, skg_scan **scan) {
    SKG_PLAIN;
    skg_view first;
    skg_scan *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS(scan);
    *scan = NULL;
    SKG_NEEDS(view);
    SKG_NEEDS(options);
    SKG_TRY(skg_view_check(view));
    SKG_TRY_CLEANUP(make(view, options, &made));
    skg_scan_displace_detector(&made->options, &made->view);
    skg_view_init(&first);
    SKG_TRY_CLEANUP(skg_scan_view_get(made, 0, &first));
    SKG_TRY_CLEANUP(skg_view_check(&first));
    *scan = made;
    return SKG_OK;
cleanup:
    skg_scan_release(&made);
    return status;
}

static void take_pose(const double *pose, skg_view *view) {
    memcpy(view->source, pose, sizeof view->source);
    memcpy(view->centre, pose + 3, sizeof view->centre);
    memcpy(view->column_step, pose + 6, sizeof view->column_step);
    memcpy(view->row_step, pose + 9, sizeof view->row_step);
}

static skg_status check_table(const skg_scan *scan) {
    for (int64_t k = 0; k < scan->options.projections; k++) {
        skg_view view = scan->view;
        take_pose(scan->poses + SKG_POSE_NUMBERS * k, &view);
        if (skg_view_check(&view) == SKG_OK) continue;
        char reason[512];
        strncpy(reason, skg_last_error(), sizeof reason - 1);
        reason[sizeof reason - 1] = '\0';
        return skg_fail(SKG_ERR_SCENE, "projection %" PRId64 " of the table of poses: %s", k, reason);
    }
    return SKG_OK;
}

skg_status skg_scan_create_table(const skg_view *view, const skg_scan_options *options, int64_t count,
                                 const double *poses, skg_scan **scan) {
    SKG_PLAIN;
    skg_scan *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS(scan);
    *scan = NULL;
    SKG_NEEDS(view);
    SKG_NEEDS(poses);
    if (count < 1 || count > SKG_SCAN_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "table of poses: %" PRId64 " projections; give 1 to %d", count,
                        SKG_SCAN_MAX);
    SKG_TRY_CLEANUP(make(view, options, &made));
    made->options.projections = count;
    SKG_TRY_CLEANUP(skg_alloc(count * SKG_POSE_NUMBERS, sizeof *made->poses, "table of poses", &made->poses));
    memcpy(made->poses, poses, (size_t)count * SKG_POSE_NUMBERS * sizeof *poses);
    SKG_TRY_CLEANUP(check_table(made));
    *scan = made;
    return SKG_OK;
cleanup:
    skg_scan_release(&made);
    return status;
}

skg_status skg_scan_create_subset(skg_scan *whole, int64_t count, const int64_t *indices, skg_scan **scan) {
    skg_scan *made = NULL;
    int64_t all = 0;
    skg_status status = SKG_OK;
    SKG_NEEDS(scan);
    *scan = NULL;
    SKG_NEEDS(indices);
    SKG_TRY(skg_scan_projection_count(whole, &all));
    if (count < 1)
        return skg_fail(SKG_ERR_ARGUMENT, "a scan of %" PRId64 " projections; give 1 or more", count);
    for (int64_t k = 0; k < count; k++)
        if (indices[k] < 0 || indices[k] >= all)
            return skg_fail(SKG_ERR_ARGUMENT,
                            "scan: no projection %" PRId64 "; projections are 0 to %" PRId64, indices[k],
                            all - 1);
    SKG_TRY_CLEANUP(skg_alloc(1, sizeof *made, "scan", &made));
    skg_refs_init(&made->refs);
    made->options = whole->options;
    made->options.projections = count;
    made->view = whole->view;
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *indices, "scan", &made->indices));
    memcpy(made->indices, indices, (size_t)count * sizeof *indices);
    skg_scan_retain(whole);
    made->whole = whole;
    *scan = made;
    return SKG_OK;
cleanup:
    skg_scan_release(&made);
    return status;
}

skg_status skg_scan_retain(skg_scan *scan) {
    SKG_NEEDS(scan);
    skg_ref(&scan->refs);
    return SKG_OK;
}

void skg_scan_release(skg_scan **scan) {
    if (!scan || !*scan) return;
    if (skg_unref(&(*scan)->refs)) {
        skg_scan_release(&(*scan)->whole);
        skg_free(&(*scan)->indices);
        skg_free(&(*scan)->poses);
        skg_free(scan);
    }
    *scan = NULL;
}

skg_status skg_scan_projection_count(const skg_scan *scan, int64_t *count) {
    SKG_NEEDS(scan);
    SKG_NEEDS(count);
    *count = scan->options.projections;
    return SKG_OK;
}

static skg_status check_index(const skg_scan *scan, int64_t index) {
    if (index >= 0 && index < scan->options.projections) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "scan: no projection %" PRId64 "; projections are 0 to %" PRId64, index,
                    scan->options.projections - 1);
}

static int64_t nearest(const skg_scan *scan, double position) {
    return (int64_t)fmax(0, fmin(floor(position + 0.5), (double)(scan->options.projections - 1)));
}

/* The view of the options' motion, without travel, drift and jitter of positions. */
static void turn_to(const skg_scan *scan, double position, skg_view *view) {
    const skg_scan_options *o = &scan->options;
    const double turned = position * o->step_rad + skg_scan_angle_error(o, nearest(scan, position));
    const double along = -o->pitch_mm * turned / (2 * SKG_PI);
    skg_scan_turn(o->axis, o->centre, -(o->start_rad + turned), o->detector_fixed, view);
    if (view->projection != SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        skg_add_scaled(view->source, along, o->axis, view->source);
    if (!o->detector_fixed) skg_add_scaled(view->centre, along, o->axis, view->centre);
}

static void view_at(const skg_scan *scan, double position, skg_view *view) {
    *view = scan->view;
    if (scan->poses) {
        take_pose(scan->poses + SKG_POSE_NUMBERS * nearest(scan, position), view);
        skg_scan_displace_detector(&scan->options, view);
    } else {
        turn_to(scan, position, view);
    }
    skg_scan_disturb(&scan->options, position, nearest(scan, position), view);
}

skg_status skg_scan_view_get(const skg_scan *scan, int64_t index, skg_view *view) {
    SKG_PLAIN;
    skg_view ours;
    SKG_NEEDS(scan);
    SKG_TRY(check_index(scan, index));
    if (scan->whole) return skg_scan_view_get(scan->whole, scan->indices[index], view);
    view_at(scan, (double)index, &ours);
    return skg_struct_write(&ours, sizeof ours, "skg_view", view);
}

skg_status skg_scan_view_at(const skg_scan *scan, double position, skg_view *view) {
    SKG_PLAIN;
    skg_view ours;
    SKG_NEEDS(scan);
    if (!(position >= -0.5 && position <= (double)scan->options.projections))
        return skg_fail(SKG_ERR_ARGUMENT, "scan: no position %g; positions are -0.5 to %" PRId64, position,
                        scan->options.projections);
    if (scan->whole) return skg_scan_view_get(scan->whole, scan->indices[nearest(scan, position)], view);
    view_at(scan, position, &ours);
    return skg_struct_write(&ours, sizeof ours, "skg_view", view);
}

skg_status skg_scan_angle_get(const skg_scan *scan, int64_t index, double *angle_rad) {
    SKG_PLAIN;
    SKG_NEEDS(scan);
    SKG_NEEDS(angle_rad);
    SKG_TRY(check_index(scan, index));
    if (scan->whole) return skg_scan_angle_get(scan->whole, scan->indices[index], angle_rad);
    *angle_rad = scan->options.start_rad + (double)index * scan->options.step_rad;
    return SKG_OK;
}

skg_status skg_scan_axis_get(const skg_scan *scan, double *axis, double *centre) {
    SKG_NEEDS(scan);
    SKG_NEEDS(axis);
    SKG_NEEDS(centre);
    if (skg_scan_is_table(scan))
        return skg_fail(SKG_ERR_UNSUPPORTED, "the scan is a table of poses, which has no axis");
    while (scan->whole) scan = scan->whole;
    memcpy(axis, scan->options.axis, sizeof scan->options.axis);
    memcpy(centre, scan->options.centre, sizeof scan->options.centre);
    return SKG_OK;
}

skg_status skg_scan_time_get(const skg_scan *scan, int64_t index, double *middle_s, double *exposure_s) {
    SKG_PLAIN;
    SKG_NEEDS(scan);
    SKG_NEEDS(middle_s);
    SKG_TRY(check_index(scan, index));
    if (scan->whole) return skg_scan_time_get(scan->whole, scan->indices[index], middle_s, exposure_s);
    *middle_s = scan->options.start_s + (double)index * scan->options.interval_s;
    if (exposure_s) *exposure_s = scan->options.exposure_s;
    return SKG_OK;
}
