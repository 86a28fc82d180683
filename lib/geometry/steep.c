#include "geometry/steep.h"

#include <math.h>

/* A convex polygon on a face, by barycentric coordinates; four half-planes cut a triangle to at most seven corners. */
enum { CORNERS = 8 };
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

/* The part of a polygon where sign (column or row - limit) >= 0. */
static polygon cut(const skg_camera *camera, const double seen[3][3], const polygon *p, int axis,
                   double limit, double sign) {
    polygon kept = {.count = 0};
    for (int k = 0; k < p->count; k++) {
        const double *here = p->b[k], *next = p->b[(k + 1) % p->count];
        const double inside = sign * (mix(seen, axis, here) - limit * depth_at(camera, seen, here));
        const double after = sign * (mix(seen, axis, next) - limit * depth_at(camera, seen, next));
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
    for (int k = 2; k < p->count; k++) {
        const double *const corners[3] = {p->b[0], p->b[k - 1], p->b[k]};
        add_triangle(camera, seen, corners, weight, moments);
    }
}

/* The integrals of a face over the pixels that see it: their sum, or to each pixel what slopes at the corners make of its own.
 * values: NULL: the sum. */
static void walk(const skg_camera *camera, double seen[3][3], skg_steep_weight weight, const void *user,
                 const double slopes[3], double *values, double sums[3]) {
    const double(*at)[3] = (const double(*)[3])seen;
    const polygon face = {.count = 3, .b = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    int64_t columns[2], rows[2];
    range_of(camera, at, &face, 0, columns);
    for (int64_t c = columns[0]; c <= columns[1]; c++) {
        const polygon left = cut(camera, at, &face, 0, (double)c - 0.5, 1);
        const polygon strip = cut(camera, at, &left, 0, (double)c + 0.5, -1);
        if (strip.count < 3) continue;
        range_of(camera, at, &strip, 1, rows);
        for (int64_t r = rows[0]; r <= rows[1]; r++) {
            const double of_pixel = weight(user, c, r);
            double own[3] = {0};
            if (of_pixel == 0) continue;
            const polygon above = cut(camera, at, &strip, 1, (double)r - 0.5, 1);
            const polygon pixel = cut(camera, at, &above, 1, (double)r + 0.5, -1);
            add_polygon(camera, at, &pixel, of_pixel, values ? own : sums);
            for (int k = 0; values && k < 3; k++)
                values[r * camera->columns + c] += slopes[k] * own[k] / fabs(camera->determinant);
        }
    }
}

void skg_steep_add(const skg_camera *camera, double seen[3][3], skg_steep_weight weight, const void *user,
                   double moments[3]) {
    double sums[3] = {0};
    walk(camera, seen, weight, user, NULL, NULL, sums);
    for (int k = 0; k < 3; k++) moments[k] += sums[k] / fabs(camera->determinant);
}

void skg_steep_spread(const skg_camera *camera, double seen[3][3], skg_steep_weight weight, const void *user,
                      const double slopes[3], double *values) {
    walk(camera, seen, weight, user, slopes, values, NULL);
}
