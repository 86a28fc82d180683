/* The self-test of filters, heel effect and detectors. */
#include "beam/spectrum.h"
#include "core/maths.h"
#include "selftest/selftest.h"

#include <math.h>
#include <stdio.h>

/* keV: the noise spans several steps, so that their rounding adds the variance of an even distribution. */
static const double noise = 300, step = 50;

void skg_self_test_detector_choose(skg_plan_options *options) {
    options->electronic_kev = noise;
    options->quantum_step_kev = step;
    options->quantity = SKG_QUANTITY_TRANSMISSION;
    options->falloff = 1;
}

/* mm from the middle of the detector to a pixel along rows and columns, and from the source to the pixel. */
static double place_of(const skg_view *view, int64_t row, int64_t column, double *x, double *y) {
    const double down = view->centre[2] - view->source[2];
    *x = ((double)column - 0.5 * (double)(view->columns - 1)) * view->column_step[0];
    *y = ((double)row - 0.5 * (double)(view->rows - 1)) * view->row_step[1];
    return sqrt(down * down + *x * *x + *y * *y);
}

void skg_self_test_detector_compare(const skg_view *view, const double *image, const double *shown,
                                    double open, skg_verdict *verdict) {
    const int64_t pixels = view->columns * view->rows;
    const double down = view->centre[2] - view->source[2], spread = sqrt(noise * noise + step * step / 12);
    double sum = 0, squares = 0, products = 0, above[SKG_SELF_TEST_PIXELS] = {0};
    for (int64_t p = 0; p < pixels; p++) {
        double x, y;
        const double fall = pow(down / place_of(view, p / view->columns, p % view->columns, &x, &y), 3);
        const double kev = image[p] * open * fall, steps = kev / step;
        /* 800 steps of the open beam with an error of two roundings to floats are 2e-4. */
        if (!(fabs(steps - rint(steps)) <= 1e-3)) {
            snprintf(verdict->reason, sizeof verdict->reason,
                     "pixel (%d, %d) has %.9g keV, which is no multiple of %g", (int)(p / view->columns),
                     (int)(p % view->columns), kev, step);
            return;
        }
        const double deviate = (kev - shown[p] * fall) / spread;
        sum += deviate, squares += deviate * deviate;
        products += deviate * above[p % view->columns];
        above[p % view->columns] = deviate;
    }
    /* As of quantum noise: six standard deviations of the sums. */
    const double n = (double)pixels;
    verdict->good =
        fabs(sum) <= 6 * sqrt(n) && fabs(squares - n) <= 6 * sqrt(2 * n) && fabs(products) <= 6 * sqrt(n);
    if (!verdict->good)
        snprintf(
            verdict->reason, sizeof verdict->reason,
            "over all pixels the electronic noise has a mean of %.3g standard deviations, a variance of %.3g "
            "instead of 1, and a covariance of %.3g with the pixel above",
            sum / n, squares / n, products / n);
}

/* Energy of the beam, of which all shades are known; rows of the bow-tie; the layer. */
static const double energy = 40, tangents[SKG_SELF_TEST_BOWTIE_ROWS] = {-0.3, -0.1, 0.05, 0.3},
                    paths[SKG_SELF_TEST_BOWTIE_ROWS] = {8, 3, 1, 6};
static const double layer = 0.3;
enum { ROWS = SKG_SELF_TEST_BOWTIE_ROWS };

skg_status skg_self_test_shades_choose(skg_self_test_scene *scene) {
    skg_bowtie *bowtie = &scene->bowtie;
    skg_grid *grid = &scene->grid;
    skg_collimation *jaws = &scene->jaws;
    skg_bowtie_init(bowtie);
    skg_grid_init(grid);
    skg_collimation_init(jaws);
    SKG_TRY(skg_material_create_formula("Al", 2.7, &scene->filter));
    SKG_TRY(skg_material_create_formula("CsI", 4.51, &scene->crystal));
    SKG_TRY(skg_response_create_scintillator(scene->crystal, layer, 1, &scene->response));
    for (int k = 0; k < ROWS; k++) scene->angles[k] = atan(tangents[k]) * 180 / SKG_PI;
    bowtie->material = scene->filter;
    bowtie->count = ROWS;
    bowtie->angle_deg = scene->angles;
    bowtie->path_mm = paths;
    grid->ratio = 8;
    grid->lines_per_cm = 40;
    grid->strip_mm = 0.05;
    grid->focus_mm = 200;
    scene->view.source[2] = -150;
    scene->view.centre[2] = 100;
    scene->options.bowtie = bowtie;
    scene->options.grid = grid;
    jaws->kind = SKG_COLLIMATION_RECTANGLE;
    jaws->distance_mm = 100;
    jaws->low[0] = -13, jaws->high[0] = 16;
    jaws->low[1] = -17, jaws->high[1] = 15;
    scene->options.collimation = jaws;
    scene->options.response = scene->response;
    scene->options.oblique = 1;
    return SKG_OK;
}

skg_status skg_self_test_shade(const skg_self_test_scene *scene, int64_t row, int64_t column, double *share) {
    const skg_view *view = &scene->view;
    const double down = view->centre[2] - view->source[2];
    double x, y, passed = 0, filter = 0, crystal = 0;
    const double length = place_of(view, row, column, &x, &y), oblique = length / down, tangent = x / down;
    int k = 0;
    while (k < ROWS - 2 && tangent > tangents[k + 1]) k++;
    const double along = (tangent - tangents[k]) / (tangents[k + 1] - tangents[k]);
    const double mm = (paths[k] + along * (paths[k + 1] - paths[k])) * length / sqrt(down * down + x * x);
    SKG_TRY(skg_grid_transmission_get(&scene->grid, energy, oblique, fabs(tangent - x / scene->grid.focus_mm),
                                      &passed));
    SKG_TRY(skg_material_attenuation_get(scene->filter, energy, &filter));
    SKG_TRY(skg_material_attenuation_get(scene->crystal, energy, &crystal));
    *share = passed * exp(-0.1 * filter * mm) * (1 - exp(-0.1 * crystal * layer * oblique));
    const skg_collimation *jaws = &scene->jaws;
    const double near = jaws->distance_mm / down;
    if (x * near < jaws->low[0] || x * near > jaws->high[0] || y * near < jaws->low[1] ||
        y * near > jaws->high[1])
        *share = 0;
    return SKG_OK;
}

void skg_self_test_heel_choose(skg_self_test_scene *scene) {
    skg_heel *heel = &scene->heel;
    skg_heel_init(heel);
    heel->kvp = 100;
    heel->angle_deg = 20;
    heel->bin_kev = 10; /* fewer bins are computed sooner */
    heel->direction[0] = 3, heel->direction[1] = -4;
    scene->view.source[2] = -150;
    scene->view.centre[2] = 100;
    scene->options.heel = heel;
}

/* The anode's face is turned by its angle from the central ray, which is along z, to the direction of the anode. */
skg_status skg_self_test_heel(const skg_self_test_scene *scene, int64_t row, int64_t column, double *shares) {
    const skg_heel *heel = &scene->heel;
    const skg_heel_tube tube = {
        .anode = heel->anode, .kvp = heel->kvp, .angle_deg = heel->angle_deg, .bin_kev = heel->bin_kev};
    const double face = heel->angle_deg * SKG_PI / 180, down = scene->view.centre[2] - scene->view.source[2];
    double x, y, losses[SKG_SELF_TEST_ENERGIES_MAX] = {0};
    const double length = place_of(&scene->view, row, column, &x, &y);
    const double toward =
        (x * heel->direction[0] + y * heel->direction[1]) / hypot(heel->direction[0], heel->direction[1]);
    const double angle = asin((sin(face) * down - cos(face) * toward) / length) * 180 / SKG_PI;
    SKG_TRY(skg_heel_losses(&tube, angle, scene->beam, losses));
    for (int e = 0; e < SKG_SELF_TEST_ENERGIES_MAX; e++) shares[e] = exp(-losses[e]);
    return SKG_OK;
}
