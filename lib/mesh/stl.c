/* STL, binary and ascii. Corner i of the file is vertex i. */
#include "mesh/read.h"

#include "core/files.h"
#include "core/text.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Bytes: a header of 80 of text and a count; a record of a normal, three corners and an attribute. */
enum { HEADER = 84, RECORD = 50 };

static uint32_t number_at(const char *bytes) {
    const unsigned char *b = (const unsigned char *)bytes;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static double float_at(const char *bytes) {
    uint32_t bits = number_at(bytes);
    float x;
    memcpy(&x, &bits, sizeof x);
    return (double)x;
}

static skg_status add(skg_mesh_arrays *arrays, skg_polygon *facet, const double position[3]) {
    SKG_TRY(skg_mesh_add_corner(arrays, facet, arrays->vertices));
    return skg_mesh_add_vertex(arrays, position);
}

static skg_status read_binary(const skg_mesh_file *file, int64_t count, skg_mesh_arrays *arrays) {
    for (int64_t t = 0; t < count; t++) {
        skg_polygon facet = {0};
        for (int c = 1; c <= 3; c++) {
            const char *corner = file->bytes + HEADER + RECORD * t + 12 * c;
            double position[3] = {float_at(corner), float_at(corner + 4), float_at(corner + 8)};
            SKG_TRY(add(arrays, &facet, position));
        }
    }
    return SKG_OK;
}

typedef struct {
    const skg_mesh_file *file;
    const char *at;
    int64_t line;
    char word[16]; /* cut off where it is longer, as no word of STL is */
} cursor;

static skg_status fail(const cursor *here, const char *reason) {
    return skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 ": %s", here->file->name, here->line, reason);
}

static void skip_space(cursor *here) {
    for (; *here->at && strchr(" \t\r\n\v\f", *here->at); here->at++) here->line += *here->at == '\n';
}

/* Returns 0 at the end of the file. "end solid" is one word. */
static int next_word(cursor *here) {
    skip_space(here);
    const size_t blanks = strncasecmp(here->at, "end", 3) == 0 ? strspn(here->at + 3, " \t") : 0;
    if (blanks > 0) {
        const char *rest = here->at + 3 + blanks;
        const size_t length = strcspn(rest, " \t\r\n\v\f");
        snprintf(here->word, sizeof here->word, "end%.*s", (int)(length < 12 ? length : 12), rest);
        here->at = rest + length;
        return 1;
    }
    size_t length = strcspn(here->at, " \t\r\n\v\f");
    size_t kept = length < sizeof here->word ? length : sizeof here->word - 1;
    memcpy(here->word, here->at, kept);
    here->word[kept] = '\0';
    here->at += length;
    return length > 0;
}

static skg_status read_numbers(cursor *here, double number[3]) {
    for (int k = 0; k < 3; k++) {
        char *end;
        skip_space(here);
        number[k] = strtod(here->at, &end);
        if (end == here->at || (*end && !strchr(" \t\r\n\v\f", *end)))
            return fail(here, "three numbers are needed");
        here->at = end;
    }
    return SKG_OK;
}

static skg_status read_facet(cursor *here, skg_mesh_arrays *arrays) {
    skg_polygon facet = {0};
    double number[3];
    while (next_word(here)) {
        if (skg_same_name(here->word, "endfacet"))
            return facet.corners < 3 ? fail(here, "a facet of fewer than three corners") : SKG_OK;
        if (skg_same_name(here->word, "vertex")) {
            SKG_TRY(read_numbers(here, number));
            SKG_TRY(add(arrays, &facet, number));
        } else if (skg_same_name(here->word, "normal"))
            SKG_TRY(read_numbers(here, number)); /* not used: the order of the corners gives the normal */
        else if (!skg_same_name(here->word, "outer") && !skg_same_name(here->word, "loop") &&
                 !skg_same_name(here->word, "endloop"))
            return fail(here, "not a word that a facet may hold");
    }
    return fail(here, "truncated: a facet ends with \"endfacet\"");
}

static skg_status read_text(const skg_mesh_file *file, size_t start, skg_mesh_arrays *arrays) {
    cursor here = {.file = file, .at = file->bytes + start, .line = 1};
    int in_solid = 0;
    while (next_word(&here)) {
        if (skg_same_name(here.word, "facet") && in_solid)
            SKG_TRY(read_facet(&here, arrays));
        else if (skg_same_name(here.word, in_solid ? "endsolid" : "solid")) {
            in_solid = !in_solid;
            here.at += strcspn(here.at, "\n"); /* skips the name */
        } else
            return fail(&here, in_solid ? "neither \"facet\" nor \"endsolid\"" : "no \"solid\"");
    }
    return in_solid ? fail(&here, "truncated: a solid ends with \"endsolid\"") : SKG_OK;
}

/* Whether a file is text that begins with "solid", in any case, behind a mark and blanks. Some programs begin binary files with it,
 * too, but those hold zero bytes. *start: where the text begins behind the mark. */
static skg_status is_text(const skg_mesh_file *file, int *result, size_t *start) {
    char word[6] = "";
    *result = 0;
    if (strlen(file->bytes) != (size_t)file->size) return SKG_OK;
    SKG_TRY(skg_text_mark(file->name, file->bytes, (size_t)file->size, start));
    const char *at = file->bytes + *start;
    memcpy(word, at + strspn(at, " \t\r\n\v\f"), strnlen(at + strspn(at, " \t\r\n\v\f"), 5));
    *result = skg_same_name(word, "solid");
    return SKG_OK;
}

skg_status skg_mesh_read_stl(const skg_mesh_file *file, skg_mesh_arrays *arrays) {
    const int64_t said = file->size < HEADER ? -1 : (int64_t)number_at(file->bytes + 80);
    const int64_t wanted = HEADER + RECORD * said;
    int is_ascii = 0;
    size_t start = 0;
    if (said >= 0 && file->size == wanted) return read_binary(file, said, arrays);
    SKG_TRY(is_text(file, &is_ascii, &start));
    if (is_ascii) return read_text(file, start, arrays);
    /* Further whole records would be triangles that the header does not count. */
    if (said > 0 && file->size > wanted && (file->size - wanted) % RECORD != 0) {
        arrays->trailing = file->size - wanted;
        return read_binary(file, said, arrays);
    }
    if (said < 0)
        return skg_fail(SKG_ERR_FORMAT, "%s: truncated: %" PRId64 " bytes are no STL (%d at least)",
                        file->name, file->size, HEADER);
    return skg_fail(SKG_ERR_FORMAT,
                    "%s: %s: its header counts %" PRId64 " triangles, its %" PRId64
                    " bytes are enough for %" PRId64,
                    file->name, file->size < wanted ? "truncated" : "not a binary STL", said, file->size,
                    (file->size - HEADER) / RECORD);
}
