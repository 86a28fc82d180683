/* The directions in which the detector is seen from the object. */
#include "scatter/beams.h"

#include "beam/grid.h"
#include "core/maths.h"
#include "geometry/optics.h"
#include "spectral/shading.h"

#include <math.h>

/* Cosine of the angle between rows and columns up to which a detector counts as a rectangle. */
static const double OBLIQUE = 1e-6;

/* More points of a source are taken evenly from its samples. */
enum { SPOTS_MAX = 4096 };

static void set(const double from[3], float to[3]) {
    for (int k = 0; k < 3; k++) to[k] = (float)from[k];
}

/* A place in the world, from the lowest corner of the cells. */
static void set_place(const double from[3], const skg_cells *cells, float to[3]) {
    for (int k = 0; k < 3; k++) to[k] = (float)(from[k] - cells->low[k]);
}

/* The direction of the rays of a parallel beam, of length 1. */
static void find_direction(const skg_view *view, double way[3]) {
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        skg_scale_vector(1, view->source, way);
    else
        skg_add_scaled(view->centre, -1, view->source, way);
    skg_scale_vector(1 / skg_length(way), way, way);
}

static int is_parallel(const skg_view *view) {
    return view->projection != SKG_PROJECTION_POINT;
}

static skg_status fill_detector(const skg_view *view, const skg_cells *cells, skg_scatter_args *args) {
    double across[3], down[3], normal[3], way[3], corner[3];
    skg_scale_vector((double)view->columns, view->column_step, across);
    skg_scale_vector((double)view->rows, view->row_step, down);
    const double u = skg_length(across), v = skg_length(down);
    if (fabs(skg_dot(across, down)) > OBLIQUE * u * v)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "scatter: the detector's rows and columns are at %.4g degrees; make them perpendicular, or leave out "
            "the scatter",
            acos(skg_dot(across, down) / (u * v)) * 57.29577951308232);
    skg_cross(across, down, normal);
    if (is_parallel(view))
        find_direction(view, way);
    else
        skg_add_scaled(view->centre, -1, view->source, way);
    skg_scale_vector((skg_dot(normal, way) < 0 ? -1 : 1) / skg_length(normal), normal, normal);
    skg_add_scaled(view->centre, -0.5, across, corner);
    skg_add_scaled(corner, -0.5, down, corner);
    set_place(corner, cells, args->corner);
    set(normal, args->normal);
    args->area = (float)(u * v);
    args->side_u = (float)u;
    args->side_v = (float)v;
    skg_scale_vector(1 / (u * u), across, across);
    skg_scale_vector(1 / (v * v), down, down);
    set(across, args->to_u);
    set(down, args->to_v);
    return SKG_OK;
}

static skg_status fill_field(const skg_scatter_work *work, const skg_cells *cells, skg_scatter_args *args) {
    skg_field field;
    double corner[3], u[3], v[3], way[3];
    SKG_TRY(skg_field_make(work->recipe->options.collimation, work->view, &field));
    skg_add_scaled(field.centre, field.low[0], field.column, corner);
    skg_add_scaled(corner, field.low[1], field.row, corner);
    skg_scale_vector(field.high[0] - field.low[0], field.column, u);
    skg_scale_vector(field.high[1] - field.low[1], field.row, v);
    set_place(corner, cells, args->field);
    set(u, args->field_u);
    set(v, args->field_v);
    skg_add_scaled(field.centre, -1, work->view->source, way);
    args->far = (float)skg_length(way);
    if (!is_parallel(work->view)) return SKG_OK;
    double start[3], direction[3];
    find_direction(work->view, direction);
    skg_add_scaled(work->view->source, -1, cells->low, start);
    if (work->view->projection == SKG_PROJECTION_PARALLEL)
        args->world_start = (float)skg_dot(start, direction);
    double middle[3]; /* back to before the object, from wherever the field's plane is */
    for (int k = 0; k < 3; k++)
        middle[k] = cells->low[k] + 0.5 * cells->size[k] - (corner[k] + 0.5 * (u[k] + v[k]));
    args->far = (float)(skg_length(middle) + skg_length(cells->size) + skg_length(u) + skg_length(v));
    return SKG_OK;
}

skg_status skg_sight_strips(const skg_scatter_work *work, double across[3]) {
    const skg_grid *grid = work->recipe->options.grid;
    const skg_view *view = &work->recipe->view;
    const double *rows = view->column_step;
    skg_shades shades = {0};
    skg_camera camera;
    SKG_TRY(skg_camera_make(work->view, NULL, 0, 0, &camera));
    SKG_TRY(skg_shade_direction(view, skg_length(grid->direction) > 0 ? grid->direction : rows, "grid",
                                "a direction across the strips", shades.strips_toward));
    if (!skg_grid_across(&shades, &camera, across))
        return skg_fail(SKG_ERR_SCENE, "scatter: the grid's direction points along the detector's normal");
    return SKG_OK;
}

static skg_status fill_grid(const skg_scatter_work *work, skg_scatter_args *args) {
    const skg_grid *grid = work->recipe->options.grid;
    double across[3];
    if (!grid) return SKG_OK;
    SKG_TRY(skg_sight_strips(work, across));
    set(across, args->strips);
    args->focus = grid->focus_mm > 0 ? (float)(1 / grid->focus_mm) : 0;
    args->strips_u = (float)(skg_dot(across, work->view->column_step) * (double)work->view->columns);
    args->strips_v = (float)(skg_dot(across, work->view->row_step) * (double)work->view->rows);
    args->period = (float)(10 / grid->lines_per_cm);
    args->strip = (float)grid->strip_mm;
    args->height = (float)skg_grid_height(grid);
    return SKG_OK;
}

/* The box around the cells, the detector and the source: what scatters farther away hardly comes back. */
static void fill_around(const skg_scatter_work *work, const skg_cells *cells, skg_scatter_args *args) {
    const skg_view *view = work->view;
    for (int k = 0; k < 3; k++) {
        double low = fmin(cells->low[k], view->source[k]),
               high = fmax(cells->low[k] + cells->size[k], view->source[k]);
        const double half = 0.5 * (fabs(view->column_step[k]) * (double)view->columns +
                                   fabs(view->row_step[k]) * (double)view->rows);
        low = fmin(low, view->centre[k] - half), high = fmax(high, view->centre[k] + half);
        args->around_low[k] = (float)(low - cells->low[k]);
        args->around_high[k] = (float)(high - cells->low[k]);
    }
}

skg_status skg_sight_fill(const skg_scatter_work *work, const skg_cells *cells, skg_scatter_args *args) {
    fill_around(work, cells, args);
    for (int k = 0; k < 3; k++) {
        args->size[k] = (float)cells->size[k];
        args->cells[k] = (SKG_INT)cells->count[k];
        args->per_mm[k] = (float)((double)cells->count[k] / cells->size[k]);
    }
    SKG_TRY(fill_detector(work->view, cells, args));
    SKG_TRY(fill_grid(work, args));
    return fill_field(work, cells, args);
}

skg_status skg_sight_spots(const skg_scatter_work *work, const skg_cells *cells, int64_t *count,
                           float (**spots)[4]) {
    const skg_samples *samples = &work->recipe->samples;
    const int64_t all = samples->spot_count > 1 ? samples->spot_count : 1;
    double source[3], shift[2];
    *count = is_parallel(work->view) ? 1 : all < SPOTS_MAX ? all : SPOTS_MAX;
    SKG_TRY(skg_alloc(*count, sizeof **spots, "source", spots));
    if (is_parallel(work->view)) {
        find_direction(work->view, source);
        set(source, (*spots)[0]);
        return SKG_OK;
    }
    for (int64_t s = 0; s < *count; s++) {
        skg_samples_at(samples, work->view, s * all / *count * samples->shifts * samples->shifts, source,
                       shift);
        set_place(source, cells, (*spots)[s]);
    }
    return SKG_OK;
}

double skg_sight_photons(const skg_scatter_work *work, const skg_scatter_args *args) {
    const skg_view *view = work->view;
    double normal[3], u[3], v[3], field[3], way[3];
    for (int k = 0; k < 3; k++) u[k] = (double)args->field_u[k], v[k] = (double)args->field_v[k];
    skg_cross(u, v, field);
    skg_cross(view->column_step, view->row_step, normal);
    const double pixel = skg_length(normal), area = skg_length(field);
    if (is_parallel(view)) return area / pixel;
    skg_add_scaled(view->centre, -1, view->source, way);
    const double foot = fabs(skg_dot(way, normal)) / pixel, far = (double)args->far;
    return area / (far * far) * foot * foot / pixel;
}
