/* PLY, ascii or binary in either byte order, with any scalar types. Other elements and properties are skipped. */
#include "core/files.h"
#include "mesh/read.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ELEMENTS_MAX = 32, PROPERTIES_MAX = 256 };

typedef enum { NO_TYPE, INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64 } scalar;

static const struct {
    const char *name;
    scalar type;
} type_names[] = {{"char", INT8},     {"int8", INT8},       {"uchar", UINT8},    {"uint8", UINT8},
                  {"short", INT16},   {"int16", INT16},     {"ushort", UINT16},  {"uint16", UINT16},
                  {"int", INT32},     {"int32", INT32},     {"uint", UINT32},    {"uint32", UINT32},
                  {"float", FLOAT32}, {"float32", FLOAT32}, {"double", FLOAT64}, {"float64", FLOAT64}};

typedef enum { NO_ROLE, X, Y, Z, CORNERS, STRIPS } role;

typedef struct {
    scalar type;
    scalar count_type; /* of the length of a list; NO_TYPE: this is no list */
    role meaning;
} property;

typedef struct {
    char name[64];
    int64_t count;
    int first, last; /* properties [first, last) */
} element;

typedef struct {
    const skg_mesh_file *file;
    const char *at, *end;
    int ascii, swapped;
    element elements[ELEMENTS_MAX];
    property properties[PROPERTIES_MAX];
    int element_count, property_count;
} ply;

static scalar type_of(const char *name) {
    for (size_t i = 0; i < sizeof type_names / sizeof *type_names; i++)
        if (strcmp(name, type_names[i].name) == 0) return type_names[i].type;
    return NO_TYPE;
}

static skg_status bad_line(const ply *in, const char *line) {
    return skg_fail(SKG_ERR_FORMAT, "%s: not a PLY header: \"%s\"", in->file->name, line);
}

static skg_status read_format(ply *in, const char *line, const char *format) {
    const uint16_t one = 1;
    unsigned char little;
    memcpy(&little, &one, 1);
    if (strcmp(format, "ascii") == 0)
        in->ascii = 1;
    else if (strcmp(format, "binary_little_endian") == 0)
        in->swapped = !little;
    else if (strcmp(format, "binary_big_endian") == 0)
        in->swapped = little;
    else
        return bad_line(in, line);
    return SKG_OK;
}

/* Reads "property TYPE NAME" or "property list COUNT_TYPE TYPE NAME". */
static skg_status read_property(ply *in, const char *line) {
    char word[3][64] = {"", "", ""};
    property found = {0};
    const char *name;
    if (in->element_count == 0) return bad_line(in, line);
    element *owner = &in->elements[in->element_count - 1];
    if (sscanf(line, "property list %63s %63s %63s", word[0], word[1], word[2]) == 3) {
        found.count_type = type_of(word[0]);
        found.type = type_of(word[1]);
        name = word[2];
        if (found.count_type == NO_TYPE) return bad_line(in, line);
        if (strcmp(owner->name, "face") == 0 &&
            (strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0))
            found.meaning = CORNERS;
        if (strcmp(owner->name, "tristrips") == 0 && strcmp(name, "vertex_indices") == 0)
            found.meaning = STRIPS;
    } else if (sscanf(line, "property %63s %63s", word[0], word[1]) == 2) {
        found.type = type_of(word[0]);
        name = word[1];
        if (strcmp(owner->name, "vertex") == 0 && strlen(name) == 1 && strchr("xyz", *name))
            found.meaning = (role)(X + (*name - 'x'));
    } else
        return bad_line(in, line);
    if (found.type == NO_TYPE) return bad_line(in, line);
    if (in->property_count == PROPERTIES_MAX)
        return skg_fail(SKG_ERR_FORMAT, "%s: more than %d properties", in->file->name, PROPERTIES_MAX);
    in->properties[in->property_count++] = found;
    owner->last = in->property_count;
    return SKG_OK;
}

static skg_status read_element(ply *in, const char *line) {
    if (in->element_count == ELEMENTS_MAX)
        return skg_fail(SKG_ERR_FORMAT, "%s: more than %d elements", in->file->name, ELEMENTS_MAX);
    element *found = &in->elements[in->element_count];
    if (sscanf(line, "element %63s %" SCNd64, found->name, &found->count) != 2 || found->count < 0)
        return bad_line(in, line);
    found->first = found->last = in->property_count;
    in->element_count++;
    return SKG_OK;
}

static skg_status read_header(ply *in) {
    for (int64_t number = 0;; number++) {
        char line[256], word[64] = "", format[64] = "";
        size_t length = strcspn(in->at, "\n");
        if (in->at[length] != '\n')
            return skg_fail(SKG_ERR_FORMAT, "%s: truncated: a PLY header ends with \"end_header\"",
                            in->file->name);
        snprintf(line, sizeof line, "%.*s", (int)(length < sizeof line ? length : sizeof line - 1), in->at);
        if (length > 0 && length < sizeof line && line[length - 1] == '\r') line[length - 1] = '\0';
        in->at += length + 1;
        sscanf(line, "%63s %63s", word, format);
        if (number == 0 && strcmp(word, "ply") != 0) return bad_line(in, line);
        if (strcmp(word, "end_header") == 0) return SKG_OK;
        if (strcmp(word, "format") == 0) SKG_TRY(read_format(in, line, format));
        if (strcmp(word, "element") == 0) SKG_TRY(read_element(in, line));
        if (strcmp(word, "property") == 0) SKG_TRY(read_property(in, line));
    }
}

/* Reads the bytes of `raw` as a value of the type. */
#define TAKE(ctype)                                                                                          \
    do {                                                                                                     \
        ctype taken;                                                                                         \
        memcpy(&taken, raw, sizeof taken);                                                                   \
        *value = (double)taken;                                                                              \
    } while (0)

static int read_binary(ply *in, scalar type, double *value) {
    static const int sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
    unsigned char raw[8];
    int size = sizes[type];
    if (in->end - in->at < size) return 0;
    for (int i = 0; i < size; i++) raw[in->swapped ? size - 1 - i : i] = (unsigned char)in->at[i];
    in->at += size;
    switch (type) {
    case INT8:
        TAKE(int8_t);
        break;
    case UINT8:
        TAKE(uint8_t);
        break;
    case INT16:
        TAKE(int16_t);
        break;
    case UINT16:
        TAKE(uint16_t);
        break;
    case INT32:
        TAKE(int32_t);
        break;
    case UINT32:
        TAKE(uint32_t);
        break;
    case FLOAT32:
        TAKE(float);
        break;
    default:
        TAKE(double);
    }
    return 1;
}

/* Returns 0 if the file ends here or holds no number. */
static int read_value(ply *in, scalar type, double *value) {
    if (!in->ascii) return read_binary(in, type, value);
    char *end;
    *value = strtod(in->at, &end);
    if (end == in->at) return 0;
    if (type == FLOAT32) *value = (double)(float)*value;
    in->at = end;
    return 1;
}

static skg_status cut_off(const ply *in, const element *what, int64_t number) {
    return skg_fail(SKG_ERR_FORMAT, "%s: truncated or damaged: %s %" PRId64 " of %" PRId64 " cannot be read",
                    in->file->name, what->name, number, what->count);
}

/* A strip of triangles, of which each shares two corners with the one before and runs the other way around; -1 begins another. */
typedef struct {
    int64_t corners; /* so far */
    int64_t last[2];
} strip;

static skg_status add_to_strip(skg_mesh_arrays *arrays, strip *s, int64_t vertex) {
    if (vertex < 0) {
        s->corners = 0;
        return SKG_OK;
    }
    const int64_t a = s->last[0], b = s->last[1];
    const int odd = (int)(s->corners % 2);
    s->last[0] = b, s->last[1] = vertex;
    if (s->corners++ < 2 || a == b || b == vertex || a == vertex)
        return SKG_OK; /* flat ones only join strips */
    skg_polygon triangle = {0};
    SKG_TRY(skg_mesh_add_corner(arrays, &triangle, odd ? b : a));
    SKG_TRY(skg_mesh_add_corner(arrays, &triangle, odd ? a : b));
    return skg_mesh_add_corner(arrays, &triangle, vertex);
}

static skg_status read_list(ply *in, const property *list, const element *owner, int64_t number,
                            skg_mesh_arrays *arrays) {
    double length, value;
    skg_polygon polygon = {0};
    strip triangles = {0};
    const int is_strip = list->meaning == STRIPS;
    if (!read_value(in, list->count_type, &length) || !(length >= 0 && length <= INT32_MAX))
        return cut_off(in, owner, number);
    for (int64_t i = 0; i < (int64_t)length; i++) {
        if (!read_value(in, list->type, &value)) return cut_off(in, owner, number);
        if (list->meaning != CORNERS && !is_strip) continue;
        if (!(fabs(value) <= UINT32_MAX)) return cut_off(in, owner, number);
        if ((value < 0 && !(is_strip && value == -1)) || value >= SKG_MESH_LIMIT)
            return skg_fail(SKG_ERR_MESH, "%s: face %" PRId64 " names vertex %.0f", in->file->name, number,
                            value);
        SKG_TRY(is_strip ? add_to_strip(arrays, &triangles, (int64_t)value)
                         : skg_mesh_add_corner(arrays, &polygon, (int64_t)value));
    }
    if (list->meaning == CORNERS && polygon.corners < 3) arrays->left_out++;
    return SKG_OK;
}

static skg_status read_instances(ply *in, const element *what, skg_mesh_arrays *arrays) {
    int is_vertex = strcmp(what->name, "vertex") == 0;
    for (int64_t i = 0; i < what->count && what->last > what->first; i++) {
        double position[3] = {0, 0, 0}, value;
        for (int p = what->first; p < what->last; p++) {
            const property *here = &in->properties[p];
            if (here->count_type != NO_TYPE) {
                SKG_TRY(read_list(in, here, what, i, arrays));
                continue;
            }
            if (!read_value(in, here->type, &value)) return cut_off(in, what, i);
            if (here->meaning != NO_ROLE) position[here->meaning - X] = value;
        }
        if (is_vertex) SKG_TRY(skg_mesh_add_vertex(arrays, position));
    }
    return SKG_OK;
}

/* A mesh needs x, y and z of its vertices, and the corners of its faces. */
static skg_status check_roles(const ply *in) {
    int seen[STRIPS + 1] = {0};
    for (int p = 0; p < in->property_count; p++) seen[in->properties[p].meaning]++;
    if (seen[X] == 1 && seen[Y] == 1 && seen[Z] == 1 && seen[CORNERS] + seen[STRIPS] > 0 && seen[CORNERS] < 2)
        return SKG_OK;
    return skg_fail(
        SKG_ERR_FORMAT,
        "%s: not a triangle mesh: needs vertices with x, y, z and faces or tristrips with a list vertex_indices",
        in->file->name);
}

skg_status skg_mesh_read_ply(const skg_mesh_file *file, skg_mesh_arrays *arrays) {
    ply in = {.file = file, .at = file->bytes, .end = file->bytes + file->size};
    size_t mark = 0;
    SKG_TRY(skg_text_mark(file->name, file->bytes, (size_t)file->size, &mark));
    in.at += mark;
    SKG_TRY(read_header(&in));
    SKG_TRY(check_roles(&in));
    for (int e = 0; e < in.element_count; e++) SKG_TRY(read_instances(&in, &in.elements[e], arrays));
    return SKG_OK;
}
