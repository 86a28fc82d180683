/* A picture as a DICOM file: stored values, the attributes of Computed Radiography (DICOM PS3.3, A.2), and dump2dcm, which writes them. */
#include "dicom/dicom.h"

#include "common/child.h"
#include "common/file.h"
#include "common/say.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <sha2.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { STORED_MAX = 65535, TEXT_MAX = 8192, LONGEST_COMPLAINT = 1024, UID_SIZE = 64 };

typedef struct {
    const skg_picture *picture;
    const cli_dicom_facts *facts;
    double low, high, slope, intercept;
    char slope_text[17], intercept_text[17];
    uint16_t *stored;
    char study[UID_SIZE], series[UID_SIZE], instance[UID_SIZE];
    char text[TEXT_MAX];
    size_t length;
} dicom;

int cli_dicom_is(const char *path) {
    return cli_has_extension(path, ".dcm");
}

int cli_dicom_check(const char *path) {
    if (!cli_has_program("dump2dcm"))
        return cli_error(
            CLI_OUTPUT,
            "%s: needs the program dump2dcm, which is not on PATH; install DCMTK (Debian: apt-get install "
            "dcmtk), or write a .mha",
            path);
    return cli_file_check(path);
}

static double value_at(const skg_picture *picture, int64_t i) {
    switch (picture->type) {
    case SKG_TYPE_FLOAT64:
        return ((const double *)picture->data)[i];
    case SKG_TYPE_UINT16:
        return ((const uint16_t *)picture->data)[i];
    default:
        return (double)((const float *)picture->data)[i];
    }
}

static int find_range(dicom *d, const char *path) {
    const int64_t pixels = d->picture->columns * d->picture->rows;
    int64_t bad = 0;
    d->low = HUGE_VAL, d->high = -HUGE_VAL;
    for (int64_t i = 0; i < pixels; i++) {
        const double value = value_at(d->picture, i);
        bad += !isfinite(value);
        d->low = fmin(d->low, value), d->high = fmax(d->high, value);
    }
    if (bad > 0)
        return cli_error(CLI_OUTPUT,
                         "%s: %" PRId64 " of %" PRId64
                         " pixels are not finite, which DICOM cannot hold; write a .mha",
                         path, bad, pixels);
    return CLI_DONE;
}

/* DICOM's decimal strings have 16 characters at most. Values are stored by what these say, not by what was meant. */
static void find_scale(dicom *d) {
    if (d->picture->type == SKG_TYPE_UINT16) {
        d->slope = 1, d->intercept = 0;
    } else {
        const double room = 1 + 1e-8; /* for the rounding of both to nine digits */
        d->slope = d->high > d->low ? (d->high - d->low) * room / STORED_MAX : 1;
        d->intercept = d->low;
    }
    snprintf(d->slope_text, sizeof d->slope_text, "%.9g", d->slope);
    snprintf(d->intercept_text, sizeof d->intercept_text, "%.9g", d->intercept);
    d->slope = strtod(d->slope_text, NULL);
    d->intercept = strtod(d->intercept_text, NULL);
}

static void store(dicom *d) {
    const int64_t pixels = d->picture->columns * d->picture->rows;
    for (int64_t i = 0; i < pixels; i++) {
        const double steps = floor((value_at(d->picture, i) - d->intercept) / d->slope + 0.5);
        const uint16_t whole = (uint16_t)fmin(fmax(steps, 0), STORED_MAX);
        ((unsigned char *)d->stored)[2 * i] = (unsigned char)(whole & 0xff); /* little endian */
        ((unsigned char *)d->stored)[2 * i + 1] = (unsigned char)(whole >> 8);
    }
}

/* "2.25." and 128 bits as a decimal number (PS3.5, B.2): here of a digest, so that the same picture has the same identifiers. */
static void name_uid(const uint8_t digest[SHA256_DIGEST_LENGTH], char uid[UID_SIZE]) {
    uint32_t words[4];
    char digits[40];
    int first = 40;
    for (int w = 0; w < 4; w++)
        words[w] = (uint32_t)digest[4 * w] << 24 | (uint32_t)digest[4 * w + 1] << 16 |
                   (uint32_t)digest[4 * w + 2] << 8 | digest[4 * w + 3];
    do {
        uint64_t rest = 0;
        for (int w = 0; w < 4; w++) {
            const uint64_t part = rest << 32 | words[w];
            words[w] = (uint32_t)(part / 10), rest = part % 10;
        }
        digits[--first] = (char)('0' + rest);
    } while (words[0] | words[1] | words[2] | words[3]);
    snprintf(uid, UID_SIZE, "2.25.%.*s", 40 - first, digits + first);
}

static void name_level(const dicom *d, const char *level, const void *data, size_t bytes,
                       char uid[UID_SIZE]) {
    const char *study = d->facts->study ? d->facts->study : "";
    uint8_t digest[SHA256_DIGEST_LENGTH];
    SHA2_CTX sum;
    SHA256Init(&sum);
    SHA256Update(&sum, (const uint8_t *)level, strlen(level) + 1);
    SHA256Update(&sum, (const uint8_t *)study, strlen(study) + 1);
    if (bytes > 0) {
        SHA256Update(&sum, (const uint8_t *)&d->facts->number, sizeof d->facts->number);
        SHA256Update(&sum, data, bytes);
    }
    SHA256Final(digest, &sum);
    name_uid(digest, uid);
}

/* Appends a line of dump2dcm's text: an attribute. */
__attribute__((format(printf, 2, 3))) static void put(dicom *d, const char *format, ...) {
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(d->text + d->length, TEXT_MAX - d->length, format, values);
    va_end(values);
    if (length > 0 && (size_t)length < TEXT_MAX - d->length - 1) {
        d->length += (size_t)length;
        d->text[d->length++] = '\n';
    }
}

static double distance(const double *a, const double *b) {
    double squares = 0;
    for (int k = 0; k < 3; k++) squares += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt(squares);
}

static void put_geometry(dicom *d) {
    static const double zero[3] = {0, 0, 0};
    const skg_view *view = d->picture->view;
    if (!view) return;
    const double column = distance(view->column_step, zero), row = distance(view->row_step, zero);
    if (view->projection == SKG_PROJECTION_POINT)
        put(d, "(0018,1110) DS [%.9g]", distance(view->source, view->centre));
    if (d->facts->patient_mm > 0) put(d, "(0018,1111) DS [%.9g]", d->facts->patient_mm);
    put(d, "(0018,1164) DS [%.9g\\%.9g]", row, column); /* between rows, then between columns */
    put(d, "(0028,0030) DS [%.9g\\%.9g]", row, column);
}

/* Bone is shown bright, as radiographs are read: where it lowers the values, small ones are white. */
static void put_pixels(dicom *d) {
    const skg_picture *picture = d->picture;
    const int falls = picture->quantity != SKG_QUANTITY_ATTENUATION;
    put(d, "(0028,0002) US 1");
    put(d, "(0028,0004) CS [%s]", falls ? "MONOCHROME1" : "MONOCHROME2");
    put(d, "(0028,0010) US %" PRId64, picture->rows);
    put(d, "(0028,0011) US %" PRId64, picture->columns);
    put(d, "(0028,0100) US 16");
    put(d, "(0028,0101) US 16");
    put(d, "(0028,0102) US 15");
    put(d, "(0028,0103) US 0");
    put(d, "(0028,1040) CS [%s]", falls ? "LIN" : "LOG");
    put(d, "(0028,1041) SS %d", falls ? 1 : -1);
    put(d, "(0028,1050) DS [%.9g]", 0.5 * (d->low + d->high));
    put(d, "(0028,1051) DS [%.9g]", fmax(d->high - d->low, d->slope));
    put(d, "(0028,1052) DS [%s]", d->intercept_text);
    put(d, "(0028,1053) DS [%s]", d->slope_text);
    put(d, "(0028,1054) LO [US]");
}

static void put_all(dicom *d, const char *pixels) {
    const char *name = d->picture->name ? d->picture->name : "image",
               *unit = d->picture->unit ? d->picture->unit : "";
    put(d, "(0008,0005) CS [ISO_IR 192]");
    put(d, "(0008,0008) CS [ORIGINAL\\PRIMARY]");
    put(d, "(0008,0016) UI [1.2.840.10008.5.1.4.1.1.1]");
    put(d, "(0008,0018) UI [%s]", d->instance);
    /* Dates and names that DICOM wants to be there, and that nothing is known of. */
    static const char *const empty[] = {"(0008,0020) DA", "(0008,0030) TM", "(0008,0050) SH",
                                        "(0008,0090) PN", "(0010,0030) DA", "(0010,0040) CS",
                                        "(0018,0015) CS", "(0018,5101) CS", "(0020,0020) CS"};
    for (size_t i = 0; i < sizeof empty / sizeof *empty; i++) put(d, "%s", empty[i]);
    put(d, "(0008,0060) CS [CR]");
    put(d, "(0008,0070) LO [Skiagraph]");
    put(d, "(0008,103e) LO [simulated: %.40s]", name);
    put(d, "(0010,0010) PN [Simulated^Skiagraph]");
    put(d, "(0010,0020) LO [SIMULATED]");
    if (d->facts->kvp > 0) put(d, "(0018,0060) DS [%.9g]", d->facts->kvp);
    put(d, "(0018,1020) LO [Skiagraph %s]", skg_version());
    put_geometry(d);
    put(d, "(0020,000d) UI [%s]", d->study);
    put(d, "(0020,000e) UI [%s]", d->series);
    put(d, "(0020,0010) SH [1]");
    put(d, "(0020,0011) IS [1]");
    put(d, "(0020,0013) IS [%" PRId64 "]", d->facts->number);
    put(d, "(0020,4000) LT [%s in %s, simulated by Skiagraph %s%s%s]", name, unit, skg_version(),
        d->facts->beside ? "; " : "", d->facts->beside ? d->facts->beside : "");
    put_pixels(d);
    put(d, "(7fe0,0010) OW =%s", pixels);
}

/* Has dump2dcm put text and pixels together. */
static int convert(const char *path, const char *text, const char *result) {
    const char *const words[] = {"dump2dcm", "+te", "+l", "65536", text, result, NULL};
    char said[LONGEST_COMPLAINT];
    cli_child child = {0};
    const int reason = cli_child_start(words, &child);
    if (reason)
        return cli_error(CLI_OUTPUT, "%s: the program dump2dcm cannot be started: %s", path,
                         strerror(reason));
    const int status = cli_child_end(&child, said, sizeof said);
    if (status == 0) return CLI_DONE;
    return cli_error(CLI_OUTPUT, "%s: dump2dcm could not write it (exit status %d): %s", path, status,
                     *said ? said : "it gave no reason");
}

/* Opens a file beside the result and fills it; its temporary name is all that dump2dcm needs. */
static int open_filled(const char *path, const void *bytes, size_t count, cli_file *file) {
    const int exit_status = cli_file_open(path, file);
    if (exit_status != CLI_DONE) return exit_status;
    errno = 0;
    if (cli_file_write(file, bytes, count) && fflush(file->stream) == 0) return CLI_DONE;
    return cli_file_fail(path, strerror(file->reason ? file->reason : errno));
}

/* Text and pixels wait in files beside the result, which are removed. */
static int write_file(dicom *d, const char *path) {
    const size_t bytes = (size_t)(d->picture->columns * d->picture->rows) * sizeof *d->stored;
    cli_file pixels = {0}, text = {0}, result = {0};
    int exit_status = cli_file_open(path, &result);
    if (exit_status == CLI_DONE) exit_status = open_filled(path, d->stored, bytes, &pixels);
    if (exit_status == CLI_DONE) {
        put_all(d, pixels.temporary);
        exit_status = open_filled(path, d->text, d->length, &text);
    }
    if (exit_status == CLI_DONE) exit_status = convert(path, text.temporary, result.temporary);
    cli_file_discard(&text);
    cli_file_discard(&pixels);
    if (exit_status == CLI_DONE) return cli_file_commit(&result);
    cli_file_discard(&result);
    return exit_status;
}

int cli_dicom_save(const skg_picture *picture, const cli_dicom_facts *facts, const char *path, double *step) {
    if (picture->channels != 1)
        return cli_error(CLI_OUTPUT,
                         "%s: a .dcm holds one channel, and the image has %" PRId64 "; write a .tif or .mha",
                         path, picture->channels);
    if (picture->columns > STORED_MAX || picture->rows > STORED_MAX)
        return cli_error(CLI_OUTPUT, "%s: a .dcm holds at most 65535 columns and rows; write a .mha", path);
    const size_t pixels = (size_t)(picture->columns * picture->rows);
    dicom *d = calloc(1, sizeof *d);
    if (d) d->stored = calloc(pixels, sizeof *d->stored);
    if (!d || !d->stored) {
        free(d);
        return cli_error(CLI_DEVICE, "out of host memory for %s", path);
    }
    d->picture = picture, d->facts = facts;
    int exit_status = find_range(d, path);
    if (exit_status == CLI_DONE) {
        find_scale(d);
        store(d);
        name_level(d, "study", NULL, 0, d->study);
        name_level(d, "series", NULL, 0, d->series);
        name_level(d, "instance", d->stored, pixels * sizeof *d->stored, d->instance);
        if (step) *step = d->slope;
        exit_status = write_file(d, path);
    }
    free(d->stored);
    free(d);
    return exit_status;
}
