/* The geometry of a scan for RTK: ThreeDCircularProjectionGeometry. */
#include "core/maths.h"
#include "trajectory/writers.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Parameters of a projection in RTK. In its rotated coordinates x runs along the columns' step, y along the rows' step, and
 * z from the detector to the source; lengths are in mm, angles in degrees. */
typedef struct {
    double distance, source_to_detector; /* of the source from the origin and from the detector, along z */
    double gantry, out_of_plane, in_plane;
    double source[2], centre[2];
    double axes[3][3];
} rtk_pose;

/* y along the axis of rotation, z from there to the source. A table of poses, and a source on the axis, keep the axes of
 * the scene. */
static void choose_world(const skg_scan *scan, skg_tool_world *world) {
    skg_tool_turn turn;
    skg_tool_world_init(world);
    if (skg_scan_is_table(scan) || !skg_tool_find_turn(scan, &turn)) return;
    memcpy(world->origin, scan->options.centre, sizeof world->origin);
    memcpy(world->axes[1], scan->options.axis, sizeof world->axes[1]);
    memcpy(world->axes[2], turn.front, sizeof world->axes[2]);
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

/* RTK bends the detector about the line at 0 of its own coordinates, whatever ProjectionOffsetX is, towards the source, by a radius that
 * all projections share. That is ours where the detector's middle is there. */
static skg_status check_radius(const skg_view *view, int64_t k, const rtk_pose *pose) {
    static const double OFF = 1e-9; /* of the radius */
    if (!(view->radius > 0) || fabs(pose->centre[0]) <= OFF * view->radius) return SKG_OK;
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "projection %" PRId64
        ": the middle of the curved detector lies %g mm beside the axis of rotation, where RTK bends it; "
        "write .csv",
        k, pose->centre[0]);
}

static skg_status find_rtk_pose(const skg_tool_world *world, const skg_view *view, int64_t k,
                                rtk_pose *pose) {
    double(*axes)[3] = pose->axes, source[3], centre[3];
    if (view->projection != SKG_PROJECTION_POINT)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "projection %" PRId64 ": the geometry of RTK has no parallel beam; write .csv", k);
    SKG_TRY(skg_tool_detector(world, view, k, "RTK", axes));
    skg_tool_point(world, view->source, source);
    skg_tool_point(world, view->centre, centre);
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
    return check_radius(view, k, pose);
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

skg_status skg_scan_write_rtk(const skg_scan *scan, FILE *stream) {
    skg_tool_world world;
    choose_world(scan, &world);
    fprintf(stream,
            "<?xml version=\"1.0\"?>\n<!DOCTYPE RTKGEOMETRY>\n<RTKThreeDCircularGeometry version=\"3\">\n");
    if (scan->view.radius > 0)
        fprintf(stream, "  <RadiusCylindricalDetector>%.17g</RadiusCylindricalDetector>\n",
                scan->view.radius);
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
