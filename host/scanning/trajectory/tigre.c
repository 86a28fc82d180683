/* The geometry of a scan for TIGRE, as its documentation (tigre.readthedocs.io, "Describing your geometry") and its
 * projector (computeDeltas) have it: the source stands at (DSO, 0, 0), the centre of the detector at (DSO - DSD, u, v) with
 * (v, u) = offDetector, its columns run along y and its rows along z, after it was turned about its centre by Rz Ry Rx of
 * rotDetector. All of that is turned about z by the angle and moved by -offOrigin. */
#include "core/maths.h"
#include "trajectory/writers.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

typedef struct {
    double angle, source_to_detector, source_to_axis, origin_z, detector_v, detector_u, rotation[3];
} tigre_pose;

/* z along the axis of rotation, x from there to the source. */
static void choose_world(const skg_scan *scan, skg_tool_world *world) {
    skg_tool_turn turn;
    skg_tool_world_init(world);
    if (!skg_tool_find_turn(scan, &turn)) return;
    memcpy(world->origin, scan->options.centre, sizeof world->origin);
    memcpy(world->axes[0], turn.front, sizeof world->axes[0]);
    memcpy(world->axes[2], turn.up, sizeof world->axes[2]);
    skg_cross(world->axes[2], world->axes[0], world->axes[1]);
}

/* Into the coordinates that have the source on their x axis. */
static void turn_back(double angle, double *v) {
    const double x = v[0], y = v[1];
    v[0] = cos(angle) * x + sin(angle) * y;
    v[1] = cos(angle) * y - sin(angle) * x;
}

/* Normal, column step and row step are the columns of Rz Ry Rx. */
static void find_rotation(double axes[3][3], double *rotation) {
    const double *u = axes[0], *v = axes[1], *n = axes[2], across = hypot(n[0], n[1]);
    rotation[1] = atan2(-n[2], across);
    if (across > 1e-9) {
        rotation[0] = atan2(u[2], v[2]);
        rotation[2] = atan2(n[1], n[0]);
    } else { /* the first and the last rotation have the same axis */
        rotation[0] = atan2(n[2] < 0 ? u[0] : -u[0], u[1]);
        rotation[2] = 0;
    }
}

static skg_status find_pose(const skg_tool_world *world, const skg_view *view, int64_t k, tigre_pose *pose) {
    double axes[3][3], source[3], centre[3];
    if (view->projection != SKG_PROJECTION_POINT)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "projection %" PRId64 ": parallel beams are not written for TIGRE; write .csv or .cil.py", k);
    SKG_TRY(skg_tool_detector(world, view, k, "TIGRE", axes));
    skg_tool_point(world, view->source, source);
    skg_tool_point(world, view->centre, centre);
    /* As near the angle before it as can be, so that angles rise or fall. */
    const double angle = atan2(source[1], source[0]), turns = round((pose->angle - angle) / (2 * SKG_PI));
    pose->angle = angle + 2 * SKG_PI * turns;
    pose->source_to_axis = hypot(source[0], source[1]);
    pose->origin_z = -source[2];
    turn_back(angle, centre);
    for (int i = 0; i < 3; i++) turn_back(angle, axes[i]);
    pose->source_to_detector = pose->source_to_axis - centre[0];
    pose->detector_u = centre[1];
    pose->detector_v = centre[2] - source[2];
    find_rotation(axes, pose->rotation);
    return SKG_OK;
}

static void write_pose(const tigre_pose *p, FILE *stream) {
    const double numbers[] = {p->angle,       p->source_to_detector, p->source_to_axis,
                              p->origin_z,    p->detector_v,         p->detector_u,
                              p->rotation[0], p->rotation[1],        p->rotation[2]};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        fprintf(stream, "%s%.17g", i ? ", " : "    [", numbers[i] + 0.0); /* no -0 */
    fprintf(stream, "],\n");
}

static const char heading[] =
    "# The geometry of a scan for TIGRE, by skiagraph. Lengths are in mm, angles in rad.\n"
    "# Projections are float32 [projection][row][column] of -ln(I / I0), as the scan has them.\n"
    "#   from runpy import run_path\n"
    "#   scan = run_path(\"THIS FILE\")\n"
    "#   volume = tigre.algorithms.fdk(projections, scan[\"geo\"], scan[\"angles\"])   # [z][y][x], 1/mm\n";

static const char assignments[] = "angles = poses[:, 0].copy()\n"
                                  "geo.DSD = poses[:, 1].copy()\n"
                                  "geo.DSO = poses[:, 2].copy()\n"
                                  "geo.offOrigin = np.column_stack([poses[:, 3], 0 * angles, 0 * angles])\n"
                                  "geo.offDetector = poses[:, 4:6].copy()\n"
                                  "geo.rotDetector = poses[:, 6:9].copy()\n";

static void write_sizes(const skg_view *view, const double *pixel, const tigre_pose *pose, FILE *stream) {
    const double share = pose->source_to_axis > 0 ? pose->source_to_axis / pose->source_to_detector : 1;
    fprintf(stream,
            "import numpy as np\nimport tigre\n\n"
            "geo = tigre.geometry(mode=\"cone\")\n"
            "geo.nDetector = np.array([%" PRId64 ", %" PRId64 "])\n"
            "geo.dDetector = np.array([%.17g, %.17g])\n"
            "geo.sDetector = geo.nDetector * geo.dDetector\n"
            "# The volume: change it as you like.\n"
            "geo.nVoxel = np.array([%" PRId64 ", %" PRId64 ", %" PRId64 "])\n"
            "geo.dVoxel = np.array([%.17g, %.17g, %.17g])\n"
            "geo.sVoxel = geo.nVoxel * geo.dVoxel\n"
            "geo.accuracy = 0.5\n"
            "# Angle, DSD, DSO, offOrigin along z, offDetector (v, u), rotDetector about x, y and z.\n"
            "poses = np.array([\n",
            view->rows, view->columns, pixel[1], pixel[0], view->columns, view->columns, view->columns,
            share * pixel[0], share * pixel[0], share * pixel[0]);
}

skg_status skg_scan_write_tigre(const skg_scan *scan, FILE *stream) {
    skg_tool_world world;
    tigre_pose pose = {0};
    double pixel[2];
    choose_world(scan, &world);
    SKG_TRY(skg_tool_pixel(scan, "TIGRE", pixel));
    fprintf(stream, "%s", heading);
    skg_tool_write_world(&world, stream);
    for (int64_t k = 0; k < scan->options.projections; k++) {
        skg_view view;
        skg_view_init(&view);
        SKG_TRY(skg_scan_view_get(scan, k, &view));
        SKG_TRY(skg_tool_flat(&view, k, "TIGRE"));
        SKG_TRY(find_pose(&world, &view, k, &pose));
        if (k == 0) write_sizes(&view, pixel, &pose, stream);
        write_pose(&pose, stream);
    }
    fprintf(stream, "])\n%s", assignments);
    return SKG_OK;
}
