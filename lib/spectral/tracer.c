/* A few rays through the parts on the host, for the choice of energies and for bounds. */
#include "spectral/verification.h"

#include "core/maths.h"
#include "mesh/mesh.h"

#include <math.h>
#include <string.h>

/* Rays are off the corner of their cell by an irrational part of it (square roots of 3 and 2), so that they do
 * not meet shared edges exactly. */
static const double OFF_COLUMN = 0.5732050807568877, OFF_ROW = 0.4142135623730951;

/* Components of a vertex in skg_tracer.seen. */
enum { X, Y, W, T, COLUMN, ROW };

static void lay(skg_tracer *grid, int64_t side, const double low[2], const double high[2]) {
    grid->side = side;
    grid->column_step = (high[0] - low[0]) / (double)side;
    grid->row_step = (high[1] - low[1]) / (double)side;
    grid->column = low[0] + OFF_COLUMN * grid->column_step;
    grid->row = low[1] + OFF_ROW * grid->row_step;
}

static void lay_over_detector(skg_tracer *grid, int64_t side) {
    const double low[2] = {-0.5, -0.5};
    const double high[2] = {(double)grid->camera->columns - 0.5, (double)grid->camera->rows - 0.5};
    lay(grid, side, low, high);
}

static double start_of(const skg_camera *camera, double i, double j) {
    return camera->parallel ? camera->start[0] + camera->start[1] * i + camera->start[2] * j : 0;
}

/* mm per unit of the path parameter, of the ray to (i, j). */
static double unit_of(const skg_camera *camera, double i, double j) {
    double ray[3];
    for (int k = 0; k < 3; k++)
        ray[k] = camera->first[k] + (camera->parallel ? 0 : i * camera->column[k] + j * camera->row[k]);
    return skg_length(ray);
}

skg_status skg_tracer_open(const skg_camera *camera, const skg_scene_part_data *part, int near_source,
                           skg_tracer *tracer) {
    static const char what[] = "rays through a part";
    const skg_mesh *mesh = part->mesh;
    *tracer = (skg_tracer){.camera = camera, .mesh = mesh, .near_source = near_source};
    SKG_TRY(skg_alloc(mesh->vertices, sizeof *tracer->seen, what, &tracer->seen));
    SKG_TRY(skg_alloc(SKG_TRACED_SIDE * SKG_TRACED_SIDE, sizeof *tracer->lengths, what, &tracer->lengths));
    SKG_TRY(skg_alloc(SKG_TRACED_SIDE * SKG_TRACED_SIDE, sizeof *tracer->counts, what, &tracer->counts));
    SKG_TRY(skg_alloc(SKG_TRACED_SIDE * SKG_TRACED_SIDE, sizeof *tracer->met, what, &tracer->met));
    for (int64_t v = 0; v < mesh->vertices; v++) {
        double at[3], world[3], *h = tracer->seen[v];
        skg_mesh_vertex(mesh, v, at);
        skg_pose_point(part->pose, at, world);
        skg_camera_see(camera, world, h);
        h[T] = camera->parallel ? h[W] + 1 : h[W];
        if (camera->parallel) h[W] = 1;
        if (h[W] > 0) h[COLUMN] = h[X] / h[W], h[ROW] = h[Y] / h[W];
    }
    return SKG_OK;
}

void skg_tracer_release(skg_tracer *tracer) {
    skg_free(&tracer->seen);
    skg_free(&tracer->lengths);
    skg_free(&tracer->counts);
    skg_free(&tracer->met);
}

/* Whether the ray to (i, j) meets a triangle. The ray is a line through the origin of (x, y, w), so the signs of three
 * determinants decide it. */
static int meets(const double *const h[3], double i, double j, double *t, int *sign) {
    double edge[3], sum = 0, depth = 0;
    for (int k = 0; k < 3; k++) {
        const double *a = h[(k + 1) % 3], *b = h[(k + 2) % 3];
        edge[k] =
            i * (a[Y] * b[W] - a[W] * b[Y]) + j * (a[W] * b[X] - a[X] * b[W]) + a[X] * b[Y] - a[Y] * b[X];
        sum += edge[k], depth += edge[k] * h[k][T];
    }
    *sign = sum > 0 ? 1 : -1;
    for (int k = 0; k < 3; k++)
        if (!(edge[k] * *sign > 0)) return 0;
    *t = depth / sum;
    return 1;
}

/* The rays along an axis that can meet a triangle with corners at a, b and c there: from *first to *end - 1. */
static void span(double a, double b, double c, double start, double step, int64_t count, int64_t *first,
                 int64_t *end) {
    const double ab = a < b ? a : b, ba = a < b ? b : a, last = (double)count;
    const double low = ((ab < c ? ab : c) - start) / step, high = ((ba < c ? c : ba) - start) / step;
    const double from = low > 0 ? (low < last ? low : last) : 0;
    const double to = high >= 0 ? (high < last ? high + 1 : last) : 0;
    *first = (int64_t)from;
    if ((double)*first < from) ++*first;
    *end = (int64_t)to;
}

static void add_triangle(skg_tracer *grid, const double *const h[3]) {
    const skg_camera *camera = grid->camera;
    int64_t column, first = 0, last = grid->side, row = 0, end = grid->side;
    if (h[0][W] > 0 && h[1][W] > 0 && h[2][W] > 0) {
        span(h[0][ROW], h[1][ROW], h[2][ROW], grid->row, grid->row_step, grid->side, &row, &end);
        if (row >= end) return;
        span(h[0][COLUMN], h[1][COLUMN], h[2][COLUMN], grid->column, grid->column_step, grid->side, &first,
             &last);
    } else if (h[0][W] <= 0 && h[1][W] <= 0 && h[2][W] <= 0)
        return;
    for (; row < end; row++)
        for (column = first; column < last; column++) {
            const double i = grid->column + (double)column * grid->column_step;
            const double j = grid->row + (double)row * grid->row_step, start = start_of(camera, i, j);
            double t = 0;
            int sign = 0;
            if (!meets(h, i, j, &t, &sign)) continue;
            if (!camera->parallel && t < 0) continue; /* behind the source */
            grid->lengths[row * grid->side + column] += sign * fmin(fmax(t, start), 1);
            grid->counts[row * grid->side + column] += sign;
            grid->met[row * grid->side + column]++;
            grid->hits++;
        }
}

/* -1 if the signed lengths of a part are mostly negative because it is seen inside out; otherwise 1. */
static double orientation_of(const skg_tracer *grid) {
    double sum = 0;
    for (int64_t r = 0; r < grid->side * grid->side; r++) sum += grid->lengths[r];
    return sum < 0 ? -1 : 1;
}

static void trace(skg_tracer *grid) {
    const skg_mesh *mesh = grid->mesh;
    const int64_t rays = grid->side * grid->side;
    memset(grid->lengths, 0, (size_t)rays * sizeof *grid->lengths);
    memset(grid->counts, 0, (size_t)rays * sizeof *grid->counts);
    memset(grid->met, 0, (size_t)rays * sizeof *grid->met);
    grid->hits = 0;
    for (int64_t t = 0; t < mesh->triangles; t++) {
        const double *const h[3] = {grid->seen[mesh->corners[3 * t]], grid->seen[mesh->corners[3 * t + 1]],
                                    grid->seen[mesh->corners[3 * t + 2]]};
        add_triangle(grid, h);
    }
    for (int64_t r = 0; r < rays; r++)
        if (grid->counts[r] != 0 && !grid->near_source) grid->lengths[r] = 0;
    const double outwards = orientation_of(grid);
    for (int64_t r = 0; r < rays; r++) {
        const double i = grid->column + (double)(r % grid->side) * grid->column_step;
        const double j = grid->row + (double)(r / grid->side) * grid->row_step;
        if (grid->lengths[r] != 0) grid->lengths[r] *= outwards * unit_of(grid->camera, i, j);
    }
}

void skg_tracer_trace(skg_tracer *tracer, int64_t side, const double low[2], const double high[2]) {
    lay(tracer, side, low, high);
    if (!(tracer->column_step > 0 && tracer->row_step > 0)) tracer->side = 0;
    trace(tracer);
}

void skg_tracer_trace_detector(skg_tracer *tracer, int64_t side) {
    lay_over_detector(tracer, side);
    trace(tracer);
}

double skg_ray_longest(const skg_camera *camera) {
    double longest = 0;
    for (int corner = 0; corner < 4; corner++)
        longest = fmax(longest, unit_of(camera, corner & 1 ? (double)camera->columns - 0.5 : -0.5,
                                        corner & 2 ? (double)camera->rows - 0.5 : -0.5));
    return longest;
}

double skg_way_longest(const skg_camera *camera) {
    double longest = 0;
    for (int corner = 0; corner < 4; corner++) {
        const double i = corner & 1 ? (double)camera->columns - 0.5 : -0.5,
                     j = corner & 2 ? (double)camera->rows - 0.5 : -0.5;
        longest = fmax(longest, unit_of(camera, i, j) * (1 - start_of(camera, i, j)));
    }
    return longest;
}

void skg_ways_find(const skg_camera *camera, int64_t side, double *ways) {
    skg_tracer grid = {.camera = camera};
    lay_over_detector(&grid, side);
    for (int64_t r = 0; r < side * side; r++) {
        const double i = grid.column + (double)(r % side) * grid.column_step;
        const double j = grid.row + (double)(r / side) * grid.row_step;
        ways[r] = unit_of(camera, i, j) * (1 - start_of(camera, i, j));
    }
}
