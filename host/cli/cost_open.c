/* skiagraph cost: what the scene is like, and which dials it has. */
#include "cost.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THUMB = 320 };

void cost_note(cost_study *study, const char *format, ...) {
    if (study->note_count == COST_MOST_NOTES) return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(study->notes[study->note_count++], sizeof study->notes[0], format, arguments);
    va_end(arguments);
}

skg_status cost_load(const cost_study *study, int64_t count, const char *const *settings, skg_setup **setup) {
    const cli_arguments *arguments = study->arguments;
    const char **all = calloc((size_t)(arguments->given_count + count), sizeof *all);
    int64_t used = 0;
    if (!all) return SKG_ERR_MEMORY;
    for (const char *set; (set = cli_nth_value(arguments, &cli_flag_set, (int)used));) all[used++] = set;
    for (int64_t i = 0; i < count; i++) all[used++] = settings[i];
    skg_status status = skg_setup_load(NULL, study->session.path, used, all, setup);
    free(all);
    return status;
}

static skg_status read_spectrum(const cost_study *study, int64_t bins, skg_spectrum **spectrum) {
    char setting[64];
    const char *const settings[] = {setting};
    skg_setup *setup = NULL;
    snprintf(setting, sizeof setting, "Source.Beam.MaxNumberOfEnergyBins=%lld", (long long)bins);
    skg_status status = cost_load(study, 1, settings, &setup);
    if (status == SKG_OK) status = skg_setup_spectrum_get(setup, spectrum);
    if (status == SKG_OK) status = skg_spectrum_retain(*spectrum);
    skg_setup_release(&setup);
    return status;
}

skg_status cost_spectrum(cost_study *study, int64_t bins, skg_spectrum **spectrum) {
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
    return cost_spectrum(study, bins, &spectrum) == SKG_OK;
}

/* What the scene's own plan finds: samples of the source, open meshes, the open beam. */
static int look_at_scene(cost_study *study) {
    const skg_plan_options *options = &study->session.options;
    skg_plan *plan = NULL;
    skg_plan_report report;
    skg_channel channel;
    skg_plan_report_init(&report);
    skg_channel_init(&channel);
    skg_status status = skg_plan_create(study->session.context, study->session.scene, &study->session.view,
                                        study->session.spectrum, options, &plan);
    if (status == SKG_OK) status = skg_plan_report_get(plan, &report);
    if (status == SKG_OK) status = skg_plan_channel_get(plan, 0, &channel);
    study->open = channel.flat_field;
    study->has_open = report.leaky_parts > 0;
    study->triangles = report.triangles;
    study->has_spot = options->spot && options->spot->shape != SKG_SPOT_POINT && options->spot->grid == 0 &&
                      study->session.view.projection == SKG_PROJECTION_POINT;
    study->own = (cost_setting){.precision = options->precision,
                                .supersampling = options->supersampling,
                                .tolerance = options->tolerance,
                                .repair = -1,
                                .meshing = -1,
                                .relaxation = -1,
                                .hysteresis = -1};
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
    skg_status status = skg_spectrum_bin_count(study->session.spectrum, &own);
    if (status != SKG_OK) return cli_fail(status);
    study->has_tube = cost_spectrum(study, COST_FINEST_BINS, &spectrum) == SKG_OK;
    if (study->has_tube) status = skg_spectrum_bin_count(spectrum, &finest);
    study->has_energies = own > 1 || finest > 1;
    study->finest = finest > own ? COST_FINEST_BINS : 0;
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int look_at_breath(cost_study *study) {
    int32_t breathes = 0;
    skg_body_options_init(&study->body);
    skg_status status = skg_setup_body_options_get(study->session.setup, &breathes, &study->body);
    study->has_breath = breathes;
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

int cost_open(cost_study *study) {
    int exit_status = cli_open_session(study->arguments, &study->session);
    if (exit_status == CLI_DONE) exit_status = look_at_scene(study);
    if (exit_status == CLI_DONE) exit_status = look_at_beam(study);
    if (exit_status == CLI_DONE) exit_status = look_at_breath(study);
    const skg_view *view = &study->session.view;
    int64_t side = view->columns > view->rows ? view->columns : view->rows;
    if (study->session.context) /* what there was to tell of the scene has been told */
        skg_context_log_set(study->session.context, NULL, NULL);
    study->pixels = view->columns * view->rows;
    study->thumb_block = (side + THUMB - 1) / THUMB > 1 ? (side + THUMB - 1) / THUMB : 1;
    study->thumb_columns = (view->columns + study->thumb_block - 1) / study->thumb_block;
    study->thumb_rows = (view->rows + study->thumb_block - 1) / study->thumb_block;
    return exit_status;
}

void cost_close(cost_study *study) {
    for (int i = 0; i < COST_REFERENCES; i++) {
        free(study->references[i].image);
        free(study->references[i].positions);
    }
    for (int i = 0; i < study->spectrum_count; i++) skg_spectrum_release(&study->spectra[i].spectrum);
    for (int i = 0; i < study->meshing_count; i++) cost_meshing_free(&study->meshings[i]);
    for (int i = 0; i < study->count; i++) {
        free(study->points[i].difference);
        free(study->points[i].small);
    }
    for (int i = 0; i < COST_TOLERANCES; i++) {
        free(study->advice[i].rays_command);
        free(study->advice[i].whole_command);
    }
    cli_close_session(&study->session);
}
