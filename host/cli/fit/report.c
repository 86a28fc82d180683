/* Reports the result of a fit as text and JSON. */
#include "fit/work.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/say.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static json_t *parameters_json(const fit_work *work, int64_t *chosen) {
    json_t *list = json_array();
    int64_t count = 0;
    *chosen = 0;
    if (skg_fit_parameter_count(work->fit, &count) != SKG_OK) return list;
    for (int64_t p = 0; p < count; p++) {
        skg_fit_parameter one;
        skg_fit_parameter_init(&one);
        if (skg_fit_parameter_get(work->fit, p, &one) != SKG_OK || !one.chosen) continue;
        json_t *object = json_object();
        json_object_set_new(object, "name", json_string(one.name));
        json_object_set_new(object, "value", cli_json_number(one.value));
        json_object_set_new(object, "unit", json_string(one.unit));
        json_object_set_new(object, "sigma", cli_json_number(one.sigma));
        json_object_set_new(object, "start", cli_json_number(one.start));
        json_object_set_new(object, "low", cli_json_number(one.low));
        json_object_set_new(object, "high", cli_json_number(one.high));
        json_object_set_new(object, "determined", json_boolean(one.determined));
        json_array_append_new(list, object);
        ++*chosen;
    }
    return list;
}

static json_t *covariance_json(const fit_work *work, int64_t size) {
    json_t *rows = json_array();
    double *values = size > 0 ? calloc((size_t)(size * size), sizeof *values) : NULL;
    if (values && skg_fit_covariance_get(work->fit, size, values) == SKG_OK)
        for (int64_t r = 0; r < size; r++)
            json_array_append_new(rows, cli_json_numbers(values + size * r, (int)size));
    free(values);
    return rows;
}

static json_t *errors_json(double mean, double rms, double max) {
    json_t *object = json_object();
    json_object_set_new(object, "mean_mm", cli_json_number(mean));
    json_object_set_new(object, "rms_mm", cli_json_number(rms));
    json_object_set_new(object, "max_mm", cli_json_number(max));
    return object;
}

json_t *fit_json(const fit_work *work) {
    json_t *object = json_object(), *parts = json_array();
    int64_t count = 0, chosen = 0;
    json_object_set_new(object, "evaluations", json_integer(work->state.evaluations));
    json_object_set_new(object, "seconds", cli_json_number(work->seconds));
    json_object_set_new(object, "generations", json_integer(work->state.generation));
    json_object_set_new(object, "restarts", json_integer(work->state.restarts));
    json_object_set_new(object, "error_mm", cli_json_number(work->state.best_mm));
    json_object_set_new(object, "parameters", parameters_json(work, &chosen));
    json_object_set_new(object, "covariance", covariance_json(work, chosen));
    if (skg_fit_target_count(work->fit, &count) != SKG_OK) count = 0;
    for (int64_t t = 0; t < count; t++) {
        skg_fit_target one;
        skg_fit_target_init(&one);
        if (skg_fit_target_get(work->fit, t, &one) != SKG_OK) continue;
        json_t *part = json_object();
        json_object_set_new(part, "label", cli_json_text(one.label));
        json_object_set_new(part, "phase", cli_json_number(one.phase));
        json_object_set_new(part, "motion_mm", cli_json_number(one.motion_mm));
        json_object_set_new(part, "before",
                            errors_json(one.before_mean_mm, one.before_rms_mm, one.before_max_mm));
        json_object_set_new(part, "after",
                            errors_json(one.after_mean_mm, one.after_rms_mm, one.after_max_mm));
        json_array_append_new(parts, part);
    }
    json_object_set_new(object, "parts", parts);
    return object;
}

static void print_parameters(const fit_work *work) {
    int64_t count = 0;
    printf("%-20s %10s %10s %10s  %s\n", "parameter", "start", "value", "sigma", "unit");
    if (skg_fit_parameter_count(work->fit, &count) != SKG_OK) return;
    for (int64_t p = 0; p < count; p++) {
        skg_fit_parameter one;
        skg_fit_parameter_init(&one);
        if (skg_fit_parameter_get(work->fit, p, &one) != SKG_OK || !one.chosen) continue;
        printf("%-20s %10.4g %10.4g %10.2g  %s%s\n", one.name, one.start, one.value, one.sigma, one.unit,
               one.determined ? "" : "  not determined by the targets");
    }
}

void fit_print(const fit_work *work) {
    int64_t count = 0;
    print_parameters(work);
    printf("\n%-20s %6s %8s | %26s | %26s\n", "", "", "", "before, mm", "after, mm");
    printf("%-20s %6s %8s | %8s %8s %8s | %8s %8s %8s\n", "target", "phase", "motion", "mean", "rms", "max",
           "mean", "rms", "max");
    if (skg_fit_target_count(work->fit, &count) != SKG_OK) return;
    for (int64_t t = 0; t < count; t++) {
        skg_fit_target one;
        skg_fit_target_init(&one);
        if (skg_fit_target_get(work->fit, t, &one) != SKG_OK) continue;
        cli_print("%-20s %6.3g %8.3g | %8.3g %8.3g %8.3g | %8.3g %8.3g %8.3g\n", one.label, one.phase,
                  one.motion_mm, one.before_mean_mm, one.before_rms_mm, one.before_max_mm, one.after_mean_mm,
                  one.after_rms_mm, one.after_max_mm);
    }
    printf("%" PRId64 " evaluations in %.3g s\n", work->state.evaluations, work->seconds);
}

int fit_write_csv(const fit_work *work, const char *path) {
    char *text = NULL;
    size_t size = 0;
    int64_t count = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return cli_error(CLI_DEVICE, "out of host memory");
    fputs(
        "label,phase,motion_mm,before_mean_mm,before_rms_mm,before_max_mm,after_mean_mm,after_rms_mm,after_max_mm\n",
        stream);
    if (skg_fit_target_count(work->fit, &count) != SKG_OK) count = 0;
    for (int64_t t = 0; t < count; t++) {
        skg_fit_target one;
        skg_fit_target_init(&one);
        if (skg_fit_target_get(work->fit, t, &one) != SKG_OK) continue;
        cli_csv_text(one.label, stream);
        fprintf(stream, ",%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", one.phase, one.motion_mm,
                one.before_mean_mm, one.before_rms_mm, one.before_max_mm, one.after_mean_mm, one.after_rms_mm,
                one.after_max_mm);
    }
    int exit_status = fclose(stream) == 0 ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory");
    if (exit_status == CLI_DONE) exit_status = cli_write_file(path, text, size);
    free(text);
    return exit_status;
}
