/* Scattered photons of an image: the flags that ask for them, and what is reported of them. */
#include "session/scattering.h"

#include "common/encode.h"
#include "common/say.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HISTORIES_MAX = 1 << 30 };

/* "0.01", or "histories=1e6". */
static int read_accuracy(const char *value, skg_scatter *scatter) {
    static const char name[] = "histories=";
    const int is_count = strncmp(value, name, strlen(name)) == 0;
    const char *digits = is_count ? value + strlen(name) : value;
    char *end = NULL;
    const double number = strtod(digits, &end);
    const int is_number = end != digits && !*end;
    if (is_count && is_number && number >= 1 && number <= HISTORIES_MAX && number == floor(number)) {
        scatter->tolerance = 0;
        scatter->histories = (int64_t)number;
        return CLI_DONE;
    }
    if (!is_count && is_number && number > 0 && number < 1) {
        scatter->tolerance = number;
        scatter->histories = 0;
        return CLI_DONE;
    }
    return cli_error(
        CLI_USAGE,
        "--scatter %s is neither a standard error above 0 and below 1, such as 0.01, nor a whole "
        "number of histories from 1 to %d, such as histories=1e6",
        value, HISTORIES_MAX);
}

int cli_scattering_read(const cli_arguments *arguments, cli_scattering *scattering) {
    const char *accuracy = cli_value(arguments, "--scatter");
    skg_scatter_init(&scattering->asked);
    scattering->is_asked = scattering->has_accuracy = accuracy != NULL;
    if (cli_given(arguments, "--scatter-image") || cli_given(arguments, "--scatter-sigma"))
        scattering->is_asked = 1;
    return accuracy ? read_accuracy(accuracy, &scattering->asked) : CLI_DONE;
}

void cli_scattering_ask(cli_scattering *scattering, cli_session *session) {
    if (!scattering->is_asked) return;
    if (session->options.scatter) {
        const skg_scatter flagged = scattering->asked;
        scattering->asked = *session->options.scatter;
        if (scattering->has_accuracy) {
            scattering->asked.tolerance = flagged.tolerance;
            scattering->asked.histories = flagged.histories;
        }
    }
    session->options.scatter = &scattering->asked;
}

/* The mean of all channels of an image; of an attenuation, that of the transmission. */
static double mean_of(const skg_picture *image) {
    const int64_t pixels = image->columns * image->rows * image->channels;
    double sum = 0;
    for (int64_t i = 0; i < pixels; i++) {
        const double value = image->type == SKG_TYPE_FLOAT64 ? ((const double *)image->data)[i]
                                                             : (double)((const float *)image->data)[i];
        sum += image->quantity == SKG_QUANTITY_ATTENUATION ? exp(-value) : value;
    }
    return sum / (double)pixels;
}

/* Mean scatter over mean primary; not finite where no primary arrives. */
static double ratio_of(const skg_scatter_report *report, const skg_picture *image) {
    return report->mean / (mean_of(image) - report->mean);
}

static int has_report(const skg_plan *plan, skg_scatter_report *report) {
    skg_scatter_report_init(report);
    return skg_plan_scatter_report_get(plan, report) == SKG_OK;
}

json_t *cli_scattering_json(const skg_plan *plan, const skg_picture *image) {
    skg_scatter_report report;
    if (!has_report(plan, &report)) return json_null();
    static const char *const parts[] = {"histories", "cells", "smoothing"};
    json_t *object = json_object(), *kinds = json_object(), *errors = json_object();
    for (int k = 0; k < 3; k++) json_object_set_new(errors, parts[k], cli_json_number(report.errors[k]));
    json_object_set_new(kinds, "rayleigh", cli_json_number(report.rayleigh));
    json_object_set_new(kinds, "compton", cli_json_number(report.mean > 0 ? 1 - report.rayleigh : 0));
    json_object_set_new(object, "mean", cli_json_number(report.mean));
    json_object_set_new(object, "ratio", cli_json_number(ratio_of(&report, image)));
    json_object_set_new(object, "sigma", cli_json_number(report.sigma));
    json_object_set_new(object, "errors", errors);
    json_object_set_new(object, "histories", json_integer(report.histories));
    json_object_set_new(object, "seconds", cli_json_number(report.seconds));
    json_object_set_new(object, "cosines", json_integer(report.cosines));
    json_object_set_new(object, "orders", cli_json_numbers(report.orders, 3));
    json_object_set_new(object, "kinds", kinds);
    return object;
}

/* A whole number with a comma at each thousand. */
static void print_grouped(int64_t number) {
    char digits[32];
    const int length = snprintf(digits, sizeof digits, "%" PRId64, number);
    for (int i = 0; i < length; i++) printf("%s%c", i > 0 && (length - i) % 3 == 0 ? "," : "", digits[i]);
}

void cli_scattering_print(const skg_plan *plan, const skg_picture *image) {
    skg_scatter_report report;
    if (!has_report(plan, &report)) return;
    const double ratio = ratio_of(&report, image);
    if (!(report.mean > 0))
        printf("scatter: none reaches the detector; ");
    else if (isfinite(ratio) && ratio > 0)
        printf("scatter: %.3g %% of the primary on average, +- %.2g %% of itself; ", 100 * ratio,
               100 * report.sigma / report.mean);
    else
        printf("scatter: %.3g %s on average, +- %.2g %% of itself, and no primary; ", report.mean,
               image->unit ? image->unit : "", 100 * report.sigma / report.mean);
    print_grouped(report.histories);
    printf(" histories in %.2g s\n", report.seconds);
}
