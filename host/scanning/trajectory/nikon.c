/* Reads the geometry of a scan from the .xtekct file of a Nikon scanner. */
#include "core/files.h"
#include "core/maths.h"
#include "core/text.h"
#include "trajectory/types.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { LINE_LENGTH = 2048, NAME_LENGTH = 64, FOLDER_LENGTH = 512 };

typedef enum {
    PROJECTIONS,
    PIXELS_X,
    PIXELS_Y,
    PIXEL_X,
    PIXEL_Y,
    TO_OBJECT,
    TO_DETECTOR,
    INITIAL_ANGLE,
    ANGULAR_STEP,
    OBJECT_OFFSET,
    OBJECT_ROLL,
    OBJECT_TILT,
    CENTRE,
    CENTRE_TOP,
    CENTRE_BOTTOM,
    WHITE_LEVEL,
    KEYS
} key;

/* least: the smallest value that is possible; a required key has no default. */
static const struct {
    const char *name;
    int is_required;
    double least;
} keys[KEYS] = {[PROJECTIONS] = {"Projections", 1, 1},
                [PIXELS_X] = {"DetectorPixelsX", 1, 1},
                [PIXELS_Y] = {"DetectorPixelsY", 1, 1},
                [PIXEL_X] = {"DetectorPixelSizeX", 1, 1e-9},
                [PIXEL_Y] = {"DetectorPixelSizeY", 1, 1e-9},
                [TO_OBJECT] = {"SrcToObject", 1, 1e-9},
                [TO_DETECTOR] = {"SrcToDetector", 1, 1e-9},
                [INITIAL_ANGLE] = {"InitialAngle", 1, -HUGE_VAL},
                [ANGULAR_STEP] = {"AngularStep", 1, -HUGE_VAL},
                [OBJECT_OFFSET] = {"ObjectOffsetX", 0, -HUGE_VAL},
                [OBJECT_ROLL] = {"ObjectRoll", 0, -HUGE_VAL},
                [OBJECT_TILT] = {"ObjectTilt", 0, -HUGE_VAL},
                [CENTRE] = {"CentreOfRotation", 0, -HUGE_VAL},
                [CENTRE_TOP] = {"CentreOfRotationTop", 0, -HUGE_VAL},
                [CENTRE_BOTTOM] = {"CentreOfRotationBottom", 0, -HUGE_VAL},
                [WHITE_LEVEL] = {"WhiteLevel", 0, 0}};

/* Other keys that begin so would change the geometry. */
static const char *const geometric[] = {"Src",     "Detector", "Object", "Angular",
                                        "Initial", "Centre",   "Axis",   "Helical"};

typedef struct {
    const char *path;
    int is_elsewhere; /* in a section that is not XTekCT */
    int given[KEYS];
    double values[KEYS];
    char folder[FOLDER_LENGTH];
} nikon;

/* The text between two places without blanks around it; refused where it does not fit. */
static skg_status trim(const nikon *n, const char *from, const char *to, char *text, size_t size) {
    while (from < to && isspace((unsigned char)*from)) from++;
    while (to > from && isspace((unsigned char)to[-1])) to--;
    if ((size_t)(to - from) >= size)
        return skg_fail(SKG_ERR_FORMAT, "%s: a line has %d characters where up to %zu are read: %.40s...",
                        n->path, (int)(to - from), size - 1, from);
    memcpy(text, from, (size_t)(to - from));
    text[to - from] = '\0';
    return SKG_OK;
}

static int is_geometric(const char *name) {
    for (size_t i = 0; i < sizeof geometric / sizeof *geometric; i++)
        if (strncasecmp(name, geometric[i], strlen(geometric[i])) == 0) return 1;
    return 0;
}

static skg_status read_other(nikon *n, const char *name, const char *text) {
    const char *end;
    const double value = skg_read_number(text, &end);
    if (skg_same_name(name, "Units") && !skg_same_name(text, "mm"))
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: Units is %s; lengths are read in mm", n->path, text);
    if (end == text || value == 0 || !is_geometric(name)) return SKG_OK;
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "%s: %s is %s, and what it does to the geometry is not known here; set it to 0 and displace source or "
        "detector of the views, or give a table of poses (.csv)",
        n->path, name, text);
}

static skg_status read_number(nikon *n, key k, const char *text) {
    const char *end;
    const double value = skg_read_number(text, &end);
    if (end == text || *end || !isfinite(value))
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: %s is '%s'; a .xtekct of a circular scan has a finite number there", n->path,
                        keys[k].name, text);
    if (value < keys[k].least)
        return skg_fail(SKG_ERR_FORMAT, "%s: %s is %s; it is at least %g", n->path, keys[k].name, text,
                        keys[k].least);
    if (n->given[k] && n->values[k] != value)
        return skg_fail(SKG_ERR_FORMAT, "%s: %s is both %.17g and %s; leave one", n->path, keys[k].name,
                        n->values[k], text);
    n->given[k] = 1;
    n->values[k] = value;
    return SKG_OK;
}

static skg_status read_line(nikon *n, const char *line) {
    char name[NAME_LENGTH], text[FOLDER_LENGTH];
    const char *equals = strchr(line, '=');
    while (isspace((unsigned char)*line)) line++;
    if (*line == '[') n->is_elsewhere = strncasecmp(line, "[XTekCT]", 8) != 0;
    if (!equals || n->is_elsewhere) return SKG_OK;
    SKG_TRY(trim(n, line, equals, name, sizeof name));
    SKG_TRY(trim(n, equals + 1, equals + strlen(equals), text, sizeof text));
    if (skg_same_name(name, "InputFolderName")) memcpy(n->folder, text, sizeof text);
    for (key k = 0; k < KEYS; k++)
        if (skg_same_name(name, keys[k].name)) return read_number(n, k, text);
    return read_other(n, name, text);
}

static skg_status read_lines(nikon *n, FILE *file) {
    char line[LINE_LENGTH];
    while (fgets(line, sizeof line, file)) {
        if (strlen(line) + 1 == sizeof line)
            return skg_fail(SKG_ERR_FORMAT, "%s: a line is longer than %d characters", n->path,
                            LINE_LENGTH - 2);
        SKG_TRY(read_line(n, line));
    }
    return ferror(file) ? skg_fail_unreadable(n->path, errno) : SKG_OK;
}

static skg_status check(const nikon *n) {
    const double *v = n->values, mean = 0.5 * (v[CENTRE_TOP] + v[CENTRE_BOTTOM]);
    for (key k = 0; k < KEYS; k++)
        if (keys[k].is_required && !n->given[k])
            return skg_fail(SKG_ERR_FORMAT, "%s: %s is missing; a .xtekct of a circular scan has it", n->path,
                            keys[k].name);
    const key whole[] = {PROJECTIONS, PIXELS_X, PIXELS_Y};
    for (int i = 0; i < 3; i++)
        if (v[whole[i]] != floor(v[whole[i]]) || v[whole[i]] > SKG_SCAN_MAX)
            return skg_fail(SKG_ERR_FORMAT, "%s: %s is %g; give a whole number of 1 to %d", n->path,
                            keys[whole[i]].name, v[whole[i]], SKG_SCAN_MAX);
    if (!(v[TO_DETECTOR] > v[TO_OBJECT]))
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: SrcToDetector is %g mm and SrcToObject %g mm; the detector is behind the object",
                        n->path, v[TO_DETECTOR], v[TO_OBJECT]);
    if (v[CENTRE] != 0 && !n->given[OBJECT_OFFSET] && fabs(v[CENTRE] - mean) > 1e-6 * fabs(v[CENTRE]))
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: CentreOfRotation is %g, but CentreOfRotationTop and Bottom have the mean %g; set all to the same",
            n->path, v[CENTRE], mean);
    return SKG_OK;
}

/* In the frame of CIL's NikonDataReader, of which the axis passes the origin: z is up, y along the beam. */
static skg_status make_scan(const nikon *n, skg_scan **scan) {
    const double *v = n->values, *top = &v[CENTRE_TOP], *bottom = &v[CENTRE_BOTTOM];
    const double offset =
        n->given[OBJECT_OFFSET] ? v[OBJECT_OFFSET] : 0.5 * (*top + *bottom) * v[TO_OBJECT] / v[TO_DETECTOR];
    const double roll = n->given[OBJECT_ROLL] ? v[OBJECT_ROLL] * SKG_PI / 180
                                              : -atan2(*top - *bottom, v[PIXELS_Y] * v[PIXEL_Y]);
    const double tilt = -v[OBJECT_TILT] * SKG_PI / 180;
    skg_view view;
    skg_scan_options options;
    skg_view_init(&view);
    skg_scan_options_init(&options);
    view.columns = (int64_t)v[PIXELS_X], view.rows = (int64_t)v[PIXELS_Y];
    view.source[0] = view.centre[0] = offset;
    view.source[1] = -v[TO_OBJECT], view.centre[1] = v[TO_DETECTOR] - v[TO_OBJECT];
    view.column_step[0] = -v[PIXEL_X], view.row_step[2] = -v[PIXEL_Y];
    options.projections = (int64_t)v[PROJECTIONS];
    options.start_rad = (180 - v[INITIAL_ANGLE]) * SKG_PI / 180;
    options.step_rad = -v[ANGULAR_STEP] * SKG_PI / 180;
    options.axis[0] = sin(roll); /* z, rolled about y, then tilted about x */
    options.axis[1] = -sin(tilt) * cos(roll);
    options.axis[2] = cos(tilt) * cos(roll);
    return skg_scan_create(&view, &options, scan);
}

skg_status skg_scan_load_xtekct(const char *path, double *white_level, char *folder, int64_t size,
                                skg_scan **scan) {
    SKG_PLAIN;
    nikon n = {.path = path};
    FILE *file = NULL;
    SKG_NEEDS(scan);
    *scan = NULL;
    SKG_NEEDS(path);
    SKG_TRY(skg_text_open(path, &file));
    skg_status status = read_lines(&n, file);
    fclose(file);
    SKG_TRY(status);
    SKG_TRY(check(&n));
    if (white_level) *white_level = n.values[WHITE_LEVEL];
    if (folder && snprintf(folder, (size_t)size, "%s", n.folder) >= size)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: InputFolderName has %zu bytes, more than %" PRId64, path,
                        strlen(n.folder), size - 1);
    return make_scan(&n, scan);
}
