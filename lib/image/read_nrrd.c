/* Reads volumes from NRRD files (G. Kindlmann, Definition of the NRRD file format, teem.sourceforge.net/nrrd). */
#include "core/text.h"
#include "image/image.h"

#include <stdlib.h>
#include <string.h>

enum { LINE = 4096, LINES = 1000 };

/* What the header says. */
typedef struct {
    skg_grid_file file;
    int64_t sizes[3];
    double spacing[3], unit_mm[3]; /* unit_mm: of each axis; 0: of no unit that is known */
    double sign[3];                /* of x, y, z towards left, back and head */
    int dimensions, has_directions, has_origin, has_minima, is_big;
    long bytes_skipped, lines_skipped;
    char data[LINE]; /* of a header alone: the file of the values; "": they follow */
} nrrd;

static const struct {
    const char *names[6];
    int bytes;
    char kind;
} types[] = {{{"signed char", "int8", "int8_t"}, 1, 'i'},
             {{"uchar", "unsigned char", "uint8", "uint8_t"}, 1, 'u'},
             {{"short", "short int", "signed short", "signed short int", "int16", "int16_t"}, 2, 'i'},
             {{"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}, 2, 'u'},
             {{"int", "signed int", "int32", "int32_t"}, 4, 'i'},
             {{"uint", "unsigned int", "uint32", "uint32_t"}, 4, 'u'},
             {{"longlong", "long long", "int64", "int64_t"}, 8, 'i'},
             {{"ulonglong", "unsigned long long", "uint64", "uint64_t"}, 8, 'u'},
             {{"float"}, 4, 'f'},
             {{"double"}, 8, 'f'}};

static void read_type(const char *value, nrrd *n) {
    for (size_t t = 0; t < sizeof types / sizeof *types; t++)
        for (int k = 0; k < 6 && types[t].names[k]; k++)
            if (!strcmp(value, types[t].names[k]))
                n->file.bytes = types[t].bytes, n->file.kind = types[t].kind;
}

/* Numbers between spaces, commas and brackets. Returns how many there are. */
static int read_numbers(const char *value, int most, double *numbers) {
    int count = 0;
    while (*value && count < most) {
        const char *end = value;
        const double number = skg_read_number(value, &end);
        if (end == value) {
            if (!strchr(" ,()\t", *value)) break;
            value++;
            continue;
        }
        numbers[count++] = number, value = end;
    }
    return count;
}

static void read_directions(const char *value, nrrd *n, skg_grid *grid) {
    double d[9];
    if (read_numbers(value, 9, d) != 9) return;
    n->has_directions = 1;
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < 3; k++) grid->affine[4 * k + axis] = d[3 * axis + k];
}

/* "mm" "mm" "mm" */
static void read_units(const char *value, nrrd *n) {
    for (int k = 0; k < 3 && *value; k++) {
        char unit[32];
        value += strspn(value, " \"");
        const size_t length = strcspn(value, "\"");
        snprintf(unit, sizeof unit, "%.*s", (int)length, value);
        n->unit_mm[k] = 0;
        if (skg_unit_of_length(unit, &n->unit_mm[k]) != SKG_OK) n->unit_mm[k] = 0;
        value += length;
    }
}

/* "right-anterior-superior" or RAS: where x, y and z point to. Others have no anatomy. */
static void read_space(const char *value, nrrd *n) {
    const int is_short = strlen(value) == 3;
    if (strstr(value, "right-") == value || (is_short && value[0] == 'R')) n->sign[0] = -1;
    if (strstr(value, "-anterior") || (is_short && value[1] == 'A')) n->sign[1] = -1;
    if (strstr(value, "-inferior") || (is_short && value[2] == 'I')) n->sign[2] = -1;
}

/* One line "field: value"; fields that say nothing of cells and place are passed over. */
static void read_field(const char *field, const char *value, nrrd *n, skg_grid *grid) {
    double d[3];
    if (!strcmp(field, "type")) read_type(value, n);
    if (!strcmp(field, "dimension")) n->dimensions = atoi(value);
    if (!strcmp(field, "endian")) n->is_big = !strcmp(value, "big");
    if (!strcmp(field, "encoding"))
        n->file.compressed = !strcmp(value, "gzip") || !strcmp(value, "gz") ? 1
                             : !strcmp(value, "raw")                        ? 0
                                                                            : -1;
    if (!strcmp(field, "sizes") && read_numbers(value, 3, d) == 3)
        for (int k = 0; k < 3; k++) n->sizes[k] = (int64_t)d[k];
    if (!strcmp(field, "spacings") && read_numbers(value, 3, d) == 3) memcpy(n->spacing, d, sizeof d);
    if (!strcmp(field, "space directions")) read_directions(value, n, grid);
    if (!strcmp(field, "space origin") && read_numbers(value, 3, d) == 3) {
        n->has_origin = 1;
        for (int k = 0; k < 3; k++) grid->affine[4 * k + 3] = d[k];
    }
    if (!strcmp(field, "space units") || !strcmp(field, "units")) read_units(value, n);
    if (!strcmp(field, "space")) read_space(value, n);
    if (!strcmp(field, "axis mins") || !strcmp(field, "axismins")) n->has_minima = 1;
    if (!strcmp(field, "byte skip") || !strcmp(field, "byteskip")) n->bytes_skipped = atol(value);
    if (!strcmp(field, "line skip") || !strcmp(field, "lineskip")) n->lines_skipped = atol(value);
    if (!strcmp(field, "data file") || !strcmp(field, "datafile"))
        snprintf(n->data, sizeof n->data, "%s", value);
}

static skg_status check(const char *path, const nrrd *n) {
    if (n->dimensions != 3)
        return skg_fail(SKG_ERR_FORMAT, "%s: has %d dimensions; a volume has 3, of one number each", path,
                        n->dimensions);
    if (!n->file.bytes) return skg_fail(SKG_ERR_UNSUPPORTED, "%s: its type is none of a number", path);
    if (n->file.compressed < 0)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: its encoding is neither raw nor gzip; write it so", path);
    for (int k = 0; k < 3; k++)
        if (!(n->unit_mm[k] > 0))
            return skg_fail(SKG_ERR_UNSUPPORTED,
                            "%s: its axes have a unit that is no length; write them in mm", path);
    if (n->has_minima && !n->has_origin)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s: is placed by axis mins; write space directions and space origin", path);
    if (n->bytes_skipped < 0 || n->lines_skipped < 0)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: skips from the end; write it without", path);
    return skg_picture_size_check(path, (double)n->sizes[0], (double)n->sizes[1], (double)n->sizes[2]);
}

static skg_status read_header(const char *path, FILE *stream, nrrd *n, skg_grid *grid) {
    char line[LINE];
    if (!fgets(line, sizeof line, stream) || strncmp(line, "NRRD", 4) != 0)
        return skg_fail(SKG_ERR_FORMAT, "%s: is no NRRD file: it does not begin with NRRD", path);
    for (int k = 0; k < LINES && fgets(line, sizeof line, stream); k++) {
        size_t length = strlen(line);
        while (length > 0 && strchr(" \t\r\n", line[length - 1])) line[--length] = '\0';
        if (length == 0) break;
        char *colon = strstr(line, ": ");
        if (line[0] == '#' || !colon) continue;
        *colon = '\0';
        read_field(line, colon + 2, n, grid);
    }
    return check(path, n);
}

/* The stream of the values, at the first one. */
static skg_status open_data(const char *path, const nrrd *n, FILE **stream) {
    char beside[2 * LINE], line[LINE];
    const char *slash = strrchr(path, '/');
    if (n->data[0]) {
        if (strchr(n->data, '%') || !strncmp(n->data, "LIST", 4))
            return skg_fail(SKG_ERR_UNSUPPORTED, "%s: its values are in several files; write one", path);
        snprintf(beside, sizeof beside, "%.*s%s", slash && n->data[0] != '/' ? (int)(slash - path) + 1 : 0,
                 path, n->data);
        fclose(*stream);
        *stream = NULL;
        SKG_TRY(skg_input_open(beside, SKG_INPUT_LARGE, stream, NULL));
    }
    for (long k = 0; k < n->lines_skipped && fgets(line, sizeof line, *stream); k++) continue;
    if (n->bytes_skipped > 0 && fseek(*stream, n->bytes_skipped, SEEK_CUR) != 0)
        return skg_fail(SKG_ERR_FORMAT, "%s: ends before its values", path);
    return SKG_OK;
}

skg_status skg_nrrd_read_grid(const char *path, skg_grid *grid) {
    nrrd n = {.spacing = {1, 1, 1}, .unit_mm = {1, 1, 1}, .sign = {1, 1, 1}};
    FILE *stream = NULL;
    skg_status status = SKG_OK;
    *grid = (skg_grid){.affine = {[15] = 1}};
    SKG_TRY(skg_input_open(path, SKG_INPUT_LARGE, &stream, NULL));
    SKG_TRY_CLEANUP(read_header(path, stream, &n, grid));
    n.file.swapped = n.file.bytes > 1 && n.is_big != skg_host_is_big_endian();
    memcpy(grid->size, n.sizes, sizeof grid->size);
    for (int k = 0; k < 3 && !n.has_directions; k++) grid->affine[5 * k] = n.spacing[k];
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++)
            grid->affine[4 * row + column] *= n.sign[row] * n.unit_mm[row];
    SKG_TRY_CLEANUP(open_data(path, &n, &stream));
    status = skg_grid_read_cells(path, stream, &n.file, grid);
cleanup:
    if (stream) fclose(stream);
    return status;
}
