#include "spectral/ranges.h"

#include "core/vector.h"
#include "geometry/extent.h"

#include <math.h>
#include <string.h>

/* Rays along each side of the detector of the view, of those of further views, and of a part's own rectangle. A
 * thin part (a duct, a needle) gets more rays of its own until it is hit ENOUGH_HITS times, because its longest
 * chord may be missed otherwise. */
enum { SIDE = SKG_TRACED_SIDE, MORE_SIDE = 24, OWN_SIDE = 16, ENOUGH_HITS = 128 };

/* The factor on lengths that leaves a margin for later views, meshes and poses, which may differ a little. */
static const double MARGIN = 1.25;
/* The share of its range by which a plane may fall below it. A closed mesh that folds over itself has negative
 * lengths in a few pixels, which rays as coarse as these seldom meet. A rib of the generated thorax has -0.5 mm
 * where the range is 180 mm. */
static const double FOLDS = 0.02;
/* Rays are off the corner of their cell by an irrational part of it (square roots of 3 and 2), so that they do
 * not meet shared edges exactly. */
static const double OFF_COLUMN = 0.5732050807568877, OFF_ROW = 0.4142135623730951;

typedef struct {
    int64_t columns, rows;
    double column, row; /* of the first ray, in pixels */
    double column_step, row_step;
    double *length; /* [rows][columns] of one part, in units of the path parameter, signed */
    int32_t *count; /* signed hits */
    int64_t hits;
} ray_grid;

static void lay_grid(ray_grid *grid, int64_t side, const double low[2], const double high[2]) {
    grid->columns = grid->rows = side;
    grid->column_step = (high[0] - low[0]) / (double)grid->columns;
    grid->row_step = (high[1] - low[1]) / (double)grid->rows;
    grid->column = low[0] + OFF_COLUMN * grid->column_step;
    grid->row = low[1] + OFF_ROW * grid->row_step;
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

/* Whether the ray to (i, j) meets a triangle with corners h, whose path parameters are h[.][3]. The ray is a
 * line through the origin of (x, y, w), so the signs of three determinants decide it. */
static int meets(const double h[3][4], double i, double j, double *t, int *sign) {
    double edge[3], sum = 0, depth = 0;
    for (int k = 0; k < 3; k++) {
        const double *a = h[(k + 1) % 3], *b = h[(k + 2) % 3];
        edge[k] =
            i * (a[1] * b[2] - a[2] * b[1]) + j * (a[2] * b[0] - a[0] * b[2]) + a[0] * b[1] - a[1] * b[0];
        sum += edge[k], depth += edge[k] * h[k][3];
    }
    *sign = sum > 0 ? 1 : -1;
    for (int k = 0; k < 3; k++)
        if (!(edge[k] * *sign > 0)) return 0;
    *t = depth / sum;
    return 1;
}

/* The rays along an axis that can meet x[3]: from *first to *end - 1. */
static void span(const double x[3], double start, double step, int64_t count, int64_t *first, int64_t *end) {
    const double low = (fmin(x[0], fmin(x[1], x[2])) - start) / step;
    const double high = (fmax(x[0], fmax(x[1], x[2])) - start) / step;
    *first = (int64_t)fmin(fmax(ceil(low), 0), (double)count);
    *end = (int64_t)fmin(fmax(floor(high) + 1, 0), (double)count);
}

static void add_triangle(const skg_camera *camera, const double h[3][4], ray_grid *grid) {
    int64_t column, first = 0, last = grid->columns, row = 0, end = grid->rows;
    if (h[0][2] > 0 && h[1][2] > 0 && h[2][2] > 0) {
        const double x[3] = {h[0][0] / h[0][2], h[1][0] / h[1][2], h[2][0] / h[2][2]};
        const double y[3] = {h[0][1] / h[0][2], h[1][1] / h[1][2], h[2][1] / h[2][2]};
        span(x, grid->column, grid->column_step, grid->columns, &first, &last);
        span(y, grid->row, grid->row_step, grid->rows, &row, &end);
    } else if (h[0][2] <= 0 && h[1][2] <= 0 && h[2][2] <= 0)
        return;
    for (; row < end; row++)
        for (column = first; column < last; column++) {
            const double i = grid->column + (double)column * grid->column_step;
            const double j = grid->row + (double)row * grid->row_step, start = start_of(camera, i, j);
            double t = 0;
            int sign = 0;
            if (!meets(h, i, j, &t, &sign)) continue;
            if (!camera->parallel && t < 0) continue; /* behind the source */
            grid->length[row * grid->columns + column] += sign * fmin(fmax(t, start), 1);
            grid->count[row * grid->columns + column] += sign;
            grid->hits++;
        }
}

/* -1 if the signed lengths of a part are mostly negative because it is seen inside out; otherwise 1. */
static double orientation_of(const ray_grid *grid) {
    double sum = 0;
    for (int64_t r = 0; r < grid->columns * grid->rows; r++) sum += grid->length[r];
    return sum < 0 ? -1 : 1;
}

/* Sets grid->length to the mm of the part along every ray; 0 where the signed hits of a leaky mesh do not cancel. */
static skg_status measure(const skg_camera *camera, const skg_scene_part_data *part, int near_source,
                          ray_grid *grid) {
    const skg_mesh *mesh = part->mesh;
    const int64_t rays = grid->columns * grid->rows;
    double(*seen)[4] = NULL;
    memset(grid->length, 0, (size_t)rays * sizeof *grid->length);
    memset(grid->count, 0, (size_t)rays * sizeof *grid->count);
    grid->hits = 0;
    SKG_TRY(skg_alloc(mesh->vertices, sizeof *seen, "ranges of lengths", &seen));
    for (int64_t v = 0; v < mesh->vertices; v++) {
        double at[3], world[3];
        skg_mesh_vertex(mesh, v, at);
        for (int k = 0; k < 3; k++) world[k] = skg_dot(part->pose + 4 * k, at) + part->pose[4 * k + 3];
        skg_camera_see(camera, world, seen[v]);
        seen[v][3] = camera->parallel ? seen[v][2] + 1 : seen[v][2];
        if (camera->parallel) seen[v][2] = 1;
    }
    for (int64_t t = 0; t < mesh->triangles; t++) {
        double h[3][4];
        for (int k = 0; k < 3; k++) memcpy(h[k], seen[mesh->corners[3 * t + k]], sizeof h[k]);
        add_triangle(camera, h, grid);
    }
    for (int64_t r = 0; r < rays; r++)
        if (grid->count[r] != 0 && !near_source) grid->length[r] = 0;
    const double outwards = orientation_of(grid);
    for (int64_t r = 0; r < rays; r++) {
        const double i = grid->column + (double)(r % grid->columns) * grid->column_step;
        const double j = grid->row + (double)(r / grid->columns) * grid->row_step;
        grid->length[r] *= outwards * unit_of(camera, i, j);
    }
    skg_free(&seen);
    return SKG_OK;
}

/* --- ranges --- */

static void widen(skg_ranges *ranges, int64_t plane, double length) {
    ranges->low[plane] = fmin(ranges->low[plane], MARGIN * length);
    ranges->high[plane] = fmax(ranges->high[plane], MARGIN * length);
}

/* Widens the ranges by a length of one part alone. */
static void widen_by_part(skg_ranges *ranges, const skg_model *model, int64_t part, double length) {
    for (int64_t w = model->first_contribution[part]; w < model->first_contribution[part + 1]; w++)
        if (model->contributions[w].weight > 0)
            widen(ranges, model->contributions[w].plane, length * model->contributions[w].weight);
}

static double longest_edge(const skg_scene_part_data *part) {
    double longest = 0;
    for (int k = 0; k < 3; k++) {
        const double edge = (double)part->mesh->highest[k] - (double)part->mesh->lowest[k];
        const double axis[3] = {part->pose[k], part->pose[4 + k], part->pose[8 + k]};
        longest = fmax(longest, edge * skg_length(axis));
    }
    return longest;
}

static skg_status add_own_rays(const skg_scene_part_data *part, int64_t number, const skg_camera *camera,
                               const skg_extent *extent, const skg_model *model, ray_grid *grid,
                               skg_ranges *ranges) {
    const skg_scale_part *r = &extent->scale;
    if (!extent->on_detector) {
        widen_by_part(ranges, model, number, longest_edge(part));
        return SKG_OK;
    }
    const double low[2] = {fmax(r->low_column, -0.5), fmax(r->low_row, -0.5)};
    const double high[2] = {fmin(r->high_column, (double)camera->columns - 0.5),
                            fmin(r->high_row, (double)camera->rows - 0.5)};
    grid->hits = 0;
    for (int64_t side = OWN_SIDE; side <= SIDE && grid->hits < ENOUGH_HITS; side *= 2) {
        lay_grid(grid, side, low, high);
        if (!(grid->column_step > 0 && grid->row_step > 0)) return SKG_OK;
        SKG_TRY(measure(camera, part, extent->near_source, grid));
        for (int64_t k = 0; k < side * side; k++) widen_by_part(ranges, model, number, grid->length[k]);
    }
    return SKG_OK;
}

/* The rays of one view over its detector. */
typedef struct {
    skg_camera camera;
    int64_t side, rays;
    double *lengths; /* [rays][planes] the place of this view in those of all views */
} looking;

static void lay_over_detector(ray_grid *grid, looking *look) {
    const double low[2] = {-0.5, -0.5};
    const double high[2] = {(double)look->camera.columns - 0.5, (double)look->camera.rows - 0.5};
    lay_grid(grid, look->side, low, high);
    look->rays = grid->columns * grid->rows;
}

static void add_world(const looking *look, const skg_model *model, const ray_grid *grid, skg_ranges *ranges) {
    if (model->world_plane < 0) return;
    for (int64_t r = 0; r < look->rays; r++) {
        const double i = grid->column + (double)(r % grid->columns) * grid->column_step;
        const double j = grid->row + (double)(r / grid->columns) * grid->row_step;
        const double way = unit_of(&look->camera, i, j) * (1 - start_of(&look->camera, i, j));
        look->lengths[r * ranges->planes + model->world_plane] += model->world_weight * way;
        ranges->way = fmax(ranges->way, model->world_weight * way);
    }
}

static skg_status add_part(const skg_scene *scene, int64_t part, looking *look, const skg_model *model,
                           ray_grid *grid, skg_ranges *ranges, double *hits) {
    skg_extent extent;
    skg_extent_find(&look->camera, scene->parts[part].mesh, scene->parts[part].pose, &extent);
    SKG_TRY(add_own_rays(&scene->parts[part], part, &look->camera, &extent, model, grid, ranges));
    if (!extent.on_detector) return SKG_OK;
    lay_over_detector(grid, look);
    SKG_TRY(measure(&look->camera, &scene->parts[part], extent.near_source, grid));
    *hits = (double)grid->hits / (double)look->rays;
    for (int64_t w = model->first_contribution[part]; w < model->first_contribution[part + 1]; w++)
        for (int64_t r = 0; r < look->rays; r++)
            look->lengths[r * ranges->planes + model->contributions[w].plane] +=
                model->contributions[w].weight * grid->length[r];
    return SKG_OK;
}

/* Adds the rays of one view. hits: [parts] mean per ray. */
static skg_status add_view(const skg_scene *scene, looking *look, const skg_model *model, ray_grid *grid,
                           skg_ranges *ranges, double *hits) {
    lay_over_detector(grid, look);
    add_world(look, model, grid, ranges);
    for (int64_t p = 0; p < scene->count; p++)
        if (model->first_contribution[p + 1] > model->first_contribution[p])
            SKG_TRY(add_part(scene, p, look, model, grid, ranges, &hits[p]));
    ranges->rays += look->rays;
    return SKG_OK;
}

static skg_status allocate(const skg_scene *scene, int64_t more, const skg_model *model, ray_grid *grid,
                           skg_ranges *ranges) {
    static const char what[] = "ranges of lengths";
    const int64_t rays = SIDE * SIDE + more * MORE_SIDE * MORE_SIDE, width = skg_model_width(model);
    SKG_TRY(skg_alloc(SIDE * SIDE, sizeof *grid->length, what, &grid->length));
    SKG_TRY(skg_alloc(SIDE * SIDE, sizeof *grid->count, what, &grid->count));
    SKG_TRY(skg_alloc(rays * width, sizeof *ranges->lengths, what, &ranges->lengths));
    SKG_TRY(skg_alloc(width, sizeof *ranges->low, what, &ranges->low));
    SKG_TRY(skg_alloc(width, sizeof *ranges->high, what, &ranges->high));
    return skg_alloc(2 * scene->count, sizeof *ranges->hits, what, &ranges->hits);
}

skg_status skg_ranges_find(const skg_scene *scene, const skg_view *view, int64_t more, const skg_view *views,
                           const skg_model *model, skg_ranges *ranges) {
    ray_grid grid = {0};
    skg_status status = SKG_OK;
    *ranges = (skg_ranges){.planes = skg_model_width(model)};
    SKG_TRY_CLEANUP(allocate(scene, more, model, &grid, ranges));
    for (int64_t v = 0; v <= more; v++) {
        looking look = {.side = v ? MORE_SIDE : SIDE,
                        .lengths = ranges->lengths + ranges->rays * ranges->planes};
        SKG_TRY_CLEANUP(skg_camera_make(v ? &views[v - 1] : view, NULL, 0, 0, &look.camera));
        SKG_TRY_CLEANUP(add_view(scene, &look, model, &grid, ranges, ranges->hits + (v ? scene->count : 0)));
    }
    for (int64_t r = 0; r < ranges->rays * ranges->planes; r++)
        widen(ranges, r % ranges->planes, ranges->lengths[r]);
    for (int32_t k = 0; k < ranges->planes; k++) ranges->low[k] -= FOLDS * (ranges->high[k] - ranges->low[k]);
cleanup:
    skg_free(&grid.length);
    skg_free(&grid.count);
    if (status != SKG_OK) skg_ranges_release(ranges);
    return status;
}

/* The longest length of a part along rays over its own rectangle. */
static skg_status find_longest(const skg_scene_part_data *part, const skg_camera *camera,
                               const skg_extent *extent, ray_grid *grid, double *longest) {
    const skg_scale_part *r = &extent->scale;
    const double low[2] = {fmax(r->low_column, -0.5), fmax(r->low_row, -0.5)};
    const double high[2] = {fmin(r->high_column, (double)camera->columns - 0.5),
                            fmin(r->high_row, (double)camera->rows - 0.5)};
    *longest = 0;
    lay_grid(grid, OWN_SIDE, low, high);
    if (!(grid->column_step > 0 && grid->row_step > 0)) return SKG_OK;
    SKG_TRY(measure(camera, part, extent->near_source, grid));
    for (int64_t r_own = 0; r_own < grid->columns * grid->rows; r_own++)
        *longest = fmax(*longest, MARGIN * grid->length[r_own]);
    return SKG_OK;
}

skg_status skg_ranges_trace(const skg_scene *scene, const skg_view *view, const skg_model *model,
                            skg_traced_part *traced, void *user) {
    ray_grid grid = {0};
    looking look = {.side = SIDE};
    skg_status status = SKG_OK;
    SKG_TRY(skg_camera_make(view, NULL, 0, 0, &look.camera));
    SKG_TRY_CLEANUP(skg_alloc(SIDE * SIDE, sizeof *grid.length, "rays", &grid.length));
    SKG_TRY_CLEANUP(skg_alloc(SIDE * SIDE, sizeof *grid.count, "rays", &grid.count));
    for (int64_t p = 0; p < scene->count; p++) {
        const skg_scene_part_data *part = &scene->parts[p];
        skg_extent extent;
        double longest = 0;
        if (model->first_contribution[p + 1] == model->first_contribution[p]) continue;
        skg_extent_find(&look.camera, part->mesh, part->pose, &extent);
        if (!extent.on_detector) continue;
        SKG_TRY_CLEANUP(find_longest(part, &look.camera, &extent, &grid, &longest));
        lay_over_detector(&grid, &look);
        SKG_TRY_CLEANUP(measure(&look.camera, part, extent.near_source, &grid));
        for (int64_t r = 0; r < look.rays; r++) longest = fmax(longest, MARGIN * grid.length[r]);
        traced(user, p, grid.length, longest);
    }
cleanup:
    skg_free(&grid.length);
    skg_free(&grid.count);
    return status;
}

void skg_ranges_release(skg_ranges *ranges) {
    skg_free(&ranges->lengths);
    skg_free(&ranges->low);
    skg_free(&ranges->high);
    skg_free(&ranges->hits);
}
