/* An anti-scatter grid. What the interspace would leave of the beam if it were everywhere is one shade, exact for any path; what
 * strips leave of this is spanned by a few directions, whose amounts are tabulated by tilt, with polynomials of the obliquity. */
#include "spectral/shading.h"

#include "beam/grid.h"
#include "core/maths.h"

#include <math.h>
#include <string.h>

int skg_grid_across(const skg_shades *shades, const skg_camera *camera, double across[3]) {
    double frame[3][3], normal[3];
    skg_detector_frame(camera->column, camera->row, frame);
    skg_scale_vector(1 / skg_length(frame[2]), frame[2], normal);
    for (int k = 0; k < 3; k++) across[k] = 0;
    for (int k = 0; k < 3; k++) skg_add_scaled(across, shades->strips_toward[k], frame[k], across);
    skg_add_scaled(across, -skg_dot(across, normal), normal, across);
    if (!(skg_length(across) > 1e-9)) return 0; /* sine of an angle; rounding is 1e-16 */
    skg_scale_vector(1 / skg_length(across), across, across);
    return 1;
}

/* The slope of the ray over the plane of the grid, less that of the strips at the pixel. */
void skg_grid_tilt(const skg_shades *shades, const skg_camera *camera, double tilt[3]) {
    double across[3];
    const double foot = skg_camera_foot(camera);
    const double focus = shades->grid_focus > 0 ? 1 / shades->grid_focus : 0;
    (void)skg_grid_across(shades, camera, across);
    tilt[0] = skg_dot(across, camera->first) / foot - focus * skg_dot(across, camera->corner);
    tilt[1] = skg_dot(across, camera->column) * ((camera->parallel ? 0 : 1 / foot) - focus);
    tilt[2] = skg_dot(across, camera->row) * ((camera->parallel ? 0 : 1 / foot) - focus);
}

typedef struct {
    const skg_shades *shades;
    double tilt, low, high; /* greatest tilt; least and greatest obliquity */
} extent;

static skg_status see(void *user, const skg_camera *camera, const double ray[3], double column, double row) {
    extent *e = user;
    double tilt[3], across[3];
    if (!skg_grid_across(e->shades, camera, across))
        return skg_fail(SKG_ERR_SCENE, "the grid's direction points along the detector's normal; give a "
                                       "direction across the strips");
    skg_grid_tilt(e->shades, camera, tilt);
    e->tilt = fmax(e->tilt, fabs(tilt[0] + tilt[1] * column + tilt[2] * row));
    const double oblique = fmax(skg_length(ray) / skg_camera_foot(camera), 1); /* but for rounding */
    e->low = fmin(e->low, oblique), e->high = fmax(e->high, oblique);
    return SKG_OK;
}

static skg_status find_extent(const skg_shading *shading, skg_shades *shades) {
    const skg_grid *grid = shading->options->grid;
    extent e = {shades, 0, HUGE_VAL, 1};
    shades->grid_focus = grid->focus_mm;
    shades->grid_height = skg_grid_height(grid);
    const double *rows = shading->view->column_step;
    SKG_TRY(skg_shade_direction(shading->view, skg_length(grid->direction) > 0 ? grid->direction : rows,
                                "grid", "a direction across the strips", shades->strips_toward));
    SKG_TRY(skg_shade_rays(shading, see, &e));
    shades->grid_lean = e.tilt;
    /* At least a hundredth of the width of an interspace. */
    shades->grid_tilt = e.tilt * (1 + SKG_SHADE_MARGIN) + 0.01 / grid->ratio;
    shades->grid_path[0] = fmax(1, e.low - SKG_SHADE_MARGIN * (e.high - e.low));
    shades->grid_path[1] = e.high + SKG_SHADE_MARGIN * (e.high - e.low) + 1e-3;
    return SKG_OK;
}

skg_status skg_grid_covers(const skg_shades *shades, const skg_view *view, const skg_plan_options *options) {
    extent e = {shades, 0, HUGE_VAL, 1};
    if (shades->grid == 0) return SKG_OK;
    SKG_TRY(skg_shade_rays_of(view, options, see, &e));
    if (e.tilt <= shades->grid_tilt && e.low >= shades->grid_path[0] && e.high <= shades->grid_path[1])
        return SKG_OK;
    return skg_fail(
        SKG_STALE,
        "rays of this view lean by up to %.3g across the strips of the grid and take %.4g to %.4g times its height, the plan "
        "knows up to %.3g, and %.4g to %.4g times; make a plan for it",
        e.tilt, e.low, e.high, shades->grid_tilt, shades->grid_path[0], shades->grid_path[1]);
}

/* Losses by the strips, for each state of the tables. interspace: [bins] 1/mm, result. */
static skg_status find_losses(const skg_shading *shading, const skg_shades *shades, double *interspace,
                              skg_directions *d) {
    const skg_grid *grid = shading->options->grid;
    for (int64_t b = 0; b < d->bins; b++) {
        double strip = 0;
        SKG_TRY(skg_grid_attenuation(grid, shading->spectrum->energy_kev[b], &strip, &interspace[b]));
        for (int64_t s = 0; s < d->states; s++) {
            const double tilt = shades->grid_tilt * (double)(s / SKG_GRID_TERMS) / (SKG_GRID_TILTS - 1);
            const double oblique = shades->grid_path[0] + (shades->grid_path[1] - shades->grid_path[0]) *
                                                              (double)(s % SKG_GRID_TERMS) /
                                                              (SKG_GRID_TERMS - 1);
            const double passed = skg_grid_pass(grid, strip, interspace[b], oblique, tilt);
            /* Strips that stop everything: the logarithm stays finite. */
            d->losses[s * d->bins + b] =
                -log(fmax(passed, 1e-30)) - interspace[b] * shades->grid_height * oblique;
        }
    }
    /* Errors are judged as shares of the transmission along the strips, so the little that passes across them counts for little. */
    for (int64_t s = 0; s < d->states; s++) {
        double mean = 0;
        for (int64_t b = 0; b < d->bins; b++)
            mean += d->weight[b] * d->weight[b] * exp(-d->losses[s * d->bins + b]);
        d->scale[s] = fmin(1, mean);
    }
    return SKG_OK;
}

/* The polynomial of z through the values at z = 0, 1/2 and 1. */
static void fit_path(const double values[SKG_GRID_TERMS], double terms[SKG_GRID_TERMS]) {
    terms[0] = values[0];
    terms[1] = -3 * values[0] + 4 * values[1] - values[2];
    terms[2] = 2 * (values[0] - 2 * values[1] + values[2]);
}

static skg_status keep_tables(const skg_directions *d, skg_shades *shades) {
    double *table = NULL;
    SKG_TRY(skg_shades_append_table(d->states * d->count, shades, &table));
    for (int64_t tilt = 0; tilt < SKG_GRID_TILTS; tilt++)
        for (int32_t k = 0; k < d->count; k++)
            fit_path(d->amounts + k * d->states + tilt * SKG_GRID_TERMS,
                     table + (tilt * d->count + k) * SKG_GRID_TERMS);
    for (int32_t k = 0; k < d->count; k++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int64_t s = 0; s < d->states; s++) {
            const double amount = d->amounts[k * d->states + s];
            low = fmin(low, amount), high = fmax(high, amount);
        }
        SKG_TRY(skg_shades_append(d->bins, d->unit + k * d->bins, low, high, shades));
    }
    shades->grid += d->count;
    return SKG_OK;
}

skg_status skg_grid_shades(const skg_shading *shading, skg_shades *shades) {
    skg_directions directions = {0};
    double *interspace = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(find_extent(shading, shades));
    SKG_TRY_CLEANUP(skg_directions_create(shading->spectrum, SKG_GRID_TILTS * SKG_GRID_TERMS, &directions));
    SKG_TRY_CLEANUP(skg_alloc(directions.bins, sizeof *interspace, "grid", &interspace));
    SKG_TRY_CLEANUP(find_losses(shading, shades, interspace, &directions));
    skg_directions_find(&directions);
    shades->grid_error = directions.error;
    SKG_TRY_CLEANUP(skg_shades_append(directions.bins, interspace, shades->grid_height * shades->grid_path[0],
                                      shades->grid_height * shades->grid_path[1], shades));
    shades->grid = 1;
    status = keep_tables(&directions, shades);
cleanup:
    skg_free(&interspace);
    skg_directions_release(&directions);
    return status;
}
