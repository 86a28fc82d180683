#include "spectral/shades.h"

#include "core/maths.h"
#include "core/vector.h"
#include "spectral/quantity.h"

#include <math.h>
#include <string.h>

/* Angles at which the spectrum is computed, and points of a detector's side at which rays are. */
enum { ANGLES = 24, SIDE = 17 };
/* Losses are taken until what is left of any angle is below this, in the logarithm of what is transmitted. */
static const double LEFT = 2e-4;
/* The least weight of an energy in the squares, as a share of the greatest. */
static const double LEAST_WEIGHT = 1e-4;
/* Samples of an extended source see the anode at angles a little beyond those of its middle. */
static const double MARGIN = 0.02;

typedef struct {
    int64_t bins;
    double *weight;   /* [bins] roots of shares of the energy */
    double *rest;     /* [ANGLES][bins] weighted losses that are not yet explained */
    double *unit;     /* [SKG_SHADES_MOST][bins] */
    double z[ANGLES]; /* Chebyshev's points */
    double amount[SKG_SHADES_MOST][ANGLES];
} fitting;

/* --- geometry --- */

static void normalise(double *v) {
    skg_scale_vector(1 / skg_length(v), v, v);
}

/* The normal of the anode's face, towards the beam: sin(angle) along the central ray less cos(angle) towards the anode. */
static int face_of(const skg_shades *shades, const skg_camera *camera, double normal[3]) {
    double frame[3][3], central[3], toward[3] = {0, 0, 0};
    skg_scale_vector(1 / skg_length(camera->column), camera->column, frame[0]);
    skg_scale_vector(1 / skg_length(camera->row), camera->row, frame[1]);
    skg_cross(frame[0], frame[1], frame[2]);
    memcpy(central, camera->first, sizeof central);
    skg_add_scaled(central, 0.5 * (double)(camera->columns - 1), camera->column, central);
    skg_add_scaled(central, 0.5 * (double)(camera->rows - 1), camera->row, central);
    normalise(central);
    for (int k = 0; k < 3; k++) skg_add_scaled(toward, shades->toward[k], frame[k], toward);
    skg_add_scaled(toward, -skg_dot(toward, central), central, toward);
    /* The sine of the angle between both; rounding is 1e-16. */
    if (!(skg_length(toward) > 1e-9)) return 0;
    normalise(toward);
    skg_scale_vector(sin(shades->angle), central, normal);
    skg_add_scaled(normal, -cos(shades->angle), toward, normal);
    return 1;
}

/* Widens *low and *high by the cosines between the normal of the anode and the rays to a detector. */
static skg_status see(const skg_shades *shades, const skg_view *view, double *low, double *high) {
    skg_camera camera;
    double normal[3];
    SKG_TRY(skg_camera_make(view, NULL, 0, 0, &camera));
    if (!face_of(shades, &camera, normal))
        return skg_fail(SKG_ERR_SCENE,
                        "the heel's direction points along the central ray; give the direction "
                        "from the detector's centre to the side of the anode");
    for (int k = 0; k < SIDE * SIDE; k++) {
        double ray[3];
        skg_add_scaled(camera.first, (k % SIDE) / (SIDE - 1.0) * (double)(view->columns - 1), camera.column,
                       ray);
        skg_add_scaled(ray, (k / SIDE) / (SIDE - 1.0) * (double)(view->rows - 1), camera.row, ray);
        const double q = skg_dot(normal, ray) / skg_length(ray);
        *low = fmin(*low, q), *high = fmax(*high, q);
    }
    return SKG_OK;
}

static skg_status find_extent(const skg_view *view, const skg_plan_options *options, skg_shades *shades) {
    double low = 1, high = -1, out[3];
    const double *steps[2] = {view->column_step, view->row_step};
    skg_cross(steps[0], steps[1], out);
    const double length = skg_length(options->heel->direction);
    if (!(isfinite(length) && length > 0))
        return skg_fail(SKG_ERR_SCENE, "the heel has no direction; give the direction from the detector's "
                                       "centre to the side of the anode");
    /* Columns and rows may be at any angle: the coordinates of the direction solve a system of two equations. */
    double frame[3][3], matrix[2][2], along[2];
    for (int k = 0; k < 2; k++) skg_scale_vector(1 / skg_length(steps[k]), steps[k], frame[k]);
    skg_cross(frame[0], frame[1], frame[2]);
    for (int k = 0; k < 2; k++) {
        along[k] = skg_dot(options->heel->direction, frame[k]) / length;
        for (int l = 0; l < 2; l++) matrix[k][l] = skg_dot(frame[k], frame[l]);
    }
    const double determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
    shades->toward[0] = (along[0] * matrix[1][1] - along[1] * matrix[0][1]) / determinant;
    shades->toward[1] = (along[1] * matrix[0][0] - along[0] * matrix[1][0]) / determinant;
    shades->toward[2] = skg_dot(options->heel->direction, frame[2]) / length / skg_dot(frame[2], frame[2]);
    SKG_TRY(see(shades, view, &low, &high));
    for (int64_t v = 0; v < options->view_count; v++) SKG_TRY(see(shades, &options->views[v], &low, &high));
    const double margin = MARGIN * (high - low) + 1e-6;
    shades->middle = 0.5 * (low + high);
    shades->half = 0.5 * (high - low) + margin;
    return SKG_OK;
}

/* --- losses --- */

static skg_status compute_losses(const skg_spectrum *spectrum, const skg_heel *heel, const skg_shades *shades,
                                 fitting *f) {
    const skg_heel_tube tube = {
        .anode = heel->anode, .kvp = heel->kvp, .angle_deg = heel->angle_deg, .bin_kev = heel->bin_kev};
    double most = 0;
    for (int64_t b = 0; b < f->bins; b++) {
        f->weight[b] = spectrum->photons[b] * spectrum->energy_kev[b];
        most = fmax(most, f->weight[b]);
    }
    double sum = 0;
    for (int64_t b = 0; b < f->bins; b++) sum += f->weight[b] = fmax(f->weight[b], LEAST_WEIGHT * most);
    for (int64_t b = 0; b < f->bins; b++) f->weight[b] = sqrt(f->weight[b] / sum);
    for (int a = 0; a < ANGLES; a++) {
        double *rest = f->rest + a * f->bins;
        f->z[a] = cos(SKG_PI * (a + 0.5) / ANGLES);
        const double angle = asin(fmin(fmax(shades->middle + shades->half * f->z[a], -1), 1));
        SKG_TRY(skg_heel_losses(&tube, angle * (180 / SKG_PI), spectrum, rest));
        for (int64_t b = 0; b < f->bins; b++) rest[b] *= f->weight[b];
    }
    return SKG_OK;
}

/* Takes the angle of which most is left as the next direction, and its component from all (Gram and Schmidt). */
static void take_directions(fitting *f, skg_shades *shades) {
    for (;;) {
        int worst = 0;
        double most = 0;
        for (int a = 0; a < ANGLES; a++) {
            const double *rest = f->rest + a * f->bins, left = sqrt(skg_dot_long(f->bins, rest, rest));
            if (left > most) most = left, worst = a;
        }
        shades->error = most;
        if (most < LEFT || shades->count == SKG_SHADES_MOST) return;
        double *unit = f->unit + shades->count * f->bins;
        for (int64_t b = 0; b < f->bins; b++) unit[b] = f->rest[worst * f->bins + b] / most;
        for (int a = 0; a < ANGLES; a++) {
            double *rest = f->rest + a * f->bins;
            const double along = skg_dot_long(f->bins, rest, unit);
            f->amount[shades->count][a] = along;
            for (int64_t b = 0; b < f->bins; b++) rest[b] -= along * unit[b];
        }
        shades->count++;
    }
}

/* Polynomials through Chebyshev's points by least squares: sums over Chebyshev's polynomials, as powers of z. */
static void fit_amounts(const fitting *f, skg_shades *shades) {
    double power[SKG_SHADE_TERMS][SKG_SHADE_TERMS] = {{1}, {0, 1}}; /* [degree][term] */
    for (int d = 2; d < SKG_SHADE_TERMS; d++)
        for (int t = 0; t < SKG_SHADE_TERMS; t++)
            power[d][t] = (t ? 2 * power[d - 1][t - 1] : 0) - power[d - 2][t];
    for (int32_t k = 0; k < shades->count; k++) {
        double *terms = shades->amounts[k];
        for (int d = 0; d < SKG_SHADE_TERMS; d++) {
            double sum = 0;
            for (int a = 0; a < ANGLES; a++) sum += f->amount[k][a] * cos(d * acos(f->z[a]));
            for (int t = 0; t < SKG_SHADE_TERMS; t++)
                terms[t] += sum * (d ? 2.0 : 1.0) / ANGLES * power[d][t];
        }
        for (int a = 0; a < ANGLES; a++) {
            double value = 0;
            for (int t = SKG_SHADE_TERMS - 1; t >= 0; t--) value = value * f->z[a] + terms[t];
            shades->error = fmax(shades->error, fabs(value - f->amount[k][a]));
            shades->low[k] = fmin(shades->low[k], f->amount[k][a]);
            shades->high[k] = fmax(shades->high[k], f->amount[k][a]);
        }
        const double margin = MARGIN * (shades->high[k] - shades->low[k]);
        shades->low[k] -= margin, shades->high[k] += margin;
    }
}

skg_status skg_shades_find(const skg_view *view, const skg_spectrum *spectrum,
                           const skg_plan_options *options, skg_shades *shades) {
    fitting f = {.bins = spectrum->count};
    skg_status status = SKG_OK;
    *shades = (skg_shades){0};
    if (!options->heel || view->projection != SKG_PROJECTION_POINT) return SKG_OK;
    const int is_ratio = skg_quantity_is_ratio(options) && !skg_quantity_is_absolute(options);
    if (is_ratio && spectrum->count == 1) return SKG_OK;
    shades->angle = options->heel->angle_deg * (SKG_PI / 180);
    SKG_TRY(find_extent(view, options, shades));
    SKG_TRY_CLEANUP(skg_alloc(f.bins, sizeof(double), "heel effect", &f.weight));
    SKG_TRY_CLEANUP(skg_alloc(ANGLES * f.bins, sizeof(double), "heel effect", &f.rest));
    SKG_TRY_CLEANUP(skg_alloc(SKG_SHADES_MOST * f.bins, sizeof(double), "heel effect", &f.unit));
    SKG_TRY_CLEANUP(compute_losses(spectrum, options->heel, shades, &f));
    take_directions(&f, shades);
    fit_amounts(&f, shades);
    SKG_TRY_CLEANUP(skg_alloc(SKG_SHADES_MOST * f.bins, sizeof(double), "heel effect", &shades->losses));
    for (int64_t k = 0; k < shades->count * f.bins; k++) shades->losses[k] = f.unit[k] / f.weight[k % f.bins];
cleanup:
    if (status != SKG_OK) skg_shades_release(shades);
    skg_free(&f.weight);
    skg_free(&f.rest);
    skg_free(&f.unit);
    return status;
}

void skg_shades_release(skg_shades *shades) {
    skg_free(&shades->losses);
    shades->count = 0;
}

void skg_shades_axis(const skg_shades *shades, const skg_camera *camera, double axis[4]) {
    double normal[3] = {0, 0, 0};
    (void)face_of(shades, camera, normal);
    axis[0] = skg_dot(normal, camera->first) / shades->half;
    axis[1] = skg_dot(normal, camera->column) / shades->half;
    axis[2] = skg_dot(normal, camera->row) / shades->half;
    axis[3] = -shades->middle / shades->half;
}
