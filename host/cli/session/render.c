/* Plan, frames, files and report of `image` and `lbuffer`. */
#include "session/render.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/say.h"
#include "dicom/dicom.h"
#include "manual/manual.h"
#include "session/explain.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REPEATS_MAX = 1000000 };

/* The share of an image's pixels that a .png shows black because they are below its window, and white because they are
 * above. */
static const double OUTSIDE = 0.005;

static int read_repeats(const cli_arguments *arguments, int64_t *repeats) {
    *repeats = 0;
    return cli_integer(arguments, "--repeat", 1, REPEATS_MAX, repeats);
}

/* Whether an output is a .png whose range --range leaves open. */
static int has_window(const cli_rendering *rendering) {
    const char *path;
    if (rendering->lengths || cli_given(rendering->arguments, "--range")) return 0;
    for (int i = 0; (path = cli_nth_value(rendering->arguments, "-o", i)); i++)
        if (cli_has_extension(path, ".png")) return 1;
    return 0;
}

/* The output `index`, of any flag; NULL: there are no more. */
static const char *nth_output(const cli_arguments *arguments, int index) {
    for (int i = 0; i < arguments->given_count; i++)
        if (cli_flag_is_output(arguments->given[i].flag) && index-- == 0) return arguments->given[i].value;
    return NULL;
}

/* How many outputs are standard output. */
static int count_streams(const cli_arguments *arguments) {
    const char *path;
    int count = 0;
    for (int i = 0; (path = nth_output(arguments, i)); i++) count += strcmp(path, "-") == 0;
    return count;
}

/* Pictures of different things need different files. */
static int check_twins(const cli_arguments *arguments) {
    for (int i = 0; i < arguments->given_count; i++) {
        const struct cli_given *one = &arguments->given[i];
        if (!cli_flag_is_output(one->flag) || strcmp(one->value, "-") == 0) continue;
        for (int j = 0; j < i; j++) {
            const struct cli_given *other = &arguments->given[j];
            if (one->flag != other->flag && cli_flag_is_output(other->flag) &&
                strcmp(one->value, other->value) == 0)
                return cli_error(CLI_USAGE, "%s %s: %s writes this file; name another one", one->flag->name,
                                 one->value, other->flag->name);
        }
    }
    return CLI_DONE;
}

/* Only the picture itself may be DICOM: its scatter and its variance are no radiographs. */
static int is_dicom(const cli_arguments *arguments, const char *path) {
    const char *own;
    for (int i = 0; (own = cli_nth_value(arguments, "-o", i)); i++)
        if (own == path) return cli_dicom_is(path);
    return 0;
}

int cli_check_outputs(const cli_arguments *arguments) {
    int64_t repeats;
    double low, high;
    int exit_status = read_repeats(arguments, &repeats);
    if (exit_status == CLI_DONE) exit_status = cli_range(arguments, "--range", &low, &high);
    if (exit_status != CLI_DONE) return exit_status;
    exit_status = check_twins(arguments);
    if (exit_status != CLI_DONE) return exit_status;
    if (!nth_output(arguments, 0) && !repeats)
        return cli_error(CLI_USAGE, "%s: no output is named; add -o FILE (.png, .tif, .mha or .dcm)",
                         arguments->manual->name);
    if (count_streams(arguments) + cli_given(arguments, "--json") > 1)
        return cli_error(CLI_USAGE, "standard output takes one thing: -o - once, or --json");
    const char *path;
    for (int i = 0; (path = cli_nth_value(arguments, "-o", i)); i++)
        if (cli_dicom_is(path) && (exit_status = cli_dicom_check(path)) != CLI_DONE) return exit_status;
    for (int i = 0; (path = nth_output(arguments, i)); i++) {
        skg_status status = is_dicom(arguments, path) ? SKG_OK : skg_picture_path_check(path);
        if (status != SKG_OK) return cli_fail(status);
    }
    return CLI_DONE;
}

static int write_dicom(const cli_rendering *rendering, const char *path) {
    const cli_session *session = &rendering->session;
    cli_dicom_facts facts = {.study = session->path, .number = 1};
    double step = 0;
    const skg_status status = cli_dicom_facts_of(session->scene, session->spectrum, &session->view, &facts);
    const int exit_status =
        status == SKG_OK ? cli_dicom_save(&rendering->picture, &facts, path, &step) : cli_fail(status);
    if (exit_status == CLI_DONE)
        cli_tell("%s: values in steps of %.3g %s", path, step, rendering->picture.unit);
    return exit_status;
}

/* Writes every file that can be written. Returns the exit status of the first that cannot. */
static int write_files(const cli_rendering *rendering) {
    int failure = CLI_DONE, written = 0;
    const char *path;
    for (int i = 0; (path = cli_nth_value(rendering->arguments, "-o", i)); i++) {
        int its = CLI_DONE;
        if (cli_dicom_is(path)) {
            its = write_dicom(rendering, path);
        } else {
            const skg_status status = skg_picture_save(&rendering->picture, path);
            if (status != SKG_OK)
                its = status == SKG_ERR_UNSUPPORTED ? cli_fail(status), CLI_OUTPUT : cli_fail(status);
        }
        if (its == CLI_DONE) cli_keep("outputs written: %d; the last one is %s", ++written, path);
        if (failure == CLI_DONE) failure = its;
    }
    return failure;
}

/* The least and the largest finite value of a channel; both are 0 if there is none. */
static void find_range(const skg_picture *picture, int64_t channel, double *low, double *high) {
    const int64_t pixels = picture->columns * picture->rows;
    int found = 0;
    *low = *high = 0;
    for (int64_t i = channel * pixels; i < (channel + 1) * pixels; i++) {
        double value = picture->type == SKG_TYPE_FLOAT64 ? ((const double *)picture->data)[i]
                                                         : (double)((const float *)picture->data)[i];
        if (!isfinite(value)) continue;
        if (!found || value < *low) *low = value;
        if (!found || value > *high) *high = value;
        found = 1;
    }
}

static void print_values(const skg_picture *picture) {
    printf("%" PRId64 " x %" PRId64 " pixels", picture->columns, picture->rows);
    for (int64_t c = 0; c < picture->channels; c++) {
        double low, high;
        find_range(picture, c, &low, &high);
        printf(", %s %.6g to %.6g %s", picture->channel_names ? picture->channel_names[c] : picture->name,
               low, high, picture->unit);
    }
    putchar('\n');
}

static void add_outputs(const cli_rendering *rendering, json_t *object) {
    json_t *ranges = json_array(), *files = json_array();
    const char *path;
    for (int64_t c = 0; c < rendering->picture.channels; c++) {
        double ends[2];
        find_range(&rendering->picture, c, &ends[0], &ends[1]);
        json_array_append_new(ranges, cli_json_numbers(ends, 2));
    }
    for (int i = 0; (path = nth_output(rendering->arguments, i)); i++)
        json_array_append_new(files, cli_json_text(path));
    json_object_set_new(object, "range", ranges);
    if (has_window(rendering)) {
        const double window[2] = {rendering->picture.low, rendering->picture.high};
        json_object_set_new(object, "window", cli_json_numbers(window, 2));
    }
    json_object_set_new(object, "files", files);
}

static int print_rendering(const cli_rendering *rendering, const skg_plan *plan, const cli_times *times) {
    const char *path;
    if (cli_given(rendering->arguments, "--json")) {
        json_t *object = json_object();
        cli_times_json(times, object);
        add_outputs(rendering, object);
        if (rendering->scattering)
            json_object_set_new(object, "scatter", cli_scattering_json(plan, &rendering->picture));
        json_object_set_new(object, "plan", cli_explain_json(plan, &rendering->session));
        return cli_json_print(object);
    }
    if (cli_is_quiet() || count_streams(rendering->arguments) > 0) return CLI_DONE;
    print_values(&rendering->picture);
    if (rendering->scattering) cli_scattering_print(plan, &rendering->picture);
    cli_times_print(times);
    for (int i = 0; (path = cli_nth_value(rendering->arguments, "-o", i)); i++) {
        cli_print("wrote %s", path);
        if (has_window(rendering) && cli_has_extension(path, ".png"))
            printf(
                ", %s from %.4g (black) to %.4g (white): percentiles %g and %g of the pixels, --range changes that",
                rendering->picture.display == SKG_DISPLAY_RADIOGRAPH ? "-ln(I/I0)" : "I/I0",
                rendering->picture.low, rendering->picture.high, 100 * OUTSIDE, 100 - 100 * OUTSIDE);
        putchar('\n');
    }
    for (int i = 0; rendering->beside && i < CLI_BESIDE_COUNT; i++)
        if (rendering->beside->paths[i]) cli_print("wrote %s\n", rendering->beside->paths[i]);
    return CLI_DONE;
}

/* Takes the channels' names from the plan, and the picture's name, unit and flat field from the first
 * channel. */
static int name_channels(cli_rendering *rendering, const skg_plan *plan) {
    skg_picture *picture = &rendering->picture;
    if (rendering->lengths) return CLI_DONE;
    skg_status status = skg_plan_channel_count(plan, &picture->channels);
    for (int64_t c = 0; status == SKG_OK && c < picture->channels; c++) {
        skg_channel channel;
        skg_channel_init(&channel);
        status = skg_plan_channel_get(plan, c, &channel);
        if (status != SKG_OK) break;
        rendering->channel_names[c] = channel.name;
        if (c > 0) continue;
        picture->name = channel.name;
        picture->unit = channel.unit;
        picture->flat_field = channel.flat_field;
    }
    picture->channel_names = rendering->channel_names;
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int find_window(skg_picture *picture) {
    skg_status status = skg_picture_window_get(picture, OUTSIDE, OUTSIDE, &picture->low, &picture->high);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* Memory for one frame in the plan's precision. */
static int allocate_frame(cli_rendering *rendering, skg_output *output) {
    const int64_t channels = rendering->picture.channels;
    const skg_view *view = &rendering->session.view;
    int twice = rendering->session.options.precision == SKG_PRECISION_DOUBLE;
    skg_output_init(output);
    output->type = twice ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
    output->data = calloc((size_t)(view->columns * view->rows * channels), twice ? 8 : 4);
    if (!output->data) return cli_error(CLI_DEVICE, "out of host memory for the image");
    rendering->picture.type = output->type;
    rendering->picture.columns = view->columns;
    rendering->picture.rows = view->rows;
    rendering->picture.data = output->data;
    rendering->picture.view = view;
    return CLI_DONE;
}

static int has_verb(const char *name) {
    for (int i = 0; cli_manuals[i]; i++)
        if (strcmp(cli_manuals[i]->name, name) == 0) return 1;
    return 0;
}

/* Says what a picture of a scan leaves out. */
static void note_scan(const cli_session *session) {
    int64_t projections = 1;
    char sentence[160];
    if (skg_setup_projection_count_get(session->setup, &projections) != SKG_OK || projections == 1) return;
    int length = snprintf(sentence, sizeof sentence, "the scene has a Scan; this is its first projection");
    if (projections > 1)
        length = snprintf(sentence, sizeof sentence,
                          "the scene has a Scan; this is one projection of %" PRId64, projections);
    if (has_verb("scan"))
        snprintf(sentence + length, sizeof sentence - (size_t)length, "; skiagraph scan makes all");
    cli_log(SKG_LOG_NOTE, sentence, NULL);
}

int cli_render(cli_rendering *rendering) {
    cli_session *session = &rendering->session;
    cli_times times = {0};
    skg_plan *plan = NULL;
    skg_output output = {0};
    int exit_status = read_repeats(rendering->arguments, &times.repeats);
    if (exit_status == CLI_DONE)
        exit_status =
            cli_range(rendering->arguments, "--range", &rendering->picture.low, &rendering->picture.high);
    session->options.profile = times.repeats > 0;
    if (exit_status == CLI_DONE) note_scan(session);
    if (exit_status == CLI_DONE) exit_status = cli_make_plan(session, &plan, &times.plan_ms);
    if (exit_status == CLI_DONE) exit_status = name_channels(rendering, plan);
    if (exit_status == CLI_DONE) exit_status = allocate_frame(rendering, &output);
    if (exit_status == CLI_DONE && rendering->beside)
        exit_status = cli_beside_allocate(session, output.type, rendering->beside);
    if (exit_status == CLI_DONE)
        exit_status = cli_run_frames(plan, rendering->frame, &output, rendering->frame_user, &times);
    if (exit_status == CLI_DONE && has_window(rendering)) exit_status = find_window(&rendering->picture);
    if (exit_status == CLI_DONE) exit_status = write_files(rendering);
    if (exit_status == CLI_DONE && rendering->beside)
        exit_status = cli_beside_write(rendering->beside, &rendering->picture);
    if (exit_status == CLI_DONE) exit_status = print_rendering(rendering, plan, &times);
    free(output.data);
    skg_plan_release(&plan);
    cli_times_free(&times);
    return exit_status;
}
