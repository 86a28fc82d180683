#include "geometry/extent.h"

#include "core/vector.h"

#include <math.h>

typedef struct {
    const double *origin;
    const float *lowest, *highest; /* mm from the origin */
} box;

/* h (pixel times t, and t) of the corners of a box: that of the lowest corner, and from there along the
 * edges. A frame may have a million parts, so only one corner and three edges of each are transformed. */
static void see_corners(const skg_camera *camera, const box *of, const double *pose, double h[8][3]) {
    double lowest[3], world[3], edge[3][3];
    for (int k = 0; k < 3; k++) lowest[k] = of->origin[k] + (double)of->lowest[k];
    skg_pose_point(pose, lowest, world);
    skg_camera_see(camera, world, h[0]);
    if (camera->parallel) h[0][2] += 1; /* t, counted as for a point source */
    for (int k = 0; k < 3; k++) {
        const double along[3] = {pose[k], pose[4 + k], pose[8 + k]};
        const double length = (double)of->highest[k] - (double)of->lowest[k];
        for (int r = 0; r < 3; r++) edge[k][r] = length * skg_dot(camera->matrix[r], along);
    }
    for (int corner = 1; corner < 8; corner++) { /* one edge away from a corner that is known */
        const int k = corner & 4 ? 2 : corner & 2 ? 1 : 0;
        for (int r = 0; r < 3; r++) h[corner][r] = h[corner & ~(1 << k)][r] + edge[k][r];
    }
}

/* Like fmin and fmax of numbers, but without a call. */
static double lesser(double a, double b) {
    return a < b ? a : b;
}

static double greater(double a, double b) {
    return a > b ? a : b;
}

/* The least and the greatest t at which parallel paths to this detector start. */
static void start_range(const skg_camera *camera, double *first, double *last) {
    const double across = camera->start[1] * (double)(camera->columns - 1);
    const double down = camera->start[2] * (double)(camera->rows - 1);
    *first = camera->start[0] + fmin(0, across) + fmin(0, down);
    *last = camera->start[0] + fmax(0, across) + fmax(0, down);
}

void skg_extent_find(const skg_camera *camera, const skg_mesh *mesh, const double *pose, skg_extent *extent) {
    skg_extent_find_within(camera, mesh, mesh->lowest, mesh->highest, pose, extent);
}

void skg_extent_find_within(const skg_camera *camera, const skg_mesh *mesh, const float lowest[3],
                            const float highest[3], const double *pose, skg_extent *extent) {
    const box of = {mesh->origin, lowest, highest};
    double h[8][3], low = HUGE_VAL, high = -HUGE_VAL, first = 0, last = 0;
    skg_scale_part *part = &extent->scale;
    *extent = (skg_extent){.scale = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL, 0, 0, 0, mesh->layers}};
    see_corners(camera, &of, pose, h);
    for (int k = 0; k < 8; k++) low = lesser(low, h[k][2]), high = greater(high, h[k][2]);
    if (camera->parallel) start_range(camera, &first, &last);
    /* Twice the limit of the kernels, which compare vertices in float; the box is compared in double. */
    extent->near_source = camera->parallel ? low <= last : low <= 2.0 * (double)SKG_NEAR;
    for (int k = 0; k < 8; k++) {
        const double t = camera->parallel ? 1 : h[k][2];
        if (extent->near_source && !camera->parallel) break;
        part->low_column = lesser(part->low_column, h[k][0] / t),
        part->high_column = greater(part->high_column, h[k][0] / t);
        part->low_row = lesser(part->low_row, h[k][1] / t),
        part->high_row = greater(part->high_row, h[k][1] / t);
    }
    if (extent->near_source && !camera->parallel) {
        part->low_column = part->low_row = -HUGE_VAL;
        part->high_column = part->high_row = HUGE_VAL;
    }
    /* The part of the mesh before the start of the rays or behind the detector adds nothing. */
    part->low_depth = lesser(greater(low, lesser(first, 1)), 1);
    part->high_depth = lesser(greater(high, part->low_depth), 1);
    extent->on_way = high > fmin(first, 1) && low < 1;
    extent->on_detector = part->high_column >= -0.5 && part->high_row >= -0.5 &&
                          part->low_column <= (double)camera->columns - 0.5 &&
                          part->low_row <= (double)camera->rows - 0.5 && part->high_depth > part->low_depth;
}

/* Rows that are added to an extent and that it is rounded to, so that a part that moves a little keeps its extent. */
enum { EXTENT_ROWS = 16 };

void skg_extent_pixels(const skg_camera *camera, const skg_extent *extent, int32_t pixels[4]) {
    const double rows = (double)camera->rows, columns = (double)camera->columns;
    const skg_scale_part *at = &extent->scale;
    pixels[0] = (int32_t)fmin(fmax(at->low_row - 2, 0), rows) & -EXTENT_ROWS;
    pixels[1] = (int32_t)fmin(fmax(at->high_row + 2 + EXTENT_ROWS, 0), rows + EXTENT_ROWS) & -EXTENT_ROWS;
    pixels[2] = (int32_t)fmin(fmax(at->low_column - 2, 0), columns) / SKG_EXTENT_COLUMNS * SKG_EXTENT_COLUMNS;
    pixels[3] = ((int32_t)fmin(fmax(at->high_column + 3, 0), columns - 1) / SKG_EXTENT_COLUMNS + 1) *
                SKG_EXTENT_COLUMNS;
}

void skg_extent_join(int32_t pixels[4], const int32_t more[4]) {
    const int known = pixels[1] > 0;
    for (int k = 0; k < 4; k += 2) {
        pixels[k] = known && pixels[k] < more[k] ? pixels[k] : more[k];
        pixels[k + 1] = known && pixels[k + 1] > more[k + 1] ? pixels[k + 1] : more[k + 1];
    }
}
