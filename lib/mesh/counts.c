/* Finds out what kind of file is to be counted: by its contents, too, as Assimp does. */
#include "mesh/counts.h"

#include "core/text.h"
#include "mesh/archive.h"
#include "mesh/collada_lengths.h"
#include "mesh/gltf_counts.h"
#include "mesh/x3d_unread.h"
#include "mesh/xml_counts.h"
#include "mesh/xml_unread.h"

#include <errno.h>
#include <string.h>

enum { HEAD = 4096, GLB_HEAD = 12, CHUNK_HEAD = 8 };

static const struct {
    const char *root, *extensions[3];
} kinds[SKG_XML_KINDS] = {{"<COLLADA", {".dae", ".zae"}}, {"<amf", {".amf"}}, {"<X3D", {".x3d", ".x3dz"}}};

static int has_extension(const char *path, const char *const *extensions) {
    const char *dot = strrchr(path, '.');
    for (; dot && *extensions; extensions++)
        if (skg_same_name(dot, *extensions)) return 1;
    return 0;
}

static skg_status read_at(FILE *stream, const char *path, int64_t at, int64_t count, char **text) {
    SKG_TRY(skg_alloc(count + 1, 1, path, text));
    if (fseek(stream, (long)at, SEEK_SET) == 0 && fread(*text, 1, (size_t)count, stream) == (size_t)count)
        return SKG_OK;
    skg_free(text);
    return skg_fail(SKG_ERR_FILE, "%s: cannot be read: %s", path, strerror(errno));
}

static int64_t word(const char *bytes) {
    const unsigned char *b = (const unsigned char *)bytes;
    return (int64_t)b[0] | (int64_t)b[1] << 8 | (int64_t)b[2] << 16 | (int64_t)b[3] << 24;
}

/* Khronos glTF 2.0, 4.4: a head of 12 bytes, then chunks of a length, a kind and bytes; the first one is the text. Version 1: the
 * length and the kind of the text stand in the head, the rest of the file is binary. */
static skg_status count_glb(const char *path, FILE *stream, int64_t size) {
    char *head = NULL, *text = NULL;
    if (size < GLB_HEAD + CHUNK_HEAD)
        return skg_fail(SKG_ERR_FORMAT, "%s: no valid glTF file: it ends in its head", path);
    SKG_TRY(read_at(stream, path, 0, GLB_HEAD + CHUNK_HEAD, &head));
    const int64_t length = word(head + GLB_HEAD), after = GLB_HEAD + CHUNK_HEAD + length;
    const int is_first = word(head + 4) == 1;
    skg_free(&head);
    if (after > size)
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: no valid glTF file: its text is %lld bytes long by its head, the file has %lld",
                        path, (long long)length, (long long)size);
    int64_t binary = is_first ? size - after : -1;
    if (!is_first && after + CHUNK_HEAD <= size) {
        SKG_TRY(read_at(stream, path, after, CHUNK_HEAD, &head));
        binary = word(head);
        skg_free(&head);
        if (binary > size - after - CHUNK_HEAD)
            return skg_fail(
                SKG_ERR_FORMAT,
                "%s: no valid glTF file: its chunk of numbers is %lld bytes long by its head, the file has %lld",
                path, (long long)binary, (long long)size);
    }
    SKG_TRY(read_at(stream, path, GLB_HEAD + CHUNK_HEAD, length, &text));
    const skg_status status = skg_mesh_count_gltf(path, size, text, (size_t)length, binary);
    skg_free(&text);
    return status;
}

/* The whole text, of an archive the part with the extension of its kind. */
static skg_status read_text(const char *path, FILE *stream, int64_t size, const char *end, char **text) {
    if (skg_archive_is(stream)) return skg_archive_read(path, end, 0, text);
    return read_at(stream, path, 0, size, text);
}

/* The kind of XML; SKG_XML_KINDS: another kind of file. */
static enum skg_mesh_xml xml_kind(const char *path, const char *head) {
    int kind = 0;
    while (kind < SKG_XML_KINDS && !has_extension(path, kinds[kind].extensions) &&
           !strstr(head, kinds[kind].root))
        kind++;
    return (enum skg_mesh_xml)kind;
}

skg_status skg_mesh_check_counts(const char *path, FILE *stream, int64_t size) {
    static const char *const gltf[] = {".gltf", NULL};
    char *text = NULL, head[HEAD + 1] = "";
    rewind(stream);
    head[fread(head, 1, HEAD, stream)] = '\0';
    if (memcmp(head, "glTF", 4) == 0) return count_glb(path, stream, size);
    const enum skg_mesh_xml kind = xml_kind(path, head);
    const int is_gltf = has_extension(path, gltf) || head[strspn(head, " \t\r\n")] == '{';
    if (kind == SKG_XML_KINDS && !is_gltf) return SKG_OK;
    SKG_TRY(read_text(path, stream, size, kind < SKG_XML_KINDS ? kinds[kind].extensions[0] : ".gltf", &text));
    skg_status status = SKG_OK;
    if (text && kind == SKG_XML_X3D) status = skg_mesh_check_x3d_unread(path, text);
    if (text && kind == SKG_XML_COLLADA) status = skg_mesh_check_collada_lengths(path, text);
    if (text && status == SKG_OK && kind < SKG_XML_KINDS)
        status = skg_mesh_check_xml_unread(path, text, kind);
    if (text && status == SKG_OK)
        status = kind < SKG_XML_KINDS ? skg_mesh_count_xml(path, size, text, kind)
                                      : skg_mesh_count_gltf(path, size, text, (size_t)size, -1);
    skg_free(&text);
    return status;
}
