/* One view of a map, drawn into pixels. */
#include "map/panel.h"

#include "common/say.h"

#include <skiagraph/breathing.h>

#include <math.h>
#include <stdlib.h>

/* Rays along a side of a pixel, and the white margin in pixels. */
enum { FINE = 2, MARGIN = 8 };

/* The darkest shade, of a facet seen edge on: the colours stay legible. */
static const double DARKEST = 0.55;

typedef struct {
    int width, height; /* in rays */
    float *depth, *value, *shade;
} buffers;

typedef struct {
    double x, y, depth, value;
} corner;

/* Fills the rays that a triangle meets and that nothing nearer has. */
static void draw_triangle(const buffers *b, const corner c[3], float shade) {
    const double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
    if (area == 0) return;
    const int left = (int)fmax(0, floor(fmin(c[0].x, fmin(c[1].x, c[2].x))));
    const int right = (int)fmin(b->width - 1, ceil(fmax(c[0].x, fmax(c[1].x, c[2].x))));
    const int top = (int)fmax(0, floor(fmin(c[0].y, fmin(c[1].y, c[2].y))));
    const int bottom = (int)fmin(b->height - 1, ceil(fmax(c[0].y, fmax(c[1].y, c[2].y))));
    for (int row = top; row <= bottom; row++)
        for (int column = left; column <= right; column++) {
            const double x = column + 0.5, y = row + 0.5;
            const double u = ((c[1].x - x) * (c[2].y - y) - (c[2].x - x) * (c[1].y - y)) / area;
            const double v = ((c[2].x - x) * (c[0].y - y) - (c[0].x - x) * (c[2].y - y)) / area;
            const double w = 1 - u - v;
            const int at = row * b->width + column;
            const float depth = (float)(u * c[0].depth + v * c[1].depth + w * c[2].depth);
            if (u < 0 || v < 0 || w < 0 || depth >= b->depth[at]) continue;
            b->depth[at] = depth;
            b->value[at] = (float)(u * c[0].value + v * c[1].value + w * c[2].value);
            b->shade[at] = shade;
        }
}

static float shade_of(const double *p, const double *q, const double *r) {
    double e[3], f[3], n[3];
    for (int k = 0; k < 3; k++) e[k] = q[k] - p[k], f[k] = r[k] - p[k];
    for (int k = 0; k < 3; k++) n[k] = e[(k + 1) % 3] * f[(k + 2) % 3] - e[(k + 2) % 3] * f[(k + 1) % 3];
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return (float)(length > 0 ? DARKEST + (1 - DARKEST) * fabs(n[1]) / length : 1);
}

/* Draws all triangles, along y: from in front towards greater y. */
static void draw_all(const buffers *b, int behind, int64_t triangles, const double *positions,
                     const int32_t *corners, const double *bounds, const double *distances) {
    const double wide = fmax(bounds[3] - bounds[0], 1e-9), high = fmax(bounds[5] - bounds[2], 1e-9);
    const double per_mm = fmin((b->width - 2 * FINE * MARGIN) / wide, (b->height - 2 * FINE * MARGIN) / high);
    const double sign = behind ? -1 : 1;
    for (int64_t t = 0; t < triangles; t++) {
        corner c[3];
        const double *p[3];
        for (int k = 0; k < 3; k++) {
            const int32_t vertex = corners[3 * t + k];
            p[k] = positions + 3 * (int64_t)vertex;
            c[k].x = b->width / 2.0 + sign * per_mm * (p[k][0] - (bounds[0] + bounds[3]) / 2);
            c[k].y = b->height / 2.0 - per_mm * (p[k][2] - (bounds[2] + bounds[5]) / 2);
            c[k].depth = sign * p[k][1];
            c[k].value = distances[vertex];
        }
        draw_triangle(b, c, shade_of(p[0], p[1], p[2]));
    }
}

/* Each pixel is the mean of its rays. */
static void mix(const buffers *b, double high_mm, const panel_pixels *to) {
    for (int row = 0; row < to->height; row++)
        for (int column = 0; column < to->width; column++) {
            double sum[3] = {0};
            for (int ray = 0; ray < FINE * FINE; ray++) {
                const int at = (row * FINE + ray / FINE) * b->width + column * FINE + ray % FINE;
                uint8_t rgb[3] = {255, 255, 255};
                if (isfinite(b->depth[at])) (void)skg_distance_colour((double)b->value[at] / high_mm, rgb);
                const double shade = isfinite(b->depth[at]) ? (double)b->shade[at] : 1;
                for (int k = 0; k < 3; k++) sum[k] += shade * rgb[k] / (FINE * FINE);
            }
            unsigned char *pixel = to->pixels + row * to->stride + 4 * column;
            for (int k = 0; k < 3; k++) pixel[2 - k] = (unsigned char)lround(sum[k]);
        }
}

int panel_draw(const cli_map *map, int behind, double high_mm, const panel_pixels *to) {
    buffers b = {.width = FINE * to->width, .height = FINE * to->height};
    const size_t rays = (size_t)b.width * (size_t)b.height;
    int64_t vertices = 0, triangles = 0;
    skg_mesh_health health;
    skg_mesh_health_init(&health);
    skg_status status = skg_mesh_count(map->mesh, &vertices, &triangles);
    if (status == SKG_OK) status = skg_mesh_health_get(map->mesh, &health);
    double *positions = malloc((size_t)(3 * vertices) * sizeof *positions);
    int32_t *corners = malloc((size_t)(3 * triangles) * sizeof *corners);
    float *all = malloc(3 * rays * sizeof *all);
    int exit_status = CLI_DONE;
    if (status == SKG_OK && positions && corners && all) {
        status = skg_mesh_positions_get(map->mesh, positions, 0);
        if (status == SKG_OK) status = skg_mesh_triangles_get(map->mesh, corners, 0);
        b.depth = all, b.value = all + rays, b.shade = all + 2 * rays;
        for (size_t i = 0; i < rays; i++) b.depth[i] = HUGE_VALF;
        if (status == SKG_OK)
            draw_all(&b, behind, triangles, positions, corners, health.bounds, map->distances);
        mix(&b, high_mm, to);
    } else if (status == SKG_OK) {
        exit_status = cli_error(CLI_DEVICE, "out of host memory for a picture");
    }
    free(positions);
    free(corners);
    free(all);
    return status == SKG_OK ? exit_status : cli_fail(status);
}
