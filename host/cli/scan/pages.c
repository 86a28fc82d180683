/* Finds and reads the images of a scan in files: the pages of a stack, or the TIFFs of a folder by their numbers. */
#include "scan/pages.h"

#include "common/file.h"
#include "common/say.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { NAME_LENGTH = 256, DIGITS_MOST = 9 };

/* A TIFF of a folder: STEM, a separator, NUMBER. */
typedef struct {
    char stem[NAME_LENGTH], name[NAME_LENGTH];
    int64_t number; /* -1: none */
    enum pages_kind kind;
} member;

typedef struct {
    member *members;
    int64_t count, capacity;
} listing;

int pages_is_folder(const char *path) {
    struct stat found;
    return stat(path, &found) == 0 && S_ISDIR(found.st_mode);
}

/* Whether a stem is a word, or ends in one behind something that is no letter. */
static int ends_in(const char *stem, const char *word) {
    const size_t length = strlen(stem), its = strlen(word);
    if (length < its || strcasecmp(stem + length - its, word) != 0) return 0;
    return length == its || !isalpha((unsigned char)stem[length - its - 1]);
}

static void parse(const char *name, member *m) {
    snprintf(m->name, sizeof m->name, "%s", name);
    snprintf(m->stem, sizeof m->stem, "%.*s", (int)(strrchr(name, '.') - name), name);
    size_t end = strlen(m->stem), digits = 0;
    while (digits < end && digits < DIGITS_MOST && isdigit((unsigned char)m->stem[end - digits - 1]))
        digits++;
    m->number = digits > 0 ? strtoll(m->stem + end - digits, NULL, 10) : -1;
    end -= digits;
    while (end > 0 && strchr("_-. ", m->stem[end - 1])) end--;
    m->stem[end] = '\0';
    m->kind = ends_in(m->stem, "flat")   ? PAGES_FLATS
              : ends_in(m->stem, "dark") ? PAGES_DARKS
                                         : PAGES_PROJECTIONS;
}

static int add_member(const char *name, listing *l) {
    if (l->count == l->capacity) {
        const int64_t capacity = l->capacity ? 2 * l->capacity : 256;
        member *more = realloc(l->members, (size_t)capacity * sizeof *more);
        if (!more) return cli_error(CLI_DEVICE, "out of host memory for the names of projections");
        l->members = more, l->capacity = capacity;
    }
    parse(name, &l->members[l->count++]);
    return CLI_DONE;
}

static int list_folder(const char *folder, enum pages_kind kind, listing *l) {
    DIR *directory = opendir(folder);
    int exit_status = CLI_DONE;
    if (!directory) return cli_error(CLI_INPUT, "%s: cannot be read: %s", folder, strerror(errno));
    for (struct dirent *entry = readdir(directory); entry && exit_status == CLI_DONE;
         entry = readdir(directory)) {
        const char *name = entry->d_name;
        if (*name == '.' || strlen(name) >= NAME_LENGTH ||
            !(cli_has_extension(name, ".tif") || cli_has_extension(name, ".tiff")))
            continue;
        exit_status = add_member(name, l);
        if (exit_status == CLI_DONE && l->members[l->count - 1].kind != kind) l->count--;
    }
    closedir(directory);
    return exit_status;
}

static int by_number(const void *a, const void *b) {
    const member *one = a, *other = b;
    const int order = (one->number > other->number) - (one->number < other->number);
    return order ? order : strcmp(one->name, other->name);
}

/* Projections have one name and all numbers. */
static int check_numbers(const char *folder, const listing *l) {
    const member *first = l->members;
    for (int64_t k = 0; k < l->count; k++) {
        const member *m = &l->members[k];
        if (m->number < 0)
            return cli_error(
                CLI_INPUT,
                "%s/%s: has no number at its end; projections are NAME_0000.tif and so on, flat and dark fields "
                "NAME_flat_0000.tif and NAME_dark_0000.tif; move other pictures out of the folder",
                folder, m->name);
        if (strcmp(m->stem, first->stem) != 0)
            return cli_error(CLI_INPUT,
                             "%s: has projections of two scans, %s and %s; leave those of one in the folder",
                             folder, first->name, m->name);
        if (m->number != first->number + k)
            return cli_error(CLI_INPUT, "%s: projection %" PRId64 " is %s, between %s and %s", folder,
                             m->number < first->number + k ? m->number : first->number + k,
                             m->number < first->number + k ? "there twice" : "missing",
                             l->members[k - 1].name, m->name);
    }
    return CLI_DONE;
}

static int look(pages *p) {
    skg_picture_contents contents;
    skg_picture_contents_init(&contents);
    const skg_status status = skg_picture_contents_get(p->paths[0], &contents);
    if (status != SKG_OK) return cli_fail(status);
    p->columns = contents.columns, p->rows = contents.rows, p->quantity = contents.quantity;
    if (p->files == 1) p->count = contents.pages;
    return CLI_DONE;
}

static int copy_paths(const char *folder, const listing *l, pages *p) {
    p->paths = calloc((size_t)l->count, sizeof *p->paths);
    for (; p->paths && p->files < l->count; p->files++) {
        p->paths[p->files] = cli_path_in(folder, "%s", l->members[p->files].name);
        if (!p->paths[p->files]) break;
    }
    p->count = p->files;
    return p->files == l->count ? look(p)
                                : cli_error(CLI_DEVICE, "out of host memory for the names of projections");
}

int pages_open_folder(const char *folder, enum pages_kind kind, pages *p) {
    listing l = {.count = 0};
    int exit_status = list_folder(folder, kind, &l);
    if (exit_status == CLI_DONE && l.count > 0) {
        qsort(l.members, (size_t)l.count, sizeof *l.members, by_number);
        if (kind == PAGES_PROJECTIONS) exit_status = check_numbers(folder, &l);
        if (exit_status == CLI_DONE) exit_status = copy_paths(folder, &l, p);
    }
    free(l.members);
    return exit_status;
}

int pages_open_stack(const char *path, pages *p) {
    p->paths = calloc(1, sizeof *p->paths);
    if (p->paths) p->paths[0] = strdup(path);
    if (!p->paths || !p->paths[0]) return cli_error(CLI_DEVICE, "out of host memory for %s", path);
    p->files = 1;
    return look(p);
}

int pages_read(const pages *p, int64_t k, double *values) {
    skg_picture_contents contents;
    const char *path = p->paths[p->files > 1 ? k : 0];
    skg_picture_contents_init(&contents);
    skg_status status = skg_picture_contents_get(path, &contents);
    if (status == SKG_OK && (contents.columns != p->columns || contents.rows != p->rows))
        return cli_error(CLI_INPUT,
                         "%s: has %" PRId64 " x %" PRId64 " pixels, but the first one has %" PRId64
                         " x %" PRId64,
                         path, contents.columns, contents.rows, p->columns, p->rows);
    if (status == SKG_OK) status = skg_picture_load(path, p->files > 1 ? 0 : k, values);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

void pages_close(pages *p) {
    for (int64_t i = 0; i < p->files; i++) free(p->paths[i]);
    free(p->paths);
}
