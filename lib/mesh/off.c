/* Object File Format (Geomview). A line has a vertex, or a face: the number of its corners, their vertices, which count from 0, and maybe
 * a colour. Normals, colours and textures do not change path lengths and are skipped. */
#include "core/files.h"
#include "core/text.h"
#include "mesh/read.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    const skg_mesh_file *file;
    const char *at;
} cursor;

static const char blanks[] = " \t\r\v\f";

/* Goes to the next word of the line. Returns 0 if there is none. */
static int next_word(cursor *here) {
    here->at += strspn(here->at, blanks);
    return *here->at != '\0' && *here->at != '\n' && *here->at != '#';
}

static void skip_line(cursor *here) {
    here->at += strcspn(here->at, "\n");
    if (*here->at == '\n') here->at++;
}

/* Goes to the next word of the file. Returns 0 if there is none. */
static int next_line(cursor *here) {
    while (!next_word(here)) {
        if (*here->at == '\0') return 0;
        skip_line(here);
    }
    return 1;
}

static int is_end(char c) {
    return c == '\0' || c == '\n' || c == '#' || strchr(blanks, c) != NULL;
}

/* A whole number of the line, or a number. Both return 0 if there is none. */
static int take_whole(cursor *here, int64_t *number) {
    char *end = NULL;
    if (!next_word(here)) return 0;
    *number = strtoll(here->at, &end, 10);
    if (end == here->at || !is_end(*end)) return 0;
    here->at = end;
    return 1;
}

static int take_number(cursor *here, double *number) {
    char *end = NULL;
    if (!next_word(here)) return 0;
    *number = strtod(here->at, &end);
    if (end == here->at || !is_end(*end)) return 0;
    here->at = end;
    return 1;
}

/* "OFF" with letters in front for what a vertex has besides its place, and the numbers of vertices and faces; that of the edges is
 * not used. Files without the word are OFF, too. */
static skg_status read_head(cursor *here, int64_t *vertices, int64_t *faces) {
    const skg_mesh_file *file = here->file;
    char word[8] = "";
    if (next_line(here))
        snprintf(word, sizeof word, "%.*s", (int)strcspn(here->at, " \t\r\n\v\f#"), here->at);
    const size_t length = strlen(word);
    if (length >= 3 && strcmp(word + length - 3, "OFF") == 0) {
        if (strspn(word, "STCN") != length - 3)
            return skg_fail(SKG_ERR_UNSUPPORTED,
                            "%s: its head is \"%s\": vertices of other than 3 dimensions are not read; "
                            "convert it to .ply or .stl",
                            file->name, word);
        here->at += length;
        if (next_word(here) && strncmp(here->at, "BINARY", 6) == 0)
            return skg_fail(SKG_ERR_UNSUPPORTED,
                            "%s: is binary OFF, which is not read; convert it to .ply or .stl", file->name);
    }
    if (next_line(here) && take_whole(here, vertices) && take_whole(here, faces) && *vertices >= 0 &&
        *faces >= 0) {
        skip_line(here);
        return SKG_OK;
    }
    return skg_fail(
        SKG_ERR_FORMAT,
        "%s: not an OFF file: it does not begin with OFF and the numbers of its vertices, faces and edges",
        file->name);
}

static skg_status cut_off(const cursor *here, const char *what, int64_t number, int64_t count) {
    return skg_fail(SKG_ERR_FORMAT, "%s: truncated or damaged: %s %" PRId64 " of %" PRId64 " cannot be read",
                    here->file->name, what, number, count);
}

static skg_status read_vertex(cursor *here, int64_t number, int64_t count, skg_mesh_arrays *arrays) {
    double position[3];
    if (!next_line(here)) return cut_off(here, "vertex", number, count);
    for (int k = 0; k < 3; k++)
        if (!take_number(here, &position[k])) return cut_off(here, "vertex", number, count);
    skip_line(here);
    return skg_mesh_add_vertex(arrays, position);
}

static skg_status read_face(cursor *here, int64_t number, int64_t count, skg_mesh_arrays *arrays) {
    skg_polygon polygon = {0};
    int64_t corners = 0, vertex = 0;
    if (!next_line(here) || !take_whole(here, &corners) || corners < 1)
        return cut_off(here, "face", number, count);
    for (int64_t k = 0; k < corners; k++) {
        if (!take_whole(here, &vertex)) return cut_off(here, "face", number, count);
        if (vertex < 0 || vertex >= arrays->vertices)
            return skg_fail(SKG_ERR_MESH,
                            "%s: face %" PRId64 " names vertex %" PRId64
                            ", but vertices run from 0 to %" PRId64,
                            here->file->name, number, vertex, arrays->vertices - 1);
        if (corners >= 3) SKG_TRY(skg_mesh_add_corner(arrays, &polygon, vertex));
    }
    arrays->left_out += corners < 3;
    skip_line(here);
    return SKG_OK;
}

skg_status skg_mesh_read_off(const skg_mesh_file *file, skg_mesh_arrays *arrays) {
    cursor here = {.file = file, .at = file->bytes};
    int64_t vertices = 0, faces = 0;
    size_t mark = 0;
    SKG_TRY(skg_text_mark(file->name, file->bytes, (size_t)file->size, &mark));
    here.at += mark;
    SKG_TRY(read_head(&here, &vertices, &faces));
    if (strlen(file->bytes) != (size_t)file->size)
        return skg_fail(SKG_ERR_FORMAT, "%s: not an OFF file: it holds a zero byte", file->name);
    for (int64_t k = 0; k < vertices; k++) SKG_TRY(read_vertex(&here, k, vertices, arrays));
    for (int64_t k = 0; k < faces; k++) SKG_TRY(read_face(&here, k, faces, arrays));
    if (next_line(&here))
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: has lines behind its last face, number %" PRId64
                        "; are the numbers in its head those of its vertices and faces?",
                        file->name, faces - 1);
    return SKG_OK;
}
