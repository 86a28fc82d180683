/* Functions that the writers of geometries share. */
#include "core/maths.h"
#include "trajectory/writers.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* The largest cosine between the detector's steps that counts as a right angle, and the largest relative difference
 * between pixels that counts as none. */
static const double max_skew = 1e-6, max_difference = 1e-9;

void skg_tool_world_init(skg_tool_world *world) {
    *world = (skg_tool_world){.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

/* At angle 0. A table of poses has it if it names a rotation: its first pose, turned back. */
static int find_first(const skg_scan *scan, skg_view *view) {
    double angle = 0;
    skg_view_init(view);
    *view = scan->view;
    if (!skg_scan_is_table(scan)) return 1;
    if (!(fabs(scan->options.step_rad) > 0)) return 0;
    if (skg_scan_view_get(scan, 0, view) != SKG_OK || skg_scan_angle_get(scan, 0, &angle) != SKG_OK) return 0;
    skg_scan_turn(scan->options.axis, scan->options.centre, angle, 0, view);
    return 1;
}

int skg_tool_find_turn(const skg_scan *scan, skg_tool_turn *turn) {
    const double *axis = scan->options.axis;
    const skg_view *view = &turn->view;
    double *front = turn->front;
    if (!find_first(scan, &turn->view)) return 0;
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        skg_scale_vector(-1, view->source, front);
    else
        skg_add_scaled(view->source, -1,
                       view->projection == SKG_PROJECTION_POINT ? scan->options.centre : view->centre, front);
    skg_add_scaled(front, -skg_dot(front, axis), axis, front);
    if (!(skg_length(front) > 0)) return 0;
    skg_scale_vector(1 / skg_length(front), front, front);
    turn->is_reversed = skg_dot(view->row_step, axis) < 0;
    skg_scale_vector(turn->is_reversed ? -1 : 1, axis, turn->up);
    return 1;
}

void skg_tool_direction(const skg_tool_world *world, const double *vector, double *result) {
    const double v[3] = {vector[0], vector[1], vector[2]};
    for (int k = 0; k < 3; k++) result[k] = skg_dot(world->axes[k], v);
}

void skg_tool_point(const skg_tool_world *world, const double *point, double *result) {
    double from[3];
    skg_add_scaled(point, -1, world->origin, from);
    skg_tool_direction(world, from, result);
}

skg_status skg_tool_flat(const skg_view *view, int64_t index, const char *tool) {
    if (!(view->radius > 0)) return SKG_OK;
    return skg_fail(SKG_ERR_UNSUPPORTED,
                    "projection %" PRId64 ": the geometry of %s has no curved detector; write .csv or .xml",
                    index, tool);
}

skg_status skg_tool_detector(const skg_tool_world *world, const skg_view *view, int64_t index,
                             const char *tool, double axes[3][3]) {
    skg_scale_vector(1 / skg_length(view->column_step), view->column_step, axes[0]);
    skg_scale_vector(1 / skg_length(view->row_step), view->row_step, axes[1]);
    if (fabs(skg_dot(axes[0], axes[1])) > max_skew)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "projection %" PRId64 ": the geometry of %s has no skewed detector; write .csv",
                        index, tool);
    for (int i = 0; i < 2; i++) skg_tool_direction(world, axes[i], axes[i]);
    skg_cross(axes[0], axes[1], axes[2]);
    return SKG_OK;
}

skg_status skg_tool_pixel(const skg_scan *scan, const char *tool, double pixel_mm[2]) {
    for (int64_t k = 0; k < scan->options.projections; k++) {
        skg_view view;
        skg_view_init(&view);
        SKG_TRY(skg_scan_view_get(scan, k, &view));
        const double now[2] = {skg_length(view.column_step), skg_length(view.row_step)};
        if (k == 0) memcpy(pixel_mm, now, sizeof now);
        for (int i = 0; i < 2; i++)
            if (fabs(now[i] - pixel_mm[i]) > max_difference * pixel_mm[i])
                return skg_fail(SKG_ERR_UNSUPPORTED,
                                "projection %" PRId64
                                ": its pixels have another size than those of the first "
                                "one, which the geometry of %s cannot express; write .csv",
                                k, tool);
    }
    return SKG_OK;
}

void skg_tool_write_world(const skg_tool_world *world, FILE *stream) {
    fprintf(stream, "# In the axes of the scene (mm):\n");
    for (int k = 0; k < 3; k++)
        fprintf(stream, "#   %c = (%.12g, %.12g, %.12g)\n", "xyz"[k], world -> axes[k][0] + 0.0,
                world -> axes[k][1] + 0.0, world -> axes[k][2] + 0.0); /* no -0 */
    fprintf(stream, "#   origin = (%.12g, %.12g, %.12g)\n", world->origin[0], world->origin[1],
            world->origin[2]);
}
