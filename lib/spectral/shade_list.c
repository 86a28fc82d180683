/* The shades of a view, listed: directions, axes, extents. */
#include "spectral/shading.h"

#include "core/maths.h"

#include <math.h>
#include <string.h>

/* Points of a detector's side at which rays are. */
enum { SIDE = 17, FEW = 9 };

/* --- geometry --- */

void skg_detector_frame(const double *column, const double *row, double frame[3][3]) {
    skg_scale_vector(1 / skg_length(column), column, frame[0]);
    skg_scale_vector(1 / skg_length(row), row, frame[1]);
    skg_cross(frame[0], frame[1], frame[2]);
}

/* Columns and rows may be at any angle: the coordinates of the direction solve a system of two equations. */
skg_status skg_shade_direction(const skg_view *view, const double *direction, const char *name,
                               const char *mend, double toward[3]) {
    double frame[3][3], matrix[2][2], along[2];
    const double length = skg_length(direction);
    if (!(isfinite(length) && length > 0))
        return skg_fail(SKG_ERR_SCENE, "the %s has no direction; give %s", name, mend);
    skg_detector_frame(view->column_step, view->row_step, frame);
    for (int k = 0; k < 2; k++) {
        along[k] = skg_dot(direction, frame[k]) / length;
        for (int l = 0; l < 2; l++) matrix[k][l] = skg_dot(frame[k], frame[l]);
    }
    const double determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
    toward[0] = (along[0] * matrix[1][1] - along[1] * matrix[0][1]) / determinant;
    toward[1] = (along[1] * matrix[0][0] - along[0] * matrix[1][0]) / determinant;
    toward[2] = skg_dot(direction, frame[2]) / length / skg_dot(frame[2], frame[2]);
    return SKG_OK;
}

/* The sine of an angle below which two directions are the same; rounding is 1e-16. */
static const double ALONG = 1e-9;

int skg_shade_axes(const skg_camera *camera, const double toward[3], double central[3], double across[3]) {
    double frame[3][3];
    if (skg_camera_is_curved(camera)) /* its camera's columns are the rows of the detector */
        skg_detector_frame(camera->row, camera->column, frame);
    else
        skg_detector_frame(camera->column, camera->row, frame);
    memcpy(central, camera->first, 3 * sizeof *central);
    if (!camera->parallel) {
        skg_add_scaled(central, 0.5 * (double)(camera->columns - 1), camera->column, central);
        skg_add_scaled(central, 0.5 * (double)(camera->rows - 1), camera->row, central);
    }
    skg_scale_vector(1 / skg_length(central), central, central);
    for (int k = 0; k < 3; k++) across[k] = 0;
    for (int k = 0; k < 3; k++) skg_add_scaled(across, toward[k], frame[k], across);
    skg_add_scaled(across, -skg_dot(across, central), central, across);
    if (!(skg_length(across) > ALONG)) return 0;
    skg_scale_vector(1 / skg_length(across), across, across);
    return 1;
}

/* How far from the middle of an extended source its samples are, at most. */
static double source_reach(const skg_plan_options *options) {
    const skg_spot *spot = options->spot;
    if (!spot || spot->shape == SKG_SPOT_POINT) return 0;
    const double most = fmax(spot->extent[0], fmax(spot->extent[1], spot->extent[2]));
    /* 2 is 4.7 standard deviations of a Gaussian. */
    const double focal = spot->shape == SKG_SPOT_GAUSSIAN ? 2 * most : 0.5 * most;
    return spot->off_focal > 0 ? fmax(focal, 0.5 * spot->off_focal_mm) : focal;
}

/* side: rays along each side of the detector */
static skg_status see_view(const skg_view *view, const double *source, int side, skg_shade_ray *seen,
                           void *user) {
    skg_camera camera;
    SKG_TRY(skg_camera_make(view, source, 0, 0, &camera));
    for (int k = 0; k < side * side; k++) {
        const double column = (k % side) / (side - 1.0) * (double)(camera.columns - 1);
        const double row = (k / side) / (side - 1.0) * (double)(camera.rows - 1);
        double ray[3];
        memcpy(ray, camera.first, sizeof ray);
        if (!camera.parallel) {
            skg_add_scaled(ray, column, camera.column, ray);
            skg_add_scaled(ray, row, camera.row, ray);
        }
        SKG_TRY(seen(user, &camera, ray, column, row));
    }
    return SKG_OK;
}

/* Calls seen for the rays of a view from the middle of the source and from its ends. */
static skg_status see_from_source(const skg_view *view, double reach, int side, skg_shade_ray *seen,
                                  void *user) {
    SKG_TRY(see_view(view, NULL, side, seen, user));
    for (int k = 0; k < 6 && reach > 0; k++) { /* both ways along the axes */
        double source[3];
        memcpy(source, view->source, sizeof source);
        source[k / 2] += k % 2 ? reach : -reach;
        SKG_TRY(see_view(view, source, side, seen, user));
    }
    return SKG_OK;
}

skg_status skg_shade_rays(const skg_shading *shading, skg_shade_ray *seen, void *user) {
    const double reach = source_reach(shading->options);
    for (int64_t v = -1; v < shading->options->view_count; v++)
        SKG_TRY(
            see_from_source(v < 0 ? shading->view : &shading->options->views[v], reach, SIDE, seen, user));
    return SKG_OK;
}

skg_status skg_shade_rays_of(const skg_view *view, const skg_plan_options *options, skg_shade_ray *seen,
                             void *user) {
    return see_from_source(view, source_reach(options), FEW, seen, user);
}

skg_shade_extent skg_shade_extent_of(double low, double high) {
    return (skg_shade_extent){.middle = 0.5 * (low + high),
                              .half = 0.5 * (high - low) + SKG_SHADE_MARGIN * (high - low) + 1e-6};
}

/* --- lists --- */

skg_status skg_shades_append(int64_t bins, const double *losses, double low, double high,
                             skg_shades *shades) {
    const double margin = SKG_SHADE_MARGIN * (high - low);
    SKG_TRY(skg_realloc((shades->count + 1) * bins, sizeof *shades->losses, "shades", &shades->losses));
    memcpy(shades->losses + shades->count * bins, losses, (size_t)bins * sizeof *losses);
    shades->low[shades->count] = low - margin, shades->high[shades->count] = high + margin;
    shades->count++;
    return SKG_OK;
}

skg_status skg_shades_append_fitted(skg_directions *d, skg_shades *shades, double *error) {
    skg_directions_find(d);
    *error = d->error;
    for (int32_t k = 0; k < d->count; k++) {
        const double *amounts = d->amounts + k * d->states;
        double low = HUGE_VAL, high = -HUGE_VAL;
        *error = fmax(*error,
                      skg_polynomial_fit(amounts, shades->polynomials[shades->heel + shades->oblique + k]));
        for (int64_t s = 0; s < d->states; s++) low = fmin(low, amounts[s]), high = fmax(high, amounts[s]);
        SKG_TRY(skg_shades_append(d->bins, d->unit + k * d->bins, low, high, shades));
    }
    return SKG_OK;
}

skg_status skg_shades_append_table(int64_t count, skg_shades *shades, double **table) {
    SKG_TRY(skg_realloc(shades->table_count + count, sizeof *shades->tables, "shades", &shades->tables));
    *table = shades->tables + shades->table_count;
    shades->table_count += count;
    return SKG_OK;
}
