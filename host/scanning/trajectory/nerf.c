/* The geometry of a scan as transforms.json, which NeRF and Gaussian splatting read (instant-ngp, nerfstudio): a pinhole camera for
 * each projection, with x along the columns, y up against the rows, and z from the scene to the camera. */
#include "core/maths.h"
#include "trajectory/writers.h"

#include <inttypes.h>

/* A detector as a pinhole camera: its axes, focal lengths and principal point in pixels. */
typedef struct {
    double axes[3][3], focal[2], principal[2];
} pinhole;

static skg_status find_camera(const skg_tool_world *world, const skg_view *view, int64_t k, pinhole *camera) {
    double to_detector[3];
    if (view->projection != SKG_PROJECTION_POINT)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "projection %" PRId64
                        ": transforms.json has pinhole cameras, and the beam is parallel; write .csv",
                        k);
    SKG_TRY(skg_tool_detector(world, view, k, "NeRF", camera->axes));
    skg_add_scaled(view->centre, -1, view->source, to_detector);
    const double distance = skg_dot(to_detector, camera->axes[2]);
    if (!(distance > 0))
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "projection %" PRId64
            ": seen from the source, columns and rows of the detector are mirrored, which no camera of transforms.json "
            "is; turn the direction of the columns, or write .csv",
            k);
    const double *steps[2] = {view->column_step, view->row_step};
    const int64_t pixels[2] = {view->columns, view->rows};
    for (int i = 0; i < 2; i++) { /* the middle of the first pixel is at 0.5 */
        const double step = skg_length(steps[i]);
        camera->focal[i] = distance / step;
        camera->principal[i] = 0.5 * (double)pixels[i] - skg_dot(to_detector, camera->axes[i]) / step;
    }
    return SKG_OK;
}

static void write_intrinsics(const pinhole *camera, FILE *stream) {
    fprintf(stream, "\"fl_x\": %.17g, \"fl_y\": %.17g, \"cx\": %.17g, \"cy\": %.17g", camera->focal[0],
            camera->focal[1], camera->principal[0], camera->principal[1]);
}

static void write_frame(const pinhole *camera, const double *source, int64_t k, FILE *stream) {
    fprintf(stream, "%s\n    {\"file_path\": \"images/%05" PRId64 ".png\", ", k ? "," : "", k);
    write_intrinsics(camera, stream);
    fprintf(stream, ",\n     \"transform_matrix\": [");
    for (int r = 0; r < 3; r++)
        fprintf(stream, "[%.17g, %.17g, %.17g, %.17g], ", camera->axes[0][r] + 0.0, -camera->axes[1][r] + 0.0,
                -camera->axes[2][r] + 0.0, source[r] + 0.0);
    fprintf(stream, "[0, 0, 0, 1]]}");
}

skg_status skg_scan_write_nerf(const skg_scan *scan, FILE *stream) {
    skg_tool_world world;
    skg_tool_world_init(&world);
    for (int64_t k = 0; k < scan->options.projections; k++) {
        skg_view view;
        pinhole camera;
        skg_view_init(&view);
        SKG_TRY(skg_scan_view_get(scan, k, &view));
        SKG_TRY(skg_tool_flat(&view, k, "NeRF"));
        SKG_TRY(find_camera(&world, &view, k, &camera));
        if (k == 0) {
            fprintf(stream, "{\"camera_model\": \"OPENCV\", \"w\": %" PRId64 ", \"h\": %" PRId64 ", ",
                    view.columns, view.rows);
            write_intrinsics(&camera, stream);
            fprintf(stream,
                    ",\n \"k1\": 0, \"k2\": 0, \"p1\": 0, \"p2\": 0, \"unit\": \"mm\",\n \"frames\": [");
        }
        write_frame(&camera, view.source, k, stream);
    }
    fprintf(stream, "\n ]}\n");
    return SKG_OK;
}
