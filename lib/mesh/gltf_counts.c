/* Counts what the nodes of a glTF file (1 or 2) place, and holds the lengths that it announces against the bytes that it has. */
#include "mesh/gltf_counts.h"

#include "mesh/gltf_unread.h"
#include "mesh/instances.h"

#include <jansson.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum {
    DEEPEST = 1000,         /* levels of nodes that Assimp follows well within the stack of a thread */
    FREE_LENGTH = 64 << 20, /* bytes of zeros that a file may announce, whatever its length */
    VALUE = 16,             /* bytes of an attribute of a vertex in Assimp's memory, at most */
    CORNER = 48             /* and of a corner, as a face of its own */
};

typedef struct {
    const char *path;
    int64_t size;
    int64_t binary; /* bytes of the chunk of the first buffer; -1: none */
    json_t *root;
    skg_instances parts;
} gltf;

/* A length; what is not there counts as 0. */
static double length_of(const json_t *owner, const char *name) {
    const double length = json_number_value(json_object_get(owner, name));
    return length > 0 ? length : 0;
}

static skg_status fail_lengths(const gltf *g, const char *what, const char *name, double says, double has) {
    return skg_fail(
        SKG_ERR_FORMAT,
        "%s: no valid glTF file: the %s \"%s\" is %.15g bytes long by its text, and has %.15g; save the file "
        "anew with the program that made it",
        g->path, what, name, says, has);
}

/* The bytes behind a buffer; -1: of a file that cannot be looked at, which Assimp refuses. */
static double bytes_behind(const gltf *g, const json_t *buffer) {
    const char *uri = json_string_value(json_object_get(buffer, "uri")), *slash = strrchr(g->path, '/');
    char path[PATH_MAX];
    struct stat about;
    if (!uri) return (double)g->binary;
    if (strncmp(uri, "data:", 5) ==
        0) { /* base64; version 1 writes "data:," for the binary part of the file itself */
        const double text = .75 * (double)strlen(uri);
        return text > (double)g->binary ? text : (double)g->binary;
    }
    snprintf(path, sizeof path, "%.*s%s", slash ? (int)(slash + 1 - g->path) : 0, g->path, uri);
    return stat(path, &about) == 0 ? (double)about.st_size : -1;
}

static skg_status check_buffer(gltf *g, const char *name, const json_t *buffer) {
    const double says = length_of(buffer, "byteLength"), has = bytes_behind(g, buffer);
    return has >= 0 && says > has ? fail_lengths(g, "buffer", name, says, has) : SKG_OK;
}

static skg_status check_view(gltf *g, const char *name, const json_t *view) {
    const json_t *buffer = skg_gltf_find(g->root, "buffers", json_object_get(view, "buffer"));
    const double says = length_of(view, "byteOffset") + length_of(view, "byteLength");
    const double has = length_of(buffer, "byteLength");
    return buffer && says > has ? fail_lengths(g, "bufferView", name, says, has) : SKG_OK;
}

/* Bytes of one value of an accessor (glTF 2.0, 3.6.2). */
static double value_bytes(const json_t *accessor) {
    static const struct {
        const char *type;
        int count;
    } types[] = {{"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    const json_int_t component = json_integer_value(json_object_get(accessor, "componentType"));
    const char *type = json_string_value(json_object_get(accessor, "type"));
    double bytes = component >= 5125 ? 4 : component >= 5122 ? 2 : 1; /* UNSIGNED_INT, FLOAT; SHORT */
    for (size_t k = 0; type && k < sizeof types / sizeof *types; k++)
        if (strcmp(type, types[k].type) == 0) bytes *= types[k].count;
    return bytes;
}

/* Accessors without bytes of their own are zeros; a file may announce a multiple of its length of them. */
static skg_status check_accessor(gltf *g, const char *name, const json_t *accessor) {
    const json_t *view = skg_gltf_find(g->root, "bufferViews", json_object_get(accessor, "bufferView"));
    const double says = length_of(accessor, "count") * value_bytes(accessor);
    const double zeros = SKG_MESH_BYTES_TIMES * (double)g->size;
    const double has = view ? length_of(view, "byteLength") : zeros > FREE_LENGTH ? zeros : FREE_LENGTH;
    return says > has ? fail_lengths(g, "accessor", name, says, has) : SKG_OK;
}

static double count_of(const gltf *g, const json_t *accessor) {
    return length_of(skg_gltf_find(g->root, "accessors", accessor), "count");
}

/* Bytes that a mesh takes in Assimp's memory. */
static double mesh_bytes(const gltf *g, const json_t *mesh) {
    json_t *primitive, *accessor;
    const char *name;
    size_t k;
    double bytes = 0;
    json_array_foreach(json_object_get(mesh, "primitives"), k, primitive) {
        json_t *attributes = json_object_get(primitive, "attributes");
        const json_t *indices = json_object_get(primitive, "indices");
        json_object_foreach(attributes, name, accessor) bytes += VALUE * count_of(g, accessor);
        bytes += CORNER * count_of(g, indices ? indices : json_object_get(attributes, "POSITION"));
    }
    return bytes;
}

/* Each mesh is opened once, and placed by nodes: its number in the count follows the nodes'. */
static skg_status add_mesh(gltf *g, const char *name, const json_t *mesh) {
    int64_t part;
    SKG_TRY(skg_instances_add(&g->parts, name, 0, &part));
    g->parts.nodes[part].bytes = mesh_bytes(g, mesh);
    return skg_instances_name(&g->parts, part, skg_instances_key(1, name));
}

/* Says that a part places what a list of numbers or names, or one of them, names. */
static skg_status place(gltf *g, int64_t part, uint64_t kind, const json_t *what) {
    char number[24];
    json_t *one;
    size_t k;
    json_array_foreach(what, k, one) SKG_TRY(place(g, part, kind, json_is_array(one) ? NULL : one));
    snprintf(number, sizeof number, "%lld", (long long)json_integer_value(what));
    const char *name = json_is_integer(what) ? number : json_string_value(what);
    return name ? skg_instances_place_named(&g->parts, part, skg_instances_key(kind, name), 0) : SKG_OK;
}

static skg_status add_node(gltf *g, const char *name, const json_t *node) {
    int64_t part;
    SKG_TRY(skg_instances_add(&g->parts, name, 1, &part));
    SKG_TRY(skg_instances_name(&g->parts, part, skg_instances_key(0, name)));
    SKG_TRY(place(g, part, 0, json_object_get(node, "children")));
    SKG_TRY(place(g, part, 1, json_object_get(node, "mesh")));
    return place(g, part, 1, json_object_get(node, "meshes")); /* version 1 */
}

/* Calls a function for everything that stands in a list, which has names in version 1 and numbers in version 2. */
static skg_status each(gltf *g, const char *list, skg_status (*add)(gltf *, const char *, const json_t *)) {
    json_t *all = json_object_get(g->root, list), *one;
    const char *name;
    size_t k;
    char number[24];
    json_object_foreach(all, name, one) SKG_TRY(add(g, name, one));
    json_array_foreach(all, k, one) {
        snprintf(number, sizeof number, "%zu", k);
        SKG_TRY(add(g, number, one));
    }
    return SKG_OK;
}

static skg_status count(gltf *g) {
    int64_t file;
    SKG_TRY(each(g, "buffers", check_buffer));
    SKG_TRY(each(g, "bufferViews", check_view));
    SKG_TRY(each(g, "accessors", check_accessor));
    SKG_TRY(skg_mesh_check_gltf_unread(g->path, g->root));
    SKG_TRY(skg_instances_add(&g->parts, "file", 0, &file));
    SKG_TRY(each(g, "nodes", add_node));
    SKG_TRY(each(g, "meshes", add_mesh));
    return skg_instances_check(&g->parts);
}

/* Bytes of zero and spaces may fill the end of the text. */
skg_status skg_mesh_count_gltf(const char *path, int64_t size, const char *text, size_t length,
                               int64_t binary) {
    gltf g = {.path = path, .size = size, .binary = binary};
    json_error_t error;
    while (length > 0 && text[length - 1] == '\0') length--;
    g.parts = (skg_instances){.path = path, .kind = "node", .size = size, .deepest = DEEPEST, .all = 1};
    g.root = json_loadb(text, length, JSON_REJECT_DUPLICATES | JSON_ALLOW_NUL, &error);
    if (!json_is_object(g.root)) {
        json_decref(g.root);
        return skg_fail(SKG_ERR_FORMAT, "%s: no valid glTF file: line %d: %s", path, g.root ? 1 : error.line,
                        g.root ? "the text is no object" : error.text);
    }
    const skg_status status = count(&g);
    skg_instances_free(&g.parts);
    json_decref(g.root);
    return status;
}
