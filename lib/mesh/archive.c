/* Mesh files that are ZIP archives, read by libzip. */
#include "mesh/archive.h"

#include "core/files.h"
#include "core/text.h"
#include "mesh/relations.h"

#include <inttypes.h>
#include <string.h>
#include <zip.h>

enum {
    END =
        22, /* the record that ends a directory, without the comment behind it (PKWARE's APPNOTE 6.3.10, 4.3.16) */
    LONGEST_COMMENT = 65535,
    LONGEST_RELATIONS = 65535,
    PIECE = 1 << 14
};

typedef struct {
    const char *path;
    zip_t *zip; /* NULL: there is no directory */
    int64_t count;
} archive;

static int is_mark(const unsigned char *bytes, int first, int second) {
    return bytes[0] == 'P' && bytes[1] == 'K' && bytes[2] == first && bytes[3] == second;
}

static int read_at(FILE *stream, int64_t at, void *to, size_t count) {
    return at >= 0 && fseek(stream, (long)at, SEEK_SET) == 0 && fread(to, 1, count, stream) == count;
}

int skg_archive_is(FILE *stream) {
    unsigned char start[4];
    return read_at(stream, 0, start, sizeof start) && is_mark(start, 3, 4);
}

static int may_be_archive(const char *path, FILE *stream) {
    static const char *const extensions[] = {".3mf", ".zae", ".pk3", ".amf"};
    const char *dot = strrchr(path, '.');
    for (size_t e = 0; dot && e < sizeof extensions / sizeof *extensions; e++)
        if (skg_same_name(dot, extensions[e])) return 1;
    return skg_archive_is(stream);
}

static skg_status fail(const char *path) {
    return skg_fail(SKG_ERR_FORMAT, "%s: the archive is damaged: its directory cannot be read", path);
}

/* Finds the last record that ends a directory, which is the one that Assimp takes. Returns its place; -1: there is none. */
static int64_t find_end(FILE *stream, int64_t size, unsigned char *record) {
    unsigned char tail[END + LONGEST_COMMENT];
    const int64_t count = size < (int64_t)sizeof tail ? size : (int64_t)sizeof tail;
    if (!read_at(stream, size - count, tail, (size_t)count)) return -1;
    for (int64_t i = count - END; i >= 0; i--)
        if (is_mark(tail + i, 5, 6)) {
            memcpy(record, tail + i, END);
            return size - count + i;
        }
    return -1;
}

static int64_t number(const unsigned char *bytes, int count) {
    int64_t value = 0;
    for (int b = count - 1; b >= 0; b--) value = value << 8 | bytes[b];
    return value;
}

/* Where the archive begins: the directory ends where its end record begins, so that bytes before the archive do not move it. */
static int64_t find_start(const unsigned char *record, int64_t end) {
    const int64_t start =
        end - number(record + 12, 4) - number(record + 16, 4); /* length and place of the directory */
    return start > 0 ? start : 0;
}

static void close_archive(archive *a) {
    if (a->zip) zip_discard(a->zip);
    a->zip = NULL;
}

/* Gives the stream to libzip, without what stands before and behind the archive, which Assimp accepts. */
static skg_status open_at(archive *a, FILE *stream, int64_t start, int64_t length, int flags) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t *source = zip_source_filep_create(stream, (zip_uint64_t)start, length, &error);
    if (source)
        a->zip = zip_open_from_source(source, ZIP_RDONLY | flags, &error);
    else
        fclose(stream);
    if (source && !a->zip) zip_source_free(source);
    zip_error_fini(&error);
    return a->zip ? SKG_OK : fail(a->path);
}

/* libzip takes the directory that fits best. Behind another than the last one stands another comment. */
static skg_status check_end(const archive *a, int64_t comment) {
    int length = 0;
    zip_get_archive_comment(a->zip, &length, ZIP_FL_ENC_RAW);
    return length == comment ? SKG_OK : fail(a->path);
}

/* flags: of zip_open. A stream of its own, because libzip closes it. */
static skg_status open_archive(const char *path, int flags, archive *a) {
    unsigned char record[END];
    FILE *stream;
    int64_t size;
    *a = (archive){.path = path};
    SKG_TRY(skg_input_open(path, SKG_INPUT_LARGE, &stream, &size));
    const int64_t end = find_end(stream, size, record);
    if (end < 0) {
        fclose(stream);
        return SKG_OK;
    }
    const int64_t start = find_start(record, end), comment = number(record + 20, 2);
    SKG_TRY(open_at(a, stream, start, end + END + comment - start, flags));
    a->count = zip_get_num_entries(a->zip, 0);
    const skg_status status = check_end(a, comment);
    if (status != SKG_OK) close_archive(a);
    return status;
}

/* All of the contents together. */
static skg_status check_total(const archive *a) {
    uint64_t total = 0;
    for (int64_t i = 0; i < a->count; i++) {
        zip_stat_t part;
        if (zip_stat_index(a->zip, (zip_uint64_t)i, 0, &part) != 0) return fail(a->path);
        total = part.size > (uint64_t)SKG_ARCHIVE_MAX ? UINT64_MAX : total + part.size;
        if (total > (uint64_t)SKG_ARCHIVE_MAX)
            return skg_fail(SKG_ERR_FORMAT,
                            "%s: is longer than %" PRId64 " MiB when it is unpacked, the limit of an archive",
                            a->path, SKG_ARCHIVE_MAX >> 20);
    }
    return SKG_OK;
}

/* Deflated bytes hold at most SKG_ARCHIVE_TIMES times as many. */
static skg_status check_lengths(const archive *a) {
    SKG_TRY(check_total(a));
    for (int64_t i = 0; i < a->count; i++) {
        zip_stat_t part;
        if (zip_stat_index(a->zip, (zip_uint64_t)i, 0, &part) != 0) return fail(a->path);
        if (part.size > SKG_ARCHIVE_TIMES * (part.comp_size + 1))
            return skg_fail(SKG_ERR_FORMAT,
                            "%s: the archive is damaged: its \"%s\" is %" PRIu64
                            " bytes long by its directory, more than %d "
                            "times the %" PRIu64 " that it has",
                            a->path, part.name, part.size, SKG_ARCHIVE_TIMES, part.comp_size);
    }
    return SKG_OK;
}

/* Whether a part can be unpacked and is what the directory says. libzip compares the check sum at the end.
 *
 * text   [length + 1] receives the part and a zero behind it; NULL: it is only read */
static int is_whole(const archive *a, const zip_stat_t *part, char *text) {
    char piece[PIECE];
    uint64_t length = 0;
    zip_int64_t count = 0;
    const int is_packed_as_known = part->comp_method == ZIP_CM_STORE || part->comp_method == ZIP_CM_DEFLATE;
    if (!is_packed_as_known || part->encryption_method != ZIP_EM_NONE) return 0;
    zip_file_t *file = zip_fopen_index(a->zip, part->index, 0);
    if (!file) return 0;
    while (length <= part->size && (count = zip_fread(file, piece, sizeof piece)) > 0) {
        if (text && length + (uint64_t)count <= part->size) memcpy(text + length, piece, (size_t)count);
        length += (uint64_t)count;
    }
    zip_fclose(file);
    if (text) text[part->size] = '\0';
    return count == 0 && length == part->size;
}

/* Finds the first part whose name ends in `end`, without regard to case; whole: the name is `end`. Returns 0: there is none. */
static int find_part(const archive *a, const char *end, int whole, zip_stat_t *part) {
    const size_t wanted = strlen(end);
    for (int64_t i = 0; i < a->count; i++) {
        if (zip_stat_index(a->zip, (zip_uint64_t)i, ZIP_FL_ENC_RAW, part) != 0) continue;
        const size_t length = strlen(part->name);
        if (length >= wanted && (!whole || length == wanted) &&
            skg_same_name(part->name + length - wanted, end))
            return 1;
    }
    return 0;
}

static skg_status check_parts(const archive *a) {
    for (int64_t i = 0; i < a->count; i++) {
        zip_stat_t part;
        if (zip_stat_index(a->zip, (zip_uint64_t)i, 0, &part) != 0 || !is_whole(a, &part, NULL))
            return skg_fail(SKG_ERR_FORMAT,
                            "%s: the archive is damaged: a part of it is not what its check sum says",
                            a->path);
    }
    return SKG_OK;
}

static skg_status check_targets(const archive *a, const char *text) {
    skg_relations relations = {.at = text};
    char target[SKG_RELATION_MAX];
    int found;
    while ((found = skg_relations_next_model(&relations, target)) > 0) {
        const char *name = target;
        for (int slash = 0; slash < 2; slash++) name += *name == '/';
        if (zip_name_locate(a->zip, name, ZIP_FL_ENC_RAW) < 0)
            return skg_fail(SKG_ERR_FORMAT, "%s: its %s names \"%s\", which is not there", a->path,
                            SKG_RELATIONS_PART, name);
    }
    if (found < 0) return skg_fail(SKG_ERR_FORMAT, "%s: its %s cannot be read", a->path, SKG_RELATIONS_PART);
    return SKG_OK;
}

/* Assimp aborts the process if the part of the model is not there. */
static skg_status check_relations(const archive *a) {
    char text[LONGEST_RELATIONS + 1];
    zip_stat_t part;
    const zip_int64_t index = zip_name_locate(a->zip, SKG_RELATIONS_PART, ZIP_FL_ENC_RAW);
    if (index < 0) return SKG_OK;
    if (zip_stat_index(a->zip, (zip_uint64_t)index, 0, &part) != 0) return fail(a->path);
    if (part.size > LONGEST_RELATIONS)
        return skg_fail(SKG_ERR_FORMAT, "%s: its %s is longer than %d bytes", a->path, SKG_RELATIONS_PART,
                        LONGEST_RELATIONS);
    if (!is_whole(a, &part, text)) return fail(a->path);
    return check_targets(a, text);
}

/* Lengths first: a directory that announces too much is not worth the reading of the rest. */
skg_status skg_archive_check(const char *path, FILE *stream) {
    archive a;
    if (!may_be_archive(path, stream)) return SKG_OK;
    SKG_TRY(open_archive(path, 0, &a));
    if (!a.zip) return SKG_OK; /* Assimp takes it for something else */
    skg_status status = check_lengths(&a);
    close_archive(&a);
    if (status == SKG_OK) status = open_archive(path, ZIP_CHECKCONS, &a);
    if (status == SKG_OK) status = check_parts(&a);
    if (status == SKG_OK) status = check_relations(&a);
    close_archive(&a);
    return status;
}

static skg_status read_part(const archive *a, const char *end, int whole, char **text) {
    zip_stat_t part;
    if (!a->zip) return fail(a->path);
    SKG_TRY(check_lengths(a));
    if (!find_part(a, end, whole, &part)) return SKG_OK;
    SKG_TRY(skg_alloc((int64_t)part.size + 1, 1, a->path, text));
    if (is_whole(a, &part, *text)) return SKG_OK;
    skg_free(text);
    return skg_fail(SKG_ERR_FORMAT, "%s: the archive is damaged: its \"%s\" cannot be unpacked", a->path,
                    end);
}

skg_status skg_archive_read(const char *path, const char *end, int whole, char **text) {
    archive a;
    *text = NULL;
    SKG_TRY(open_archive(path, 0, &a));
    const skg_status status = read_part(&a, end + (*end == '/'), whole, text);
    close_archive(&a);
    return status;
}

skg_status skg_archive_read_model(const char *path, char *name, char **text) {
    char *relations = NULL;
    *text = NULL;
    SKG_TRY(skg_archive_read(path, SKG_RELATIONS_PART, 1, &relations));
    skg_relations models = {.at = relations ? relations : ""};
    const int found = relations ? skg_relations_next_model(&models, name) : 0;
    skg_free(&relations);
    if (found < 0) return skg_fail(SKG_ERR_FORMAT, "%s: its %s cannot be read", path, SKG_RELATIONS_PART);
    if (!found)
        return skg_fail(SKG_ERR_FORMAT, "%s: no 3MF file: its %s names no model", path, SKG_RELATIONS_PART);
    SKG_TRY(skg_archive_read(path, name, 1, text));
    if (*text) return SKG_OK;
    return skg_fail(SKG_ERR_FORMAT, "%s: its %s names \"%s\", which is not there", path, SKG_RELATIONS_PART,
                    name);
}
