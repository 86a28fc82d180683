/* Wavefront OBJ. Vertex i is the i-th line "v"; triangles are in the order of the lines "f". Normals, textures
 * and materials do not change path lengths and are skipped. Objects and groups become named pieces. */
#include "core/files.h"
#include "mesh/read.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    const skg_mesh_file *file;
    const char *at;
    int64_t line;
} cursor;

static skg_status fail(const cursor *here, const char *reason) {
    return skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 ": %s", here->file->name, here->line, reason);
}

/* The length of a backslash with the end of line that it cancels; 0 if there is none here. */
static int continuation(const char *c) {
    if (c[0] != '\\') return 0;
    if (c[1] == '\r') return c[2] == '\n' ? 3 : 2;
    return c[1] == '\n' ? 2 : 0;
}

/* Goes to the next word of the line, across continuations. Returns 0 if there is none. A line ends by LF, CR LF, or CR alone. */
static int next_word(cursor *here) {
    for (;;) {
        const char *c = here->at;
        const int length = continuation(c);
        if (!length && *c != ' ' && *c != '\t') return *c != '\0' && *c != '\n' && *c != '\r' && *c != '#';
        here->at += length ? length : 1;
        here->line += length != 0;
    }
}

static int is_end(char c) {
    return c == '\0' || c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\\' || c == '#';
}

static void skip_line(cursor *here) {
    while (next_word(here)) do {
            here->at++; /* a word has at least one character, which may be a backslash */
        } while (!is_end(*here->at) || (*here->at == '\\' && !continuation(here->at)));
    here->at += strcspn(here->at, "\r\n"); /* a comment */
    if (here->at[0] == '\r' && here->at[1] == '\n') here->at++;
    if (*here->at != '\0') here->at++;
    here->line++;
}

/* Reads "v x y z" from behind the "v". A weight or colours may follow. */
static skg_status read_vertex(cursor *here, skg_mesh_arrays *arrays) {
    double position[3];
    for (int k = 0; k < 3; k++) {
        char *end = NULL;
        if (next_word(here)) position[k] = strtod(here->at, &end);
        if (!end || end == here->at || !is_end(*end))
            return fail(here, "a vertex is \"v\" and three numbers");
        here->at = end;
    }
    return skg_mesh_add_vertex(arrays, position);
}

/* Reads "f v v v ...", "f v/vt ...", "f v/vt/vn ..." or "f v//vn ..." from behind the "f". Vertices count from 1, or
 * from the last one back as -1, -2, ... */
static skg_status read_face(cursor *here, skg_mesh_arrays *arrays) {
    skg_polygon polygon = {0};
    while (next_word(here)) {
        char *end;
        errno = 0;
        long long number = strtoll(here->at, &end, 10);
        if (end == here->at || (!is_end(*end) && *end != '/') || errno != 0 || number == 0)
            return fail(here, "a face is \"f\" and vertex numbers, which count from 1 (or back from -1)");
        int64_t vertex = number > 0 ? number - 1 : arrays->vertices + number;
        if (vertex < 0 || vertex >= SKG_MESH_LIMIT)
            return skg_fail(SKG_ERR_MESH, "%s: line %" PRId64 ": vertex %lld of %" PRId64, here->file->name,
                            here->line, number, arrays->vertices);
        SKG_TRY(skg_mesh_add_corner(arrays, &polygon, vertex));
        while (!is_end(*end)) end++;
        here->at = end;
    }
    return polygon.corners < 3 ? fail(here, "a face of fewer than three corners; truncated?") : SKG_OK;
}

/* Reads "o NAME" or "g NAME NAME ..." from behind the letter: all of the line is one name. */
static skg_status read_name(cursor *here, int is_group, skg_mesh_arrays *arrays) {
    char *name = NULL;
    size_t length = 0;
    if (next_word(here)) length = strcspn(here->at, "\r\n");
    while (length > 0 && strchr(" \t", here->at[length - 1])) length--;
    SKG_TRY(skg_alloc((int64_t)length + 1, 1, here->file->name, &name));
    memcpy(name, here->at, length);
    const skg_status status = is_group ? skg_mesh_begin_group(arrays, length ? name : "default")
                                       : skg_mesh_begin_object(arrays, length ? name : "default");
    skg_free(&name);
    return status;
}

static int is_keyword(const cursor *here, char word) {
    return here->at[0] == word && is_end(here->at[1]);
}

skg_status skg_mesh_read_obj(const skg_mesh_file *file, skg_mesh_arrays *arrays) {
    cursor here = {file, file->bytes, 1};
    size_t mark = 0;
    SKG_TRY(skg_text_mark(file->name, file->bytes, (size_t)file->size, &mark));
    here.at += mark;
    if (strlen(file->bytes) != (size_t)file->size)
        return skg_fail(SKG_ERR_FORMAT, "%s: not an OBJ file: it holds a zero byte", file->name);
    while (*here.at != '\0') {
        if (next_word(&here)) {
            if (is_keyword(&here, 'v')) {
                here.at++;
                SKG_TRY(read_vertex(&here, arrays));
            } else if (is_keyword(&here, 'f')) {
                here.at++;
                SKG_TRY(read_face(&here, arrays));
            } else if (is_keyword(&here, 'o') || is_keyword(&here, 'g')) {
                const int is_group = *here.at++ == 'g';
                SKG_TRY(read_name(&here, is_group, arrays));
            } else if (is_keyword(&here, 'l') || is_keyword(&here, 'p'))
                arrays->left_out++;
        }
        skip_line(&here);
    }
    return SKG_OK;
}
