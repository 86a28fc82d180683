/* Reads volumes from NRRD files (G. Kindlmann, Definition of the NRRD file format, teem.sourceforge.net/nrrd). */
#include "core/text.h"
#include "image/image.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 4096, LINES = 1000, MOST_NAMES = 7 };

/* Fields of the header. */
typedef struct {
    skg_grid_file file;
    double sizes[3], unit_mm[3]; /* unit_mm: of each axis; 0: not given; below 0: of none that is known */
    double sign[3];              /* of x, y, z towards left, back and head */
    int dimensions, has_minima, is_quantized;
    char endian[8]; /* "": not given */
    long bytes_skipped, lines_skipped;
    char directions[LINE], origin[LINE], spacings[LINE]; /* what these fields say; "": they are not given */
    char data[LINE]; /* of a header alone: the file of the values; "": they follow */
} nrrd;

static const struct {
    const char *names[MOST_NAMES];
    int bytes;
    char kind;
} types[] = {{{"signed char", "int8", "int8_t"}, 1, 'i'},
             {{"uchar", "unsigned char", "uint8", "uint8_t"}, 1, 'u'},
             {{"short", "short int", "signed short", "signed short int", "int16", "int16_t"}, 2, 'i'},
             {{"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}, 2, 'u'},
             {{"int", "signed int", "int32", "int32_t"}, 4, 'i'},
             {{"uint", "unsigned int", "uint32", "uint32_t"}, 4, 'u'},
             {{"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64",
               "int64_t"},
              8,
              'i'},
             {{"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}, 8, 'u'},
             {{"float"}, 4, 'f'},
             {{"double"}, 8, 'f'}};

static void read_type(const char *value, nrrd *n) {
    for (size_t t = 0; t < sizeof types / sizeof *types; t++)
        for (int k = 0; k < MOST_NAMES && types[t].names[k]; k++)
            if (!strcmp(value, types[t].names[k]))
                n->file.bytes = types[t].bytes, n->file.kind = types[t].kind;
}

/* Behind blanks and one mark; NULL if another thing stands there. mark: 0: none is wanted */
static const char *behind(const char *at, char mark) {
    at += strspn(at, " \t");
    if (!mark) return at;
    return *at == mark ? at + 1 : NULL;
}

/* Three finite numbers with nothing between them but blanks and, where it is not 0, the mark. Returns what follows; NULL: they are none. */
static const char *read_three(const char *at, char mark, double *numbers) {
    for (int k = 0; k < 3; k++) {
        const char *end = at;
        if (k > 0 && !(at = behind(at, mark))) return NULL;
        numbers[k] = skg_read_number(at, &end);
        if (end == at || !isfinite(numbers[k])) return NULL;
        at = end;
    }
    return at;
}

/* (1,2,3): a vector */
static const char *read_vector(const char *at, double *numbers) {
    if (!(at = behind(at, '(')) || !(at = read_three(at, ',', numbers))) return NULL;
    return behind(at, ')');
}

static skg_status fail_field(const char *path, const char *field, const char *says, const char *mend) {
    return skg_fail(SKG_ERR_FORMAT, "%s: its field \"%s\" says \"%.200s\"; write %s", path, field, says,
                    mend);
}

/* Three vectors are the columns of the matrix, and spacings its diagonal. */
static skg_status read_place(const char *path, const nrrd *n, skg_grid *grid) {
    const char *at = n->directions;
    double d[3] = {1, 1, 1};
    for (int axis = 0; axis < 3 && n->directions[0]; axis++) {
        if (!(at = read_vector(at, d)) || (axis == 2 && *behind(at, 0)))
            return fail_field(path, "space directions", n->directions,
                              "three vectors of three finite numbers each, as (0.7,0,0) (0,0.7,0) (0,0,1.2)");
        for (int k = 0; k < 3; k++) grid->affine[4 * k + axis] = d[k];
    }
    if (n->spacings[0] && !n->directions[0] && (!(at = read_three(n->spacings, 0, d)) || *behind(at, 0)))
        return fail_field(path, "spacings", n->spacings, "three finite numbers, as 0.7 0.7 1.2");
    for (int k = 0; k < 3 && !n->directions[0]; k++) grid->affine[5 * k] = d[k];
    if (!n->origin[0]) return SKG_OK;
    if (!(at = read_vector(n->origin, d)) || *behind(at, 0))
        return fail_field(path, "space origin", n->origin,
                          "a vector of three finite numbers, as (-120,-120,30)");
    for (int k = 0; k < 3; k++) grid->affine[4 * k + 3] = d[k];
    return SKG_OK;
}

/* "mm" "mm" "mm" */
static void read_units(const char *value, nrrd *n) {
    for (int k = 0; k < 3 && *value; k++) {
        char unit[32];
        value += strspn(value, " \"");
        const size_t length = strcspn(value, "\"");
        snprintf(unit, sizeof unit, "%.*s", (int)length, value);
        if (skg_unit_of_length(unit, &n->unit_mm[k]) != SKG_OK) n->unit_mm[k] = -1;
        value += length;
    }
}

/* "right-anterior-superior" or RAS: where x, y and z point to. Others have no anatomy. */
static void read_space(const char *value, nrrd *n) {
    const int is_short = strlen(value) == 3;
    if (strstr(value, "right-") == value || (is_short && value[0] == 'r')) n->sign[0] = -1;
    if (strstr(value, "-anterior") || (is_short && value[1] == 'a')) n->sign[1] = -1;
    if (strstr(value, "-inferior") || (is_short && value[2] == 'i')) n->sign[2] = -1;
}

static void keep(const char *value, char kept[LINE]) {
    snprintf(kept, LINE, "%s", value);
}

/* Case does not matter in NRRD, nor do the blanks in the name of a field. */
static void simplify(char *field, char *value) {
    char *to = field;
    for (const char *at = field; *at; at++)
        if (*at != ' ') *to++ = (char)tolower((unsigned char)*at);
    *to = '\0';
    if (strcmp(field, "datafile") == 0) return;
    for (char *at = value; *at; at++) *at = (char)tolower((unsigned char)*at);
}

/* One line "field: value", both simplified; fields that say nothing of cells and place are passed over. */
static void read_field(const char *field, const char *value, nrrd *n) {
    const char *end;
    if (!strcmp(field, "type")) read_type(value, n);
    if (!strcmp(field, "dimension")) n->dimensions = atoi(value);
    if (!strcmp(field, "endian")) snprintf(n->endian, sizeof n->endian, "%s", value);
    if (!strcmp(field, "encoding"))
        n->file.compressed = !strcmp(value, "gzip") || !strcmp(value, "gz") ? 1
                             : !strcmp(value, "raw")                        ? 0
                                                                            : -1;
    for (int k = 0; k < 3 && !strcmp(field, "sizes"); k++, value = end)
        n->sizes[k] = skg_read_number(value, &end);
    if (!strcmp(field, "spacings")) keep(value, n->spacings);
    if (!strcmp(field, "spacedirections")) keep(value, n->directions);
    if (!strcmp(field, "spaceorigin")) keep(value, n->origin);
    if (!strcmp(field, "spaceunits") || !strcmp(field, "units")) read_units(value, n);
    if (!strcmp(field, "space")) read_space(value, n);
    if (!strcmp(field, "axismins")) n->has_minima = 1;
    if (!strcmp(field, "oldmin") || !strcmp(field, "oldmax")) n->is_quantized = 1;
    if (!strcmp(field, "byteskip")) n->bytes_skipped = atol(value);
    if (!strcmp(field, "lineskip")) n->lines_skipped = atol(value);
    if (!strcmp(field, "datafile")) keep(value, n->data);
}

static skg_status check(const char *path, const nrrd *n) {
    if (n->dimensions != 3)
        return skg_fail(SKG_ERR_FORMAT, "%s: has %d dimensions; a volume has 3, of one number each", path,
                        n->dimensions);
    if (!n->file.bytes) return skg_fail(SKG_ERR_UNSUPPORTED, "%s: its type is none of a number", path);
    if (n->endian[0] && strcmp(n->endian, "little") && strcmp(n->endian, "big"))
        return skg_fail(SKG_ERR_FORMAT, "%s: its endian is \"%s\"; write little or big", path, n->endian);
    if (n->file.compressed < 0)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: its encoding is neither raw nor gzip; write it so", path);
    for (int k = 0; k < 3; k++)
        if (n->unit_mm[k] < 0 || (n->unit_mm[k] > 0) != (n->unit_mm[0] > 0))
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "%s: one of its axes has no unit, or one that is no length; write all of them in mm", path);
    if (n->has_minima && !n->origin[0])
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s: is placed by axis mins; write space directions and space origin", path);
    if (n->is_quantized)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s: its values stand for others (old min, old max); write those themselves", path);
    if (n->bytes_skipped < 0 || n->lines_skipped < 0)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: skips from the end; write it without", path);
    return skg_picture_size_check(path, n->sizes[0], n->sizes[1], n->sizes[2]);
}

static skg_status read_header(const char *path, FILE *stream, nrrd *n) {
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
        simplify(line, colon + 2);
        read_field(line, colon + 2, n);
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
    nrrd n = {.sign = {1, 1, 1}};
    FILE *stream = NULL;
    skg_status status = SKG_OK;
    *grid = (skg_grid){.affine = {[15] = 1}};
    SKG_TRY(skg_input_open(path, SKG_INPUT_LARGE, &stream, NULL));
    SKG_TRY_CLEANUP(read_header(path, stream, &n));
    SKG_TRY_CLEANUP(read_place(path, &n, grid));
    n.file.swapped = n.file.bytes > 1 && (strcmp(n.endian, "big") == 0) != skg_host_is_big_endian();
    for (int k = 0; k < 3; k++) grid->size[k] = (int64_t)n.sizes[k];
    memcpy(grid->unit_mm, n.unit_mm, sizeof grid->unit_mm);
    grid->no_spacing = !n.directions[0] && !n.spacings[0];
    grid->no_order = n.file.bytes > 1 && !n.endian[0];
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) grid->affine[4 * row + column] *= n.sign[row];
    SKG_TRY_CLEANUP(open_data(path, &n, &stream));
    status = skg_grid_read_cells(path, stream, &n.file, grid);
cleanup:
    if (stream) fclose(stream);
    return status;
}
