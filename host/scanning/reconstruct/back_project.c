/* Adds a filtered projection to the volume: a voxel reads the image where it is seen. */
#include "core/maths.h"
#include "core/threads.h"
#include "reconstruct/reconstruction.h"
#include "scene/curve.h"

#include <math.h>

/* Column, row and 1 of the pixel that a point is seen in, times w, as affine functions of the point; and the point's
 * distance from the source across the rows of the detector as well, over the radius. */
typedef struct {
    double column[4], row[4], w[4], depth[4];
} pixel_map;

static void affine(const double *direction, double factor, const double *from, double add, double *function) {
    skg_scale_vector(factor, direction, function);
    function[3] = add - factor * skg_dot(direction, from);
}

static void find_map(const skg_orbit_pose *pose, pixel_map *map) {
    const skg_view *v = &pose->view;
    double normal[3], dual[2][3], across[3], from[3];
    skg_cross(v->column_step, v->row_step, normal);
    skg_cross(v->row_step, normal, across);
    skg_scale_vector(1 / skg_dot(v->column_step, across), across, dual[0]);
    skg_cross(normal, v->column_step, across);
    skg_scale_vector(1 / skg_dot(v->row_step, across), across, dual[1]);
    const double middle[2] = {0.5 * (double)(v->columns - 1), 0.5 * (double)(v->rows - 1)};
    double *pixel[2] = {map->column, map->row};
    if (pose->is_parallel) { /* the point slides along the beam to the detector's plane */
        const double along = skg_dot(normal, pose->forward);
        for (int k = 0; k < 2; k++) {
            skg_add_scaled(dual[k], -skg_dot(dual[k], pose->forward) / along, normal, across);
            affine(across, 1, v->centre, middle[k], pixel[k]);
        }
        memset(map->w, 0, sizeof map->w);
        memset(map->depth, 0, sizeof map->depth);
        map->w[3] = 1;
        map->depth[3] = 1;
        return;
    }
    skg_add_scaled(v->centre, -1, v->source, from);
    const double distance = skg_dot(normal, from);
    affine(normal, 1 / distance, v->source, 0, map->w);
    affine(pose->depth, 1 / pose->radius, v->source, 0, map->depth);
    for (int k = 0; k < 2; k++) { /* (x - source) dual / w + (source - centre) dual + middle, times w */
        const double shift = middle[k] - skg_dot(dual[k], from);
        affine(dual[k], 1, v->source, 0, pixel[k]);
        for (int i = 0; i < 4; i++) pixel[k][i] += shift * map->w[i];
    }
}

/* The filtered image between pixels; 0 beyond its edge. */
static double image_at(const skg_fdk *fdk, double column, double row) {
    const double fine = (double)fdk->filter.finer * (column + (double)fdk->pad[0]), c = floor(fine),
                 r = floor(row);
    if (!(c >= 0 && r >= 0 && c < (double)(fdk->fine - 1) && r < (double)(fdk->rows - 1))) return 0;
    const float *at = fdk->image + (int64_t)r * fdk->fine + (int64_t)c;
    const double u = fine - c, v = row - r;
    return (1 - v) * ((1 - u) * (double)at[0] + u * (double)at[1]) +
           v * ((1 - u) * (double)at[fdk->fine] + u * (double)at[fdk->fine + 1]);
}

static double at_point(const double *function, const double *point) {
    return skg_dot(function, point) + function[3];
}

/* Adds a row of voxels. A voxel weighs by the inverse of w times its depth: rows are filtered in the detector's own columns, and of two rays
 * to places s and t of a row at the depth D, the sine of the angle between them is D (s - t) over their lengths (Kak and Slaney 1988,
 * section 3.4.2). So the rows may be turned about the axis, and the foot of the perpendicular from the source may lie anywhere. */
static void back_project_line(skg_fdk *fdk, const pixel_map *map, double scale, int64_t y, int64_t z) {
    const skg_fdk_options *o = &fdk->options;
    const double start[3] = {skg_fdk_place(o, 0, 0), skg_fdk_place(o, 1, y), skg_fdk_place(o, 2, z)};
    const double column = at_point(map->column, start), row = at_point(map->row, start);
    const double w = at_point(map->w, start), depth = at_point(map->depth, start);
    float *to = fdk->volume + (z * o->voxels[1] + y) * o->voxels[0];
    for (int64_t x = 0; x < o->voxels[0]; x++) {
        const double along = (double)x * o->voxel_mm, near = w + along * map->w[0],
                     far = depth + along * map->depth[0];
        if (!(near > 0)) continue;
        const double value =
            image_at(fdk, (column + along * map->column[0]) / near, (row + along * map->row[0]) / near);
        to[x] += (float)(scale * value / (near * far));
    }
}

/* Where a curved detector about the source sees a point. Returns the distance of the point from the detector's axis. */
static double find_on_curve(const skg_view *v, const skg_curvature *curve, double *point, double *column,
                            double *row) {
    skg_add_scaled(point, -1, v->source, point);
    const double across = skg_dot(point, curve->across), depth = -skg_dot(point, curve->normal);
    const double far = hypot(across, depth), down = skg_dot(point, curve->down) * curve->radius / far;
    *column = 0.5 * (double)(v->columns - 1) + atan2(across, depth) / curve->angle;
    *row = 0.5 * (double)(v->rows - 1) + (down + curve->along) / curve->height;
    return far;
}

/* Adds a row of voxels of a projection by a curved detector about the source: a voxel is seen by its angle about the detector's axis, and
 * weighs by the inverse square of its distance from that axis (Kak and Slaney 1988, sections 3.4.2 and 3.6; H. Turbell, thesis 1001,
 * Linkoping 2001, on cylindrical detectors). */
static void back_project_fan(skg_fdk *fdk, const skg_orbit_pose *pose, double scale, int64_t y, int64_t z) {
    const skg_fdk_options *o = &fdk->options;
    float *to = fdk->volume + (z * o->voxels[1] + y) * o->voxels[0];
    skg_curvature curve;
    skg_curvature_find(&pose->view, NULL, &curve);
    for (int64_t x = 0; x < o->voxels[0]; x++) {
        double point[3] = {skg_fdk_place(o, 0, x), skg_fdk_place(o, 1, y), skg_fdk_place(o, 2, z)}, column,
               row;
        const double ratio = find_on_curve(&pose->view, &curve, point, &column, &row) / pose->radius;
        to[x] += (float)(scale * image_at(fdk, column, row) / (ratio * ratio));
    }
}

double skg_fdk_row_of(const skg_orbit_pose *pose, const double *point) {
    double at[3] = {point[0], point[1], point[2]}, column, row;
    if (pose->fan_step > 0) {
        skg_curvature curve;
        skg_curvature_find(&pose->view, NULL, &curve);
        (void)find_on_curve(&pose->view, &curve, at, &column, &row);
        return row;
    }
    pixel_map map;
    find_map(pose, &map);
    return at_point(map.row, at) / at_point(map.w, at);
}

typedef struct {
    skg_fdk *fdk;
    const skg_orbit_pose *pose;
    const pixel_map *map;
    double scale;
} back_projection;

/* A slice of the volume: a skg_item_work. */
static skg_status back_project_slice(void *user, int64_t z) {
    const back_projection *b = user;
    for (int64_t y = 0; y < b->fdk->options.voxels[1]; y++)
        if (b->pose->fan_step > 0)
            back_project_fan(b->fdk, b->pose, b->scale, y, z);
        else
            back_project_line(b->fdk, b->map, b->scale, y, z);
    return SKG_OK;
}

skg_status skg_fdk_back_project(skg_fdk *fdk, const skg_orbit_pose *pose) {
    enum { MM_PER_CM = 10 };
    pixel_map map;
    find_map(pose, &map);
    back_projection b = {
        .fdk = fdk, .pose = pose, .map = &map, .scale = MM_PER_CM * fdk->orbit.step / pose->spacing};
    return skg_parallel(fdk->options.voxels[2], back_project_slice, &b);
}
