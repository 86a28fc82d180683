/* Stacks of projections without a library of their own: MetaImage with its header inside (.mha) or beside (.raw with
 * .mhd), and BigTIFF. */
#include "core/files.h"
#include "core/maths.h"
#include "core/text.h"
#include "image/image.h"
#include "scan/format.h"

#include <skiagraph/version.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { HEADER_LENGTH = 2048 };

static const char *metaimage_type(const skg_scan_file *file) {
    return file->options.type == SKG_TYPE_FLOAT64  ? "MET_DOUBLE"
           : file->options.type == SKG_TYPE_UINT16 ? "MET_USHORT"
                                                   : "MET_FLOAT";
}

static void title(const skg_scan_file *file, char *text, size_t size) {
    skg_picture picture;
    skg_picture_init(&picture);
    picture.name = file->options.name;
    picture.unit = file->options.unit;
    skg_picture_title(&picture, text, size);
}

/* The length of a header is a multiple of this, so that memory can be aligned like the projections (slot.c). */
enum { HEADER_UNIT = 64 };

/* The header of MetaImage. Slices are the projections; the origin is the middle of the detector, as RTK expects it. */
static int metaimage_header(const skg_scan_file *file, const char *data, int blanks, char *text) {
    char heading[200], identity[160], levels[SKG_SCAN_LEVELS_LENGTH], spacing[80], offset[80];
    const skg_view *view = &file->view;
    const double steps[3] = {skg_length(view->column_step), skg_length(view->row_step), 1};
    const double first[3] = {-0.5 * (double)(view->columns - 1) * steps[0],
                             -0.5 * (double)(view->rows - 1) * steps[1], 0};
    title(file, heading, sizeof heading);
    skg_scan_write_identity(file, identity, sizeof identity);
    skg_scan_write_levels(file, levels);
    skg_picture_numbers(steps, 3, spacing, sizeof spacing);
    skg_picture_numbers(first, 3, offset, sizeof offset);
    return snprintf(
        text, HEADER_LENGTH,
        "ObjectType = Image\nNDims = 3\nComment = %s%*s\n%s%sBinaryData = True\n"
        "BinaryDataByteOrderMSB = %s\nCompressedData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n"
        "Offset = %s\nCenterOfRotation = 0 0 0\nElementSpacing = %s\nDimSize = %" PRId64 " %" PRId64
        " %" PRId64 "\nElementType = %s\nElementDataFile = %s\n",
        heading, blanks, "", identity, levels, skg_host_is_big_endian() ? "True" : "False", offset, spacing,
        view->columns, view->rows, file->projections, metaimage_type(file), data);
}

/* Blanks behind the comment fill it up to a multiple of HEADER_UNIT. */
static int header_inside(const skg_scan_file *file, char *text) {
    const int length = metaimage_header(file, "LOCAL", 0, text);
    return metaimage_header(file, "LOCAL", (HEADER_UNIT - length % HEADER_UNIT) % HEADER_UNIT, text);
}

static skg_status lay_out_mha(skg_scan_file *file, const char *temporary) {
    char header[HEADER_LENGTH];
    const int length = header_inside(file, header);
    return skg_scan_lay_out(temporary, header, length, length + file->projections * file->bytes);
}

static skg_status locate_mha(skg_scan_file *file) {
    char header[HEADER_LENGTH];
    file->data_at = header_inside(file, header);
    return skg_scan_check_length(file->path, file->data_at + file->projections * file->bytes);
}

/* "scan.mhd" for "scan.raw" */
static skg_status header_path(const char *path, char **result) {
    SKG_TRY(skg_copy_text(path, result));
    memcpy(*result + strlen(*result) - 4, ".mhd", 4);
    return SKG_OK;
}

static skg_status lay_out_raw(skg_scan_file *file, const char *temporary) {
    char header[HEADER_LENGTH], *path = NULL;
    skg_output_file beside = {0};
    const char *slash = strrchr(file->path, '/');
    const int length = metaimage_header(file, slash ? slash + 1 : file->path, 0, header);
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(header_path(file->path, &path));
    SKG_TRY_CLEANUP(skg_output_open(path, &beside));
    fwrite(header, 1, (size_t)length, beside.stream);
    SKG_TRY_CLEANUP(skg_output_commit(&beside));
    SKG_TRY_CLEANUP(skg_scan_lay_out(temporary, "", 0, file->projections * file->bytes));
cleanup:
    skg_output_discard(&beside);
    skg_free(&path);
    return status;
}

static skg_status locate_raw(skg_scan_file *file) {
    file->data_at = 0;
    return skg_scan_check_length(file->path, file->projections * file->bytes);
}

static skg_status identify_raw(const char *path, skg_scan_identity *identity) {
    char *header = NULL;
    SKG_TRY(header_path(path, &header));
    skg_status status = skg_scan_read_identity(header, identity);
    skg_free(&header);
    return status;
}

/* BigTIFF: 16 bytes, the description, a directory for each projection, the projections. Every projection is one strip,
 * so that none of this changes when it is written. */
enum { TIFF_TAGS = 12, TIFF_DIRECTORY = 8 + 20 * TIFF_TAGS + 8, TIFF_HEADER = 16, TIFF_TEXT = 1024 };

static char *put(char *to, const void *value, size_t size) {
    memcpy(to, value, size);
    return to + size;
}

static char *put_tag(char *to, int tag, int type, int64_t count, int64_t value) {
    enum { SHORT = 3 };
    const uint16_t words[2] = {(uint16_t)tag, (uint16_t)type};
    const uint64_t number = (uint64_t)count;
    char field[8] = {0};
    const uint16_t narrow = (uint16_t)value;
    if (type == SHORT)
        memcpy(field, &narrow, sizeof narrow);
    else
        memcpy(field, &value, sizeof value);
    to = put(to, words, sizeof words);
    to = put(to, &number, sizeof number);
    return put(to, field, sizeof field);
}

static int64_t tiff_data(const skg_scan_file *file) {
    enum { PAGE = 4096 };
    const int64_t used = TIFF_HEADER + TIFF_TEXT + file->projections * TIFF_DIRECTORY;
    return (used + PAGE - 1) / PAGE * PAGE;
}

static char *put_directory(const skg_scan_file *file, int64_t page, char *to) {
    enum { TEXT = 2, SHORT = 3, LONG8 = 16, WIDTH = 256, LENGTH = 257, BITS = 258, COMPRESSION = 259 };
    enum { PHOTOMETRIC = 262, DESCRIPTION = 270, STRIPS = 273, SAMPLES = 277, ROWS = 278, BYTES = 279 };
    enum { PAGE_NUMBER = 254, FORMAT = 339, UNSIGNED = 1, IEEE = 3 };
    const uint64_t tags = TIFF_TAGS;
    const int64_t next = TIFF_HEADER + TIFF_TEXT + (page + 1) * TIFF_DIRECTORY;
    const uint64_t after = page + 1 < file->projections ? (uint64_t)next : 0;
    to = put(to, &tags, sizeof tags);
    to = put_tag(to, PAGE_NUMBER, SHORT, 1, 2); /* one page of several */
    to = put_tag(to, WIDTH, LONG8, 1, file->view.columns);
    to = put_tag(to, LENGTH, LONG8, 1, file->view.rows);
    to = put_tag(to, BITS, SHORT, 1, 8 * skg_element_bytes(file->options.type));
    to = put_tag(to, COMPRESSION, SHORT, 1, 1);
    to = put_tag(to, PHOTOMETRIC, SHORT, 1, 1);
    to = put_tag(to, DESCRIPTION, TEXT, TIFF_TEXT, TIFF_HEADER);
    to = put_tag(to, STRIPS, LONG8, 1, tiff_data(file) + page * file->bytes);
    to = put_tag(to, SAMPLES, SHORT, 1, 1);
    to = put_tag(to, ROWS, LONG8, 1, file->view.rows);
    to = put_tag(to, BYTES, LONG8, 1, file->bytes);
    to = put_tag(to, FORMAT, SHORT, 1, file->options.type == SKG_TYPE_UINT16 ? UNSIGNED : IEEE);
    return put(to, &after, sizeof after);
}

static skg_status lay_out_tiff(skg_scan_file *file, const char *temporary) {
    const int64_t length = tiff_data(file);
    const uint64_t first = TIFF_HEADER + TIFF_TEXT;
    const uint16_t start[3] = {43, 8, 0};
    char *header = NULL, heading[200], identity[160], levels[SKG_SCAN_LEVELS_LENGTH], begin[TIFF_HEADER];
    SKG_TRY(skg_alloc(length, 1, "directories of a TIFF file", &header));
    put(put(put(begin, skg_host_is_big_endian() ? "MM" : "II", 2), start, sizeof start), &first,
        sizeof first);
    char *to = put(header, begin, sizeof begin);
    title(file, heading, sizeof heading);
    skg_scan_write_identity(file, identity, sizeof identity);
    skg_scan_write_levels(file, levels);
    snprintf(to, TIFF_TEXT, "%s\n%s%sskiagraph %s\n", heading, identity, levels, SKG_VERSION);
    to += TIFF_TEXT;
    for (int64_t k = 0; k < file->projections; k++) to = put_directory(file, k, to);
    skg_status status = skg_scan_lay_out(temporary, header, length, length + file->projections * file->bytes);
    skg_free(&header);
    return status;
}

static skg_status locate_tiff(skg_scan_file *file) {
    file->data_at = tiff_data(file);
    return skg_scan_check_length(file->path, file->data_at + file->projections * file->bytes);
}

static skg_status remove_raw(skg_scan_file *file) {
    char *header = NULL;
    SKG_TRY(header_path(file->path, &header));
    unlink(header);
    skg_free(&header);
    unlink(file->path);
    return SKG_OK;
}

const skg_scan_format skg_scan_format_mha = {.extensions = {".mha"},
                                             .lay_out = lay_out_mha,
                                             .locate = locate_mha,
                                             .identify = skg_scan_read_identity,
                                             .fields_beside = 1};
const skg_scan_format skg_scan_format_raw = {.extensions = {".raw"},
                                             .lay_out = lay_out_raw,
                                             .locate = locate_raw,
                                             .identify = identify_raw,
                                             .remove = remove_raw,
                                             .fields_beside = 1};
const skg_scan_format skg_scan_format_tiff = {.extensions = {".tif", ".tiff"},
                                              .lay_out = lay_out_tiff,
                                              .locate = locate_tiff,
                                              .identify = skg_scan_read_identity,
                                              .fields_beside = 1};
