/* A radiograph out of a DICOM file: the programs of DCMTK decompress it and say what it holds. */
#include "dicom/dicom.h"

#include "common/child.h"
#include "common/file.h"
#include "common/say.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TEXT_MAX = 65536, LONGEST_COMPLAINT = 1024, PATH_SIZE = 512 };

/* Attributes that are read from the file, by their numbers in DICOM (PS3.6). */
typedef enum {
    FRAMES,
    ROWS,
    COLUMNS,
    SAMPLES,
    ALLOCATED,
    STORED,
    HIGH_BIT,
    SIGNED,
    INTERCEPT,
    SLOPE,
    SIGN,
    FACTS
} fact;

static const struct {
    const char *attribute, *name;
    double otherwise; /* the value where the file has none; NaN: it must have one */
} facts[FACTS] = {[FRAMES] = {"(0028,0008)", "NumberOfFrames", 1},
                  [ROWS] = {"(0028,0010)", "Rows", (double)NAN},
                  [COLUMNS] = {"(0028,0011)", "Columns", (double)NAN},
                  [SAMPLES] = {"(0028,0002)", "SamplesPerPixel", 1},
                  [ALLOCATED] = {"(0028,0100)", "BitsAllocated", (double)NAN},
                  [STORED] = {"(0028,0101)", "BitsStored", (double)NAN},
                  [HIGH_BIT] = {"(0028,0102)", "HighBit", (double)NAN},
                  [SIGNED] = {"(0028,0103)", "PixelRepresentation", 0},
                  [INTERCEPT] = {"(0028,1052)", "RescaleIntercept", 0},
                  [SLOPE] = {"(0028,1053)", "RescaleSlope", 1},
                  [SIGN] = {"(0028,1041)", "PixelIntensityRelationshipSign", 0}};

typedef struct {
    const char *path;
    char folder[PATH_SIZE], plain[PATH_SIZE], said[PATH_SIZE], raw[PATH_SIZE]; /* temporary files */
    char text[TEXT_MAX];
    double of[FACTS];
} reading;

/* Runs a program of DCMTK. output: -1, or where its standard output goes. Returns its exit status, or -1000 if it did not start. */
static int run(const char *const *words, int output, char *said, size_t size) {
    FILE *complaints = tmpfile();
    const int nothing = open("/dev/null", O_RDONLY);
    pid_t process = 0;
    int status = -1000;
    if (complaints && nothing >= 0 &&
        cli_process_start(words, nothing, output, fileno(complaints), &process) == 0) {
        status = cli_process_end(process);
        rewind(complaints);
        const size_t count = fread(said, 1, size - 1, complaints);
        said[count] = '\0';
        said[strcspn(said, "\n")] = '\0';
    }
    if (complaints) fclose(complaints);
    if (nothing >= 0) close(nothing);
    return status;
}

/* Each program knows one kind of compression, and copies what is not compressed. */
static int decompress(reading *r) {
    static const char *const programs[] = {"dcmdjpeg", "dcmdjpls", "dcmdrle"};
    char said[LONGEST_COMPLAINT] = "", first[LONGEST_COMPLAINT] = "";
    for (size_t p = 0; p < sizeof programs / sizeof *programs; p++) {
        const char *const words[] = {programs[p], "+te", r->path, r->plain, NULL};
        if (run(words, -1, said, sizeof said) == 0) return CLI_DONE;
        if (p == 0) memcpy(first, said, sizeof first);
    }
    return cli_error(CLI_INPUT, "%s: is no DICOM file that DCMTK can decompress: %s", r->path,
                     *first ? first : "dcmdjpeg gave no reason");
}

/* Has dcmdump write the pixels to a file of their own, and the attributes as text. */
static int take_apart(reading *r) {
    const char *words[2 * FACTS + 16] = {"dcmdump",   "-q",        "+L",       "+W",        r->folder,
                                         "+P",        "0028,1040", "+P",       "0008,0070", "+P",
                                         "0020,4000", "+P",        "7fe0,0010"};
    char said[LONGEST_COMPLAINT] = "", names[FACTS][12];
    int count = 13;
    for (int f = 0; f < FACTS; f++) {
        snprintf(names[f], sizeof names[f], "%.9s", facts[f].attribute + 1);
        words[count++] = "+P", words[count++] = names[f];
    }
    words[count++] = r->plain;
    const int output = open(r->said, O_RDWR | O_CREAT | O_EXCL, 0600);
    if (output < 0) return cli_file_fail(r->said, strerror(errno));
    const int status = run(words, output, said, sizeof said);
    const ssize_t length = status == 0 ? pread(output, r->text, TEXT_MAX - 1, 0) : 0;
    close(output);
    if (status == 0 && length > 0) return CLI_DONE;
    return cli_error(CLI_INPUT, "%s: dcmdump could not read it: %s", r->path,
                     *said ? said : "it gave no reason");
}

/* The value of an attribute in the text: behind its kind, without brackets; NULL: there is none. A picture in a picture stands
 * indented, and does not count. */
static const char *value_of(const reading *r, const char *attribute, char value[64]) {
    const size_t length = strlen(attribute);
    for (const char *line = r->text; line; line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL) {
        if (strncmp(line, attribute, length) != 0 || strlen(line) < length + 4) continue;
        const char *from = line + length + 4 + (line[length + 4] == '[');
        snprintf(value, 64, "%.*s", (int)strcspn(from, "]#\n"), from);
        return value;
    }
    return NULL;
}

static int read_facts(reading *r) {
    char value[64];
    for (int f = 0; f < FACTS; f++) {
        const char *text = value_of(r, facts[f].attribute, value);
        char *end = NULL;
        r->of[f] = text ? strtod(text, &end) : facts[f].otherwise;
        if (text && end != text && end[strspn(end, " ")] != '\0')
            return cli_error(CLI_INPUT, "%s: its %s %s says \"%s\"; write one finite number", r->path,
                             facts[f].name, facts[f].attribute, text);
        if ((text && end == text) || !isfinite(r->of[f]))
            return cli_error(CLI_INPUT, "%s: has no %s %s, and so no picture", r->path, facts[f].name,
                             facts[f].attribute);
    }
    if (r->of[SAMPLES] != 1)
        return cli_error(CLI_INPUT, "%s: is in colour, and radiographs are grey", r->path);
    const double stored = r->of[STORED], high = r->of[HIGH_BIT], allocated = r->of[ALLOCATED];
    if ((allocated != 8 && allocated != 16) || !(stored >= 1) || !(high >= stored - 1) ||
        !(high < allocated) || !(r->of[ROWS] >= 1) || !(r->of[COLUMNS] >= 1) || !(r->of[FRAMES] >= 1))
        return cli_error(
            CLI_INPUT,
            "%s: bits %g of %g, the highest %g, in %g x %g x %g pixels are no picture that is read", r->path,
            stored, allocated, high, r->of[COLUMNS], r->of[ROWS], r->of[FRAMES]);
    return CLI_DONE;
}

/* Finds the quantity of the values. A file of Skiagraph says it; others say at most whether values rise with the intensity. */
static int find_quantity(const reading *r, int32_t *quantity) {
    char relation[64] = "", maker[64] = "", comment[64] = "";
    (void)value_of(r, "(0028,1040)", relation);
    (void)value_of(r, "(0008,0070)", maker);
    (void)value_of(r, "(0020,4000)", comment);
    const int is_log = strncmp(relation, "LOG", 3) == 0, is_ours = strncmp(maker, "Skiagraph", 9) == 0;
    *quantity = -1;
    if (is_log && r->of[SIGN] < 0) {
        *quantity = SKG_QUANTITY_ATTENUATION;
        if (!is_ours)
            cli_note(
                "%s: its values are taken for -ln(I / I0); DICOM does not say to which base they are, and "
                "--quantity takes them otherwise",
                r->path);
    } else if (is_ours && strncmp(comment, "transmission", 12) == 0) {
        *quantity = SKG_QUANTITY_TRANSMISSION;
    } else if (is_log || r->of[SIGN] < 0) {
        return cli_error(
            CLI_INPUT,
            "%s: its values are %s the intensity (0028,1040 and 1041), and no zero or scale is said; convert it to a "
            ".mha of intensities or of -ln(I / I0)",
            r->path, is_log ? "logarithms that rise with" : "numbers that fall with");
    }
    return CLI_DONE;
}

/* A page of the file of pixels, little endian. */
static int read_pixels(const reading *r, int64_t page, double *values) {
    const int64_t pixels = (int64_t)r->of[ROWS] * (int64_t)r->of[COLUMNS],
                  bytes = r->of[ALLOCATED] > 8 ? 2 : 1;
    const int low = (int)(r->of[HIGH_BIT] - r->of[STORED]) + 1;
    const int32_t mask = (int32_t)((INT64_C(1) << (int)r->of[STORED]) - 1),
                  sign = r->of[SIGNED] != 0 ? mask / 2 + 1 : 0;
    unsigned char *raw = malloc((size_t)(pixels * bytes));
    FILE *stream = raw ? fopen(r->raw, "rb") : NULL;
    if (!raw) return cli_error(CLI_DEVICE, "out of host memory for %s", r->path);
    const int whole = stream && fseeko(stream, (off_t)(page * pixels * bytes), SEEK_SET) == 0 &&
                      fread(raw, (size_t)bytes, (size_t)pixels, stream) == (size_t)pixels;
    for (int64_t i = 0; whole && i < pixels; i++) {
        const int32_t word = bytes == 2 ? raw[2 * i] | raw[2 * i + 1] << 8 : raw[i];
        const int32_t stored = word >> low & mask;
        values[i] = (stored & sign ? stored - 2 * sign : stored) * r->of[SLOPE] + r->of[INTERCEPT];
    }
    if (stream) fclose(stream);
    free(raw);
    return whole ? CLI_DONE : cli_error(CLI_INPUT, "%s: has fewer pixels than its header says", r->path);
}

/* Of the pixels of the detector (ImagerPixelSpacing), whose first number is from row to row. */
static void read_spacing(const reading *r, double spacing_mm[2]) {
    char value[64] = "";
    double down = 0, across = 0;
    if (!value_of(r, "(0018,1164)", value) || sscanf(value, "%lf\\%lf", &down, &across) != 2) return;
    spacing_mm[0] = across, spacing_mm[1] = down;
}

/* values: NULL: only what the file holds. */
static int read_open(reading *r, int64_t page, skg_picture_contents *contents, double *values) {
    snprintf(r->plain, sizeof r->plain, "%.480s/plain.dcm", r->folder);
    snprintf(r->said, sizeof r->said, "%.480s/said", r->folder);
    snprintf(r->raw, sizeof r->raw, "%.480s/plain.dcm.0.raw", r->folder);
    int exit_status = decompress(r);
    if (exit_status == CLI_DONE) exit_status = take_apart(r);
    if (exit_status == CLI_DONE) exit_status = read_facts(r);
    if (exit_status == CLI_DONE) exit_status = find_quantity(r, &contents->quantity);
    if (exit_status != CLI_DONE) return exit_status;
    contents->columns = (int64_t)r->of[COLUMNS];
    contents->rows = (int64_t)r->of[ROWS];
    contents->pages = (int64_t)r->of[FRAMES];
    read_spacing(r, contents->spacing_mm);
    if (!values) return CLI_DONE;
    if (page < 0 || page >= contents->pages)
        return cli_error(CLI_INPUT, "%s: has %" PRId64 " frames, counted from 0, and no %" PRId64, r->path,
                         contents->pages, page);
    return read_pixels(r, page, values);
}

int cli_dicom_read(const char *path, int64_t page, skg_picture_contents *contents, double *values) {
    const char *temporary = getenv("TMPDIR");
    FILE *stream = fopen(path, "rb");
    if (!stream) return cli_error(CLI_INPUT, "%s: cannot be read: %s", path, strerror(errno));
    fclose(stream);
    if (!cli_has_program("dcmdump"))
        return cli_error(
            CLI_INPUT,
            "%s: needs the program dcmdump, which is not on PATH; install DCMTK (Debian: apt-get install dcmtk), or "
            "give a .mha, .tif or .png",
            path);
    reading *r = calloc(1, sizeof *r);
    if (!r) return cli_error(CLI_DEVICE, "out of host memory for %s", path);
    r->path = path;
    snprintf(r->folder, sizeof r->folder, "%.400s/skiagraph-dicom-XXXXXX",
             temporary && *temporary ? temporary : "/tmp");
    if (!mkdtemp(r->folder)) {
        const int reason = errno;
        free(r);
        return cli_error(CLI_OUTPUT, "a temporary folder cannot be made: %s; set TMPDIR", strerror(reason));
    }
    const int exit_status = read_open(r, page, contents, values);
    unlink(r->plain), unlink(r->said), unlink(r->raw);
    rmdir(r->folder);
    free(r);
    return exit_status;
}
