/* Shades: factors of energies that differ from ray to ray. */
#include "spectral/shading.h"

#include "core/maths.h"
#include "spectral/model.h"

skg_status skg_shades_find(const skg_view *view, const skg_spectrum *spectrum,
                           const skg_plan_options *options, skg_shades *shades) {
    const skg_shading shading = {view, spectrum, options};
    const int is_ratio = skg_quantity_is_ratio(options) && !skg_quantity_is_absolute(options);
    const int is_point = view->projection == SKG_PROJECTION_POINT;
    skg_status status = SKG_OK;
    *shades = (skg_shades){0};
    if (is_ratio && spectrum->count == 1) return SKG_OK;
    if (options->heel && is_point) SKG_TRY_CLEANUP(skg_heel_shades(&shading, shades));
    if (options->oblique) SKG_TRY_CLEANUP(skg_oblique_shades(&shading, shades));
    if (options->bowtie && is_point) SKG_TRY_CLEANUP(skg_bowtie_shade(&shading, shades));
    if (options->grid) SKG_TRY_CLEANUP(skg_grid_shades(&shading, shades));
    return SKG_OK;
cleanup:
    skg_shades_release(shades);
    return status;
}

void skg_shades_release(skg_shades *shades) {
    skg_free(&shades->losses);
    skg_free(&shades->tables);
    *shades = (skg_shades){0};
}

/* --- cameras --- */

/* Sets args so that (args[0] + args[1] i + args[2] j) is what a vector has along the ray to pixel (i, j). */
static void along(const skg_camera *camera, const double *vector, double scale, double args[3]) {
    args[0] = scale * skg_dot(vector, camera->first);
    args[1] = camera->parallel ? 0 : scale * skg_dot(vector, camera->column);
    args[2] = camera->parallel ? 0 : scale * skg_dot(vector, camera->row);
}

void skg_shades_see(const skg_shades *shades, const skg_camera *camera, skg_shade_double *args) {
    double central[3], axis[3];
    const double foot = skg_camera_foot(camera);
    *args = (skg_shade_double){
        .count = shades->count, .heels = shades->heel, .obliques = shades->oblique, .grids = shades->grid};
    if (shades->heel) {
        skg_heel_axis(shades, camera, axis);
        along(camera, axis, 1 / shades->heel_extent.half, args->heel);
        args->heel[3] = -shades->heel_extent.middle / shades->heel_extent.half;
    }
    if (shades->oblique) {
        args->oblique[0] = foot / shades->oblique_extent.half;
        args->oblique[1] = -shades->oblique_extent.middle / shades->oblique_extent.half;
    }
    if (shades->bowtie) {
        (void)skg_shade_axes(camera, shades->fan_toward, central, axis);
        along(camera, axis, 1, args->fan);
        along(camera, central, 1, args->fan + 3);
        args->rows = (SKG_INT)shades->rows;
    }
    if (shades->grid) {
        skg_grid_tilt(shades, camera, args->tilt);
        args->path[0] = shades->grid_height / foot;
        args->path[1] = 1 / foot;
        args->path[2] = shades->grid_path[0];
        args->path[3] = 1 / (shades->grid_path[1] - shades->grid_path[0]);
        args->tilt[3] = (SKG_GRID_TILTS - 1) / shades->grid_tilt;
        args->table = (SKG_INT)(2 * shades->rows);
    }
}
