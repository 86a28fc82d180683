/* Reading a stack of projections (.mha) with the table of its poses, for reconstruct. */
#include "scan/stack.h"

#include "common/say.h"
#include "core/maths.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER_LONGEST = 4096, SIDE_MAX = 1 << 20 };

/* An open .mha: slices of a type. */
typedef struct {
    FILE *stream;
    int64_t size[3], data_at; /* columns, rows, slices */
    int bytes;                /* of an element: 2 whole number, 4 float, 8 double */
    double flat_field;        /* 0: the header has none */
    int is_attenuation;
} slices;

struct stack_reader {
    char path[4096];
    slices images;
    skg_scan *scan;
    double axis[3], centre[3];
    float *white, *dark; /* [rows][columns] means of the fields; white NULL: the header's flat field */
    unsigned char *raw;
};

/* The value of a line "KEY = ..." of the header; NULL: there is none. */
static const char *value_of(const char *header, const char *key) {
    const size_t length = strlen(key);
    for (const char *line = header; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (strncmp(line, key, length) == 0 && strncmp(line + length, " = ", 3) == 0)
            return line + length + 3;
    }
    return NULL;
}

static int starts(const char *value, const char *word) {
    return value && strncmp(value, word, strlen(word)) == 0;
}

static int read_header(const char *path, slices *s) {
    char header[HEADER_LONGEST + 1];
    const size_t count = fread(header, 1, HEADER_LONGEST, s->stream);
    header[count] = '\0';
    const char *end = strstr(header, "ElementDataFile = LOCAL\n"), *size = value_of(header, "DimSize");
    const char *type = value_of(header, "ElementType"), *flat = value_of(header, "FlatField");
    long long n[3] = {0};
    if (!end || !size || !type || sscanf(size, "%lld %lld %lld", &n[0], &n[1], &n[2]) != 3 || n[0] < 1 ||
        n[1] < 1 || n[2] < 1 || n[0] > SIDE_MAX || n[1] > SIDE_MAX ||
        !starts(value_of(header, "BinaryDataByteOrderMSB"), "False"))
        return cli_error(CLI_INPUT, "%s: is no MetaImage of projections as `skiagraph scan` writes it", path);
    for (int k = 0; k < 3; k++) s->size[k] = n[k];
    s->data_at = end - header + (int64_t)strlen("ElementDataFile = LOCAL\n");
    s->bytes = starts(type, "MET_FLOAT")    ? 4
               : starts(type, "MET_DOUBLE") ? 8
               : starts(type, "MET_USHORT") ? 2
                                            : 0;
    s->flat_field = flat ? strtod(flat, NULL) : 0;
    s->is_attenuation = starts(value_of(header, "Comment"), "attenuation");
    return s->bytes ? CLI_DONE
                    : cli_error(CLI_INPUT, "%s: its elements are neither floats nor whole numbers of 16 bits",
                                path);
}

static int open_slices(const char *path, slices *s) {
    s->stream = fopen(path, "rb");
    if (!s->stream) return cli_error(CLI_INPUT, "%s: cannot be read", path);
    return read_header(path, s);
}

static double element(const slices *s, const unsigned char *raw, int64_t i) {
    uint16_t whole;
    float single;
    double twice;
    memcpy(&whole, raw + i * s->bytes, sizeof whole);
    if (s->bytes == 2) return whole;
    memcpy(&single, raw + i * s->bytes, sizeof single);
    if (s->bytes == 4) return (double)single;
    memcpy(&twice, raw + i * s->bytes, sizeof twice);
    return twice;
}

/* Reads slice k into raw, which has room for it. */
static int read_slice(const slices *s, const char *path, int64_t k, unsigned char *raw) {
    const int64_t bytes = s->size[0] * s->size[1] * s->bytes;
    if (fseek(s->stream, (long)(s->data_at + k * bytes), SEEK_SET) == 0 &&
        fread(raw, 1, (size_t)bytes, s->stream) == (size_t)bytes)
        return CLI_DONE;
    return cli_error(CLI_INPUT, "%s: slice %" PRId64 " cannot be read: the file is truncated", path, k);
}

/* The mean of the fields in NAME-WORD.mha beside the stack; left NULL if that file is not there. */
static int read_fields(stack_reader *r, const char *word, float **mean) {
    char path[sizeof r->path + 16];
    slices fields = {0};
    const int64_t pixels = r->images.size[0] * r->images.size[1];
    snprintf(path, sizeof path, "%.*s-%s.mha", (int)strlen(r->path) - 4, r->path, word);
    FILE *stream = fopen(path, "rb");
    if (!stream) return CLI_DONE;
    fclose(stream);
    int exit_status = open_slices(path, &fields);
    if (exit_status == CLI_DONE &&
        (fields.size[0] != r->images.size[0] || fields.size[1] != r->images.size[1]))
        exit_status = cli_error(CLI_INPUT, "%s: has another size than the projections", path);
    unsigned char *raw = malloc((size_t)(8 * pixels));
    *mean = calloc((size_t)pixels, sizeof **mean);
    if (exit_status == CLI_DONE && (!raw || !*mean))
        exit_status = cli_error(CLI_DEVICE, "out of host memory for %s", path);
    for (int64_t k = 0; k < fields.size[2] && exit_status == CLI_DONE; k++) {
        exit_status = read_slice(&fields, path, k, raw);
        for (int64_t i = 0; i < pixels && exit_status == CLI_DONE; i++)
            (*mean)[i] += (float)(element(&fields, raw, i) / (double)fields.size[2]);
    }
    free(raw);
    if (fields.stream) fclose(fields.stream);
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
    for (int64_t k = 1; k < r->images.size[2] && status == SKG_OK; k++) {
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

static int read_poses(stack_reader *r, const char *geometry) {
    skg_view view;
    int64_t count = 0;
    skg_view_init(&view);
    view.columns = r->images.size[0], view.rows = r->images.size[1];
    skg_status status = skg_scan_load_table(&view, NULL, geometry, &r->scan);
    if (status == SKG_OK) status = skg_scan_projection_count(r->scan, &count);
    if (status != SKG_OK) return cli_fail(status);
    if (count != r->images.size[2])
        return cli_error(CLI_INPUT, "%s: has %" PRId64 " poses, but %s has %" PRId64 " projections", geometry,
                         count, r->path, r->images.size[2]);
    return find_axis(r);
}

int stack_open(const char *path, const char *geometry, stack_reader **reader) {
    stack_reader *r = *reader = calloc(1, sizeof *r);
    if (!r || snprintf(r->path, sizeof r->path, "%s", path) >= (int)sizeof r->path)
        return cli_error(CLI_DEVICE, "out of host memory for %s", path);
    int exit_status = open_slices(path, &r->images);
    if (exit_status == CLI_DONE) exit_status = read_poses(r, geometry);
    if (exit_status == CLI_DONE) exit_status = read_fields(r, "flats", &r->white);
    if (exit_status == CLI_DONE) exit_status = read_fields(r, "darks", &r->dark);
    if (exit_status == CLI_DONE && !r->images.is_attenuation && !r->white && !(r->images.flat_field > 0))
        exit_status = cli_error(
            CLI_INPUT, "%s: has no flat field, in its header or in a file -flats.mha beside it", path);
    r->raw = malloc((size_t)(8 * r->images.size[0] * r->images.size[1]) + 1);
    if (exit_status == CLI_DONE && !r->raw)
        exit_status = cli_error(CLI_DEVICE, "out of host memory for %s", path);
    return exit_status;
}

void stack_scan(stack_reader *r, skg_scan **scan, double axis[3], double centre[3]) {
    *scan = r->scan;
    memcpy(axis, r->axis, sizeof r->axis);
    memcpy(centre, r->centre, sizeof r->centre);
}

int stack_attenuation(stack_reader *r, int64_t index, float *image) {
    static const double LEAST = 1e-6; /* of the flat field, as of an .h5 */
    const int64_t pixels = r->images.size[0] * r->images.size[1];
    const int exit_status = read_slice(&r->images, r->path, index, r->raw);
    for (int64_t i = 0; i < pixels && exit_status == CLI_DONE; i++) {
        const double value = element(&r->images, r->raw, i), dark = r->dark ? (double)r->dark[i] : 0;
        const double white = (r->white ? (double)r->white[i] : r->images.flat_field) - dark;
        image[i] = (float)(r->images.is_attenuation ? value : -log(fmax((value - dark) / white, LEAST)));
    }
    return exit_status;
}

void stack_close(stack_reader **reader) {
    stack_reader *r = *reader;
    if (!r) return;
    if (r->images.stream) fclose(r->images.stream);
    skg_scan_release(&r->scan);
    free(r->white);
    free(r->dark);
    free(r->raw);
    free(r);
    *reader = NULL;
}
