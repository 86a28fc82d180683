/* The geometry of a scan for CIL, the Core Imaging Library, as its documentation of AcquisitionGeometry has it: positions and
 * directions of source and detector at angle 0, and angles by which the sample turns about the axis. Scans that do more
 * than turn have positions and directions for each projection (create_Cone3D_SOUV). */
#include "core/maths.h"
#include "trajectory/writers.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* mm: how far a pose may be from that of a circle to be one. */
static const double max_deviation = 1e-9;

/* z along the axis of rotation, y from the source to it: CIL's own axes. */
static int choose_world(const skg_scan *scan, skg_tool_turn *turn, skg_tool_world *world) {
    skg_tool_world_init(world);
    if (!skg_tool_find_turn(scan, turn)) return 0;
    memcpy(world->origin, scan->options.centre, sizeof world->origin);
    skg_scale_vector(-1, turn->front, world->axes[1]);
    memcpy(world->axes[2], turn->up, sizeof world->axes[2]);
    skg_cross(world->axes[1], world->axes[2], world->axes[0]);
    return 1;
}

static double difference(const double *a, const double *b) {
    double apart[3];
    skg_add_scaled(a, -1, b, apart);
    return skg_length(apart);
}

/* Whether every projection is the first one, turned about the axis. */
static skg_status is_circle(const skg_scan *scan, const skg_tool_turn *turn, int *result) {
    const skg_view *first = &turn->view;
    *result = 0;
    for (int64_t k = 0; k < scan->options.projections; k++) {
        skg_view view;
        double angle = 0;
        skg_view_init(&view);
        SKG_TRY(skg_scan_view_get(scan, k, &view));
        SKG_TRY(skg_tool_flat(&view, k, "CIL"));
        SKG_TRY(skg_scan_angle_get(scan, k, &angle));
        skg_scan_turn(scan->options.axis, scan->options.centre, angle, 0, &view);
        /* Steps are of a pixel; at the detector's edge they count half of its columns and rows. */
        const double apart = difference(view.source, first->source) + difference(view.centre, first->centre) +
                             (double)view.columns * difference(view.column_step, first->column_step) +
                             (double)view.rows * difference(view.row_step, first->row_step);
        if (!(apart < max_deviation)) return SKG_OK;
    }
    *result = 1;
    return SKG_OK;
}

static void write_vector(const char *name, const double *v, FILE *stream) {
    fprintf(stream, "    %s=[%.17g, %.17g, %.17g],\n", name, v[0] + 0.0, v[1] + 0.0, v[2] + 0.0); /* no -0 */
}

/* From the source to the detector. */
static void find_ray(const skg_tool_world *world, const skg_view *view, double *ray) {
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        memcpy(ray, view->source, 3 * sizeof *ray);
    else
        skg_add_scaled(view->centre, -1, view->source, ray);
    skg_tool_direction(world, ray, ray);
}

static skg_status write_circle(const skg_scan *scan, const skg_tool_world *world, const skg_tool_turn *turn,
                               FILE *stream) {
    const skg_view *view = &turn->view;
    const int is_cone = view->projection == SKG_PROJECTION_POINT;
    const double degrees = (turn->is_reversed ? -180 : 180) / SKG_PI;
    double axes[3][3], place[3];
    SKG_TRY(skg_tool_detector(world, view, 0, "CIL", axes));
    fprintf(stream, "geometry = AcquisitionGeometry.create_%s(\n", is_cone ? "Cone3D" : "Parallel3D");
    if (is_cone)
        skg_tool_point(world, view->source, place);
    else
        find_ray(world, view, place);
    write_vector(is_cone ? "source_position" : "ray_direction", place, stream);
    skg_tool_point(world, view->centre, place);
    write_vector("detector_position", place, stream);
    write_vector("detector_direction_x", axes[0], stream);
    write_vector("detector_direction_y", axes[1], stream);
    fprintf(stream, "    rotation_axis_position=[0, 0, 0],\n    rotation_axis_direction=[0, 0, 1],\n"
                    "    units=\"mm\")\ngeometry.set_angles(np.array([\n");
    for (int64_t k = 0; k < scan->options.projections; k++) {
        double angle = 0;
        SKG_TRY(skg_scan_angle_get(scan, k, &angle));
        fprintf(stream, "    %.17g,\n", degrees * angle + 0.0);
    }
    fprintf(stream, "]), angle_unit=\"degree\")\n");
    return SKG_OK;
}

static skg_status write_pose(const skg_tool_world *world, const skg_view *view, int64_t k, FILE *stream) {
    double axes[3][3], places[2][3];
    if (view->projection != SKG_PROJECTION_POINT)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "projection %" PRId64
                        ": the geometry of CIL has parallel beams on a circle only; write "
                        ".csv",
                        k);
    SKG_TRY(skg_tool_detector(world, view, k, "CIL", axes));
    skg_tool_point(world, view->source, places[0]);
    skg_tool_point(world, view->centre, places[1]);
    const double *rows[] = {places[0], places[1], axes[0], axes[1]};
    for (int i = 0; i < SKG_POSE_NUMBERS; i++)
        fprintf(stream, "%s%.17g", i ? ", " : "    [", rows[i / 3][i % 3] + 0.0);
    fprintf(stream, "],\n");
    return SKG_OK;
}

static skg_status write_poses(const skg_scan *scan, const skg_tool_world *world, FILE *stream) {
    fprintf(stream,
            "# Source, centre of the detector, directions of its columns and rows.\nposes = np.array([\n");
    for (int64_t k = 0; k < scan->options.projections; k++) {
        skg_view view;
        skg_view_init(&view);
        SKG_TRY(skg_scan_view_get(scan, k, &view));
        SKG_TRY(skg_tool_flat(&view, k, "CIL"));
        SKG_TRY(write_pose(world, &view, k, stream));
    }
    fprintf(stream,
            "])\ngeometry = AcquisitionGeometry.create_Cone3D_SOUV(\n"
            "    source_position_set=poses[:, 0:3],\n    detector_position_set=poses[:, 3:6],\n"
            "    detector_direction_x_set=poses[:, 6:9],\n    detector_direction_y_set=poses[:, 9:12],\n"
            "    volume_centre_position=[0, 0, 0],\n    units=\"mm\")\n");
    return SKG_OK;
}

static const char heading[] =
    "# The geometry of a scan for CIL, by skiagraph. Lengths are in mm, angles in degrees.\n"
    "# Projections are float32 [projection][row][column] of -ln(I / I0), as the scan has them.\n"
    "#   from runpy import run_path\n"
    "#   from cil.framework import AcquisitionData\n"
    "#   geometry = run_path(\"THIS FILE\")[\"geometry\"]\n"
    "#   data = AcquisitionData(projections, geometry=geometry)\n";

skg_status skg_scan_write_cil(const skg_scan *scan, FILE *stream) {
    skg_tool_world world;
    skg_tool_turn turn;
    skg_view view;
    double pixel[2];
    int turns = choose_world(scan, &turn, &world);
    skg_view_init(&view);
    SKG_TRY(skg_tool_pixel(scan, "CIL", pixel));
    SKG_TRY(skg_scan_view_get(scan, 0, &view));
    if (turns) SKG_TRY(is_circle(scan, &turn, &turns));
    fprintf(stream, "%s", heading);
    skg_tool_write_world(&world, stream);
    fprintf(stream, "import numpy as np\nfrom cil.framework import AcquisitionGeometry\n\n");
    SKG_TRY(turns ? write_circle(scan, &world, &turn, stream) : write_poses(scan, &world, stream));
    fprintf(stream,
            "geometry.set_panel([%" PRId64 ", %" PRId64
            "], pixel_size=[%.17g, %.17g], origin=\"bottom-left\")\n"
            "geometry.set_labels([\"angle\", \"vertical\", \"horizontal\"])\n",
            view.columns, view.rows, pixel[0], pixel[1]);
    return SKG_OK;
}
