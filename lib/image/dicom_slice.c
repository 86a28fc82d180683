/* Reads a file of DICOM (PS3.5 and PS3.10 of the standard, 2023) as far as a slice of a CT image needs it. */
#include "image/dicom_slice.h"

#include "core/files.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PREAMBLE = 128, DEEPEST = 32, LONGEST_VALUE = 256 };

/* Lengths of what ends with a mark of its own, and the group of such marks. */
static const uint32_t UNKNOWN_LENGTH = 0xffffffff;
enum { MARKS = 0xfffe, ITEM = 0xe000, END_OF_ITEM = 0xe00d, END_OF_SEQUENCE = 0xe0dd };

static const struct {
    uint16_t group, element;
    int32_t most;     /* numbers; 0: binary, of 16 bits */
    const char *name; /* of those that are text */
} attributes[SKG_DICOM_NUMBERS] = {
    [SKG_DICOM_PLACE] = {0x0020, 0x0032, 3, "ImagePositionPatient"},
    [SKG_DICOM_ORIENTATION] = {0x0020, 0x0037, 6, "ImageOrientationPatient"},
    [SKG_DICOM_SAMPLES] = {0x0028, 0x0002, 0, NULL},
    [SKG_DICOM_FRAMES] = {0x0028, 0x0008, 1, "NumberOfFrames"},
    [SKG_DICOM_ROWS] = {0x0028, 0x0010, 0, NULL},
    [SKG_DICOM_COLUMNS] = {0x0028, 0x0011, 0, NULL},
    [SKG_DICOM_SPACING] = {0x0028, 0x0030, 2, "PixelSpacing"},
    [SKG_DICOM_ALLOCATED] = {0x0028, 0x0100, 0, NULL},
    [SKG_DICOM_STORED] = {0x0028, 0x0101, 0, NULL},
    [SKG_DICOM_HIGH] = {0x0028, 0x0102, 0, NULL},
    [SKG_DICOM_SIGNED] = {0x0028, 0x0103, 0, NULL},
    [SKG_DICOM_INTERCEPT] = {0x0028, 0x1052, 1, "RescaleIntercept"},
    [SKG_DICOM_SLOPE] = {0x0028, 0x1053, 1, "RescaleSlope"},
};

/* An attribute as it begins in the file. */
typedef struct {
    uint16_t group, element;
    int is_sequence; /* 1: so its kind says; of implicit kinds only an unknown length does */
    int is_opaque;   /* 1: its kind is not known, so that what it holds has implicit kinds */
    uint32_t length;
} head;

typedef struct {
    const char *path;
    FILE *stream;
    int64_t size;
} source;

static skg_status fail_short(const source *s) {
    return skg_fail(SKG_ERR_FORMAT, "%s: ends within its attributes; is it the whole file?", s->path);
}

static uint32_t number_of(const unsigned char *bytes, int count) {
    uint32_t number = 0;
    for (int k = count - 1; k >= 0; k--) number = number << 8 | bytes[k];
    return number;
}

static skg_status take(const source *s, void *bytes, size_t count) {
    return fread(bytes, 1, count, s->stream) == count ? SKG_OK : fail_short(s);
}

/* Passes over a value. */
static skg_status pass_over(const source *s, uint32_t length) {
    const int64_t at = (int64_t)ftello(s->stream) + length;
    if (at > s->size || fseeko(s->stream, (off_t)at, SEEK_SET) != 0) return fail_short(s);
    return SKG_OK;
}

/* implicit: kinds are not in the file. */
static skg_status take_head(const source *s, int implicit, head *h) {
    static const char large[] = "OB OW OF OD OL OV SQ UC UR UT UN SV UV ";
    unsigned char b[8];
    char kind[4] = "   ";
    SKG_TRY(take(s, b, 8));
    *h = (head){.group = (uint16_t)number_of(b, 2), .element = (uint16_t)number_of(b + 2, 2)};
    if (implicit || h->group == MARKS) {
        h->length = number_of(b + 4, 4);
        return SKG_OK;
    }
    memcpy(kind, b + 4, 2);
    h->is_sequence = memcmp(kind, "SQ", 2) == 0, h->is_opaque = memcmp(kind, "UN", 2) == 0;
    h->length = number_of(b + 6, 2);
    if (!strstr(large, kind)) return SKG_OK;
    SKG_TRY(take(s, b, 4));
    h->length = number_of(b, 4);
    return SKG_OK;
}

static skg_status skip(const source *s, int implicit, const head *h, int depth);

/* Passes over the attributes of an item of unknown length, to behind its end. */
static skg_status skip_item(const source *s, int implicit, int depth) {
    head h;
    for (;;) {
        SKG_TRY(take_head(s, implicit, &h));
        if (h.group == MARKS && h.element == END_OF_ITEM) return SKG_OK;
        SKG_TRY(skip(s, implicit, &h, depth));
    }
}

/* Passes over the value of an attribute, whatever it holds. Sequences of unknown length are followed to their end. */
static skg_status skip(const source *s, int implicit, const head *h, int depth) {
    head item;
    if (h->length != UNKNOWN_LENGTH) return pass_over(s, h->length);
    if (depth > DEEPEST)
        return skg_fail(SKG_ERR_FORMAT, "%s: has more than %d sequences within each other", s->path,
                        (int)DEEPEST);
    for (;;) {
        SKG_TRY(take_head(s, 1, &item));
        if (item.group != MARKS || (item.element != ITEM && item.element != END_OF_SEQUENCE))
            return skg_fail(SKG_ERR_FORMAT,
                            "%s: a sequence (%04x,%04x) holds what is no item; take another copy", s->path,
                            h->group, h->element);
        if (item.element == END_OF_SEQUENCE) return SKG_OK;
        if (item.length != UNKNOWN_LENGTH)
            SKG_TRY(pass_over(s, item.length));
        else
            SKG_TRY(skip_item(s, implicit || h->is_opaque, depth + 1));
    }
}

/* A value as text without blanks at its end; what is longer than that is none of those that are asked for. */
static skg_status take_text(const source *s, uint32_t length, char text[LONGEST_VALUE]) {
    const size_t kept = length < LONGEST_VALUE ? length : LONGEST_VALUE - 1;
    SKG_TRY(take(s, text, kept));
    text[kept] = '\0';
    for (size_t end = strlen(text); end > 0 && text[end - 1] == ' '; end--) text[end - 1] = '\0';
    return pass_over(s, length - (uint32_t)kept);
}

static skg_status take_copy(const source *s, uint32_t length, char copy[SKG_DICOM_TEXT]) {
    char text[LONGEST_VALUE];
    SKG_TRY(take_text(s, length, text));
    snprintf(copy, SKG_DICOM_TEXT, "%.64s", text);
    return SKG_OK;
}

/* Reads the numbers of a text, which stand between backslashes, with blanks around them. Returns their number; -1: it holds something
 * else, a number beyond doubles, or more than `most` of them. */
static int32_t read_numbers(const char *from, int32_t most, double *numbers) {
    int32_t count = 0;
    while (count < most) {
        const char *end = from += strspn(from, " ");
        const size_t length = strspn(from, "+-.0123456789Ee");
        numbers[count] = skg_read_number(from, &end);
        if (length == 0 || end != from + length || !isfinite(numbers[count])) return -1;
        count++;
        end += strspn(end, " ");
        if (*end == '\0') return count;
        if (*end != '\\') return -1;
        from = end + 1;
    }
    return -1;
}

/* Takes the numbers of an attribute of text. One that is empty is not given, except where the values of the pixels would be others for that. */
static skg_status take_decimals(const source *s, uint32_t length, int which, skg_dicom_slice *slice) {
    const int32_t most = attributes[which].most;
    char text[LONGEST_VALUE];
    SKG_TRY(take_text(s, length, text));
    slice->count[which] = 0;
    if (text[strspn(text, " ")] == '\0' && which != SKG_DICOM_INTERCEPT && which != SKG_DICOM_SLOPE)
        return SKG_OK;
    const int32_t count = read_numbers(text, most, slice->numbers[which]);
    if (count < 0)
        return skg_fail(SKG_ERR_FORMAT, "%s: its %s says \"%.200s\"; write %d finite number%s%s", s->path,
                        attributes[which].name, text, (int)most, most == 1 ? ", as -1024" : "s",
                        most == 1 ? "" : ", a backslash between each two");
    slice->count[which] = count;
    return SKG_OK;
}

static skg_status take_numbers(const source *s, const head *h, int which, skg_dicom_slice *slice) {
    unsigned char b[2];
    if (attributes[which].most > 0) return take_decimals(s, h->length, which, slice);
    if (h->length < 2) return pass_over(s, h->length);
    SKG_TRY(take(s, b, 2));
    slice->numbers[which][0] = number_of(b, 2), slice->count[which] = 1;
    return pass_over(s, h->length - 2);
}

/* Takes or passes over the value of an attribute. */
static skg_status take_value(const source *s, int implicit, const head *h, skg_dicom_slice *slice) {
    if (h->group == 0x0028 && h->element == 0x3000) slice->has_table = 1;
    if (h->group == 0x0004) slice->is_directory = 1;
    if (h->length == UNKNOWN_LENGTH || h->is_sequence) return skip(s, implicit, h, 0);
    for (int k = 0; k < SKG_DICOM_NUMBERS; k++)
        if (h->group == attributes[k].group && h->element == attributes[k].element)
            return take_numbers(s, h, k, slice);
    if (h->group == 0x0002 && h->element == 0x0010) return take_copy(s, h->length, slice->syntax);
    if (h->group == 0x0020 && h->element == 0x000e) return take_copy(s, h->length, slice->series);
    if (h->group == 0x0008 && h->element == 0x103e) return take_copy(s, h->length, slice->description);
    if (h->group == 0x0008 && h->element == 0x0060) return take_copy(s, h->length, slice->modality);
    if (h->group == 0x0028 && h->element == 0x1054) return take_copy(s, h->length, slice->scale);
    return skip(s, implicit, h, 0);
}

static int is_syntax(const skg_dicom_slice *slice, const char *last) {
    static const char first[] = "1.2.840.10008.1.2";
    return strncmp(slice->syntax, first, sizeof first - 1) == 0 &&
           strcmp(slice->syntax + sizeof first - 1, last) == 0;
}

/* Up to the pixels, behind which nothing is asked for. The attributes of group 2 have kinds in any file. */
static skg_status take_attributes(const source *s, skg_dicom_slice *slice) {
    int is_about_file = 1;
    while ((int64_t)ftello(s->stream) < s->size) {
        const off_t at = ftello(s->stream);
        const int implicit = !is_about_file && is_syntax(slice, "");
        head h;
        SKG_TRY(take_head(s, implicit, &h));
        if (is_about_file && h.group != 0x0002) {
            is_about_file = 0;
            if (is_syntax(slice, ".2") || is_syntax(slice, ".1.99"))
                return skg_fail(SKG_ERR_UNSUPPORTED,
                                "%s: is written with %s; write it anew as dcmconv +te does (DCMTK)", s->path,
                                is_syntax(slice, ".2") ? "the most significant byte first"
                                                       : "all of it compressed");
            if (fseeko(s->stream, at, SEEK_SET) != 0) return fail_short(s);
            continue;
        }
        if (h.group == 0x7fe0 && h.element == 0x0010) {
            slice->pixels = (int64_t)ftello(s->stream);
            slice->pixel_bytes = h.length == UNKNOWN_LENGTH ? -1 : (int64_t)h.length;
            if (slice->pixels + slice->pixel_bytes <= s->size) return SKG_OK;
            return skg_fail(SKG_ERR_FORMAT, "%s: ends within its pixels; is it the whole file?", s->path);
        }
        SKG_TRY(take_value(s, implicit, &h, slice));
    }
    return SKG_OK;
}

skg_status skg_dicom_slice_read(const char *path, int *is_dicom, skg_dicom_slice *slice) {
    source s = {.path = path};
    char begin[PREAMBLE + 4] = "";
    skg_status status = SKG_OK;
    *slice = (skg_dicom_slice){.path = NULL};
    SKG_TRY(skg_input_open(path, SKG_INPUT_LARGE, &s.stream, &s.size));
    *is_dicom =
        fread(begin, 1, sizeof begin, s.stream) == sizeof begin && memcmp(begin + PREAMBLE, "DICM", 4) == 0;
    if (*is_dicom) status = take_attributes(&s, slice);
    fclose(s.stream);
    return status;
}

double skg_dicom_number(const skg_dicom_slice *slice, enum skg_dicom_numbers which, double otherwise) {
    return slice->count[which] > 0 ? slice->numbers[which][0] : otherwise;
}

/* How a pixel lies in its word: the bits of both, and the lowest. */
typedef struct {
    int allocated, stored, low;
} word_layout;

static int64_t pixels_of(const skg_dicom_slice *slice) {
    return (int64_t)skg_dicom_number(slice, SKG_DICOM_ROWS, 0) *
           (int64_t)skg_dicom_number(slice, SKG_DICOM_COLUMNS, 0);
}

static skg_status find_layout(const skg_dicom_slice *slice, word_layout *word) {
    const double allocated = skg_dicom_number(slice, SKG_DICOM_ALLOCATED, 0),
                 stored = skg_dicom_number(slice, SKG_DICOM_STORED, allocated),
                 high = skg_dicom_number(slice, SKG_DICOM_HIGH, stored - 1);
    if (skg_dicom_number(slice, SKG_DICOM_SAMPLES, 1) != 1)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: its pixels are colours; a volume has one number each",
                        slice->path);
    if (slice->has_table)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: its values stand in a table (ModalityLUTSequence), which is not read; write them with RescaleSlope",
            slice->path);
    if (!(fabs(skg_dicom_number(slice, SKG_DICOM_SLOPE, 1)) > 0) ||
        !isfinite(skg_dicom_number(slice, SKG_DICOM_SLOPE, 1)))
        return skg_fail(SKG_ERR_FORMAT, "%s: RescaleSlope is %g; give one that is finite and not 0",
                        slice->path, skg_dicom_number(slice, SKG_DICOM_SLOPE, 1));
    if (slice->pixel_bytes < 0)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: its pixels are compressed (%s); expand them by dcmdjpeg, dcmdjpls or dcmdrle (DCMTK), "
            "or read the folder in Python",
            slice->path, slice->syntax);
    if ((allocated != 8 && allocated != 16) || !(stored >= 1) || !(high >= stored - 1) || !(high < allocated))
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: bits %g of %g, the highest %g, are no pixel that is read",
                        slice->path, stored, allocated, high);
    *word = (word_layout){(int)allocated, (int)stored, (int)(high - stored) + 1};
    const int64_t bytes = pixels_of(slice) * word->allocated / 8;
    /* a byte may fill up an odd number of them */
    if (slice->pixel_bytes == bytes || slice->pixel_bytes == bytes + bytes % 2) return SKG_OK;
    return skg_fail(SKG_ERR_FORMAT,
                    "%s: has %" PRId64 " bytes of pixels, and its size asks for %" PRId64
                    "; are Rows, Columns and BitsAllocated those of the pixels?",
                    slice->path, slice->pixel_bytes, bytes);
}

skg_status skg_dicom_slice_check(const skg_dicom_slice *slice) {
    word_layout word;
    return find_layout(slice, &word);
}

skg_status skg_dicom_slice_values(const skg_dicom_slice *slice, double *values) {
    const int64_t pixels = pixels_of(slice);
    const double slope = skg_dicom_number(slice, SKG_DICOM_SLOPE, 1),
                 intercept = skg_dicom_number(slice, SKG_DICOM_INTERCEPT, 0);
    word_layout word = {8, 8, 0};
    FILE *stream = NULL;
    unsigned char *bytes = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(find_layout(slice, &word));
    const int each = word.allocated / 8;
    const uint32_t mask = (UINT32_C(1) << word.stored) - 1,
                   sign = skg_dicom_number(slice, SKG_DICOM_SIGNED, 0) != 0 ? (mask >> 1) + 1 : 0;
    SKG_TRY(skg_input_open(slice->path, SKG_INPUT_LARGE, &stream, NULL));
    SKG_TRY_CLEANUP(skg_alloc(pixels, (size_t)each, "pixels of a slice", &bytes));
    if (fseeko(stream, (off_t)slice->pixels, SEEK_SET) != 0 ||
        fread(bytes, (size_t)each, (size_t)pixels, stream) != (size_t)pixels)
        status = skg_fail(SKG_ERR_FORMAT, "%s: ends within its pixels; is it the whole file?", slice->path);
    for (int64_t k = 0; status == SKG_OK && k < pixels; k++) {
        const uint32_t stored = number_of(bytes + k * each, each) >> word.low & mask;
        values[k] = ((double)stored - (stored & sign ? (double)mask + 1 : 0)) * slope + intercept;
    }
cleanup:
    skg_free(&bytes);
    fclose(stream);
    return status;
}
