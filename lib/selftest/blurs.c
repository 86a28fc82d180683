/* The self-test of blurs and of the power of noise. */
#include "core/maths.h"
#include "selftest/selftest.h"

#include <math.h>
#include <stdio.h>

enum { DEPTHS = SKG_SELF_TEST_DEPTH_COUNT };

/* No line is symmetrical, so that an image that is turned over is found. */
static const double row[] = {0.05, 0.2, 0.5, 0.15, 0.1}, column[] = {0.1, 0.3, 0.4, 0.2, 0};
static const double one[] = {1}, flat[] = {0.2, 0.5, 0.3},
                    point[] = {0.05, 0.1, 0.02, 0.2, 0.3, 0.08, 0.1, 0.12, 0.03};

/* Of the scintillator: the end of each depth as a share of the thickness, the thickness in mm, and the energy in keV. */
static const double ends[DEPTHS] = {0.2, 0.6, 1}, layer = 0.1, energy = 40;

/* Noise is blurred along rows and columns by the samples beside, own, beside. The DQE at frequency 0. */
static const double beside = -0.25, own = 1.5, dqe_zero = 0.8;

/* keV per pixel, of the test of variances. Steps have a third of the variance of the electronic noise. */
static const double electronic = 300, step = 600;

static skg_detector_blur lines(int64_t columns, const double *along_row, int64_t rows,
                               const double *along_column) {
    return (skg_detector_blur){.size = sizeof(skg_detector_blur),
                               .columns = columns,
                               .rows = rows,
                               .along_row = along_row,
                               .along_column = along_column};
}

static skg_status choose_depths(skg_self_test_scene *scene) {
    skg_detector_blur *blurs = scene->depth_blurs;
    blurs[0] = lines(1, one, 1, one);
    blurs[1] = lines(5, row, 3, flat);
    skg_detector_blur_init(&blurs[2]);
    blurs[2].columns = blurs[2].rows = 3;
    blurs[2].point = point;
    skg_depth_blur_init(&scene->depths);
    scene->depths.count = DEPTHS;
    scene->depths.to = ends;
    scene->depths.blur = blurs;
    scene->options.depth_blur = &scene->depths;
    SKG_TRY(skg_material_create_formula("CsI", 4.51, &scene->crystal));
    SKG_TRY(skg_response_create_scintillator(scene->crystal, layer, 1, &scene->response));
    scene->options.response = scene->response;
    return SKG_OK;
}

/* Samples a, b, a have the transfer function b + 2 a cos(2 pi f). The power of the noise is its square, and that of the image
 * is 1, so that the DQE is the inverse of it. */
static void choose_dqe(skg_self_test_scene *scene) {
    enum { LAST = SKG_SELF_TEST_FREQUENCIES - 1 };
    const double highest = 0.5 / scene->view.column_step[0];
    for (int k = 0; k <= LAST; k++) {
        const double transfer = own + 2 * beside * cos(SKG_PI * k / LAST);
        scene->per_mm[k] = highest * k / LAST;
        scene->dqe_values[k] = dqe_zero / (transfer * transfer);
    }
    skg_dqe_init(&scene->dqe);
    scene->dqe.count = SKG_SELF_TEST_FREQUENCIES;
    scene->dqe.per_mm = scene->per_mm;
    scene->dqe.dqe = scene->dqe_values;
    scene->options.noise = 1;
    scene->options.dqe = &scene->dqe;
}

static void choose_noise(skg_self_test_scene *scene) {
    scene->options.blur = &scene->blur;
    scene->options.noise = 1;
    scene->options.electronic_kev = electronic;
    scene->options.quantum_step_kev = step;
    scene->options.falloff = SKG_FALLOFF_ON;
    scene->options.quantity = SKG_QUANTITY_ATTENUATION;
}

skg_status skg_self_test_blurs_choose(skg_self_test_scene *scene) {
    scene->blur = lines(5, row, 5, column);
    if (scene->number == SKG_SELF_TEST_BLUR) scene->options.blur = &scene->blur;
    if (scene->number == SKG_SELF_TEST_APART) choose_dqe(scene);
    if (scene->number == SKG_SELF_TEST_VARIANCE) choose_noise(scene);
    return scene->number == SKG_SELF_TEST_DEPTHS ? choose_depths(scene) : SKG_OK;
}

/* Adds a share of the image to what is wanted, blurred. A pixel beyond the edge has the value of the nearest one. */
static void add_blurred(const skg_self_test_scene *scene, const skg_detector_blur *blur, double share,
                        const double *shown, double *wanted) {
    const int columns = (int)scene->view.columns, rows = (int)scene->view.rows;
    for (int p = 0; p < rows * columns; p++)
        for (int k = 0; k < blur->rows * blur->columns; k++) {
            const int j = k / (int)blur->columns, i = k % (int)blur->columns;
            const int r = p / columns - (j - (int)blur->rows / 2),
                      c = p % columns - (i - (int)blur->columns / 2);
            const double weight = blur->point ? blur->point[k] : blur->along_column[j] * blur->along_row[i];
            wanted[p] +=
                share * weight *
                shown[(int)fmin(fmax(r, 0), rows - 1) * columns + (int)fmin(fmax(c, 0), columns - 1)];
        }
}

skg_status skg_self_test_blur(const skg_self_test_scene *scene, const double *shown, double *wanted) {
    double per_cm = 0;
    for (int64_t p = 0; p < scene->view.rows * scene->view.columns; p++) wanted[p] = 0;
    if (scene->number == SKG_SELF_TEST_BLUR) {
        add_blurred(scene, &scene->blur, 1, shown, wanted);
        return SKG_OK;
    }
    SKG_TRY(skg_material_attenuation_get(scene->crystal, energy, &per_cm));
    for (int d = 0; d < DEPTHS; d++) {
        const double before = d ? ends[d - 1] : 0;
        const double share = exp(-0.1 * per_cm * layer * before) - exp(-0.1 * per_cm * layer * ends[d]);
        add_blurred(scene, &scene->depth_blurs[d], share, shown, wanted);
    }
    return SKG_OK;
}

/* The variance of a pixel's noise, from that of nine pixels before the noise was blurred. */
static double variance_at(const double *shown, int64_t pixel, int64_t columns, const double *samples) {
    double sum = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            const double weight = samples[j + 1] * samples[i + 1];
            sum += weight * weight * shown[pixel + j * columns + i];
        }
    return sum;
}

/* With the expected mean and variance, n normal deviates have the sum 0 and the sum of squares n. Without blur their standard
 * deviations are sqrt(n) and sqrt(2 n); if the correlation of deviates at a distance d is r(d), the latter is sqrt(2 n sum r^2),
 * and so is at most that of the sum of products. The former falls where neighbours have opposite signs. Six of them. */
void skg_self_test_noise_compare(const skg_self_test_scene *scene, const double *image, const double *shown,
                                 double open, skg_verdict *verdict) {
    const int apart = scene->number == SKG_SELF_TEST_APART;
    const double samples[3] = {apart ? beside : 0, apart ? own : 1, apart ? beside : 0};
    const double power = samples[1] * samples[1] + 2 * samples[0] * samples[0];
    const double next = 2 * samples[0] * samples[1] / power, after = samples[0] * samples[0] / power;
    const double related = 1 + 2 * (next * next + after * after); /* sum r^2 of a line */
    const double kev = open / 1000 / (apart ? dqe_zero : 1); /* 1000 photons reach a pixel of the open beam */
    const int64_t columns = scene->view.columns, rows = scene->view.rows;
    double sum = 0, squares = 0, products = 0;
    for (int64_t j = 1; j < rows - 1; j++) {
        double left = 0;
        for (int64_t i = 1; i < columns - 1; i++) {
            const int64_t p = j * columns + i;
            const double deviate =
                (image[p] - shown[p]) / sqrt(kev * variance_at(shown, p, columns, samples));
            sum += deviate, squares += deviate * deviate, products += left * deviate;
            left = deviate;
        }
    }
    const double n = (double)((rows - 2) * (columns - 2)), bar = 6 * related * sqrt(2 * n);
    verdict->good = fabs(sum) <= 6 * sqrt(n) && fabs(squares - n) <= bar && fabs(products - next * n) <= bar;
    if (!verdict->good)
        snprintf(
            verdict->reason, sizeof verdict->reason,
            "over %.0f pixels the noise has a mean of %.3g standard deviations, a variance of %.3g instead "
            "of 1, and a covariance of %.3g instead of %.3g with the pixel beside",
            n, sum / n, squares / n, products / n, next);
}

/* The weight of a pixel of a line in another, beyond whose ends pixels have the value of the last. */
static double weight_of(const double *samples, int count, int to, int from, int last) {
    double sum = 0;
    for (int k = 0; k < count; k++) {
        const int at = to - (k - count / 2);
        if ((at < 0 ? 0 : at > last ? last : at) == from) sum += samples[k];
    }
    return sum;
}

/* Photons have 40 keV each, so the variance of a pixel before the blur is 40 times its energy. Flat fields cancel in the variance
 * of a logarithm. Image and blur are right to 1e-4 of the open beam, of which more than a twentieth passes everywhere. */
void skg_self_test_variance_compare(const skg_self_test_scene *scene, const double *variance,
                                    const double *shown, skg_verdict *verdict) {
    enum { TAPS = 5, REACH = TAPS / 2 };
    const skg_view *view = &scene->view;
    const int columns = (int)view->columns, rows = (int)view->rows;
    const double down = view->centre[2] - view->source[2], bar = 1e-2;
    verdict->good = 1;
    for (int p = 0; p < rows * columns && verdict->good; p++) {
        const int y = p / columns, x = p % columns;
        double mean = 0, wanted = electronic * electronic + step * step / 12;
        for (int j = y - REACH < 0 ? 0 : y - REACH; j <= y + REACH && j < rows; j++)
            for (int i = x - REACH < 0 ? 0 : x - REACH; i <= x + REACH && i < columns; i++) {
                const double weight =
                    weight_of(column, TAPS, y, j, rows - 1) * weight_of(row, TAPS, x, i, columns - 1);
                const double right = (i - 0.5 * (columns - 1)) * view->column_step[0],
                             below = (j - 0.5 * (rows - 1)) * view->row_step[1];
                const double fall = pow(down / sqrt(down * down + right * right + below * below), 3);
                mean += weight * fall * shown[j * columns + i];
                wanted += weight * weight * energy * fall * shown[j * columns + i];
            }
        wanted /= mean * mean;
        verdict->good = fabs(variance[p] - wanted) <= bar * wanted;
        if (!verdict->good)
            snprintf(verdict->reason, sizeof verdict->reason,
                     "pixel (%d, %d) has a variance of %.6g instead of %.6g", y, x, variance[p], wanted);
    }
}
