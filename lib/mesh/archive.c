/* The directory at the end of a ZIP archive, as PKWARE's APPNOTE 6.3.10 describes it. */
#include "mesh/archive.h"

#include "core/text.h"
#include "mesh/relations.h"
#include "mesh/unpack.h"

#include <inttypes.h>
#include <string.h>

/* Lengths of records without their texts. */
enum {
    END = 22,
    END_64 = 56,
    LOCATOR_64 = 20,
    ENTRY = 46,
    NAME = 28, /* in an entry: the length of its name */
    LONGEST_COMMENT = 65535,
    LONGEST_RELATIONS = 65535
};

typedef struct {
    const char *path;
    FILE *stream;
    int64_t at, end; /* of the directory in the file */
    int64_t start;   /* where the archive begins in the file */
} archive;

static uint64_t number(const unsigned char *bytes, int count) {
    uint64_t value = 0;
    for (int b = count - 1; b >= 0; b--) value = value << 8 | bytes[b];
    return value;
}

static int is_mark(const unsigned char *bytes, int first, int second) {
    return bytes[0] == 'P' && bytes[1] == 'K' && bytes[2] == first && bytes[3] == second;
}

static int read_at(FILE *stream, int64_t at, void *to, size_t count) {
    return at >= 0 && fseek(stream, (long)at, SEEK_SET) == 0 && fread(to, 1, count, stream) == count;
}

static int is_archive(const char *path, FILE *stream) {
    static const char *const extensions[] = {".3mf", ".zae", ".pk3", ".amf"};
    unsigned char start[4];
    const char *dot = strrchr(path, '.');
    for (size_t e = 0; dot && e < sizeof extensions / sizeof *extensions; e++)
        if (skg_same_name(dot, extensions[e])) return 1;
    return read_at(stream, 0, start, sizeof start) && is_mark(start, 3, 4);
}

static skg_status fail(const archive *a) {
    return skg_fail(SKG_ERR_FORMAT, "%s: the archive is damaged: its directory cannot be read", a->path);
}

/* Finds the last record that ends a directory. Returns its place; -1: there is none. */
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

/* The directory ends where its end record begins, so that bytes before the archive do not move it. */
static skg_status find_directory(archive *a, int64_t end, const unsigned char *record) {
    unsigned char locator[LOCATOR_64], large[END_64];
    uint64_t length = number(record + 12, 4), before = number(record + 16, 4);
    a->end = end;
    if (read_at(a->stream, end - LOCATOR_64, locator, sizeof locator) && is_mark(locator, 6, 7)) {
        a->end = (int64_t)(number(locator + 8, 8) & INT64_MAX);
        if (!read_at(a->stream, a->end, large, sizeof large) || !is_mark(large, 6, 6)) return fail(a);
        length = number(large + 40, 8), before = number(large + 48, 8);
    }
    if (length > (uint64_t)a->end || before > (uint64_t)a->end - length) return fail(a);
    a->at = a->end - (int64_t)length;
    a->start = a->at - (int64_t)before;
    return SKG_OK;
}

/* Numbers that need 8 bytes stand in the field of number 1 behind the name, in this order, each only if it is needed. */
static void read_large(const archive *a, const unsigned char *entry, skg_packed_part *part) {
    unsigned char fields[65535 + 1];
    uint64_t header = UINT32_MAX, *const numbers[] = {&part->length, &part->packed, &header};
    const size_t count = (size_t)number(entry + 30, 2);
    if (!read_at(a->stream, a->at + ENTRY + (int64_t)number(entry + NAME, 2), fields, count)) return;
    for (size_t i = 0; i + 4 <= count; i += 4 + (size_t)number(fields + i + 2, 2)) {
        size_t at = i + 4;
        for (int n = 0; number(fields + i, 2) == 1 && n < 3; n++)
            if ((n < 2 ? *numbers[n] : number(entry + 42, 4)) == UINT32_MAX && at + 8 <= count)
                *numbers[n] = number(fields + at, 8), at += 8;
    }
    if (number(entry + 42, 4) == UINT32_MAX) part->header = a->start + (int64_t)(header & INT64_MAX >> 1);
}

static skg_packed_part read_part(const archive *a, const unsigned char *entry) {
    skg_packed_part part = {.header = a->start + (int64_t)number(entry + 42, 4),
                            .packed = number(entry + 20, 4),
                            .length = number(entry + 24, 4),
                            .crc = (uint32_t)number(entry + 16, 4),
                            .method = (uint32_t)number(entry + 10, 2),
                            .flags = (uint32_t)number(entry + 8, 2),
                            .name = (uint32_t)number(entry + NAME, 2)};
    read_large(a, entry, &part);
    return part;
}

/* The entry at a->at. */
static skg_status read_entry(const archive *a, unsigned char *entry) {
    if (!read_at(a->stream, a->at, entry, ENTRY) || !is_mark(entry, 1, 2)) return fail(a);
    return SKG_OK;
}

static void go_on(archive *a, const unsigned char *entry) {
    a->at += ENTRY + (int64_t)(number(entry + NAME, 2) + number(entry + 30, 2) + number(entry + 32, 2));
}

static int has_name(const archive *a, const unsigned char *entry, const char *name) {
    char its[SKG_RELATION_MAX];
    const size_t length = strlen(name);
    return number(entry + NAME, 2) == length && length < sizeof its &&
           read_at(a->stream, a->at + ENTRY, its, length) && memcmp(its, name, length) == 0;
}

/* Deflated bytes hold at most SKG_ARCHIVE_TIMES times as many. */
static skg_status check_length(const archive *a, const unsigned char *entry, const skg_packed_part *part) {
    char name[SKG_RELATION_MAX] = "";
    const size_t length = (size_t)number(entry + NAME, 2);
    if (part->packed > (uint64_t)SKG_ARCHIVE_MAX || part->length <= SKG_ARCHIVE_TIMES * (part->packed + 1))
        return SKG_OK;
    if (length >= sizeof name || !read_at(a->stream, a->at + ENTRY, name, length)) *name = '\0';
    return skg_fail(SKG_ERR_FORMAT,
                    "%s: the archive is damaged: its \"%s\" is %" PRIu64
                    " bytes long by its directory, more than %d "
                    "times the %" PRIu64 " that it has",
                    a->path, name, part->length, SKG_ARCHIVE_TIMES, part->packed);
}

static skg_status check_lengths(archive a) {
    unsigned char entry[ENTRY];
    uint64_t total = 0;
    for (; a.at < a.end; go_on(&a, entry)) {
        SKG_TRY(read_entry(&a, entry));
        const skg_packed_part part = read_part(&a, entry);
        total = part.length > (uint64_t)SKG_ARCHIVE_MAX ? UINT64_MAX : total + part.length;
        if (total > (uint64_t)SKG_ARCHIVE_MAX)
            return skg_fail(SKG_ERR_FORMAT,
                            "%s: is longer than %" PRId64 " MiB when it is unpacked, the limit of an archive",
                            a.path, SKG_ARCHIVE_MAX >> 20);
    }
    return SKG_OK;
}

/* relations: receives the text of the relationships */
static skg_status check_parts(archive a, char *relations) {
    unsigned char entry[ENTRY];
    for (; a.at < a.end; go_on(&a, entry)) {
        SKG_TRY(read_entry(&a, entry));
        const skg_packed_part part = read_part(&a, entry);
        SKG_TRY(check_length(&a, entry, &part));
        const int is_kept = has_name(&a, entry, SKG_RELATIONS_PART);
        if (is_kept && part.length > LONGEST_RELATIONS)
            return skg_fail(SKG_ERR_FORMAT, "%s: its %s is longer than %d bytes", a.path, SKG_RELATIONS_PART,
                            LONGEST_RELATIONS);
        if (!skg_unpack_is_whole(a.stream, &part, is_kept ? relations : NULL,
                                 is_kept ? LONGEST_RELATIONS : 0))
            return skg_fail(SKG_ERR_FORMAT,
                            "%s: the archive is damaged: a part of it is not what its check sum says",
                            a.path);
    }
    return SKG_OK;
}

static int has_part(archive a, const char *name) {
    unsigned char entry[ENTRY];
    for (; a.at < a.end; go_on(&a, entry))
        if (read_entry(&a, entry) != SKG_OK || has_name(&a, entry, name)) return 1;
    return 0;
}

/* Assimp aborts the process if the part of the model is not there. */
static skg_status check_relations(const archive *a, const char *text) {
    skg_relations relations = {.at = text};
    char target[SKG_RELATION_MAX];
    int found;
    while ((found = skg_relations_next_model(&relations, target)) > 0) {
        const char *name = target;
        for (int slash = 0; slash < 2; slash++) name += *name == '/';
        if (!has_part(*a, name))
            return skg_fail(SKG_ERR_FORMAT, "%s: its %s names \"%s\", which is not there", a->path,
                            SKG_RELATIONS_PART, name);
    }
    if (found < 0) return skg_fail(SKG_ERR_FORMAT, "%s: its %s cannot be read", a->path, SKG_RELATIONS_PART);
    return SKG_OK;
}

skg_status skg_archive_check(const char *path, FILE *stream, int64_t size) {
    archive a = {.path = path, .stream = stream};
    unsigned char record[END];
    char *relations = NULL;
    if (!is_archive(path, stream)) return SKG_OK;
    const int64_t end = find_end(stream, size, record);
    if (end < 0) return SKG_OK; /* Assimp takes it for something else */
    SKG_TRY(find_directory(&a, end, record));
    SKG_TRY(check_lengths(a));
    SKG_TRY(skg_alloc(LONGEST_RELATIONS + 1, 1, path, &relations));
    skg_status status = check_parts(a, relations);
    if (status == SKG_OK && has_part(a, SKG_RELATIONS_PART)) status = check_relations(&a, relations);
    skg_free(&relations);
    return status;
}

int skg_archive_is(FILE *stream) {
    unsigned char start[4];
    return read_at(stream, 0, start, sizeof start) && is_mark(start, 3, 4);
}

/* Whether the name of an entry ends in `end`, or is it. */
static int name_fits(const archive *a, const unsigned char *entry, const char *end, int whole) {
    char its[SKG_RELATION_MAX];
    const size_t length = (size_t)number(entry + NAME, 2), wanted = strlen(end);
    if (length >= sizeof its || length < wanted || (whole && length != wanted)) return 0;
    if (!read_at(a->stream, a->at + ENTRY, its, length)) return 0;
    its[length] = '\0';
    return skg_same_name(its + length - wanted, end);
}

static skg_status open_archive(const char *path, FILE *stream, int64_t size, archive *a) {
    unsigned char record[END];
    *a = (archive){.path = path, .stream = stream};
    const int64_t end = find_end(stream, size, record);
    if (end < 0) return fail(a);
    SKG_TRY(find_directory(a, end, record));
    return check_lengths(*a);
}

skg_status skg_archive_read(const char *path, FILE *stream, int64_t size, const char *end, int whole,
                            char **text) {
    archive a;
    unsigned char entry[ENTRY];
    *text = NULL;
    SKG_TRY(open_archive(path, stream, size, &a));
    end += *end == '/';
    for (; a.at < a.end; go_on(&a, entry)) {
        SKG_TRY(read_entry(&a, entry));
        if (!name_fits(&a, entry, end, whole)) continue;
        const skg_packed_part part = read_part(&a, entry);
        SKG_TRY(skg_alloc((int64_t)part.length + 1, 1, path, text));
        if (skg_unpack_is_whole(stream, &part, *text, part.length)) return SKG_OK;
        skg_free(text);
        return skg_fail(SKG_ERR_FORMAT, "%s: the archive is damaged: its \"%s\" cannot be unpacked", path,
                        end);
    }
    return SKG_OK;
}

skg_status skg_archive_read_model(const char *path, FILE *stream, int64_t size, char *name, char **text) {
    char *relations = NULL;
    *text = NULL;
    SKG_TRY(skg_archive_read(path, stream, size, SKG_RELATIONS_PART, 1, &relations));
    skg_relations models = {.at = relations ? relations : ""};
    const int found = relations ? skg_relations_next_model(&models, name) : 0;
    skg_free(&relations);
    if (found < 0) return skg_fail(SKG_ERR_FORMAT, "%s: its %s cannot be read", path, SKG_RELATIONS_PART);
    if (!found)
        return skg_fail(SKG_ERR_FORMAT, "%s: no 3MF file: its %s names no model", path, SKG_RELATIONS_PART);
    SKG_TRY(skg_archive_read(path, stream, size, name, 1, text));
    if (*text) return SKG_OK;
    return skg_fail(SKG_ERR_FORMAT, "%s: its %s names \"%s\", which is not there", path, SKG_RELATIONS_PART,
                    name);
}
