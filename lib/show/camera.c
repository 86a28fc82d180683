/* The eye of a 3D view, and the corners of detector and beam. */
#include "show/drawing.h"

#include "core/maths.h"
#include "scene/curve.h"

#include <cglm/cglm.h>

#include <math.h>

/* Height of the field of view, and the part of the picture that the scene fills at most. */
static const double FIELD = 28 * SKG_PI / 180, FILLED = 0.92;

/* Distance of the eye from the nearest point, as a share of half the scene's depth. */
static const double NEAREST = 0.5;

/* With a target: what is nearer to the eye than this share of the farthest thing is not drawn, because depths are float. */
static const double CLOSEST = 2e-3;

/* Extents, in the eye's axes, of the points that have to be in the picture. */
typedef struct {
    const double (*axes)[3];
    double tangent[2]; /* of half the field: across, up; 0: orthographic */
    double highest[2]; /* max (x + z tan), min (x - z tan), x across or up, z towards the eye */
    double lowest[2];
    double near, far; /* the range of z */
} frame;

static void frame_point(frame *f, const double point[3]) {
    const double z = skg_dot(f->axes[2], point);
    for (int k = 0; k < 2; k++) {
        const double x = skg_dot(f->axes[k], point);
        f->highest[k] = fmax(f->highest[k], x + z * f->tangent[k]);
        f->lowest[k] = fmin(f->lowest[k], x - z * f->tangent[k]);
    }
    f->near = fmax(f->near, z);
    f->far = fmin(f->far, z);
}

void skg_show_detector_place(const skg_view *view, double column, double row, double place[3]) {
    if (view->radius > 0) {
        skg_view_pixel(view, column * (double)view->columns - 0.5, row * (double)view->rows - 0.5, place);
        return;
    }
    skg_add_scaled(view->centre, (column - 0.5) * (double)view->columns, view->column_step, place);
    skg_add_scaled(place, (row - 0.5) * (double)view->rows, view->row_step, place);
}

void skg_show_beam_start(const skg_view *view, const double low[3], const double high[3], const double at[3],
                         double start[3]) {
    double along[3], farthest = 0;
    memcpy(start, view->source, 3 * sizeof *start);
    if (view->projection == SKG_PROJECTION_POINT) return;
    if (view->projection == SKG_PROJECTION_PARALLEL) {
        skg_add_scaled(view->source, -1, view->centre, along);
        skg_add_scaled(at, 1, along, start);
        return;
    }
    skg_scale_vector(-1 / skg_length(view->source), view->source, along);
    for (int corner = 0; corner < 8; corner++) {
        double from[3];
        for (int k = 0; k < 3; k++) from[k] = (corner >> k & 1 ? high[k] : low[k]) - view->centre[k];
        farthest = fmax(farthest, skg_dot(along, from));
    }
    skg_add_scaled(at, 1.1 * farthest, along, start);
}

skg_status skg_show_beam_corners(const skg_view *view, const skg_look *look, double corners[4][3]) {
    return skg_collimation_corners_get(look->collimation, view, 0, corners[0]);
}

/* A direction of length 1 across another one of length 1: `wanted` if that is across enough, otherwise any. */
static void across(const double wanted[3], const double direction[3], double result[3]) {
    double candidate[3];
    memcpy(candidate, wanted, sizeof candidate);
    for (int k = 2; k >= 0; k--) {
        const double length = skg_length(candidate);
        if (length > 0) {
            skg_scale_vector(1 / length, candidate, candidate);
            skg_add_scaled(candidate, -skg_dot(candidate, direction), direction, result);
            if (skg_length(result) > 1e-3) break;
        }
        for (int axis = 0; axis < 3; axis++) candidate[axis] = axis == k;
    }
    skg_scale_vector(1 / skg_length(result), result, result);
}

static skg_status find_axes(const skg_view *view, const skg_look *look, double axes[3][3]) {
    double *toward = axes[2], beam[3], start[3], up[3];
    if (!skg_all_finite(look->from, 3) || !skg_all_finite(look->up, 3))
        return skg_fail(SKG_ERR_ARGUMENT, "skg_scene_picture: a direction of the look is not finite");
    memcpy(up, look->up, sizeof up);
    if (skg_length(up) == 0) skg_scale_vector(-1, view->row_step, up);
    memcpy(toward, look->from, sizeof axes[2]);
    if (skg_length(toward) == 0) { /* obliquely: across the beam, a little from the source and from above */
        skg_show_beam_start(view, view->centre, view->centre, view->centre, start);
        skg_add_scaled(view->centre, -1, start, beam);
        if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
            memcpy(beam, view->source, sizeof beam);
        skg_scale_vector(1 / skg_length(beam), beam, beam);
        skg_scale_vector(1 / skg_length(up), up, up);
        skg_cross(beam, up, toward);
        skg_scale_vector(1 / skg_length(toward), toward, toward);
        skg_add_scaled(toward, -0.55, beam, toward);
        skg_add_scaled(toward, 0.42, up, toward);
    }
    skg_scale_vector(1 / skg_length(toward), toward, toward);
    across(up, toward, axes[1]);
    skg_cross(axes[1], toward, axes[0]);
    return SKG_OK;
}

static void frame_everything(frame *f, const skg_view *view, const skg_look *look, const double low[3],
                             const double high[3]) {
    double point[3], start[3], beam[4][3];
    if (skg_show_beam_corners(view, look, beam) != SKG_OK) return; /* checked before */
    for (int corner = 0; corner < 8; corner++) {
        for (int k = 0; k < 3; k++) point[k] = corner >> k & 1 ? high[k] : low[k];
        frame_point(f, point);
    }
    for (int corner = 0; corner < 4; corner++) {
        skg_show_detector_place(view, corner & 1, corner >> 1, point);
        skg_show_beam_start(view, low, high, beam[corner], start);
        frame_point(f, point);
        frame_point(f, beam[corner]);
        frame_point(f, start);
    }
    for (int64_t i = 0; i < look->path_count; i++) frame_point(f, look->path + 3 * i);
}

/* Where the eye stands so that everything is in the picture: centre, distance and mm that the picture is high there. */
static void fit(const frame *f, const skg_look *look, double aspect, skg_show_camera *camera, double *height,
                double *depth) {
    const double tangent = tan(FIELD / 2) * FILLED, middle = 0.5 * (f->near + f->far);
    double half[2];
    for (int k = 0; k < 3; k++) camera->centre[k] = middle * camera->axes[2][k];
    for (int k = 0; k < 2; k++) {
        half[k] = 0.5 * (f->highest[k] - f->lowest[k]);
        skg_add_scaled(camera->centre, 0.5 * (f->highest[k] + f->lowest[k]), camera->axes[k], camera->centre);
    }
    /* everything may lie on the axis */
    *height = fmax(fmax(half[1], half[0] / aspect), 1e-6 * (1 + f->near - f->far));
    *depth = fmax(0.5 * (f->near - f->far), 0.01 * *height);
    /* in perspective everything is in the picture from z = height / tangent on; the eye keeps off the nearest point */
    const double eye_z = fmax(*height / tangent, f->near + NEAREST * *depth);
    camera->distance = look->orthographic ? 2 * *depth : eye_z - middle;
    camera->pixel = look->orthographic ? 2 * *height / FILLED / (double)look->rows
                                       : 2 * camera->distance * tan(FIELD / 2) / (double)look->rows;
}

/* From positions relative to the centre to clip coordinates. near, far: mm in front of the eye; top: half of the height of an
 * orthographic picture, mm. */
static void make_matrix(const skg_look *look, double aspect, float near, float far, float top,
                        skg_show_camera *camera) {
    vec3 eye, up, origin = {0, 0, 0};
    mat4 seen, lens, whole;
    for (int k = 0; k < 3; k++) {
        eye[k] = (float)(camera->distance * camera->axes[2][k]);
        up[k] = (float)camera->axes[1][k];
    }
    glm_lookat(eye, origin, up, seen);
    if (look->orthographic)
        glm_ortho(-top * (float)aspect, top * (float)aspect, -top, top, near, far, lens);
    else
        glm_perspective((float)FIELD, (float)aspect, near, far, lens);
    glm_mat4_mul(lens, seen, whole);
    memcpy(camera->matrix, whole, sizeof camera->matrix);
}

/* The eye where the look has it. */
static void aim(const frame *f, const skg_look *look, double aspect, skg_show_camera *camera) {
    const double height = look->distance * tan(FIELD / 2), target = skg_dot(camera->axes[2], look->target);
    const double far = look->distance + target - f->far;
    memcpy(camera->centre, look->target, sizeof camera->centre);
    camera->distance = look->distance;
    camera->pixel = 2 * height / (double)look->rows;
    double near = look->distance + target - f->near;
    if (!look->orthographic) {
        camera->nearest = CLOSEST * fmax(far, look->distance);
        near = fmax(near, camera->nearest);
    }
    make_matrix(look, aspect, (float)near, (float)fmax(far, near + 1e-3 * look->distance), (float)height,
                camera);
}

skg_status skg_show_camera_make(const skg_view *view, const skg_look *look, const double low[3],
                                const double high[3], skg_show_camera *camera) {
    *camera = (skg_show_camera){0};
    SKG_TRY(find_axes(view, look, camera->axes));
    const double aspect = (double)look->columns / (double)look->rows, tangent = tan(FIELD / 2) * FILLED;
    double height, depth;
    frame f = {.axes = (const double(*)[3])camera->axes,
               .tangent = {look->orthographic ? 0 : tangent * aspect, look->orthographic ? 0 : tangent},
               .highest = {-HUGE_VAL, -HUGE_VAL},
               .lowest = {HUGE_VAL, HUGE_VAL},
               .near = -HUGE_VAL,
               .far = HUGE_VAL};
    frame_everything(&f, view, look, low, high);
    if (look->target) {
        aim(&f, look, aspect, camera);
        return SKG_OK;
    }
    fit(&f, look, aspect, camera, &height, &depth);
    const float near = (float)(camera->distance - 1.05 * depth),
                far = (float)(camera->distance + 1.05 * depth);
    make_matrix(look, aspect, look->orthographic ? near : fmaxf(near, 1e-3f * far), far,
                (float)(height / FILLED), camera);
    return SKG_OK;
}

double skg_show_camera_depth(const skg_show_camera *camera, const double point[3]) {
    double from[3];
    skg_add_scaled(point, -1, camera->centre, from);
    return camera->distance - skg_dot(camera->axes[2], from);
}

double skg_show_camera_pixel(const skg_show_camera *camera, const double point[3]) {
    if (!(camera->nearest > 0)) return camera->pixel;
    return camera->pixel * fmax(skg_show_camera_depth(camera, point), camera->nearest) / camera->distance;
}

void skg_show_camera_place(const skg_show_camera *camera, const skg_look *look, const double point[3],
                           double place[2]) {
    vec4 position = {0, 0, 0, 1}, clip;
    mat4 matrix;
    memcpy(matrix, camera->matrix, sizeof matrix);
    for (int k = 0; k < 3; k++) position[k] = (float)(point[k] - camera->centre[k]);
    glm_mat4_mulv(matrix, position, clip);
    place[0] = 0.5 * (double)look->columns * (1 + (double)(clip[0] / clip[3])) - 0.5;
    place[1] = 0.5 * (double)look->rows * (1 - (double)(clip[1] / clip[3])) - 0.5;
}
