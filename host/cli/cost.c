/* skiagraph cost */
#include "cost.h"

#include "plot.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

const char *const cost_dial_names[COST_DIALS] = {"scene", "precision",      "tolerance",
                                                 "bins",  "source samples", "supersampling"};
const double cost_tolerances[COST_TOLERANCES] = {1e-2, 1e-3, 1e-4, 1e-6};

static int is_same(const cost_setting *a, const cost_setting *b) {
    return a->precision == b->precision && a->supersampling == b->supersampling &&
           a->tolerance == b->tolerance && a->bins == b->bins && a->samples == b->samples;
}

/* A point to be measured; one that is there already, or would take too long, is not added. */
static void add(cost_study *study, int dial, int reference, cost_setting setting) {
    for (int i = 0; i < study->count; i++)
        if (study->points[i].reference == reference && is_same(&study->points[i].setting, &setting)) return;
    if (study->count == COST_MOST_POINTS) return;
    if (study->pass_ms * cost_passes(&setting) > cost_patience_ms(study)) {
        char text[160];
        cost_describe(&setting, text, sizeof text);
        cost_note(study, "%s left out: about %.3g s an image", text,
                  1e-3 * study->pass_ms * cost_passes(&setting));
        return;
    }
    study->points[study->count++] = (cost_point){.dial = dial, .reference = reference, .setting = setting};
}

/* Precision, tolerance and bins: what happens along a ray. */
static void add_rays(cost_study *study) {
    static const double tolerances[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
    static const int64_t bins[] = {64, 32, 16, 8, 4};
    const int step = study->quick ? 2 : 1;
    const int32_t twice = study->session.device.has_double;
    cost_setting exact = study->own;
    exact.tolerance = 0;
    exact.bins = study->finest;
    add(study, COST_SCENE, 0, study->own);
    static const int32_t precisions[] = {SKG_HALF, SKG_SINGLE, SKG_DOUBLE};
    for (int i = 0; i < 2 + twice; i++) {
        exact.precision = precisions[i];
        add(study, COST_PRECISION, 0, exact);
    }
    if (!study->has_energies) return;
    cost_setting its = exact;
    for (int32_t precision = SKG_SINGLE; precision <= (twice ? SKG_DOUBLE : SKG_SINGLE); precision++)
        for (int i = step - 1; i < 6; i += step) {
            its.precision = precision;
            its.tolerance = tolerances[i];
            add(study, COST_TOLERANCE, 0, its);
        }
    its.precision = SKG_SINGLE;
    for (int i = 0; study->has_tube && i < 5; i += step) {
        if (!cost_has_bins(study, bins[i])) break; /* wider than the tube's model allows */
        its.bins = bins[i];
        its.tolerance = 0;
        add(study, COST_BINS, 0, its);
        its.tolerance = 1e-4;
        add(study, COST_BINS, 0, its);
    }
}

/* Powers of two of source samples, against four times the most of them that patience allows. */
static void add_samples(cost_study *study) {
    cost_setting its = study->own;
    if (!study->has_spot) return;
    const int64_t most = study->quick ? 64 : 1024;
    its.samples = 4 * most;
    while (its.samples > 16 && study->pass_ms * cost_passes(&its) > 3 * cost_patience_ms(study))
        its.samples /= 4;
    study->references[1].setting = its;
    for (int64_t n = 1; 4 * n <= study->references[1].setting.samples; n *= study->quick ? 4 : 2) {
        its.samples = n;
        add(study, COST_SAMPLES, 1, its);
    }
}

/* Rays a side of a pixel, against twice the most of them. At most 16 samples of the source, for the time. */
static void add_supersampling(cost_study *study) {
    static const int32_t sides[] = {1, 2, 3, 4, 6, 8};
    cost_setting its = study->own;
    if (its.samples > 16) its.samples = 16;
    its.supersampling = study->quick ? 8 : 16;
    while (its.supersampling > 2 && study->pass_ms * cost_passes(&its) > 3 * cost_patience_ms(study))
        its.supersampling /= 2;
    const int32_t most = its.supersampling;
    study->references[2].setting = its;
    for (int i = 0; i < 6 && 2 * sides[i] <= most; i++) {
        its.supersampling = sides[i];
        add(study, COST_SUPERSAMPLING, 2, its);
    }
}

static int make_reference(cost_study *study, cost_reference *reference) {
    reference->image = calloc((size_t)study->pixels, sizeof *reference->image);
    if (!reference->image) return cli_error(CLI_DEVICE, "out of host memory for the image");
    skg_status status = cost_image(study, &reference->setting, reference->image, NULL);
    return status < SKG_OK ? cli_fail(status) : CLI_DONE;
}

/* One image of the scene as it stands, to know what the others will take. */
static int find_pass_time(cost_study *study, double *image) {
    cost_point point = {0};
    skg_status status = cost_image(study, &study->own, image, &point);
    study->pass_ms = point.median_ms / cost_passes(&study->own);
    return status < SKG_OK ? cli_fail(status) : CLI_DONE;
}

/* Root mean square of what the scene's noise adds to `image`, which is without. */
static int find_noise(cost_study *study, const double *image) {
    const skg_plan_options *options = &study->session.options;
    if (!options->noise && !(options->electronic_kev > 0)) return CLI_DONE;
    double *noisy = calloc((size_t)study->pixels, sizeof *noisy), squares = 0;
    if (!noisy) return cli_error(CLI_DEVICE, "out of host memory for the image");
    study->noisy = 1;
    skg_status status = cost_image(study, &study->own, noisy, NULL);
    study->noisy = 0;
    for (int64_t i = 0; i < study->pixels; i++) squares += (noisy[i] - image[i]) * (noisy[i] - image[i]);
    study->noise = sqrt(squares / (double)study->pixels) / study->open;
    free(noisy);
    return status < SKG_OK ? cli_fail(status) : CLI_DONE;
}

/* A setting that the scene does not allow (half of an open mesh), or has no memory, is noted, not fatal. */
static int measure(cost_study *study, cost_point *point, double *image, int *keep) {
    skg_status status = cost_image(study, &point->setting, image, point);
    *keep = status >= SKG_OK;
    if (status == SKG_ERR_DEVICE || status == SKG_ERR_INTERNAL || status == SKG_ERR_NO_DEVICE)
        return cli_fail(status);
    if (!*keep) {
        char text[160];
        cost_describe(&point->setting, text, sizeof text);
        cost_note(study, "%s left out: %s", text, skg_last_error());
        return CLI_DONE;
    }
    int exit_status = cost_compare(study, image, study->references[point->reference].image, point);
    if (exit_status == CLI_DONE && (point->dial == COST_PRECISION || point->dial == COST_SCENE))
        point->max_mm = cost_length_error(study, point->setting.precision);
    return exit_status;
}

static int measure_all(cost_study *study, double *image) {
    const double begun = cli_now_ms();
    const int count = study->count;
    int exit_status = CLI_DONE;
    study->count = 0;
    for (int i = 0; exit_status == CLI_DONE && i < count; i++) {
        int keep = 0;
        cost_point point = study->points[i];
        exit_status = measure(study, &point, image, &keep);
        if (keep) study->points[study->count++] = point;
        cli_progress("settings", i + 1, count, begun);
    }
    return exit_status;
}

static int sweep(cost_study *study) {
    double *image = calloc((size_t)study->pixels, sizeof *image);
    if (!image) return cli_error(CLI_DEVICE, "out of host memory for the image");
    cost_setting best = study->own;
    best.tolerance = 0;
    best.bins = study->finest;
    best.precision = study->session.device.has_double ? SKG_DOUBLE : SKG_SINGLE;
    study->references[0].setting = best;
    if (best.precision == SKG_SINGLE)
        cost_note(study, "the device has no fp64: single precision is compared with itself");
    if (study->session.options.spot && study->session.options.spot->grid > 0)
        cost_note(study, "source samples are not swept: the scene fixes them by a grid");
    int exit_status = find_pass_time(study, image);
    if (exit_status == CLI_DONE) exit_status = find_noise(study, image);
    if (exit_status == CLI_DONE) {
        add_rays(study);
        add_samples(study);
        add_supersampling(study);
        exit_status = make_reference(study, &study->references[0]);
    }
    if (exit_status == CLI_DONE && study->has_spot)
        exit_status = make_reference(study, &study->references[1]);
    if (exit_status == CLI_DONE) exit_status = make_reference(study, &study->references[2]);
    if (exit_status == CLI_DONE) exit_status = measure_all(study, image);
    free(image);
    return exit_status;
}

static const cli_flag flag_output = {"-o", "FILE",
                                     "where to write: .html (plots, pictures, advice in one page) or .csv\n"
                                     "(the table); may be repeated"};
static const cli_flag flag_quick = {"--quick", NULL, "fewer settings and runs"};

static int has_extension(const char *path, const char *extension) {
    size_t length = strlen(path), its = strlen(extension);
    return length > its && strcasecmp(path + length - its, extension) == 0;
}

/* Before the long computation: whether what -o names could be written. */
static int check_outputs(const cli_arguments *arguments) {
    const char *path;
    for (int i = 0; (path = cli_nth_value(arguments, &flag_output, i)); i++) {
        if (!has_extension(path, ".html") && !has_extension(path, ".csv"))
            return cli_error(CLI_USAGE, "-o %s: its extension is neither .html nor .csv", path);
        const char *slash = strrchr(path, '/');
        char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
        if (!folder) return cli_error(CLI_DEVICE, "out of host memory");
        int can = access(folder, W_OK | X_OK) == 0;
        free(folder);
        if (!can) return cli_error(CLI_OUTPUT, "%s: cannot be written: %s", path, strerror(errno));
    }
    return CLI_DONE;
}

static int write_csv(const cost_study *study, const char *path) {
    char *text = cost_csv(study);
    if (!text) return cli_error(CLI_DEVICE, "out of host memory");
    int exit_status = cli_write_file(path, text, strlen(text));
    free(text);
    return exit_status;
}

static int write_outputs(const cost_study *study) {
    const char *path;
    int failure = CLI_DONE;
    for (int i = 0; (path = cli_nth_value(study->arguments, &flag_output, i)); i++) {
        int its = has_extension(path, ".csv") ? write_csv(study, path) : cost_write_page(study, path);
        if (failure == CLI_DONE) failure = its;
    }
    return failure;
}

static int report(const cost_study *study) {
    const char *path;
    if (cli_given(study->arguments, &cli_flag_json)) return cli_json_print(cost_json(study));
    if (cli_is_quiet()) return CLI_DONE;
    cost_print(study);
    for (int i = 0; (path = cli_nth_value(study->arguments, &flag_output, i)); i++)
        printf("wrote %s\n", path);
    return CLI_DONE;
}

static int run(const cli_arguments *arguments) {
    cost_study *study = calloc(1, sizeof *study);
    if (!study) return cli_error(CLI_DEVICE, "out of host memory");
    study->arguments = arguments;
    study->quick = cli_given(arguments, &flag_quick);
    int exit_status = check_outputs(arguments);
    if (exit_status == CLI_DONE) {
        exit_status = cost_open(study);
        if (exit_status == CLI_DONE) exit_status = sweep(study);
        if (exit_status == CLI_DONE) exit_status = cost_advise(study);
        if (exit_status == CLI_DONE) exit_status = write_outputs(study);
        if (exit_status == CLI_DONE) exit_status = report(study);
        cost_close(study);
    }
    free(study);
    return exit_status;
}

static const cli_flag *const flags[] = {&flag_output,  &flag_quick,    &cli_flag_device, &cli_flag_strategy,
                                        &cli_flag_set, &cli_flag_json, &cli_flag_quiet,  NULL};

const cli_verb cli_cost = {
    "cost",
    "SCENE",
    "error against time for every dial, and the setting to use",
    "Makes the scene's image at many settings, and compares each with the best that the device can give:\n"
    "precision, tolerance and the tube's bins with double precision, every energy, at the scene's own rays;\n"
    "source samples and supersampling with the most of them. Prints time (minimum and median), largest and\n"
    "root mean square error of the open beam and of the pixel, path lengths also in mm; and for errors of 1e-2,\n"
    "1e-3, 1e-4 and 1e-6 the command that gives it soonest. Times mean something on an idle machine only.\n"
    "--json prints {references, points, advice, notes, ...}; advice names points by their number.",
    1,
    1,
    flags,
    run};
