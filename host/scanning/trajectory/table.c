/* A table of poses from a text file. */
#include "core/files.h"
#include "core/text.h"
#include "trajectory/types.h"
#include "trajectory/writers.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

typedef struct {
    const char *path;
    int64_t count, capacity, line;
    double *poses;
    double radius; /* of a curved detector, which each line gives then */
    int64_t radii; /* lines that give it */
    int32_t beam;  /* enum skg_projection of a parallel beam that the first line names; -1: none */
} table;

static int is_skipped(const table *t, const char *text) {
    return !*text || *text == '#' || (t->count == 0 && isalpha((unsigned char)*text));
}

static const char *skip(const char *text, const char *what) {
    while (*text && (isspace((unsigned char)*text) || strchr(what, *text))) text++;
    return text;
}

/* The radius of a curved detector behind the numbers of a pose, in every line the same or in none. */
static skg_status read_radius(table *t, const char **text) {
    const char *end;
    const double radius = skg_read_number(*text, &end);
    if (end == *text && t->radii == 0) return SKG_OK;
    if (end == *text || t->radii != t->count || (t->count > 0 && radius != t->radius))
        return skg_fail(
            SKG_ERR_FORMAT,
            "%s: line %" PRId64
            ": behind the row step stands the radius of a curved detector, in every line the same",
            t->path, t->line);
    t->radius = radius;
    t->radii++;
    *text = skip(end, ",;");
    return SKG_OK;
}

/* The kind of beam, as skg_scan_geometry_save writes it into a comment before the poses. */
static void read_beam(table *t, const char *comment) {
    for (int32_t k = SKG_PROJECTION_PARALLEL_FROM_INFINITY; k > SKG_PROJECTION_POINT; k--) {
        const char *words = skg_scan_table_beams[k];
        if (strncmp(comment, words, strlen(words)) != 0) continue;
        t->beam = k;
        return;
    }
}

static skg_status read_line(table *t, const char *text) {
    text = skip(text, "");
    if (*text == '#' && t->count == 0) read_beam(t, skip(text + 1, ""));
    if (is_skipped(t, text)) return SKG_OK;
    if (t->count == t->capacity) {
        t->capacity = t->capacity ? 2 * t->capacity : 256;
        SKG_TRY(skg_realloc(t->capacity, SKG_POSE_NUMBERS * sizeof *t->poses, t->path, &t->poses));
    }
    for (int k = 0; k < SKG_POSE_NUMBERS; k++) {
        const char *end;
        t->poses[SKG_POSE_NUMBERS * t->count + k] = skg_read_number(text, &end);
        if (end == text)
            return skg_fail(SKG_ERR_FORMAT,
                            "%s: line %" PRId64 ": number %d of %d is missing; a line has x, y, z of source, "
                            "detector centre, column step and row step in mm",
                            t->path, t->line, k + 1, SKG_POSE_NUMBERS);
        text = skip(end, ",;");
    }
    SKG_TRY(read_radius(t, &text));
    if (*text)
        return skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 ": there are more than %d numbers and a radius",
                        t->path, t->line, SKG_POSE_NUMBERS);
    t->count++;
    return SKG_OK;
}

static skg_status read_lines(table *t, FILE *file) {
    char text[1024];
    while (fgets(text, sizeof text, file)) {
        t->line++;
        if (strlen(text) + 1 == sizeof text)
            return skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 " is too long", t->path, t->line);
        SKG_TRY(read_line(t, text));
    }
    if (ferror(file)) return skg_fail_unreadable(t->path, errno);
    if (t->count == 0) return skg_fail(SKG_ERR_FORMAT, "%s: there is no line with numbers", t->path);
    return SKG_OK;
}

skg_status skg_scan_load_table(const skg_view *view, const skg_scan_options *options, const char *path,
                               skg_scan **scan) {
    SKG_PLAIN;
    table t = {.path = path, .beam = -1};
    SKG_NEEDS(scan);
    *scan = NULL;
    SKG_NEEDS(path);
    FILE *file = NULL;
    SKG_TRY(skg_text_open(path, &file));
    skg_status status = read_lines(&t, file);
    fclose(file);
    skg_view ours;
    skg_view_init(&ours);
    if (status == SKG_OK) status = skg_struct_read(view, "skg_view", &ours, sizeof ours);
    if (t.radii > 0) ours.radius = t.radius;
    if (t.beam >= 0) ours.projection = t.beam;
    if (status == SKG_OK) status = skg_scan_create_table(&ours, options, t.count, t.poses, scan);
    skg_free(&t.poses);
    return status;
}
