/* detector: response, unsharpness and grey values. */
#include "core/files.h"
#include "core/maths.h"
#include "ctsimu/parts.h"

#include <math.h>
#include <string.h>

enum { HALF_MAX = 64 };

/* Two columns of a characteristics file as a list of pairs; a third one, the uncertainty, is passed over. */
static skg_status put_file(const skg_item *item, const char *path, const char *key, json_t *object) {
    double *columns[3] = {NULL};
    int64_t count = 0, width = 0;
    json_t *pairs = json_array();
    skg_status status = skg_read_columns_of(path, 2, 3, &count, &width, columns);
    for (int64_t i = 0; i < count && status == SKG_OK; i++) {
        const double pair[2] = {columns[0][i], columns[1][i]};
        json_array_append_new(pairs, skg_ctsimu_numbers(2, pair));
    }
    for (int k = 0; k < 3; k++) skg_free(&columns[k]);
    if (status == SKG_OK) return skg_ctsimu_put(object, key, pairs);
    json_decref(pairs);
    return skg_item_fail(item, status, "%s", skg_last_error());
}

/* Value of a table at x: linear, constant beyond its ends. */
static double interpolate(int64_t count, const double *x, const double *y, double at) {
    int64_t i = 0;
    if (at <= x[0]) return y[0];
    while (i + 2 < count && x[i + 1] < at) i++;
    if (count < 2 || at >= x[count - 1]) return y[count - 1];
    return y[i] + (y[i + 1] - y[i]) * (at - x[i]) / (x[i + 1] - x[i]);
}

/* The share of the photons of an energy that is absorbed: by a table, or by the scintillator. */
typedef struct {
    double *columns[3];
    int64_t rows;
    skg_material *scintillator;
    double thickness_mm;
} absorber;

static skg_status absorb(const absorber *a, double kev, double *share) {
    double mu = 0;
    if (a->rows > 0) {
        *share = interpolate(a->rows, a->columns[0], a->columns[1], kev);
        return SKG_OK;
    }
    SKG_TRY(skg_material_attenuation_get(a->scintillator, kev, &mu));
    *share = 1 - exp(-mu * 0.1 * a->thickness_mm);
    return SKG_OK;
}

static skg_status read_absorber(skg_ctsimu *scenario, absorber *a) {
    const skg_item root = skg_item_root(scenario), detector = skg_item_at(&root, "detector");
    const skg_item file = skg_item_at(&detector, "gray_value|grey_value.efficiency_characteristics_file");
    const skg_item id = skg_item_at(&detector, "scintillator.material_id"),
                   type = skg_item_at(&detector, "type");
    const skg_item thickness = skg_item_at(&detector, "scintillator.thickness");
    const char *path = NULL, *name = NULL;
    int64_t width = 0;
    SKG_TRY(skg_item_file(&file, &path));
    if (path) {
        const skg_status status = skg_read_columns_of(path, 2, 3, &a->rows, &width, a->columns);
        return status == SKG_OK ? SKG_OK : skg_item_fail(&file, status, "%s", skg_last_error());
    }
    SKG_TRY(skg_item_text(&type, &name));
    if (!name || strcmp(name, "real") != 0) return SKG_OK; /* an ideal one absorbs all */
    SKG_TRY(skg_ctsimu_material(&id, &a->scintillator));
    SKG_TRY(skg_item_number(&thickness, SKG_UNIT_MM, &a->thickness_mm));
    if (a->scintillator && !(a->thickness_mm > 0)) skg_material_release(&a->scintillator);
    if (!a->scintillator)
        SKG_TRY(skg_item_remark(&type, "there is neither a scintillator nor an efficiency; all is absorbed"));
    return SKG_OK;
}

/* The response at the energies of the beam, and just beside a single one, because a table needs two. */
static skg_status put_response(const absorber *a, const json_t *beam, json_t *detector) {
    json_t *table = json_array();
    const size_t bins = json_array_size(beam);
    skg_status status = SKG_OK;
    for (size_t i = 0; i < (bins == 1 ? 3 : bins) && status == SKG_OK; i++) {
        const double beside = bins == 1 ? 1 + 1e-3 * ((double)i - 1) : 1;
        const json_t *bin = json_array_get(beam, bins == 1 ? 0 : i);
        double row[2] = {beside * json_number_value(json_object_get(bin, "Energy")), 0};
        status = absorb(a, row[0], &row[1]);
        row[1] *= row[0];
        json_array_append_new(table, skg_ctsimu_numbers(2, row));
    }
    if (status == SKG_OK)
        return skg_ctsimu_put(detector, "EnergyResponse",
                              json_pack("{s:o, s:s}", "LUT", table, "Unit", "keV"));
    json_decref(table);
    return status;
}

/* A Gaussian whose modulation is 20 % at the pitch of the smallest duplex wire that is resolved: its sigma is
 * sqrt(2 ln 5) / pi of the basic spatial resolution (half the unsharpness, ASTM E2597). */
static double gaussian(double mm, const double *resolution) {
    const double sigma = sqrt(2 * log(5)) / SKG_PI * *resolution;
    return exp(-0.5 * mm * mm / (sigma * sigma));
}

/* The line spread function that belongs to a table of modulation over line pairs per mm. */
typedef struct {
    const double *frequencies, *modulation;
    int64_t count;
} modulation_table;

static double line_spread(double mm, const modulation_table *table) {
    enum { STEPS = 4000 };
    const double last = table->frequencies[table->count - 1], step = last / STEPS;
    double sum = 0;
    for (int i = 0; i <= STEPS; i++) {
        const double f = i * step, weight = i == 0 || i == STEPS ? 0.5 : 1;
        sum += weight * interpolate(table->count, table->frequencies, table->modulation, f) *
               cos(2 * SKG_PI * f * mm);
    }
    return sum * step;
}

/* Samples a pixel apart; beyond them all are below 1e-4 of the middle one. */
static json_t *sample_line(double pitch, const double *resolution, const modulation_table *table) {
    double right[HALF_MAX + 1], samples[2 * HALF_MAX + 1];
    int half = 0;
    for (int i = 0; i <= HALF_MAX; i++) {
        right[i] = table ? line_spread(i * pitch, table) : gaussian(i * pitch, resolution);
        if (fabs(right[i]) > 1e-4 * right[0]) half = i;
    }
    for (int i = -half; i <= half; i++) samples[i + half] = right[i < 0 ? -i : i];
    return skg_ctsimu_numbers(2 * half + 1, samples);
}

static skg_status put_blur(skg_ctsimu *scenario, const skg_ctsimu_geometry *g, json_t *detector) {
    const skg_item root = skg_item_root(scenario);
    const skg_item unsharpness = skg_item_at(&root, "detector.unsharpness|sharpness");
    const skg_item resolution_item = skg_item_at(&unsharpness, "basic_spatial_resolution");
    const skg_item file = skg_item_at(&unsharpness, "mtf");
    double resolution = 0, *columns[3] = {NULL};
    int64_t count = 0, width = 0;
    const char *path = NULL;
    SKG_TRY(skg_item_number(&resolution_item, SKG_UNIT_MM, &resolution));
    SKG_TRY(skg_item_file(&file, &path));
    if (!path && !(resolution > 0)) return SKG_OK;
    skg_status status = path ? skg_read_columns_of(path, 2, 3, &count, &width, columns) : SKG_OK;
    if (status != SKG_OK) status = skg_item_fail(&file, status, "%s", skg_last_error());
    if (status == SKG_OK) {
        const modulation_table table = {columns[0], columns[1], count};
        json_t *lines = json_array();
        for (int k = 0; k < 2; k++)
            json_array_append_new(lines, sample_line(g->pitch[k], &resolution, path ? &table : NULL));
        status = skg_ctsimu_put(detector, "LSF", lines);
    }
    for (int k = 0; k < 3; k++) skg_free(&columns[k]);
    return status;
}

/* A number of the scenario under a key of ours, if it is given. */
static skg_status put_number(const skg_item *item, const char *key, json_t *object, int *is_given) {
    double number = 0;
    if (is_given) *is_given = skg_item_given(item);
    if (!skg_item_given(item)) return SKG_OK;
    SKG_TRY(skg_item_number(item, SKG_UNIT_NONE, &number));
    return skg_ctsimu_put(object, key, json_real(number));
}

/* File before line before minimum and maximum, as the format ranks them. */
static skg_status put_curve(const skg_item *detector, json_t *grey) {
    const skg_item values = skg_item_at(detector, "gray_value|grey_value");
    const skg_item file = skg_item_at(&values, "intensity_characteristics_file");
    const skg_item factor = skg_item_at(&values, "factor"), offset = skg_item_at(&values, "offset");
    const skg_item least = skg_item_at(&values, "imin"), most = skg_item_at(&values, "imax");
    const char *path = NULL;
    SKG_TRY(skg_item_file(&file, &path));
    if (path) return put_file(&file, path, "Curve", grey);
    if (skg_item_given(&factor) && skg_item_given(&offset)) {
        SKG_TRY(put_number(&factor, "PerJoule", grey, NULL));
        return put_number(&offset, "Dark", grey, NULL);
    }
    SKG_TRY(put_number(&least, "Dark", grey, NULL));
    return put_number(&most, "Full", grey, NULL);
}

/* The ratio of grey value to noise where the free beam is strongest: by file, by number, or by the noise's full width at
 * half maximum (formats before 0.9). */
static skg_status put_noise(const skg_item *detector, json_t *grey) {
    const skg_item noise = skg_item_at(detector, "noise"), snr = skg_item_at(&noise, "snr_at_imax");
    const skg_item file = skg_item_at(&noise, "noise_characteristics_file");
    const skg_item width = skg_item_at(&noise, "fwhm_at_imax");
    const skg_item most = skg_item_at(detector, "gray_value|grey_value.imax");
    const char *path = NULL;
    double fwhm = 0, full = 0;
    SKG_TRY(skg_item_file(&file, &path));
    if (path) return put_file(&file, path, "NoiseCurve", grey);
    SKG_TRY(skg_item_number(&width, SKG_UNIT_NONE, &fwhm));
    SKG_TRY(skg_item_number(&most, SKG_UNIT_NONE, &full));
    if (!skg_item_given(&snr) && fwhm > 0 && full > 0)
        return skg_ctsimu_put(grey, "SNR", json_real(full * 2 * sqrt(2 * log(2)) / fwhm));
    double ratio = 0;
    SKG_TRY(skg_item_number(&snr, SKG_UNIT_NONE, &ratio));
    return ratio > 0 ? skg_ctsimu_put(grey, "SNR", json_real(ratio)) : SKG_OK;
}

static skg_status put_bad_pixels(const skg_item *detector, json_t *grey) {
    const skg_item map = skg_item_at(detector, "bad_pixel_map"), file = skg_item_at(&map, "file|value");
    const skg_item type = skg_item_at(&map, "type"), endian = skg_item_at(&map, "endian");
    const skg_item header = skg_item_at(&map, "headersize");
    const char *path = NULL, *name = NULL, *kind = NULL, *order = NULL;
    int64_t skipped = 0;
    SKG_TRY(skg_item_file(&file, &path));
    if (!path) return SKG_OK;
    SKG_TRY(skg_item_text(&file, &name));
    SKG_TRY(skg_item_text(&type, &kind));
    SKG_TRY(skg_item_text(&endian, &order));
    SKG_TRY(skg_item_integer(&header, 0, INT32_MAX, &skipped));
    const size_t length = strlen(name);
    if (length < 4 || strcmp(name + length - 4, ".raw") != 0)
        return skg_item_remark(&file, "is not simulated: maps of bad pixels are read from .raw only");
    return skg_ctsimu_put(grey, "BadPixels",
                          json_pack("{s:s, s:s, s:s, s:I}", "Path", name, "Format", kind ? kind : "int16",
                                    "ByteOrder", order ? order : "little", "Header", (json_int_t)skipped));
}

/* The format knows one share: of the grey value in the first frame without radiation over that with it. What the frame after shows it does not
 * say, and nothing is left for it: the time constant is so short that exp(-1 / constant) is 0 in float. Of the frames that a projection averages,
 * the first has the share. */
static skg_status put_lag(const skg_item *detector, int64_t frames, json_t *grey) {
    static const double at_once = 0.005; /* frames */
    const skg_item lag = skg_item_at(detector, "image_lag");
    double share = 0;
    SKG_TRY(skg_item_number(&lag, SKG_UNIT_NONE, &share));
    if (!skg_item_given(&lag) || share == 0) return SKG_OK;
    if (!(share > 0 && share < 1))
        return skg_item_fail(&lag, SKG_ERR_FORMAT, "is %g; give 0 or more, and less than 1", share);
    return skg_ctsimu_put(grey, "Lag", json_pack("[[f, f]]", share / (double)frames, at_once));
}

static skg_status put_grey(skg_ctsimu *scenario, json_t *detector) {
    const skg_item root = skg_item_root(scenario), section = skg_item_at(&root, "detector");
    const skg_item depth = skg_item_at(&section, "bit_depth"),
                   average = skg_item_at(&root, "acquisition.frame_average");
    json_t *grey = json_object();
    int64_t bits = 16, frames = 1;
    SKG_TRY(skg_ctsimu_put(detector, "GreyValues", grey));
    SKG_TRY(put_curve(&section, grey));
    SKG_TRY(put_noise(&section, grey));
    SKG_TRY(put_bad_pixels(&section, grey));
    SKG_TRY(skg_item_integer(&depth, 1, 64, &bits));
    SKG_TRY(skg_item_integer(&average, 1, 1000000, &frames));
    SKG_TRY(put_lag(&section, frames, grey));
    SKG_TRY(skg_ctsimu_put(grey, "Bits", json_integer(bits > 16 ? 0 : bits)));
    return skg_ctsimu_put(grey, "Frames", json_integer(frames));
}

skg_status skg_ctsimu_put_detector(skg_ctsimu *scenario, const skg_ctsimu_geometry *g, json_t *scene) {
    json_t *detector = json_object_get(scene, "Detector");
    const json_t *beam = json_object_get(json_object_get(scene, "Source"), "Beam");
    absorber a = {.rows = 0};
    skg_status status = read_absorber(scenario, &a);
    if (status == SKG_OK && (a.rows > 0 || a.scintillator)) status = put_response(&a, beam, detector);
    for (int k = 0; k < 3; k++) skg_free(&a.columns[k]);
    skg_material_release(&a.scintillator);
    SKG_TRY(status);
    SKG_TRY(put_blur(scenario, g, detector));
    return put_grey(scenario, detector);
}
