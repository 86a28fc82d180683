/* Reads MetaImages. */
#include "image/image.h"

#include "core/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 4096, LINES = 200 };

/* Fields of the header. */
typedef struct {
    double size[3], spacing[3], offset[3];
    double axes[9];                                             /* a row for each axis */
    double element[3];                                          /* ElementSize; [0] 0: not given */
    double slope, intercept;                                    /* ElementToIntensityFunction... */
    int dimensions, told, bytes, swapped, compressed, channels; /* told: NDims; 0: not given */
    int has_spacing, is_text;
    char kind;
    char data[LINE]; /* ElementDataFile */
    char unit[32];   /* DistanceUnits; "": not given */
    /* a key of the place that does not say as many finite numbers as a volume needs; "": none */
    char bad[32];
    long header; /* HeaderSize; 0: the data follow the header, or begin the file */
    int32_t quantity;
} metaimage;

static const struct {
    const char *name;
    int bytes;
    char kind;
} types[] = {{"MET_UCHAR", 1, 'u'}, {"MET_CHAR", 1, 'i'},      {"MET_USHORT", 2, 'u'},
             {"MET_SHORT", 2, 'i'}, {"MET_UINT", 4, 'u'},      {"MET_INT", 4, 'i'},
             {"MET_ULONG", 4, 'u'}, {"MET_LONG", 4, 'i'},      {"MET_ULONG_LONG", 8, 'u'},
             {"MET_FLOAT", 4, 'f'}, {"MET_LONG_LONG", 8, 'i'}, {"MET_DOUBLE", 8, 'f'}};

static int is_true(const char *value) {
    return skg_same_name(value, "True") || !strcmp(value, "1");
}

/* Keeps three, and counts all. */
static void read_sizes(const char *value, metaimage *image) {
    for (int k = 0;; k++) {
        const char *end = value;
        const double size = skg_read_number(value, &end);
        if (end == value) return;
        if (k < 3) image->size[k] = size;
        value = end;
        image->dimensions = k + 1;
    }
}

/* Up to `count` numbers, the others stay. Returns how many finite ones there were. */
static int read_numbers(const char *value, int count, double *numbers) {
    int finite = 0;
    for (int k = 0; k < count; k++) {
        const char *end = value;
        const double number = skg_read_number(value, &end);
        if (end == value) return finite;
        numbers[k] = number, value = end;
        finite += isfinite(number) != 0;
    }
    return finite;
}

/* Where the grid lies; MetaIO knows several names. */
static void read_place(const char *key, const char *value, metaimage *image) {
    const struct {
        const char *keys[3];
        int count;
        double *numbers;
    } places[] = {{{"ElementSpacing"}, 3, image->spacing},
                  {{"ElementSize"}, 3, image->element},
                  {{"Offset", "Position", "Origin"}, 3, image->offset},
                  {{"TransformMatrix", "Rotation", "Orientation"}, 9, image->axes}};
    for (size_t p = 0; p < sizeof places / sizeof *places; p++)
        for (int k = 0; k < 3 && places[p].keys[k]; k++)
            if (!strcmp(key, places[p].keys[k]) &&
                read_numbers(value, places[p].count, places[p].numbers) < places[p].count)
                snprintf(image->bad, sizeof image->bad, "%s", key);
    if (!strcmp(key, "ElementSpacing")) image->has_spacing = 1;
    if (!strcmp(key, "DistanceUnits")) snprintf(image->unit, sizeof image->unit, "%s", value);
}

/* One line "key = value" of the header. Keys that say nothing of the values are passed over. */
static void read_line(const char *key, const char *value, metaimage *image) {
    if (!strcmp(key, "DimSize")) read_sizes(value, image);
    read_place(key, value, image);
    if (!strcmp(key, "NDims")) image->told = atoi(value);
    if (!strcmp(key, "BinaryData")) image->is_text = !is_true(value);
    if (!strcmp(key, "ElementToIntensityFunctionSlope")) read_numbers(value, 1, &image->slope);
    if (!strcmp(key, "ElementToIntensityFunctionOffset")) read_numbers(value, 1, &image->intercept);
    if (!strcmp(key, "ElementNumberOfChannels")) image->channels = atoi(value);
    if (!strcmp(key, "CompressedData")) image->compressed = is_true(value);
    if (!strcmp(key, "BinaryDataByteOrderMSB") || !strcmp(key, "ElementByteOrderMSB"))
        image->swapped = is_true(value) != skg_host_is_big_endian();
    if (!strcmp(key, "HeaderSize")) image->header = atol(value);
    if (!strcmp(key, "Comment")) image->quantity = skg_quantity_of_title(value);
    for (size_t t = 0; t < sizeof types / sizeof *types && !strcmp(key, "ElementType"); t++)
        if (!strcmp(value, types[t].name)) image->bytes = types[t].bytes, image->kind = types[t].kind;
    if (!strcmp(key, "ElementDataFile")) snprintf(image->data, sizeof image->data, "%s", value);
}

static void trim(char *text) {
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\r\n", text[length - 1])) text[--length] = '\0';
}

static skg_status read_header(const char *path, FILE *stream, metaimage *image) {
    char line[LINE];
    for (int k = 0; k < LINES && !image->data[0] && fgets(line, sizeof line, stream); k++) {
        char *equals = strchr(line, '=');
        if (!equals) break;
        *equals++ = '\0';
        while (*equals == ' ' || *equals == '\t') equals++;
        trim(line);
        trim(equals);
        read_line(line, equals, image);
    }
    if (!image->data[0] || image->dimensions < 2)
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: is no MetaImage: its header has no DimSize or no ElementDataFile", path);
    if (!image->bytes) return skg_fail(SKG_ERR_UNSUPPORTED, "%s: its ElementType is none of a number", path);
    if (image->channels > 1)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: is of several channels; write it with one", path);
    if (image->told && image->told != image->dimensions)
        return skg_fail(SKG_ERR_FORMAT, "%s: its NDims is %d, but DimSize has %d sizes", path, image->told,
                        image->dimensions);
    if (image->dimensions > 3)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s: has %d dimensions (DimSize); write 2, or 3 for a volume or several pages", path,
                        image->dimensions);
    if (image->is_text)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s: its values are text (BinaryData = False); write them binary", path);
    if (image->slope != 1 || image->intercept != 0)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: its values mean others (ElementToIntensityFunctionSlope %g, Offset %g); write those", path,
            image->slope, image->intercept);
    /* As MetaIO does. */
    if (!image->has_spacing && image->element[0] > 0)
        memcpy(image->spacing, image->element, sizeof image->spacing);
    if (image->dimensions < 3) image->size[2] = 1;
    return skg_picture_size_check(path, image->size[0], image->size[1], image->size[2]);
}

/* The stream of the values, at the first one. */
static skg_status open_data(const char *path, const metaimage *image, FILE **stream) {
    char beside[2 * LINE];
    const char *slash = strrchr(path, '/');
    if (!strcmp(image->data, "LOCAL")) return SKG_OK;
    if (strchr(image->data, '%') || !strcmp(image->data, "LIST"))
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: its values are in several files; write one", path);
    snprintf(beside, sizeof beside, "%.*s%s", slash && image->data[0] != '/' ? (int)(slash - path) + 1 : 0,
             path, image->data);
    fclose(*stream);
    *stream = NULL;
    SKG_TRY(skg_input_open(beside, SKG_INPUT_LARGE, stream, NULL));
    /* -1: the values end the file */
    const double bytes = image->size[0] * image->size[1] * image->size[2] * image->bytes;
    if ((image->header > 0 && fseek(*stream, image->header, SEEK_SET) != 0) ||
        (image->header < 0 && fseek(*stream, -(long)bytes, SEEK_END) != 0))
        return skg_fail(SKG_ERR_FORMAT, "%s: ends within its header", beside);
    return SKG_OK;
}

static skg_status read_values(const char *path, FILE *stream, const metaimage *image, int64_t page,
                              double *values) {
    const int64_t count = (int64_t)image->size[0] * (int64_t)image->size[1];
    unsigned char *row = NULL;
    SKG_TRY(skg_alloc((int64_t)image->size[0], (size_t)image->bytes, "row of a MetaImage", &row));
    skg_status status = SKG_OK;
    if (fseek(stream, (long)(page * count * image->bytes), SEEK_CUR) != 0) status = SKG_ERR_FORMAT;
    for (int64_t at = 0; at < count && status == SKG_OK; at += (int64_t)image->size[0]) {
        if (fread(row, (size_t)image->bytes, (size_t)image->size[0], stream) != (size_t)image->size[0])
            status = SKG_ERR_FORMAT;
        for (int64_t c = 0; c < (int64_t)image->size[0] && status == SKG_OK; c++)
            values[at + c] =
                skg_number_of_bytes(row + c * image->bytes, image->bytes, image->kind, image->swapped);
    }
    skg_free(&row);
    if (status == SKG_OK) return SKG_OK;
    return skg_fail(SKG_ERR_FORMAT, "%s: ends before its last value", path);
}

/* mm: of its DistanceUnits; 0: not given, for which MetaIO writes "?". Returns 0 if they are no length. */
static int find_unit(const metaimage *image, double *mm) {
    *mm = 0;
    return !image->unit[0] || !strcmp(image->unit, "?") || skg_unit_of_length(image->unit, mm) == SKG_OK;
}

skg_status skg_metaimage_read(const skg_image_source *source, int64_t page, skg_picture_contents *contents,
                              double *values) {
    const char *path = source->name;
    metaimage image = {.quantity = -1, .channels = 1, .slope = 1};
    double mm = 0;
    FILE *stream = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_image_open(source, &stream));
    SKG_TRY_CLEANUP(read_header(path, stream, &image));
    if (image.compressed) {
        status = skg_fail(SKG_ERR_UNSUPPORTED, "%s: is compressed; write it without compression", path);
        goto cleanup;
    }
    contents->columns = (int64_t)image.size[0], contents->rows = (int64_t)image.size[1];
    contents->pages = (int64_t)image.size[2];
    contents->quantity = image.quantity;
    for (int k = 0; k < 2 && image.has_spacing && find_unit(&image, &mm); k++)
        contents->spacing_mm[k] = fabs(image.spacing[k]) * (mm > 0 ? mm : 1);
    SKG_TRY_CLEANUP(skg_picture_page_check(path, page, contents->pages));
    if (!values) goto cleanup;
    if (source->bytes && strcmp(image.data, "LOCAL") != 0) {
        status =
            skg_fail(SKG_ERR_UNSUPPORTED,
                     "%s: its values are in another file (ElementDataFile = %s), which memory does not have; "
                     "write LOCAL, with the values behind the header",
                     path, image.data);
        goto cleanup;
    }
    SKG_TRY_CLEANUP(open_data(path, &image, &stream));
    SKG_TRY_CLEANUP(read_values(path, stream, &image, page, values));
cleanup:
    if (stream) fclose(stream);
    return status;
}

skg_status skg_metaimage_read_grid(const char *path, skg_grid *grid) {
    metaimage image = {
        .quantity = -1, .channels = 1, .slope = 1, .spacing = {1, 1, 1}, .axes = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    double mm = 0;
    FILE *stream = NULL;
    skg_status status = SKG_OK;
    *grid = (skg_grid){0};
    SKG_TRY(skg_input_open(path, SKG_INPUT_LARGE, &stream, NULL));
    SKG_TRY_CLEANUP(read_header(path, stream, &image));
    if (image.dimensions != 3) {
        status = skg_fail(SKG_ERR_FORMAT, "%s: has %d dimensions; a volume has 3", path, image.dimensions);
        goto cleanup;
    }
    if (image.bad[0]) {
        status = skg_fail(
            SKG_ERR_FORMAT,
            "%s: its %s does not say as many finite numbers as a volume of 3 dimensions needs; write 3, or "
            "9 for a matrix",
            path, image.bad);
        goto cleanup;
    }
    if (!find_unit(&image, &mm)) {
        status = skg_fail(SKG_ERR_UNSUPPORTED,
                          "%s: its DistanceUnits are \"%s\", which is no length; write mm", path, image.unit);
        goto cleanup;
    }
    grid->no_spacing = !image.has_spacing && !(image.element[0] > 0);
    for (int k = 0; k < 3; k++) {
        grid->unit_mm[k] = mm;
        grid->size[k] = (int64_t)image.size[k];
        for (int r = 0; r < 3; r++) grid->affine[4 * r + k] = image.axes[3 * k + r] * image.spacing[k];
        grid->affine[4 * k + 3] = image.offset[k];
    }
    grid->affine[15] = 1;
    SKG_TRY_CLEANUP(open_data(path, &image, &stream));
    const skg_grid_file file = {
        .bytes = image.bytes, .swapped = image.swapped, .compressed = image.compressed, .kind = image.kind};
    status = skg_grid_read_cells(path, stream, &file, grid);
cleanup:
    if (stream) fclose(stream);
    return status;
}
