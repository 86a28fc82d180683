/* The verb reconstruct. */
#include "common/encode.h"
#include "common/file.h"
#include "common/progress.h"
#include "common/say.h"
#include "common/values.h"
#include "scan/pages.h"
#include "scan/stack.h"
#include "verbs/verbs.h"

#include <skiagraph/scanning.h>

#include "core/maths.h"
#include <inttypes.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { VOXELS_MAX = 4096 };

typedef struct {
    skg_scan_reader *reader;
    stack_reader *stack; /* instead of the reader, of projections without their geometry */
    skg_scan *scan;      /* of one of them */
    skg_fdk *fdk;
    skg_fdk_options options;
    const char *place;
    float *image;
    int64_t pixels; /* of it */
    int64_t dark;   /* pixels of all projections that nothing reached */
    int64_t projections;
    double seconds;
    skg_fdk_report report;
} reconstruction;

/* Projections alone, which do not say where source and detector were. */
static int is_bare(const char *path) {
    static const char *const bare[] = {".mha", ".mhd", ".raw", ".tif", ".tiff"};
    for (size_t i = 0; i < sizeof bare / sizeof *bare; i++)
        if (cli_has_extension(path, bare[i])) return 1;
    return pages_is_folder(path);
}

/* The file that has the places of source and detector; NULL: the scan itself has them. */
static const char *geometry_of(const cli_arguments *arguments) {
    const char *path = arguments->operands[0];
    return cli_has_extension(path, ".xtekct") ? path : cli_value(arguments, "--geometry");
}

static int check_geometry(const cli_arguments *arguments) {
    const char *path = arguments->operands[0], *geometry = cli_value(arguments, "--geometry");
    if (cli_has_extension(path, ".raw"))
        return cli_error(CLI_INPUT, "%s: does not say what its bytes mean; name the .mhd beside it", path);
    if (is_bare(path) && !geometry)
        return cli_error(
            CLI_INPUT,
            "%s: holds projections without the places of source and detector; give them by --geometry FILE.csv, "
            "which scan --geometry writes, or FILE.xtekct, or write the scan as .h5 (scan SCENE -o scan.h5)",
            path);
    if (geometry && !is_bare(path))
        return cli_error(CLI_USAGE, "--geometry %s: %s has its geometry inside", geometry, path);
    return CLI_DONE;
}

static int read_flags(const cli_arguments *arguments, reconstruction *r, int64_t *size) {
    r->place = cli_value(arguments, "-o");
    if (!r->place) return cli_error(CLI_USAGE, "reconstruct: no volume is named; add -o FILE.mha");
    if (!cli_has_extension(r->place, ".mha"))
        return cli_error(CLI_USAGE, "reconstruct: %s is no .mha; give -o FILE.mha", r->place);
    int exit_status = cli_integer(arguments, "--size", 1, VOXELS_MAX, size);
    if (exit_status == CLI_DONE) exit_status = check_geometry(arguments);
    if (exit_status == CLI_DONE)
        exit_status = cli_number(arguments, "--voxel", 1e-6, 1e6, &r->options.voxel_mm);
    if (exit_status == CLI_DONE) exit_status = cli_choice(arguments, "--filter", &r->options.filter);
    if (exit_status == CLI_DONE) exit_status = cli_choice(arguments, "--truncation", &r->options.truncation);
    return exit_status;
}

static double length(const double *v) {
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* The step of the columns at the distance of the centre of rotation. */
static double step_at_axis(const skg_view *view, const double *centre) {
    double to_axis[3], to_detector[3];
    for (int k = 0; k < 3; k++) {
        to_axis[k] = centre[k] - view->source[k];
        to_detector[k] = view->centre[k] - view->source[k];
    }
    const double share = view->projection == SKG_PROJECTION_POINT ? length(to_axis) / length(to_detector) : 1;
    return share * length(view->column_step);
}

static skg_status prepare(const cli_arguments *arguments, reconstruction *r, int64_t size) {
    skg_view view;
    skg_status status = SKG_OK;
    skg_view_init(&view);
    if (r->stack) {
        stack_scan(r->stack, &r->scan, r->options.axis, r->options.centre);
    } else {
        status = skg_scan_reader_open(arguments->operands[0], &r->reader);
        if (status == SKG_OK) status = skg_scan_reader_scan_get(r->reader, &r->scan);
        if (status == SKG_OK)
            status = skg_scan_reader_axis_get(r->reader, r->options.axis, r->options.centre);
    }
    if (status == SKG_OK) status = skg_scan_projection_count(r->scan, &r->projections);
    if (status == SKG_OK) status = skg_scan_view_get(r->scan, 0, &view);
    if (status != SKG_OK) return status;
    if (!cli_given(arguments, "--voxel")) r->options.voxel_mm = step_at_axis(&view, r->options.centre);
    for (int k = 0; k < 3; k++) {
        r->options.voxels[k] = size > 0 ? size : view.columns < VOXELS_MAX ? view.columns : VOXELS_MAX;
        r->options.middle[k] = r->options.centre[k];
    }
    r->pixels = view.columns * view.rows;
    r->image = calloc((size_t)r->pixels, sizeof *r->image);
    return r->image ? skg_fdk_create(r->scan, &r->options, &r->fdk) : SKG_ERR_MEMORY;
}

/* SKG_ERR_FILE: a stack, which has said what is wrong. */
static skg_status read_projection(reconstruction *r, int64_t k) {
    if (!r->stack) return skg_scan_reader_attenuation_get(r->reader, k, r->image);
    return stack_attenuation(r->stack, k, r->image) == CLI_DONE ? SKG_OK : SKG_ERR_FILE;
}

static void count_dark(reconstruction *r) {
    const float most = (float)-log(CLI_LEAST_TRANSMISSION);
    for (int64_t i = 0; i < r->pixels; i++) r->dark += r->image[i] == most;
}

static skg_status add_projections(reconstruction *r) {
    const double start = cli_now_ms();
    skg_status status = SKG_OK;
    cli_progress_follow("projections");
    for (int64_t k = 0; k < r->projections && status == SKG_OK; k++) {
        status = read_projection(r, k);
        if (status == SKG_OK) count_dark(r);
        if (status == SKG_OK) status = skg_fdk_add(r->fdk, k, r->image);
    }
    cli_progress_end();
    r->seconds = 1e-3 * (cli_now_ms() - start);
    return status;
}

/* --size alone keeps the voxels' size and takes the middle. */
static void note_crop(const cli_arguments *arguments, const reconstruction *r) {
    const double width = (double)r->options.voxels[0] * r->options.voxel_mm, seen = 2 * r->report.covered_mm;
    if (!cli_given(arguments, "--size") || cli_given(arguments, "--voxel") || width > seen * (1 - 1e-6))
        return;
    cli_note(
        "--size %s crops: the volume is %.4g mm wide, of %.4g mm that the detector covers about the axis; --voxel %.4g shows "
        "all of it",
        cli_value(arguments, "--size"), width, seen, seen / (double)r->options.voxels[0]);
}

/* Slices of the volume across the axis of rotation that lie beyond the rows of the detector where they meet the axis. */
static int64_t slices_beyond(const reconstruction *r, int64_t *all) {
    const skg_fdk_options *o = &r->options;
    const double *axis = o->axis, *seen = r->report.along_mm;
    int64_t beyond = 0;
    int k = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(axis[i]) > fabs(axis[k])) k = i;
    const double along = axis[k] / skg_length(axis), tiny = 1e-6 * o->voxel_mm;
    *all = o->voxels[k];
    for (int64_t i = 0; i < *all; i++) {
        const double place = o->middle[k] + ((double)i - 0.5 * (double)(*all - 1)) * o->voxel_mm;
        const double at = (place - o->centre[k]) / along;
        beyond += at < seen[0] - tiny || at > seen[1] + tiny;
    }
    return beyond;
}

/* Says what the detector did not see. */
static void warn(const reconstruction *r) {
    const skg_fdk_report *seen = &r->report;
    int64_t slices = 0;
    const int64_t beyond = slices_beyond(r, &slices);
    if (beyond > 0)
        cli_warn(
            "%" PRId64 " of %" PRId64
            " slices lie beyond the rows of the detector, which sees the axis from %.4g to %.4g mm of the "
            "centre of rotation; voxels there hold 0 or too little",
            beyond, slices, seen->along_mm[0], seen->along_mm[1]);
    if (seen->displaced)
        cli_note(
            "the detector is displaced: rays are weighted for it, and %.4g mm about the axis are covered",
            seen->covered_mm);
    if (r->dark > 0)
        cli_warn(
            "%" PRId64
            " pixels of the projections have a millionth of the flat field or less, as dead pixels and those behind "
            "much metal have, and count as an attenuation of 13.8: streaks and rings follow from them",
            r->dark);
    if (seen->truncated > 0)
        cli_warn(
            "projections are truncated: in %.3g %% of the rows the shadow goes beyond the detector, and values are %s, "
            "above all near %.4g mm from the axis, where it ends%s",
            100 * seen->truncated,
            r->options.truncation == SKG_FDK_TRUNCATION_NONE ? "wrong everywhere" : "estimates",
            seen->covered_mm,
            r->options.truncation == SKG_FDK_TRUNCATION_NONE ? "; --truncation extrapolate continues the rows"
                                                             : "; the rows were continued");
}

static int print(const cli_arguments *arguments, const reconstruction *r) {
    const int64_t *n = r->options.voxels, count = n[0] * n[1] * n[2];
    const float *volume = NULL;
    const skg_status status = skg_fdk_volume_get(r->fdk, &volume);
    if (status != SKG_OK) return cli_fail(status);
    double range[2] = {(double)volume[0], (double)volume[0]};
    for (int64_t i = 1; i < count; i++) {
        range[0] = fmin(range[0], (double)volume[i]);
        range[1] = fmax(range[1], (double)volume[i]);
    }
    if (cli_given(arguments, "--json")) {
        json_t *object = json_object();
        json_object_set_new(object, "projections", json_integer(r->projections));
        json_object_set_new(object, "size", json_integer(n[0]));
        json_object_set_new(object, "voxel_mm", cli_json_number(r->options.voxel_mm));
        json_object_set_new(object, "range", cli_json_numbers(range, 2));
        json_object_set_new(object, "displaced", json_boolean(r->report.displaced));
        json_object_set_new(object, "covered_mm", cli_json_number(r->report.covered_mm));
        json_object_set_new(object, "truncated", cli_json_number(r->report.truncated));
        json_object_set_new(object, "along_mm", cli_json_numbers(r->report.along_mm, 2));
        json_object_set_new(object, "seconds", cli_json_number(r->seconds));
        json_object_set_new(object, "file", cli_json_text(r->place));
        return cli_json_print(object);
    }
    if (!cli_is_quiet())
        printf("%" PRId64 " x %" PRId64 " x %" PRId64
               " voxels of %.4g mm, %.4g to %.4g per cm, in %.1f s; wrote %s\n",
               n[0], n[1], n[2], r->options.voxel_mm, range[0], range[1], r->seconds, r->place);
    return CLI_DONE;
}

int cli_reconstruct(const cli_arguments *arguments) {
    reconstruction r = {0};
    int64_t size = 0;
    skg_fdk_options_init(&r.options);
    r.options.progress = cli_progress();
    int exit_status = read_flags(arguments, &r, &size);
    const char *geometry = geometry_of(arguments);
    if (exit_status == CLI_DONE && geometry)
        exit_status = stack_open(arguments->operands[0], geometry, &r.stack);
    if (exit_status == CLI_DONE) {
        skg_status status = prepare(arguments, &r, size);
        if (status == SKG_OK) status = add_projections(&r);
        skg_fdk_report_init(&r.report);
        if (status == SKG_OK) status = skg_fdk_report_get(r.fdk, &r.report);
        if (status == SKG_OK) warn(&r);
        if (status == SKG_OK) note_crop(arguments, &r);
        if (status == SKG_OK) status = skg_fdk_save(r.fdk, r.place);
        exit_status = status == SKG_OK                           ? print(arguments, &r)
                      : r.stack && *cli_first_failure()->message ? CLI_INPUT
                      : status == SKG_ERR_UNSUPPORTED            ? (cli_fail(status), CLI_INPUT)
                                                                 : cli_fail(status);
    }
    skg_fdk_release(&r.fdk);
    skg_scan_reader_release(&r.reader);
    stack_close(&r.stack);
    free(r.image);
    return exit_status;
}
