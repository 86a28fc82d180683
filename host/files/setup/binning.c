/* The key Binning of a detector: sensor pixels that are summed into one. The view has the pixels of the image, each with a ray through the
 * middle of every sensor pixel, so that counts, geometry and every later step are those of the image. */
#include "core/maths.h"
#include "core/text.h"
#include "setup/sections.h"

#include <inttypes.h>
#include <math.h>

enum { MOST = 16 };

static skg_status read_bins(const skg_json_node *node, int64_t bins[2]) {
    double given[2];
    SKG_TRY(skg_json_numbers(node, "[columns, rows]", 2, given));
    for (int64_t k = 0; k < 2; k++) {
        const skg_json_node element = skg_json_element(node, k);
        SKG_TRY(skg_json_integer(&element, 1, MOST, &bins[k]));
    }
    return SKG_OK;
}

/* "once", or "each", the default. */
static skg_status read_once(const skg_json_object *detector, int32_t *once) {
    const skg_json_node node = skg_json_member(detector, "BinningNoise");
    const char *text = NULL;
    *once = 0;
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_text(&node, &text));
    *once = skg_same_name(text, "once");
    if (*once || skg_same_name(text, "each")) return SKG_OK;
    return skg_json_fail(
        &node, SKG_ERR_FORMAT,
        "is \"%s\"; give \"each\" (electronic noise of every sensor pixel) or \"once\" (of every bin)", text);
}

static int64_t least_common_multiple(int64_t a, int64_t b) {
    int64_t multiple = a;
    while (multiple % b) multiple += a;
    return multiple;
}

/* Rays are as many along rows as along columns: at least one for each sensor pixel. */
static skg_status multiply_rays(const skg_json_node *node, const int64_t bins[2], int32_t *rays) {
    const int64_t all = *rays * least_common_multiple(bins[0], bins[1]);
    if (all > MOST)
        return skg_json_fail(node, SKG_ERR_FORMAT,
                             "needs %" PRId64 " x %" PRId64
                             " rays a pixel of the image, Oversampling included; at most %d x %d are "
                             "possible: choose smaller or equal numbers, or less Oversampling",
                             all, all, MOST, MOST);
    *rays = (int32_t)all;
    return SKG_OK;
}

static skg_status join_pixels(const skg_json_node *node, const int64_t bins[2], skg_view *view) {
    int64_t *const counts[2] = {&view->columns, &view->rows};
    double *const steps[2] = {view->column_step, view->row_step};
    for (int k = 0; k < 2; k++) {
        if (*counts[k] % bins[k])
            return skg_json_fail(node, SKG_ERR_FORMAT,
                                 "is %" PRId64 " x %" PRId64
                                 ", which does not divide NumberOfPixels, %" PRId64 " x %" PRId64
                                 ", those of the sensor",
                                 bins[0], bins[1], view->columns, view->rows);
    }
    for (int k = 0; k < 2; k++) {
        *counts[k] /= bins[k];
        skg_scale_vector((double)bins[k], steps[k], steps[k]);
    }
    return SKG_OK;
}

/* The weight between bins `apart` from each other of a function of sensor pixels: the mean over the pixels of one bin of what they give to
 * those of the other. */
static double weight_of(const double *samples, int64_t count, int64_t stride, int64_t bins, int64_t apart) {
    const int64_t middle = count / 2;
    double sum = 0;
    for (int64_t i = 0; i < bins; i++)
        for (int64_t j = 0; j < bins; j++) {
            const int64_t at = middle + apart * bins + i - j;
            if (at >= 0 && at < count) sum += samples[at * stride];
        }
    return sum / (double)bins;
}

/* Samples of sensor pixels along one axis become those of bins; the first is at to[0], the others follow by `stride`. */
static int64_t bin_samples(const double *samples, int64_t count, int64_t stride, int64_t bins, double *to) {
    const int64_t reach = (count / 2 + bins - 1) / bins;
    for (int64_t k = -reach; k <= reach; k++)
        to[(k + reach) * stride] = weight_of(samples, count, stride, bins, k);
    return 2 * reach + 1;
}

/* A point spread function: its rows, then its columns. bin_samples never makes more of them. */
static skg_status bin_points(skg_detector_blur *shape, const int64_t bins[2], double **samples) {
    double *narrow = NULL, *both = NULL;
    const int64_t columns = 2 * ((shape->columns / 2 + bins[0] - 1) / bins[0]) + 1;
    const int64_t rows = 2 * ((shape->rows / 2 + bins[1] - 1) / bins[1]) + 1;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(columns * shape->rows, sizeof *narrow, "PSF", &narrow));
    SKG_TRY_CLEANUP(skg_alloc(columns * rows, sizeof *both, "PSF", &both));
    for (int64_t j = 0; j < shape->rows; j++)
        bin_samples(shape->point + j * shape->columns, shape->columns, 1, bins[0], narrow + j * columns);
    for (int64_t i = 0; i < columns; i++) bin_samples(narrow + i, shape->rows, columns, bins[1], both + i);
    skg_free(samples);
    *samples = both;
    both = NULL;
    shape->columns = columns, shape->rows = rows, shape->point = *samples;
cleanup:
    skg_free(&narrow);
    skg_free(&both);
    return status;
}

static skg_status bin_lines(skg_detector_blur *shape, const int64_t bins[2], double **samples) {
    double *both = NULL;
    const int64_t room = shape->columns + 2;
    SKG_TRY(skg_alloc(room + shape->rows + 2, sizeof *both, "LSF", &both));
    shape->columns = bin_samples(shape->along_row, shape->columns, 1, bins[0], both);
    shape->rows = bin_samples(shape->along_column, shape->rows, 1, bins[1], both + room);
    skg_free(samples);
    *samples = both;
    shape->along_row = both, shape->along_column = both + room;
    return SKG_OK;
}

static double sample_of(const skg_detector_blur *shape, int64_t column, int64_t row) {
    if (column < 0 || row < 0 || column >= shape->columns || row >= shape->rows) return 0;
    return shape->point ? shape->point[row * shape->columns + column]
                        : shape->along_row[column] * shape->along_column[row];
}

/* The sum of squares of what each pixel gives to a bin: the variance of a bin over that of a pixel in front of the blur. */
static double variance_of(const skg_detector_blur *shape, const int64_t bins[2]) {
    double sum = 0, squares = 0;
    for (int64_t r = 0; r < shape->rows; r++)
        for (int64_t c = 0; c < shape->columns; c++) sum += sample_of(shape, c, r);
    for (int64_t r = 1 - bins[1]; r < shape->rows; r++)
        for (int64_t c = 1 - bins[0]; c < shape->columns; c++) {
            double given = 0;
            for (int64_t j = 0; j < bins[1]; j++)
                for (int64_t i = 0; i < bins[0]; i++) given += sample_of(shape, c + i, r + j);
            squares += given * given;
        }
    return squares / (sum * sum);
}

static skg_status bin_blur(skg_setup_blur *blur, const int64_t bins[2]) {
    if (blur->shape.columns == 0) return SKG_OK;
    for (int d = 0; d < 2; d++) blur->shape.pixel_mm[d] *= (double)bins[d];
    return blur->shape.point ? bin_points(&blur->shape, bins, &blur->samples)
                             : bin_lines(&blur->shape, bins, &blur->samples);
}

skg_status skg_setup_read_binning(skg_setup_reader *reader, const skg_json_object *detector) {
    skg_setup *setup = reader->setup;
    const skg_json_node node = skg_json_member(detector, "Binning"),
                        noise = skg_json_member(detector, "BinningNoise");
    setup->bins[0] = setup->bins[1] = 1;
    SKG_TRY(read_once(detector, &setup->bins_once));
    if (noise.value && !node.value)
        return skg_json_fail(&noise, SKG_ERR_FORMAT, "says how bins are read out; give Binning as well");
    if (!node.value) return SKG_OK;
    SKG_TRY(read_bins(&node, setup->bins));
    if (setup->dqe.count > 0)
        return skg_json_fail(
            &node, SKG_ERR_FORMAT,
            "a DQE is of the pixels that it was measured with; give MTF, DQE and NumberOfPixels of the bins, and "
            "leave Binning out");
    SKG_TRY(join_pixels(&node, setup->bins, &setup->view));
    SKG_TRY(multiply_rays(&node, setup->bins, &setup->supersampling));
    const double right = setup->blur.shape.columns ? variance_of(&setup->blur.shape, setup->bins) : 0;
    SKG_TRY(bin_blur(&setup->blur, setup->bins));
    if (right > 0) {
        static const int64_t one[2] = {1, 1};
        const double pixels = (double)(setup->bins[0] * setup->bins[1]);
        setup->bins_variance = pixels * variance_of(&setup->blur.shape, one) / right;
    }
    for (int64_t d = 0; d < setup->depths.count; d++) {
        SKG_TRY(bin_blur(&setup->depth_blurs[d], setup->bins));
        setup->depth_shapes[d] = setup->depth_blurs[d].shape;
    }
    return SKG_OK;
}

skg_status skg_setup_bin_counts(skg_setup_reader *reader) {
    skg_setup *setup = reader->setup;
    const double pixels = (double)(setup->bins[0] * setup->bins[1]);
    skg_setup_noise *noise = &setup->noise;
    if (!(pixels > 1)) return SKG_OK;
    if (noise->quantum && setup->bins_variance > 0)
        skg_logger_say(
            &reader->log, SKG_LOG_NOTE,
            "Binning behind a blur: noise within a bin is spread evenly over it, which makes %.3g of the variance of the "
            "sums of blurred pixels",
            setup->bins_variance);
    if (!setup->bins_once) {
        /* Each sensor pixel adds its own deviate and, but for the last rounding, which is that of the sum, its own error of a step. */
        const double steps = (pixels - 1) * noise->step_kev * noise->step_kev / 12;
        noise->electronic_kev = sqrt(pixels * noise->electronic_kev * noise->electronic_kev + steps);
    }
    if (setup->absolute || !setup->spectrum) return SKG_OK;
    skg_spectrum *of_bin = NULL; /* photons are counted per sensor pixel */
    SKG_TRY(skg_spectrum_create_scaled(setup->spectrum, pixels, &of_bin));
    skg_spectrum_release(&setup->spectrum);
    setup->spectrum = of_bin;
    return SKG_OK;
}
