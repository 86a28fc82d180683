/* The pixels and depths that a part covers. */
#include "geometry/bounds.h"

#include "core/maths.h"

#include <float.h>
#include <math.h>

typedef struct {
    const double *origin;
    const float *lowest, *highest; /* mm from the origin */
} box;

/* h (pixel times t, and t) of the corners of a box: that of the lowest corner, and from there along the
 * edges. A frame may have a million parts, so only one corner and three edges of each are transformed.
 *
 * reach   the sum of the terms of which the device makes t, less that of the mesh's origin */
static void see_corners(const skg_camera *camera, const box *of, const double *pose, double h[8][3],
                        double *reach) {
    double lowest[3], world[3], edge[3][3];
    *reach = 0;
    for (int k = 0; k < 3; k++) lowest[k] = of->origin[k] + (double)of->lowest[k];
    skg_pose_point(pose, lowest, world);
    skg_camera_see(camera, world, h[0]);
    if (camera->parallel) h[0][2] += 1; /* t, counted as for a point source */
    for (int k = 0; k < 3; k++) {
        const double along[3] = {pose[k], pose[4 + k], pose[8 + k]};
        const double length = (double)of->highest[k] - (double)of->lowest[k];
        const double most = fmax(fabs((double)of->lowest[k]), fabs((double)of->highest[k]));
        for (int r = 0; r < 3; r++) edge[k][r] = length * skg_dot(camera->matrix[r], along);
        *reach += most * fabs(skg_dot(camera->matrix[2], along));
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

void skg_extent_find(const skg_camera *camera, const skg_mesh *mesh, const double *pose, double last_bit,
                     skg_extent *extent) {
    skg_extent_find_within(camera, mesh, mesh->lowest, mesh->highest, pose, last_bit, mesh->layers, extent);
}

/* A range of t, and that of the planes where rays start. */
typedef struct {
    double low, high, first, last;
} range;

static void clamp_to_path(const range *t, double *low, double *high) {
    *low = lesser(greater(t->low, lesser(t->first, 1)), 1);
    *high = lesser(greater(t->high, *low), 1);
}

/* By how much a t of the device may differ from that in double. There, t less the reference is the sum of `reach` and of the
 * origin's, from entries that are rounded themselves (project.cl), then interpolated between corners (source_plane.cl): at most
 * eight roundings of half a last bit each. Where the path ends within the part, the reference and the end are rounded, too.
 * Bounds are floats, also those of vertices in double. World coordinates are in double. */
static double depth_rounding(const range *t, const skg_camera *camera, const double *origin,
                             const double *pose, double reach, double last_bit) {
    double low, high, world[3], far = 0;
    clamp_to_path(t, &low, &high);
    const double reference = 0.5 * (low + high);
    const double span = fmax(fabs(t->low - reference), fabs(t->high - reference));
    const int from_start = t->low <= t->last;
    skg_pose_point(pose, origin, world);
    for (int k = 0; k < 3; k++)
        far += fabs(camera->matrix[2][k]) * (fabs(world[k]) + fabs(camera->origin[k]));
    const double ends = from_start     ? 1 + fabs(reference) + fabs(t->first) + fabs(t->last)
                        : t->high >= 1 ? 1 + fabs(reference)
                                       : 0;
    return 4 * last_bit * (reach + span) + 0.5 * (double)FLT_EPSILON * reach + 4 * DBL_EPSILON * far +
           last_bit * ends;
}

/* Widens the range by what the device rounds, where that is not small against the depth: a scale that were made for the depth
 * alone would let sums wrap. A quarter leaves a factor of 1.5 of the 2 that integers have beyond the bound. Where paths of a
 * parallel beam start behind the part, its hits have the depth of that start, which cancels but has to be an integer of the
 * device. */
static void widen(range *t, double rounding) {
    double low, high;
    clamp_to_path(t, &low, &high);
    if (4 * rounding > high - low) t->low -= rounding, t->high += rounding;
    if (t->low <= t->last && t->high > t->first && t->last - low > 2 * (high - low)) t->high = t->last;
}

/* From places on the plane of the camera to pixels of a curved detector. */
static void bend(const skg_camera *camera, skg_scale_part *part) {
    double columns[2] = {part->low_column, part->high_column}, rows[2] = {part->low_row, part->high_row};
    skg_bends_extent(camera, columns, rows);
    part->low_column = columns[0], part->high_column = columns[1];
    part->low_row = rows[0], part->high_row = rows[1];
}

void skg_extent_find_within(const skg_camera *camera, const skg_mesh *mesh, const float lowest[3],
                            const float highest[3], const double *pose, double last_bit, int64_t layers,
                            skg_extent *extent) {
    const box of = {mesh->origin, lowest, highest};
    double h[8][3], reach;
    range t = {HUGE_VAL, -HUGE_VAL, 0, 0};
    skg_scale_part *part = &extent->scale;
    *extent = (skg_extent){.scale = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL, 0, 0, 0, (double)layers}};
    see_corners(camera, &of, pose, h, &reach);
    for (int k = 0; k < 8; k++) t.low = lesser(t.low, h[k][2]), t.high = greater(t.high, h[k][2]);
    if (camera->parallel) start_range(camera, &t.first, &t.last);
    const double rounding = depth_rounding(&t, camera, mesh->origin, pose, reach, last_bit);
    widen(&t, rounding);
    /* Twice the limit of the kernels, which compare rounded vertices; the box is compared in double. */
    extent->near_source = camera->parallel
                              ? t.low <= t.last
                              : t.low <= 2.0 * (double)SKG_NEAR || t.low - rounding <= (double)SKG_NEAR;
    for (int k = 0; k < 8; k++) {
        const double by = camera->parallel ? 1 : h[k][2];
        if (extent->near_source && !camera->parallel) break;
        part->low_column = lesser(part->low_column, h[k][0] / by),
        part->high_column = greater(part->high_column, h[k][0] / by);
        part->low_row = lesser(part->low_row, h[k][1] / by),
        part->high_row = greater(part->high_row, h[k][1] / by);
    }
    if (extent->near_source && !camera->parallel) {
        part->low_column = part->low_row = -HUGE_VAL;
        part->high_column = part->high_row = HUGE_VAL;
    }
    if (skg_camera_is_curved(camera)) bend(camera, part);
    /* The part of the mesh before the start of the rays or behind the detector adds nothing. */
    clamp_to_path(&t, &part->low_depth, &part->high_depth);
    extent->on_way = t.high > fmin(t.first, 1) && t.low < 1;
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
