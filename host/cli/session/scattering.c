#include "session/scattering.h"

#include "common/encode.h"
#include "common/interrupt.h"
#include "common/say.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HISTORIES_MAX = 1 << 30 };

static const cli_flag *const flags[CLI_SCATTERED_COUNT] = {
    [CLI_SCATTERED] = &cli_flag_image_scatter_image, [CLI_SCATTERED_SIGMA] = &cli_flag_image_scatter_sigma};

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
    const char *accuracy = cli_value(arguments, &cli_flag_image_scatter);
    skg_scatter_init(&scattering->asked);
    scattering->is_asked = scattering->has_accuracy = accuracy != NULL;
    for (int i = 0; i < CLI_SCATTERED_COUNT; i++) {
        scattering->paths[i] = cli_value(arguments, flags[i]);
        if (scattering->paths[i]) scattering->is_asked = 1;
    }
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

int cli_scattering_allocate(const cli_session *session, int32_t type, cli_scattering *scattering) {
    const int64_t channels = session->options.bands > 0 ? session->options.bands : 1;
    const size_t pixels = (size_t)(session->view.columns * session->view.rows * channels);
    for (int i = 0; i < CLI_SCATTERED_COUNT; i++) {
        if (!scattering->paths[i]) continue;
        scattering->planes[i] = calloc(pixels, type == SKG_TYPE_FLOAT64 ? 8 : 4);
        if (!scattering->planes[i]) return cli_error(CLI_DEVICE, "out of host memory for the scatter");
    }
    return CLI_DONE;
}

void cli_scattering_free(cli_scattering *scattering) {
    for (int i = 0; i < CLI_SCATTERED_COUNT; i++) free(scattering->planes[i]);
    *scattering = (cli_scattering){0};
}

skg_status cli_scattering_frame(skg_plan *plan, const skg_output *output, const void *user) {
    static const int32_t kinds[CLI_SCATTERED_COUNT] = {
        [CLI_SCATTERED] = SKG_OUTPUT_SCATTER, [CLI_SCATTERED_SIGMA] = SKG_OUTPUT_SCATTER_SIGMA};
    const cli_scattering *scattering = user;
    skg_output outputs[1 + CLI_SCATTERED_COUNT] = {*output};
    skg_job *job = NULL;
    int count = 1;
    for (int i = 0; i < CLI_SCATTERED_COUNT; i++) {
        if (!scattering->planes[i]) continue;
        outputs[count] = *output;
        outputs[count].kind = kinds[i];
        outputs[count++].data = scattering->planes[i];
    }
    const skg_status status = skg_plan_outputs_submit(plan, 1, NULL, count, outputs, &job);
    return status == SKG_OK ? skg_job_wait(&job) : status;
}

int cli_scattering_write(const cli_scattering *scattering, const skg_picture *image) {
    static const char *const names[CLI_SCATTERED_COUNT] = {
        [CLI_SCATTERED] = "scatter", [CLI_SCATTERED_SIGMA] = "standard error of the scatter"};
    int failure = CLI_DONE;
    for (int i = 0; i < CLI_SCATTERED_COUNT; i++) {
        if (!scattering->planes[i]) continue;
        skg_picture picture = *image;
        const int is_share =
            image->quantity == SKG_QUANTITY_ATTENUATION || image->quantity == SKG_QUANTITY_TRANSMISSION;
        picture.data = scattering->planes[i];
        picture.name = names[i];
        if (picture.channels == 1) picture.channel_names = NULL; /* they would name the picture */
        if (is_share) picture.quantity = SKG_QUANTITY_TRANSMISSION;
        if (is_share) picture.unit = "I/I0";
        picture.display = SKG_DISPLAY_TRANSMISSION; /* with no flat field: grey levels follow the values */
        picture.flat_field = picture.low = picture.high = 0;
        const skg_status status = skg_picture_save(&picture, scattering->paths[i]);
        if (status == SKG_OK)
            cli_keep("the last output written is %s", scattering->paths[i]);
        else if (failure == CLI_DONE)
            failure = status == SKG_ERR_UNSUPPORTED ? cli_fail(status), CLI_OUTPUT : cli_fail(status);
    }
    return failure;
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
    json_t *object = json_object(), *kinds = json_object();
    json_object_set_new(kinds, "rayleigh", cli_json_number(report.rayleigh));
    json_object_set_new(kinds, "compton", cli_json_number(report.mean > 0 ? 1 - report.rayleigh : 0));
    json_object_set_new(object, "mean", cli_json_number(report.mean));
    json_object_set_new(object, "ratio", cli_json_number(ratio_of(&report, image)));
    json_object_set_new(object, "sigma", cli_json_number(report.sigma));
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
