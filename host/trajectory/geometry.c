/* The geometry of a scan as files that reconstruction tools read. */
#include "core/maths.h"
#include "core/names.h"
#include "core/output.h"
#include "core/plain.h"
#include "core/vector.h"
#include "trajectory/types.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* The largest cosine between the detector's steps that counts as a right angle. */
static const double most_skew = 1e-6;

static skg_status write_table(const skg_scan *scan, FILE *stream) {
    fprintf(stream, "# source x y z, detector centre x y z, column step x y z, row step x y z (mm)\n");
    for (int64_t k = 0; k < scan->options.projections; k++) {
        skg_view view;
        skg_view_init(&view);
        SKG_TRY(skg_scan_view_get(scan, k, &view));
        const double *rows[] = {view.source, view.centre, view.column_step, view.row_step};
        for (int i = 0; i < SKG_POSE_NUMBERS; i++)
            fprintf(stream, "%s%.17g", i ? ", " : "", rows[i / 3][i % 3]);
        fputc('\n', stream);
    }
    return SKG_OK;
}

/* The axes of RTK's world as rows, and its origin. A circular orbit of RTK runs about y, and its source is at +z at
 * angle 0. */
typedef struct {
    double axes[3][3], origin[3];
} rtk_world;

/* What RTK says of a projection. In its rotated coordinates x runs along the columns' step, y along the rows' step, and
 * z from the detector to the source; lengths are in mm, angles in degrees. */
typedef struct {
    double distance, source_to_detector; /* of the source from the origin and from the detector, along z */
    double gantry, out_of_plane, in_plane;
    double source[2], centre[2];
    double axes[3][3];
} rtk_pose;

static void to_world(const rtk_world *world, const double *vector, double *result) {
    const double v[3] = {vector[0], vector[1], vector[2]};
    for (int k = 0; k < 3; k++) result[k] = skg_dot(world->axes[k], v);
}

/* y along the axis of rotation, z from there to the source. A table of poses, and a source on the axis, keep the axes of
 * the scene. */
static void choose_world(const skg_scan *scan, rtk_world *world) {
    *world = (rtk_world){.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    if (skg_scan_is_table(scan)) return;
    double from[3];
    const double *axis = scan->options.axis;
    skg_add_scaled(scan->view.source, -1, scan->options.centre, from);
    skg_add_scaled(from, -skg_dot(from, axis), axis, from);
    if (!(skg_length(from) > 0)) return;
    memcpy(world->origin, scan->options.centre, sizeof world->origin);
    memcpy(world->axes[1], axis, sizeof world->axes[1]);
    skg_scale_vector(1 / skg_length(from), from, world->axes[2]);
    skg_cross(world->axes[1], world->axes[2], world->axes[0]);
}

/* The rows of Rz(-in plane) Rx(-out of plane) Ry(-gantry) are the axes. */
static void find_angles(rtk_pose *pose) {
    const double(*axes)[3] = (const double(*)[3])pose->axes, degrees = 180 / SKG_PI;
    const double across = hypot(axes[2][0], axes[2][2]);
    pose->out_of_plane = degrees * atan2(-axes[2][1], across);
    if (across > 1e-9) {
        pose->gantry = degrees * atan2(axes[2][0], axes[2][2]);
        pose->in_plane = degrees * atan2(axes[0][1], axes[1][1]);
    } else { /* gantry and in-plane angle turn about the same axis */
        pose->gantry = 0;
        pose->in_plane = degrees * atan2(-axes[1][0], axes[0][0]);
    }
}

static skg_status find_rtk_pose(const rtk_world *world, const skg_view *view, int64_t k, rtk_pose *pose) {
    double(*axes)[3] = pose->axes, source[3], centre[3];
    if (view->projection != SKG_PROJECTION_POINT)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "projection %" PRId64 ": the geometry of RTK has no parallel beam; write .csv", k);
    skg_scale_vector(1 / skg_length(view->column_step), view->column_step, axes[0]);
    skg_scale_vector(1 / skg_length(view->row_step), view->row_step, axes[1]);
    if (fabs(skg_dot(axes[0], axes[1])) > most_skew)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "projection %" PRId64 ": the geometry of RTK has no skewed detector; write .csv", k);
    for (int i = 0; i < 2; i++) to_world(world, axes[i], axes[i]);
    skg_cross(axes[0], axes[1], axes[2]);
    skg_add_scaled(view->source, -1, world->origin, source);
    skg_add_scaled(view->centre, -1, world->origin, centre);
    to_world(world, source, source);
    to_world(world, centre, centre);
    pose->distance = skg_dot(axes[2], source);
    pose->source_to_detector = pose->distance - skg_dot(axes[2], centre);
    if (!(pose->source_to_detector > 0))
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "projection %" PRId64 ": the detector is seen from behind (column step x row step "
                        "points away from the source), which the geometry of RTK cannot express; write .csv",
                        k);
    for (int i = 0; i < 2; i++) {
        pose->source[i] = skg_dot(axes[i], source);
        pose->centre[i] = skg_dot(axes[i], centre);
    }
    find_angles(pose);
    return SKG_OK;
}

/* The 3 x 4 matrix from RTK's world to detector coordinates in mm, with RTK's factor: its third row is the depth. */
static void write_matrix(const rtk_pose *pose, FILE *stream) {
    fprintf(stream, "    <Matrix>");
    for (int r = 0; r < 3; r++) {
        double row[4];
        const double focal = r < 2 ? -pose->source_to_detector : 0;
        const double shift = r < 2 ? pose->source[r] - pose->centre[r] : 1;
        for (int c = 0; c < 3; c++) row[c] = focal * pose->axes[r][c] + shift * pose->axes[2][c];
        row[3] = (r < 2 ? -focal * pose->source[r] : 0) - shift * pose->distance;
        for (int c = 0; c < 4; c++) fprintf(stream, " %.17g", row[c]);
    }
    fprintf(stream, " </Matrix>\n");
}

static skg_status write_rtk(const skg_scan *scan, FILE *stream) {
    rtk_world world;
    choose_world(scan, &world);
    fprintf(stream,
            "<?xml version=\"1.0\"?>\n<!DOCTYPE RTKGEOMETRY>\n<RTKThreeDCircularGeometry version=\"3\">\n");
    for (int64_t k = 0; k < scan->options.projections; k++) {
        skg_view view;
        rtk_pose pose;
        skg_view_init(&view);
        SKG_TRY(skg_scan_view_get(scan, k, &view));
        SKG_TRY(find_rtk_pose(&world, &view, k, &pose));
        const struct {
            const char *name;
            double value;
        } values[] = {{"SourceToIsocenterDistance", pose.distance},
                      {"SourceToDetectorDistance", pose.source_to_detector},
                      {"GantryAngle", pose.gantry},
                      {"OutOfPlaneAngle", pose.out_of_plane},
                      {"InPlaneAngle", pose.in_plane},
                      {"SourceOffsetX", pose.source[0]},
                      {"SourceOffsetY", pose.source[1]},
                      {"ProjectionOffsetX", pose.centre[0]},
                      {"ProjectionOffsetY", pose.centre[1]}};
        fprintf(stream, "  <Projection>\n");
        for (size_t v = 0; v < sizeof values / sizeof *values; v++)
            fprintf(stream, "    <%s>%.17g</%s>\n", values[v].name, values[v].value + 0.0,
                    values[v].name); /* no -0 */
        write_matrix(&pose, stream);
        fprintf(stream, "  </Projection>\n");
    }
    fprintf(stream, "</RTKThreeDCircularGeometry>\n");
    return SKG_OK;
}

skg_status skg_scan_geometry_write(const skg_scan *scan, const char *path) {
    SKG_PLAIN;
    skg_output_file file;
    SKG_NEEDS(scan);
    SKG_NEEDS(path);
    const char *dot = strrchr(path, '.');
    const int is_rtk = dot && skg_same_name(dot, ".xml");
    if (!is_rtk && !(dot && skg_same_name(dot, ".csv")))
        return skg_fail(SKG_ERR_ARGUMENT, "%s: a geometry is written to a .csv or, for RTK, an .xml", path);
    SKG_TRY(skg_output_open(path, &file));
    skg_status status = is_rtk ? write_rtk(scan, file.stream) : write_table(scan, file.stream);
    if (status == SKG_OK) return skg_output_commit(&file);
    skg_output_discard(&file);
    return status;
}
