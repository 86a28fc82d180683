/* Study of accuracy and time: the dials of a scene, swept against the best reference that the device can give. */
#include "cost/study.h"

#include "common/interrupt.h"
#include "common/progress.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const cost_repair_names[2 * COST_UNITE] = {[SKG_REPAIR_NONE] = "none",
                                                       [SKG_REPAIR_NEIGHBOURS] = "neighbours",
                                                       [SKG_REPAIR_EXACT] = "exact",
                                                       [SKG_REPAIR_NONE + COST_UNITE] = "none and union",
                                                       [SKG_REPAIR_NEIGHBOURS + COST_UNITE] =
                                                           "neighbours and union",
                                                       [SKG_REPAIR_EXACT + COST_UNITE] = "exact and union"};
const double cost_tolerances[COST_TOLERANCES] = {1e-2, 1e-3, 1e-4, 1e-6};

double cost_left_ms(const cost_study *study, double share) {
    return cli_stop_asked() ? 0 : study->begun_ms + share * study->within_ms - cli_now_ms();
}

double cost_coarse_left_ms(const cost_study *study) {
    return cost_left_ms(study, 0.85);
}

const char *cost_time_reason(void) {
    return cli_stop_asked() ? "not measured: the measurement was stopped"
                            : "not measured: the time did not suffice";
}

int32_t cost_repair(const cost_study *study, const cost_setting *setting) {
    const skg_plan_options *own = &study->session.options;
    return setting->repair >= 0 ? setting->repair : own->repair + (own->unite ? COST_UNITE : 0);
}

int cost_is_other_body(const cost_study *study, const cost_setting *setting) {
    return study->subject.has_shells && cost_repair(study, setting) < COST_UNITE;
}

const char *cost_repair_of(const cost_study *study, const cost_setting *setting) {
    return cost_repair_names[cost_repair(study, setting)];
}

int64_t cost_triangles(const cost_study *study, const cost_setting *setting) {
    return setting->meshing >= 0 ? study->meshings[setting->meshing].triangles : study->subject.triangles;
}

const char *cost_precision_name(const cost_setting *setting) {
    return cli_flag_precision.values[setting->precision].name;
}

void cost_append(char *text, size_t size, const char *format, ...) {
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
}

void cost_note(cost_study *study, const char *format, ...) {
    if (study->note_count == COST_NOTES_MAX) return;
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
    for (const char *set; (set = cli_nth_value(arguments, "--set", (int)used));) all[used++] = set;
    for (int64_t i = 0; i < count; i++) all[used++] = settings[i];
    skg_setup_source source;
    skg_setup_source_init(&source);
    source.path = study->session.path;
    source.settings = all;
    source.setting_count = used;
    source.lenient = cli_given(arguments, "--lenient");
    skg_status status = skg_setup_create(NULL, &source, setup);
    free(all);
    return status;
}

char *cost_part_setting(const skg_part *part, int64_t number, const char *format, ...) {
    char *text = NULL;
    size_t size = 0;
    const char *name = "";
    FILE *stream = open_memstream(&text, &size);
    va_list arguments;
    if (!stream) return NULL;
    if (skg_mesh_name_get(part->mesh, &name) == SKG_OK && strcmp(part->label, name) == 0)
        fprintf(stream, "Samples.%" PRId64 ".", number);
    else
        fprintf(stream, "Samples.%s.", part->label);
    va_start(arguments, format);
    vfprintf(stream, format, arguments);
    va_end(arguments);
    if (fclose(stream) == 0) return text;
    free(text);
    return NULL;
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
    if (study->spectrum_count == COST_SPECTRA_MAX) return SKG_ERR_INTERNAL;
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

void cost_meshing_free(cost_meshing *meshing) {
    skg_scene_release(&meshing->scene);
    for (int64_t i = 0; i < meshing->setting_count; i++) free(meshing->settings[i]);
    free(meshing->settings);
    *meshing = (cost_meshing){0};
}

skg_status cost_count_triangles(const skg_scene *scene, int64_t *triangles) {
    int64_t parts = 0, vertices, its;
    skg_status status = skg_scene_part_count(scene, &parts);
    *triangles = 0;
    for (int64_t i = 0; i < parts && status == SKG_OK; i++) {
        skg_part part;
        skg_part_init(&part);
        status = skg_scene_part_get(scene, i, &part);
        if (status == SKG_OK) status = skg_mesh_count(part.mesh, &vertices, &its);
        if (status == SKG_OK) *triangles += its;
    }
    return status;
}
