/* skiagraph cost: a setting as an image, its time and its error. */
#include "cost.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_RUNS = 200, THUMB = 320 };

void cost_note(cost_study *study, const char *format, ...) {
    if (study->note_count == COST_MOST_NOTES) return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(study->notes[study->note_count++], sizeof study->notes[0], format, arguments);
    va_end(arguments);
}

double cost_passes(const cost_setting *setting) {
    return (double)(setting->samples > 0 ? setting->samples : 1) * setting->supersampling *
           setting->supersampling;
}

double cost_patience_ms(const cost_study *study) {
    return study->quick ? 1e3 : 4e3;
}

/* Reads the scene again with so many bins at most. The caller releases the spectrum. */
static skg_status read_spectrum(const cost_study *study, int64_t bins, skg_spectrum **spectrum) {
    const cli_arguments *arguments = study->arguments;
    const char **settings = calloc((size_t)arguments->given_count + 1, sizeof *settings);
    char setting[64];
    int count = 0;
    skg_setup *setup = NULL;
    if (!settings) return SKG_ERR_MEMORY;
    for (const char *set; (set = cli_nth_value(arguments, &cli_flag_set, count)); count++)
        settings[count] = set;
    snprintf(setting, sizeof setting, "Source.Beam.MaxNumberOfEnergyBins=%lld", (long long)bins);
    settings[count++] = setting;
    skg_status status = skg_setup_load(NULL, study->session.path, count, settings, &setup);
    if (status == SKG_OK) status = skg_setup_spectrum(setup, spectrum);
    if (status == SKG_OK) status = skg_spectrum_retain(*spectrum);
    skg_setup_release(&setup);
    free(settings);
    return status;
}

/* The scene's spectrum with so many bins at most; it belongs to the study. */
static skg_status spectrum_of(cost_study *study, int64_t bins, skg_spectrum **spectrum) {
    *spectrum = study->session.spectrum;
    if (bins == 0) return SKG_OK;
    for (int i = 0; i < study->spectrum_count; i++)
        if (study->spectra[i].bins == bins) {
            *spectrum = study->spectra[i].spectrum;
            return SKG_OK;
        }
    if (study->spectrum_count == COST_MOST_SPECTRA) return SKG_ERR_INTERNAL;
    skg_status status = read_spectrum(study, bins, spectrum);
    if (status != SKG_OK) return status;
    study->spectra[study->spectrum_count].bins = bins;
    study->spectra[study->spectrum_count++].spectrum = *spectrum;
    return SKG_OK;
}

int cost_has_bins(cost_study *study, int64_t bins) {
    skg_spectrum *spectrum;
    return spectrum_of(study, bins, &spectrum) == SKG_OK;
}

static skg_status plan_of(cost_study *study, const cost_setting *setting, skg_plan **plan) {
    skg_plan_options options = study->session.options;
    skg_spot spot;
    skg_spectrum *spectrum = NULL;
    skg_status status = spectrum_of(study, setting->bins, &spectrum);
    if (status != SKG_OK) return status;
    options.precision = setting->precision;
    options.tolerance = setting->tolerance;
    options.supersampling = setting->supersampling;
    if (!study->noisy) {
        options.noise = 0;
        options.electronic_kev = options.quantum_step_kev = 0;
    }
    options.overlaps = 0; /* told once, by cost_open */
    if (setting->samples > 0) {
        spot = *options.spot;
        spot.samples = setting->samples;
        options.spot = &spot;
    }
    return skg_plan_create(study->session.context, study->session.scene, &study->session.view, spectrum,
                           &options, plan);
}

/* What the scene's own plan finds: samples of the source, the open beam, the size of the image. */
static int look_at_scene(cost_study *study) {
    const skg_plan_options *options = &study->session.options;
    skg_plan *plan = NULL;
    skg_plan_report report;
    skg_channel channel;
    skg_plan_report_init(&report);
    skg_channel_init(&channel);
    skg_status status = skg_plan_create(study->session.context, study->session.scene, &study->session.view,
                                        study->session.spectrum, options, &plan);
    if (status == SKG_OK) status = skg_plan_get_report(plan, &report);
    if (status == SKG_OK) status = skg_plan_channel(plan, 0, &channel);
    study->open = channel.open;
    study->has_spot = options->spot && options->spot->shape != SKG_SPOT_POINT && options->spot->grid == 0 &&
                      study->session.view.projection == SKG_POINT;
    study->own = (cost_setting){.precision = options->precision,
                                .supersampling = options->supersampling,
                                .tolerance = options->tolerance};
    if (study->has_spot)
        study->own.samples = report.samples / ((int64_t)options->supersampling * options->supersampling);
    skg_plan_release(&plan);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* Whether the beam is a tube, whose bins can be set, and whether the scene asks for wider ones than it may.
 */
static int look_at_beam(cost_study *study) {
    int64_t own = 0, finest = 0;
    skg_spectrum *spectrum = NULL;
    skg_status status = skg_spectrum_size(study->session.spectrum, &own);
    if (status != SKG_OK) return cli_fail(status);
    study->has_tube = spectrum_of(study, COST_FINEST_BINS, &spectrum) == SKG_OK;
    if (study->has_tube) status = skg_spectrum_size(spectrum, &finest);
    study->has_energies = own > 1 || finest > 1;
    study->finest = finest > own ? COST_FINEST_BINS : 0;
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

int cost_open(cost_study *study) {
    int exit_status = cli_open_session(study->arguments, &study->session);
    if (exit_status == CLI_DONE) exit_status = look_at_scene(study);
    if (exit_status == CLI_DONE) exit_status = look_at_beam(study);
    const skg_view *view = &study->session.view;
    int64_t side = view->columns > view->rows ? view->columns : view->rows;
    if (study->session.context) /* what there was to tell of the scene has been told */
        skg_context_set_log(study->session.context, NULL, NULL);
    study->pixels = view->columns * view->rows;
    study->thumb_block = (side + THUMB - 1) / THUMB > 1 ? (side + THUMB - 1) / THUMB : 1;
    study->thumb_columns = (view->columns + study->thumb_block - 1) / study->thumb_block;
    study->thumb_rows = (view->rows + study->thumb_block - 1) / study->thumb_block;
    return exit_status;
}

void cost_close(cost_study *study) {
    for (int i = 0; i < 3; i++) free(study->references[i].image);
    for (int i = 0; i < study->spectrum_count; i++) skg_spectrum_release(&study->spectra[i].spectrum);
    for (int i = 0; i < study->count; i++) free(study->points[i].difference);
    for (int i = 0; i < COST_TOLERANCES; i++) {
        free(study->advice[i].rays_command);
        free(study->advice[i].whole_command);
    }
    cli_close_session(&study->session);
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Warm runs until there are enough of them and they took long enough for the clock. */
static skg_status time_runs(const cost_study *study, skg_plan *plan, const skg_output *output,
                            cost_point *point) {
    const int64_t least = study->quick ? 3 : 9;
    const double wish_ms = study->quick ? 50 : 300, limit_ms = study->quick ? 1000 : 3000;
    double ms[MOST_RUNS], begun = cli_now_ms(), passed = 0;
    int64_t n = 0;
    skg_status status = SKG_OK;
    while (n < MOST_RUNS && (n < least || passed < wish_ms) && (n < 2 || passed < limit_ms)) {
        double start = cli_now_ms();
        status = skg_plan_image(plan, output);
        if (status < SKG_OK) return status;
        ms[n++] = cli_now_ms() - start;
        passed = cli_now_ms() - begun;
    }
    qsort(ms, (size_t)n, sizeof *ms, ascending);
    point->runs = n;
    point->min_ms = ms[0];
    point->median_ms = 0.5 * (ms[(n - 1) / 2] + ms[n / 2]);
    return status;
}

static skg_status report_plan(const skg_plan *plan, cost_point *point) {
    skg_plan_report report;
    skg_plan_report_init(&report);
    skg_status status = skg_plan_get_report(plan, &report);
    point->nodes = report.nodes;
    point->planes = report.planes;
    point->bins = report.bins;
    return status;
}

skg_status cost_image(cost_study *study, const cost_setting *setting, double *image, cost_point *point) {
    skg_plan *plan = NULL;
    skg_output output;
    double start = cli_now_ms();
    skg_status status = plan_of(study, setting, &plan);
    if (status < SKG_OK) return status;
    if (point) point->plan_ms = cli_now_ms() - start;
    skg_output_init(&output);
    output.type = setting->precision == SKG_DOUBLE ? SKG_FLOAT64 : SKG_FLOAT32;
    output.data = image;
    status = skg_plan_image(plan, &output);
    if (status >= SKG_OK && point) status = time_runs(study, plan, &output, point);
    if (status >= SKG_OK && point) status = report_plan(plan, point);
    if (status >= SKG_OK && output.type == SKG_FLOAT32)
        for (int64_t i = study->pixels - 1; i >= 0; i--) { /* widened in place, from the end */
            float value;
            memcpy(&value, (const char *)image + (size_t)i * sizeof value, sizeof value);
            image[i] = (double)value;
        }
    skg_plan_release(&plan);
    return status < SKG_OK ? status : SKG_OK;
}

static void shrink_difference(const cost_study *study, const double *image, const double *reference,
                              float *difference) {
    const int64_t columns = study->session.view.columns;
    for (int64_t i = 0; i < study->pixels; i++) {
        float value = (float)((image[i] - reference[i]) / study->open);
        float *place = &difference[i / columns / study->thumb_block * study->thumb_columns +
                                   i % columns / study->thumb_block];
        if (fabsf(value) > fabsf(*place)) *place = value;
    }
}

int cost_compare(const cost_study *study, const double *image, const double *reference, cost_point *point) {
    double squares_open = 0, squares_ref = 0;
    int64_t seen = 0;
    point->max_open = point->max_ref = 0;
    point->max_mm = (double)NAN;
    for (int64_t i = 0; i < study->pixels; i++) {
        double error = fabs(image[i] - reference[i]), of_open = error / study->open;
        if (!(of_open <= point->max_open)) point->max_open = of_open; /* NaN stays and is seen */
        squares_open += of_open * of_open;
        if (!(reference[i] > 0)) continue;
        double of_ref = error / reference[i];
        if (!(of_ref <= point->max_ref)) point->max_ref = of_ref;
        squares_ref += of_ref * of_ref;
        seen++;
    }
    point->rms_open = sqrt(squares_open / (double)study->pixels);
    point->rms_ref = seen ? sqrt(squares_ref / (double)seen) : 0;
    point->difference = calloc((size_t)(study->thumb_columns * study->thumb_rows), sizeof *point->difference);
    if (!point->difference) return cli_error(CLI_DEVICE, "out of host memory");
    shrink_difference(study, image, reference, point->difference);
    return CLI_DONE;
}

static skg_status lengths(skg_plan *plan, int64_t part, int32_t type, void *data) {
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.type = type;
    output.data = data;
    skg_status status = skg_plan_lengths(plan, part, SKG_SURFACE, 1, NULL, &output, &job);
    return status < SKG_OK ? status : skg_job_wait(&job);
}

double cost_length_error(cost_study *study, int32_t precision) {
    cost_setting best = study->references[0].setting, its = best;
    const int32_t type = precision == SKG_DOUBLE ? SKG_FLOAT64 : SKG_FLOAT32;
    skg_plan *plans[2] = {NULL, NULL};
    double *exact = calloc((size_t)study->pixels, sizeof *exact), worst = 0;
    void *rough = calloc((size_t)study->pixels, sizeof(double));
    int64_t parts = 0;
    best.samples = its.samples = study->own.samples > 0 ? 1 : 0;
    best.supersampling = its.supersampling = 1;
    its.precision = precision;
    skg_status status = exact && rough ? skg_scene_size(study->session.scene, &parts) : SKG_ERR_MEMORY;
    if (status >= SKG_OK) status = plan_of(study, &best, &plans[0]);
    if (status >= SKG_OK) status = plan_of(study, &its, &plans[1]);
    double begun = 0;
    int64_t part = 0;
    for (; status >= SKG_OK && part < parts; part++) {
        if (part == 1) begun = cli_now_ms(); /* the first one compiles */
        if (part > 1 && cli_now_ms() - begun > cost_patience_ms(study)) break;
        status = lengths(plans[0], part, SKG_FLOAT64, exact);
        if (status >= SKG_OK) status = lengths(plans[1], part, type, rough);
        for (int64_t i = 0; status >= SKG_OK && i < study->pixels; i++) {
            double value = type == SKG_FLOAT64 ? ((double *)rough)[i] : (double)((float *)rough)[i];
            worst = fmax(worst, fabs(value - exact[i]));
        }
    }
    if (status >= SKG_OK && part < parts)
        cost_note(study, "path lengths in %s: the first %lld of %lld parts; more take too long",
                  cli_precision_names[precision], (long long)part, (long long)parts);
    skg_plan_release(&plans[0]);
    skg_plan_release(&plans[1]);
    free(exact);
    free(rough);
    return status >= SKG_OK ? worst : (double)NAN;
}
