/* Faces that contain rays: seen edge-on, they are hit by no ray, but the mean length over a pixel changes when they move. */
#include "gradient/steep.h"

#include <math.h>

/* A convex polygon on a face, by barycentric coordinates. Four half-planes cut a triangle to at most seven corners, and each plane that
 * then cuts off a slice adds at most one. */
enum { CORNERS = 16 };
typedef struct {
    int count;
    double b[CORNERS][3];
} polygon;

/* The path parameter of a point of a face, and its column or row times that parameter. */
static double mix(const double seen[3][3], int axis, const double b[3]) {
    return b[0] * seen[0][axis] + b[1] * seen[1][axis] + b[2] * seen[2][axis];
}

static double depth_at(const skg_camera *camera, const double seen[3][3], const double b[3]) {
    return camera->parallel ? 1 : mix(seen, 2, b);
}

/* The plane of a column or row. The sum is positive on the side of higher ones if sign is 1. */
static skg_seen_plane limit_of(const skg_camera *camera, int axis, double limit, double sign) {
    skg_seen_plane plane = {{0}};
    plane.p[axis] = sign;
    plane.p[camera->parallel ? 3 : 2] = -sign * limit;
    return plane;
}

static double side_of(const skg_seen_plane *plane, const double seen[3][3], const double b[3]) {
    double side = plane->p[3];
    for (int axis = 0; axis < 3; axis++)
        if (plane->p[axis] != 0) side += plane->p[axis] * mix(seen, axis, b);
    return side;
}

/* The part of a polygon where sign times what the plane gives is not negative. */
static polygon cut(const double seen[3][3], const polygon *p, const skg_seen_plane *plane, double sign) {
    polygon kept = {.count = 0};
    for (int k = 0; k < p->count; k++) {
        const double *here = p->b[k], *next = p->b[(k + 1) % p->count];
        const double inside = sign * side_of(plane, seen, here), after = sign * side_of(plane, seen, next);
        if (inside >= 0 && kept.count < CORNERS) {
            for (int c = 0; c < 3; c++) kept.b[kept.count][c] = here[c];
            kept.count++;
        }
        if ((inside >= 0) != (after >= 0) && kept.count < CORNERS) {
            const double share = inside / (inside - after);
            for (int c = 0; c < 3; c++) kept.b[kept.count][c] = here[c] + share * (next[c] - here[c]);
            kept.count++;
        }
    }
    return kept;
}

/* The part of a polygon between two columns or rows. */
static polygon cut_strip(const skg_camera *camera, const double seen[3][3], const polygon *p, int axis,
                         double from, double to) {
    const skg_seen_plane low = limit_of(camera, axis, from, 1), high = limit_of(camera, axis, to, -1);
    const polygon above = cut(seen, p, &low, 1);
    return cut(seen, &above, &high, 1);
}

/* The first and last pixel of an axis that a polygon meets, on the detector. */
static void range_of(const skg_camera *camera, const double seen[3][3], const polygon *p, int axis,
                     int64_t range[2]) {
    const int64_t count = axis == 0 ? camera->columns : camera->rows;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int k = 0; k < p->count; k++) {
        const double at = mix(seen, axis, p->b[k]) / depth_at(camera, seen, p->b[k]);
        low = fmin(low, at);
        high = fmax(high, at);
    }
    range[0] = (int64_t)fmin(fmax(floor(low + 0.5), 0), (double)count);
    range[1] = (int64_t)fmin(fmax(floor(high + 0.5), -1), (double)(count - 1));
}

/* Adds the integral of b_k / t^2 over a triangle: the rule of 7 points and degree 5 (J. Radon, Monatshefte fuer Mathematik und
 * Physik 52 (1948) 286-300). */
static void add_triangle(const skg_camera *camera, const double seen[3][3], const double *const corner[3],
                         double weight, double moments[3]) {
    const double root = sqrt(15.0), far[2] = {(6 - root) / 21, (6 + root) / 21};
    const double shares[2] = {(155 - root) / 1200, (155 + root) / 1200};
    const double middle = 9.0 / 40;
    const double area = 0.5 * fabs((corner[1][1] - corner[0][1]) * (corner[2][2] - corner[0][2]) -
                                   (corner[2][1] - corner[0][1]) * (corner[1][2] - corner[0][2]));
    for (int point = 0; point < 7; point++) {
        const int ring = (point - 1) / 3, turned = (point - 1) % 3;
        double b[3], local[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
        for (int k = 0; point > 0 && k < 3; k++) local[k] = k == turned ? 1 - 2 * far[ring] : far[ring];
        for (int c = 0; c < 3; c++)
            b[c] = local[0] * corner[0][c] + local[1] * corner[1][c] + local[2] * corner[2][c];
        const double t = depth_at(camera, seen, b);
        const double share = (point > 0 ? shares[ring] : middle) * weight * area / (t * t);
        for (int k = 0; k < 3; k++) moments[k] += share * b[k];
    }
}

static void add_polygon(const skg_camera *camera, const double seen[3][3], const polygon *p, double weight,
                        double moments[3]) {
    for (int k = 2; weight != 0 && k < p->count; k++) {
        const double *const corners[3] = {p->b[0], p->b[k - 1], p->b[k]};
        add_triangle(camera, seen, corners, weight, moments);
    }
}

/* A polygon that a pixel sees, which planes divide into slices with weights of their own. */
static void add_slices(const skg_camera *camera, const double seen[3][3], const polygon *p,
                       const skg_steep_weights *weights, double moments[3]) {
    polygon rest = *p;
    for (int64_t k = 0; k < weights->planes.count; k++) {
        const skg_seen_plane *plane = &weights->planes.at[k].plane;
        const polygon slice = cut(seen, &rest, plane, -1);
        add_polygon(camera, seen, &slice, weights->weights[k], moments);
        rest = cut(seen, &rest, plane, 1);
    }
    add_polygon(camera, seen, &rest, weights->rest, moments);
}

/* The middle of the line as which a polygon is seen: column and row. */
static void find_middle(const skg_camera *camera, const double seen[3][3], const polygon *p,
                        double middle[2]) {
    for (int axis = 0; axis < 2; axis++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int k = 0; k < p->count; k++) {
            const double at = mix(seen, axis, p->b[k]) / depth_at(camera, seen, p->b[k]);
            low = fmin(low, at);
            high = fmax(high, at);
        }
        middle[axis] = 0.5 * (low + high);
    }
}

/* A face on its way over the pixels that see it. Their integrals are summed up, or go to each pixel times what slopes at the corners
 * make of them. values: NULL: the sum. */
typedef struct {
    const skg_camera *camera;
    const double (*seen)[3];
    skg_steep_weigh weigh;
    const void *user;
    const double *slopes;
    double *values, *sums;
    skg_steep_weights weights; /* of the present pixel */
} steep_walk;

static skg_status add_pixel(steep_walk *w, int64_t column, int64_t row, const polygon *strip) {
    const polygon pixel = cut_strip(w->camera, w->seen, strip, 1, (double)row - 0.5, (double)row + 0.5);
    double middle[2], own[3] = {0};
    if (pixel.count < 3) return SKG_OK;
    find_middle(w->camera, w->seen, &pixel, middle);
    SKG_TRY(w->weigh(w->user, column, row, middle, &w->weights));
    add_slices(w->camera, w->seen, &pixel, &w->weights, w->values ? own : w->sums);
    for (int k = 0; w->values && k < 3; k++)
        w->values[row * w->camera->columns + column] += w->slopes[k] * own[k] / fabs(w->camera->determinant);
    return SKG_OK;
}

static skg_status add_pixels(steep_walk *w) {
    const polygon face = {.count = 3, .b = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    int64_t columns[2], rows[2];
    range_of(w->camera, w->seen, &face, 0, columns);
    for (int64_t c = columns[0]; c <= columns[1]; c++) {
        const polygon strip = cut_strip(w->camera, w->seen, &face, 0, (double)c - 0.5, (double)c + 0.5);
        if (strip.count < 3) continue;
        range_of(w->camera, w->seen, &strip, 1, rows);
        for (int64_t r = rows[0]; r <= rows[1]; r++) SKG_TRY(add_pixel(w, c, r, &strip));
    }
    return SKG_OK;
}

static skg_status walk(steep_walk *w) {
    const skg_status status = add_pixels(w);
    skg_free(&w->weights.planes.at);
    skg_free(&w->weights.weights);
    return status;
}

skg_status skg_steep_add(const skg_camera *camera, double seen[3][3], skg_steep_weigh weigh, const void *user,
                         double moments[3]) {
    double sums[3] = {0};
    steep_walk w = {
        .camera = camera, .seen = (const double(*)[3])seen, .weigh = weigh, .user = user, .sums = sums};
    SKG_TRY(walk(&w));
    for (int k = 0; k < 3; k++) moments[k] += sums[k] / fabs(camera->determinant);
    return SKG_OK;
}

skg_status skg_steep_spread(const skg_camera *camera, double seen[3][3], skg_steep_weigh weigh,
                            const void *user, const double slopes[3], double *values) {
    steep_walk w = {.camera = camera,
                    .seen = (const double(*)[3])seen,
                    .weigh = weigh,
                    .user = user,
                    .slopes = slopes,
                    .values = values};
    return walk(&w);
}
