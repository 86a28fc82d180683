/* Reads projections in a stack or a folder of TIFFs, with the places of source and detector in a file of their own, for reconstruct. */
#include "scan/stack.h"

#include "common/file.h"
#include "common/say.h"
#include "common/values.h"
#include "core/maths.h"
#include "scan/pages.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER_LONGEST = 8192, PATH_LONGEST = 4096, FOLDER_LONGEST = 512 };

/* Levels of a header as `scan` writes it: values of a pixel without parts, and without radiation. */
typedef struct {
    double flat, dark; /* NaN: it does not say */
    int flat_varies;   /* 1: they are not those of all pixels */
    int dark_varies;
} levels;

struct stack_reader {
    char path[PATH_LONGEST];
    int is_folder;
    pages images;
    levels header;
    double flat_field; /* of the header, or of a .xtekct; 0: not known */
    skg_scan *scan;
    double axis[3], centre[3];
    double *white, *dark; /* [rows][columns] means of the fields; white NULL: flat_field */
    double *values;       /* [rows][columns] */
};

/* The text behind a key such as "\nFlatField = " in `count` bytes, which a 0 follows; NULL: the key is not there. */
static const char *value_of(const char *head, size_t count, const char *key) {
    const size_t length = strlen(key);
    for (size_t i = 0; i + length < count; i++)
        if (memcmp(head + i, key, length) == 0) return head + i + length;
    return NULL;
}

/* The lines of a header among the first bytes of a file. */
static void read_levels(const char *path, levels *header) {
    char head[HEADER_LONGEST + 1] = "";
    FILE *stream = fopen(path, "rb");
    const size_t count = stream ? fread(head, 1, HEADER_LONGEST, stream) : 0;
    const char *flat = value_of(head, count, "\nFlatField = "), *dark = value_of(head, count, "\nDark = ");
    if (stream) fclose(stream);
    *header = (levels){.flat = flat ? strtod(flat, NULL) : (double)NAN,
                       .dark = dark ? strtod(dark, NULL) : (double)NAN,
                       .flat_varies = value_of(head, count, "\nFlatFieldVaries = True") != NULL,
                       .dark_varies = value_of(head, count, "\nDarkVaries = True") != NULL};
}

static int is_attenuation(const stack_reader *r) {
    return r->images.quantity == SKG_QUANTITY_ATTENUATION;
}

/* Opens the fields of a kind: in the folder, or in NAME-flats.mha beside NAME.mha. Leaves count 0 if there are none. */
static int open_fields(const stack_reader *r, enum pages_kind kind, pages *fields) {
    char path[PATH_LONGEST + 16];
    if (r->is_folder) return pages_open_folder(r->path, kind, fields);
    const char *ending = strrchr(r->path, '.');
    snprintf(path, sizeof path, "%.*s-%s%s", (int)(ending - r->path), r->path,
             kind == PAGES_FLATS ? "flats" : "darks", ending);
    FILE *stream = fopen(path, "rb");
    if (!stream) return CLI_DONE;
    fclose(stream);
    return pages_open_stack(path, fields);
}

/* The mean of the fields of a kind; left NULL if there are none. */
static int read_fields(stack_reader *r, enum pages_kind kind, double **mean) {
    pages fields = {0};
    const int64_t pixels = r->images.columns * r->images.rows;
    int exit_status = open_fields(r, kind, &fields);
    if (exit_status == CLI_DONE && fields.count > 0 &&
        (fields.columns != r->images.columns || fields.rows != r->images.rows))
        exit_status = cli_error(CLI_INPUT, "%s: has another size than the projections", fields.paths[0]);
    if (exit_status == CLI_DONE && fields.count > 0 && !(*mean = calloc((size_t)pixels, sizeof **mean)))
        exit_status = cli_error(CLI_DEVICE, "out of host memory for %s", fields.paths[0]);
    for (int64_t k = 0; k < fields.count && exit_status == CLI_DONE; k++) {
        exit_status = pages_read(&fields, k, r->values);
        for (int64_t i = 0; i < pixels && exit_status == CLI_DONE; i++)
            (*mean)[i] += r->values[i] / (double)fields.count;
    }
    pages_close(&fields);
    return exit_status;
}

/* Right, up and normal of a detector, of length 1, as the columns of a matrix. */
static void frame_of(const skg_view *view, double frame[3][3]) {
    double columns[3], normal[3], rows[3];
    skg_scale_vector(1 / skg_length(view->column_step), view->column_step, columns);
    skg_cross(view->column_step, view->row_step, normal);
    skg_scale_vector(1 / skg_length(normal), normal, normal);
    skg_cross(normal, columns, rows);
    for (int i = 0; i < 3; i++) frame[i][0] = columns[i], frame[i][1] = rows[i], frame[i][2] = normal[i];
}

/* How one view is turned into another: axis times the sine of the angle; and its cosine. */
static void find_turn(const skg_view *from, const skg_view *to, double axis_sine[3], double *cosine) {
    double a[3][3], b[3][3], turn[3][3] = {{0}};
    frame_of(from, a);
    frame_of(to, b);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) turn[i][j] += b[i][k] * a[j][k];
    for (int i = 0; i < 3; i++)
        axis_sine[i] = 0.5 * (turn[(i + 2) % 3][(i + 1) % 3] - turn[(i + 1) % 3][(i + 2) % 3]);
    *cosine = 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1);
}

/* The axis by the projection that is turned most nearly by a right angle: the source moves on a circle about it. */
static int find_axis(stack_reader *r) {
    skg_view first, view, best;
    double most = 0, cosine = 0, angle = 0;
    skg_view_init(&first), skg_view_init(&view), skg_view_init(&best);
    skg_status status = skg_scan_view_get(r->scan, 0, &first);
    for (int64_t k = 1; k < r->images.count && status == SKG_OK; k++) {
        double sine[3], its;
        status = skg_scan_view_get(r->scan, k, &view);
        if (status != SKG_OK) break;
        find_turn(&first, &view, sine, &its);
        if (skg_length(sine) <= most) continue;
        most = skg_length(sine), cosine = its, best = view;
        memcpy(r->axis, sine, sizeof sine);
    }
    if (status != SKG_OK) return cli_fail(status);
    if (most < 1e-3) return cli_error(CLI_INPUT, "%s: its projections do not turn about an axis", r->path);
    skg_scale_vector(1 / most, r->axis, r->axis);
    angle = atan2(most, cosine);
    double chord[3], across[3];
    skg_add_scaled(best.source, -1, first.source, chord);
    skg_add_scaled(chord, -skg_dot(chord, r->axis), r->axis, chord);
    skg_cross(r->axis, chord, across);
    for (int k = 0; k < 3; k++)
        r->centre[k] = 0.5 * (first.source[k] + best.source[k]) + across[k] / (2 * tan(angle / 2));
    return CLI_DONE;
}

/* The scan of a .xtekct, of which the white level counts where there are no flat fields. */
static int read_nikon(stack_reader *r, const char *geometry) {
    skg_view view;
    double white = 0;
    skg_view_init(&view);
    skg_status status = skg_scan_load_xtekct(geometry, &white, NULL, 0, &r->scan);
    if (status == SKG_OK) status = skg_scan_axis_get(r->scan, r->axis, r->centre);
    if (status == SKG_OK) status = skg_scan_view_get(r->scan, 0, &view);
    if (status != SKG_OK) return cli_fail(status);
    if (!(r->flat_field > 0)) r->flat_field = white;
    if (view.columns == r->images.columns && view.rows == r->images.rows) return CLI_DONE;
    return cli_error(CLI_INPUT,
                     "%s: the detector has %" PRId64 " x %" PRId64
                     " pixels, but the projections of %s have %" PRId64 " x %" PRId64,
                     geometry, view.columns, view.rows, r->path, r->images.columns, r->images.rows);
}

static int read_table(stack_reader *r, const char *geometry) {
    skg_view view;
    skg_view_init(&view);
    view.columns = r->images.columns, view.rows = r->images.rows;
    const skg_status status = skg_scan_load_table(&view, NULL, geometry, &r->scan);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int read_poses(stack_reader *r, const char *geometry) {
    const int is_nikon = cli_has_extension(geometry, ".xtekct");
    int64_t count = 0;
    int exit_status = is_nikon ? read_nikon(r, geometry) : read_table(r, geometry);
    if (exit_status != CLI_DONE) return exit_status;
    const skg_status status = skg_scan_projection_count(r->scan, &count);
    if (status != SKG_OK) return cli_fail(status);
    if (count != r->images.count)
        return cli_error(CLI_INPUT, "%s: has %" PRId64 " poses, but %s has %" PRId64 " projections", geometry,
                         count, r->path, r->images.count);
    return is_nikon ? CLI_DONE : find_axis(r);
}

static int open_images(stack_reader *r) {
    char text[PATH_LONGEST + 16];
    int exit_status;
    snprintf(text, sizeof text, "%s%s", r->path, r->is_folder ? "/scan.txt" : "");
    exit_status = r->is_folder ? pages_open_folder(r->path, PAGES_PROJECTIONS, &r->images)
                               : pages_open_stack(r->path, &r->images);
    if (exit_status == CLI_DONE && r->images.count == 0)
        return cli_error(CLI_INPUT, "%s: has no projections; they are NAME_0000.tif and so on", r->path);
    if (exit_status != CLI_DONE) return exit_status;
    if (r->images.quantity == SKG_QUANTITY_TRANSMISSION)
        r->header = (levels){.flat = 1};
    else
        read_levels(text, &r->header);
    r->flat_field = r->header.flat > 0 ? r->header.flat : 0;
    r->values = calloc((size_t)(r->images.columns * r->images.rows), sizeof *r->values);
    return r->values ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory for %s", r->path);
}

/* The path of the projections: that of the operand, or, of a .xtekct, the folder that it names. */
static int find_path(stack_reader *r, const char *path) {
    char folder[FOLDER_LONGEST];
    skg_scan *scan = NULL;
    const int is_nikon = cli_has_extension(path, ".xtekct");
    const char *slash = strrchr(path, '/');
    const skg_status status =
        is_nikon ? skg_scan_load_xtekct(path, NULL, folder, sizeof folder, &scan) : SKG_OK;
    skg_scan_release(&scan);
    if (status != SKG_OK) return cli_fail(status);
    const int length = is_nikon ? snprintf(r->path, sizeof r->path, "%.*s/%s",
                                           slash ? (int)(slash - path) : 1, slash ? path : ".", folder)
                                : snprintf(r->path, sizeof r->path, "%s", path);
    if (length >= (int)sizeof r->path) return cli_error(CLI_INPUT, "%s: its path is too long", path);
    for (char *end = r->path + length - 1; end > r->path && *end == '/'; end--) *end = '\0';
    r->is_folder = pages_is_folder(r->path);
    return !is_nikon || r->is_folder
               ? CLI_DONE
               : cli_error(CLI_INPUT, "%s: its InputFolderName, %s, is no folder of projections", path,
                           folder);
}

/* A header without the level of darkness, which older versions wrote, does not say whether FlatField holds for all pixels either. */
static int warn_of_old_header(stack_reader *r) {
    double most = 0;
    const int exit_status = pages_read(&r->images, 0, r->values);
    for (int64_t i = 0; i < r->images.columns * r->images.rows && exit_status == CLI_DONE; i++)
        most = fmax(most, r->values[i]);
    if (exit_status == CLI_DONE)
        cli_warn(
            "%s: its header has FlatField but not Dark, as older versions wrote it, and the brightest pixel of the first "
            "projection has %.4g of FlatField: coefficients are wrong unless that is 1 where the free beam is seen, darkness "
            "is 0 and all pixels are alike (no falloff, gain or heel effect); scan again, or put flat and dark fields beside it",
            r->path, most / r->flat_field);
    return exit_status;
}

/* Refuses projections whose -ln(I/I0) is not known. */
static int check_levels(stack_reader *r, const char *path) {
    if (is_attenuation(r)) return CLI_DONE;
    if (!r->white && !(r->flat_field > 0))
        return cli_error(
            CLI_INPUT,
            r->is_folder
                ? "%s: has no flat field: neither NAME_flat_0000.tif nor a scan.txt or .xtekct that gives it"
                : "%s: has no flat field, in its header or in a file -flats beside it",
            path);
    const int needs_flat = !r->white && r->header.flat_varies, needs_dark = !r->dark && r->header.dark_varies;
    if (needs_flat || needs_dark)
        return cli_error(
            CLI_INPUT,
            "%s: its %s fields are missing, which differ from pixel to pixel by falloff, a map of the detector or the heel "
            "effect, so that the one number of the header is not enough; run the same `scan` again with --flats 1 --darks 1, "
            "which computes no projection again, or write it as .h5",
            path,
            needs_flat && needs_dark ? "flat and dark"
            : needs_flat             ? "flat"
                                     : "dark");
    const int is_old = !r->white && !r->dark && r->header.flat > 0 && isnan(r->header.dark);
    return is_old ? warn_of_old_header(r) : CLI_DONE;
}

int stack_open(const char *path, const char *geometry, stack_reader **reader) {
    stack_reader *r = *reader = calloc(1, sizeof *r);
    if (!r) return cli_error(CLI_DEVICE, "out of host memory for %s", path);
    int exit_status = find_path(r, path);
    if (exit_status == CLI_DONE) exit_status = open_images(r);
    if (exit_status == CLI_DONE) exit_status = read_poses(r, geometry);
    if (exit_status == CLI_DONE) exit_status = read_fields(r, PAGES_FLATS, &r->white);
    if (exit_status == CLI_DONE) exit_status = read_fields(r, PAGES_DARKS, &r->dark);
    return exit_status == CLI_DONE ? check_levels(r, path) : exit_status;
}

void stack_scan(stack_reader *r, skg_scan **scan, double axis[3], double centre[3]) {
    *scan = r->scan;
    memcpy(axis, r->axis, sizeof r->axis);
    memcpy(centre, r->centre, sizeof r->centre);
}

int stack_attenuation(stack_reader *r, int64_t index, float *image) {
    const int64_t pixels = r->images.columns * r->images.rows;
    const double darkness = isnan(r->header.dark) ? 0 : r->header.dark;
    const int exit_status = pages_read(&r->images, index, r->values);
    for (int64_t i = 0; i < pixels && exit_status == CLI_DONE; i++) {
        const double value = r->values[i], dark = r->dark ? r->dark[i] : darkness;
        const double white = (r->white ? r->white[i] : r->flat_field) - dark;
        const double share = white > 0 ? (value - dark) / white : 0; /* a pixel that does not see the beam */
        /* what is no number stays so, and is refused where it stands */
        image[i] = (float)(is_attenuation(r)
                               ? value
                               : -log(share < CLI_LEAST_TRANSMISSION ? CLI_LEAST_TRANSMISSION : share));
    }
    return exit_status;
}

void stack_close(stack_reader **reader) {
    stack_reader *r = *reader;
    if (!r) return;
    pages_close(&r->images);
    skg_scan_release(&r->scan);
    free(r->white);
    free(r->dark);
    free(r->values);
    free(r);
    *reader = NULL;
}
