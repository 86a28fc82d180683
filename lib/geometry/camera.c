/* Where points and parts are seen, from a view and a sample of the source. */
#include "geometry/optics.h"

#include "core/maths.h"

#include <math.h>
#include <string.h>

/* matrix = [a b c]^-1, by cofactors. Returns the determinant of [a b c]. */
static double invert(const double a[3], const double b[3], const double c[3], double matrix[3][3]) {
    skg_cross(b, c, matrix[0]);
    skg_cross(c, a, matrix[1]);
    skg_cross(a, b, matrix[2]);
    const double determinant = skg_dot(a, matrix[0]);
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++) matrix[r][k] /= determinant;
    return determinant;
}

/* The t at which the paths of a parallel beam start: at the plane through the source across the direction d. There
 * t - 1 = -((D0 + i Du + j Dv - S) . d) / d.d for pixel (i, j). */
static void parallel_start(const skg_view *view, const double pixel[3], skg_camera *camera) {
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY) {
        camera->start[0] = -1e30; /* before every part, and a float */
        return;
    }
    const double *d = camera->first, square = skg_dot(d, d);
    double from[3];
    for (int k = 0; k < 3; k++) from[k] = pixel[k] - view->source[k];
    camera->start[0] = 1 - skg_dot(from, d) / square;
    camera->start[1] = -skg_dot(camera->column, d) / square;
    camera->start[2] = -skg_dot(camera->row, d) / square;
}

/* Nothing is rounded here. A direction from infinity is scaled to a length near 1 by a power of two. */
static void parallel_direction(const skg_view *view, double direction[3]) {
    int exponent = 0;
    if (view->projection == SKG_PROJECTION_PARALLEL) {
        skg_add_scaled(view->centre, -1, view->source, direction);
        return;
    }
    frexp(fmax(fabs(view->source[0]), fmax(fabs(view->source[1]), fabs(view->source[2]))), &exponent);
    for (int k = 0; k < 3; k++) direction[k] = ldexp(view->source[k], -exponent);
}

skg_status skg_camera_make(const skg_view *view, const double *source, double shift_column, double shift_row,
                           skg_camera *camera) {
    skg_view flat = *view;
    *camera = (skg_camera){.parallel = view->projection != SKG_PROJECTION_POINT};
    if (view->radius > 0) {
        skg_bends_find(view, source, shift_column, shift_row, &flat, &camera->bends);
        shift_column = shift_row = 0; /* they are in the places of the lines */
    }
    camera->columns = flat.columns, camera->rows = flat.rows;
    const double column = shift_column - 0.5 * (double)(flat.columns - 1);
    const double row = shift_row - 0.5 * (double)(flat.rows - 1);
    double pixel[3];
    for (int k = 0; k < 3; k++) {
        camera->column[k] = flat.column_step[k];
        camera->row[k] = flat.row_step[k];
        pixel[k] = flat.centre[k] + column * flat.column_step[k] + row * flat.row_step[k];
    }
    const double *seen_from = source ? source : view->source;
    for (int k = 0; k < 3; k++) {
        camera->origin[k] = camera->parallel ? pixel[k] : seen_from[k];
        camera->first[k] = pixel[k] - seen_from[k];
        camera->corner[k] = pixel[k] - view->centre[k];
    }
    if (camera->parallel) parallel_direction(view, camera->first);
    camera->determinant = invert(camera->column, camera->row, camera->first, camera->matrix);
    if (!(fabs(camera->determinant) > 0) || !isfinite(camera->determinant))
        return skg_fail(SKG_ERR_SCENE,
                        "the detector's steps and the beam lie in one plane, or are not finite; "
                        "nothing can be projected");
    if (camera->parallel) parallel_start(view, pixel, camera);
    return SKG_OK;
}

void skg_camera_see(const skg_camera *camera, const double world[3], double h[3]) {
    double v[3];
    for (int k = 0; k < 3; k++) v[k] = world[k] - camera->origin[k];
    for (int r = 0; r < 3; r++) h[r] = skg_dot(camera->matrix[r], v);
}

/* The pixel of the detector that is nearest to x along one axis. */
static double own_pixel(double x, int64_t count) {
    const double last = (double)(count - 1);
    const double pixel = floor(x + 0.5);
    return pixel > 0 ? (pixel < last ? pixel : last) : 0;
}

static double determinant(double m[3][3]) {
    double c[3];
    skg_cross(m[1], m[2], c);
    return skg_dot(m[0], c);
}

/* --- Sums of two doubles: `low` is what rounding has lost. The place of a part far from the source or the origin is a small
 * difference of large numbers, and parts that touch must agree on it by less than a thousandth of what doubles leave. */
typedef struct {
    double high, low;
} pair;

/* sum + a b. Written so that no compiler may contract anything. */
static pair add_product(pair sum, double a, double b) {
    const double product = a * b, high = sum.high + product, of_b = high - sum.high;
    const double lost = (sum.high - (high - of_b)) + (product - of_b);
    const double rest = fma(a, b, -product);
    return (pair){high, sum.low + lost + rest};
}

/* As skg_pose_point and skg_camera_see, with twice the digits. */
static void see_exactly(const skg_camera *camera, const double *pose, const double *origin, pair h[3]) {
    pair v[3];
    for (int r = 0; r < 3; r++) {
        v[r] = (pair){pose[4 * r + 3], 0};
        for (int k = 0; k < 3; k++) v[r] = add_product(v[r], pose[4 * r + k], origin[k]);
        v[r] = add_product(v[r], -1, camera->origin[r]);
    }
    for (int r = 0; r < 3; r++) {
        h[r] = (pair){0, 0};
        for (int k = 0; k < 3; k++) h[r] = add_product(h[r], camera->matrix[r][k], v[k].high);
        double low = h[r].low;
        for (int k = 0; k < 3; k++) low = fma(camera->matrix[r][k], v[k].low, low);
        h[r].low = low;
    }
}

static void see_origin(const skg_camera *camera, const double *pose, const double *origin, int32_t exact,
                       pair h[3]) {
    double world[3], seen[3];
    if (exact) {
        see_exactly(camera, pose, origin, h);
        return;
    }
    for (int r = 0; r < 3; r++) world[r] = skg_dot(pose + 4 * r, origin) + pose[4 * r + 3];
    skg_camera_see(camera, world, seen);
    for (int r = 0; r < 3; r++) h[r] = (pair){seen[r], 0};
}

/* One axis of the picture: anchor, offset and row of the part, relative to its pixel (skg_shared.h). shared: the pixel, if it is
 * given. */
static void point_axis(pair h, pair depth, const double linear[3], const double deep[3], int64_t count,
                       const int32_t *shared, double row[3], double *offset, double *anchor, SKG_INT *pixel) {
    const int seen = depth.high > (double)SKG_NEAR; /* otherwise the origin of the mesh has no projection */
    const double at = seen ? h.high / depth.high : 0.5 * (double)(count - 1);
    const double rest = fma(-at, depth.high, h.high) + (h.low - at * depth.low);
    const double own = shared ? *shared : own_pixel(at, count);
    const double relative_to = seen ? at : own;
    *pixel = (SKG_INT)own;
    *anchor = seen ? (at - own) + (h.low != 0 || depth.low != 0 ? rest / depth.high : 0) : 0;
    *offset = seen ? 0 : h.high - own * depth.high;
    for (int k = 0; k < 3; k++) row[k] = linear[k] - relative_to * deep[k];
}

static void parallel_axis(pair h, const double linear[3], int64_t count, const int32_t *shared, double row[3],
                          double *offset, double *anchor, SKG_INT *pixel) {
    const double own = shared ? *shared : own_pixel(h.high, count);
    *pixel = (SKG_INT)own;
    *anchor = (h.high - own) + h.low;
    *offset = 0;
    for (int k = 0; k < 3; k++) row[k] = linear[k];
}

void skg_camera_part(const skg_camera *camera, const skg_camera_place *place, skg_part_double *part) {
    const double *pose = place->pose;
    const int32_t *shared = place->shared;
    double pose_linear[3][3], linear[3][3];
    pair h[3];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) pose_linear[r][c] = pose[4 * r + c];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            linear[r][c] = camera->matrix[r][0] * pose[c] + camera->matrix[r][1] * pose[4 + c] +
                           camera->matrix[r][2] * pose[8 + c];
    see_origin(camera, pose, place->origin, place->exact, h);
    const pair depth = !camera->parallel ? h[2]
                       : place->exact    ? add_product(h[2], 1, 1)
                                         : (pair){h[2].high + 1, 0};
    if (camera->parallel) {
        parallel_axis(h[0], linear[0], camera->columns, shared, part->row0, &part->offset_x, &part->anchor_x,
                      &part->pixel_i);
        parallel_axis(h[1], linear[1], camera->rows, shared ? shared + 1 : NULL, part->row1, &part->offset_y,
                      &part->anchor_y, &part->pixel_j);
    } else {
        point_axis(h[0], depth, linear[0], linear[2], camera->columns, shared, part->row0, &part->offset_x,
                   &part->anchor_x, &part->pixel_i);
        point_axis(h[1], depth, linear[1], linear[2], camera->rows, shared ? shared + 1 : NULL, part->row1,
                   &part->offset_y, &part->anchor_y, &part->pixel_j);
    }
    for (int k = 0; k < 3; k++) part->row2[k] = linear[2][k];
    part->reference = camera->parallel || place->reference > 0 ? place->reference : 1;
    part->offset_r = (depth.high - part->reference) + depth.low;
    part->highest = 1 - part->reference;
    part->start[0] = camera->start[0] + camera->start[1] * part->pixel_i + camera->start[2] * part->pixel_j -
                     part->reference;
    part->start[1] = camera->start[1];
    part->start[2] = camera->start[2];
    part->steepest = part->shift = 0;
    part->fine = 0;
    /* Seen from the source, the far faces of an outward mesh turn in the sense of the picture's axes. */
    const int mirrored = (determinant(pose_linear) < 0) != (camera->determinant < 0);
    part->turned = mirrored != (place->flipped != 0) ? -1 : 0;
    memset(part->low0, 0, sizeof part->low0);
    memset(part->low1, 0, sizeof part->low1);
    memset(part->low2, 0, sizeof part->low2);
    part->low_x = part->low_y = part->low_r = part->low_anchor_x = part->low_anchor_y = part->low_reference =
        0;
}

double skg_camera_pixel_area(const skg_camera *camera) {
    double across[3];
    if (skg_camera_is_curved(camera)) return camera->bends.area;
    skg_cross(camera->column, camera->row, across);
    return skg_length(across);
}

double skg_camera_foot(const skg_camera *camera) {
    double across[3];
    skg_cross(camera->column, camera->row, across);
    return fabs(skg_dot(camera->first, across)) / skg_length(across);
}

void skg_camera_rays(const skg_camera *camera, double scale, skg_ray_double *ray) {
    const double column = 0.5 * (double)(camera->columns - 1), row = 0.5 * (double)(camera->rows - 1);
    *ray = (skg_ray_double){.unit = 1 / scale};
    for (int k = 0; k < 3; k++) {
        ray->centre[k] = camera->first[k];
        if (camera->parallel) continue; /* all rays have the direction d */
        ray->centre[k] += column * camera->column[k] + row * camera->row[k];
        ray->column[k] = camera->column[k];
        ray->row[k] = camera->row[k];
    }
    ray->middle_i = column;
    ray->middle_j = row;
}

void skg_rays_round(const skg_ray_double *from, skg_ray_float *to) {
    for (int k = 0; k < 3; k++) {
        to->centre[k] = (float)from->centre[k];
        to->column[k] = (float)from->column[k];
        to->row[k] = (float)from->row[k];
    }
    to->middle_i = (float)from->middle_i;
    to->middle_j = (float)from->middle_j;
    to->unit = (float)from->unit;
}
