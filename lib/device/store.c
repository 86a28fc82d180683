/* Files in the user's folder, each whole or absent. */
#include "core/core.h"
#include "core/text.h"
#include "device/cache.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

/* The header of a file. It is followed by `bytes` bytes. A shared folder may meet machines of another byte order;
 * their files fail the comparison of `format`. */
typedef struct {
    char magic[8];
    uint32_t format, kind;
    skg_digest key;
    uint64_t bytes;
    uint32_t checksum; /* CRC-32 of the header with 0 here, and of what follows */
    uint32_t reserved;
} header;

_Static_assert(sizeof(header) == 64, "the header of a file has no padding");

enum { FORMAT = 2, BYTES_MAX = 64 << 20, NAME_LENGTH_MAX = SKG_DIGEST_TEXT + 16 };

static const char magic[8] = "skgkept";
static const char *const endings[] = {"program", "uses", "verdict"};

void skg_store_find(char path[SKG_STORE_PATH]) {
    const char *own = getenv("SKG_CACHE_DIR"), *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int length = 0;
    path[0] = '\0';
    if (getuid() != geteuid()) return; /* the environment is another user's */
    if (own && *own)
        length = strcmp(own, "none") == 0 ? 0 : snprintf(path, SKG_STORE_PATH, "%s", own);
    else if (cache && *cache == '/')
        length = snprintf(path, SKG_STORE_PATH, "%s/skiagraph", cache);
    else if (home && *home == '/')
        length = snprintf(path, SKG_STORE_PATH, "%s/.cache/skiagraph", home);
    if (length < 0 || length >= SKG_STORE_PATH) path[0] = '\0';
}

static void make_folders(const char *path) {
    char above[SKG_STORE_PATH];
    snprintf(above, sizeof above, "%s", path);
    for (char *slash = strchr(above + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        if (mkdir(above, 0700) != 0 && errno != EEXIST) return;
        *slash = '/';
    }
    mkdir(above, 0700);
}

/* Whether the file belongs to this user, and no one else may write to it. */
static int is_ours(const struct stat *status) {
    return status->st_uid == geteuid() && (status->st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

/* Opens the folder. -1: there is none, or it is not ours. */
static int open_folder(const char *path, int make) {
    if (!path[0]) return -1;
    if (make) make_folders(path);
    const int folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    struct stat status;
    if (folder < 0) return -1;
    if (fstat(folder, &status) == 0 && is_ours(&status)) return folder;
    close(folder);
    return -1;
}

static void name_of(const skg_digest *key, skg_kept kind, char name[NAME_LENGTH_MAX]) {
    char text[SKG_DIGEST_TEXT];
    skg_digest_text(key, text);
    snprintf(name, NAME_LENGTH_MAX, "%s.%s", text, endings[kind]);
}

static int read_whole(int file, void *data, size_t bytes) {
    char *at = data;
    while (bytes > 0) {
        const ssize_t got = read(file, at, bytes);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return 0;
        at += got, bytes -= (size_t)got;
    }
    return 1;
}

static int write_whole(int file, const void *data, size_t bytes) {
    const char *at = data;
    while (bytes > 0) {
        const ssize_t put = write(file, at, bytes);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) return 0;
        at += put, bytes -= (size_t)put;
    }
    return 1;
}

/* The check sum detects damage, not manipulation: no one else may write to the folder. */
static uint32_t checksum_of(const header *head, const void *data) {
    header bare = *head;
    bare.checksum = 0;
    const uLong start = crc32_z(0, (const Bytef *)&bare, sizeof bare);
    return (uint32_t)crc32_z(start, data, (size_t)head->bytes);
}

static int read_content(int file, const skg_digest *key, skg_kept kind, void **data, int64_t *bytes) {
    struct stat status;
    header head;
    if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode) || !is_ours(&status)) return 0;
    if (!read_whole(file, &head, sizeof head)) return 0;
    if (memcmp(head.magic, magic, sizeof magic) != 0 || head.format != FORMAT ||
        head.kind != (uint32_t)kind || !skg_digest_same(&head.key, key))
        return 0;
    if (head.bytes > BYTES_MAX || (uint64_t)status.st_size != sizeof head + head.bytes) return 0;
    if (skg_alloc((int64_t)head.bytes + 1, 1, "cached kernels", data) != SKG_OK) return 0;
    *bytes = (int64_t)head.bytes;
    if (read_whole(file, *data, (size_t)head.bytes) && head.checksum == checksum_of(&head, *data)) return 1;
    skg_free(data);
    return 0;
}

int skg_store_read(const char *path, const skg_digest *key, skg_kept kind, void **data, int64_t *bytes) {
    char name[NAME_LENGTH_MAX];
    int good = 0;
    *data = NULL;
    const int folder = open_folder(path, 0);
    if (folder < 0) return 0;
    name_of(key, kind, name);
    const int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file >= 0) {
        good = read_content(file, key, kind, data, bytes);
        if (good) skg_store_used(file);
        close(file);
        if (!good) unlinkat(folder, name, 0);
    }
    close(folder);
    return good;
}

int skg_store_write(const char *path, const skg_digest *key, skg_kept kind, const void *data, int64_t bytes) {
    static atomic_int number; /* makes the temporary names of a process differ; it has no other effect */
    header head = {.format = FORMAT, .kind = (uint32_t)kind, .key = *key, .bytes = (uint64_t)bytes};
    char name[NAME_LENGTH_MAX], ending[SKG_PART_ENDING], temporary[NAME_LENGTH_MAX + SKG_PART_ENDING + 32];
    if (bytes < 0 || bytes > BYTES_MAX) return 0;
    const int folder = open_folder(path, 1);
    if (folder < 0) return 0;
    memcpy(head.magic, magic, sizeof magic);
    head.checksum = checksum_of(&head, data);
    name_of(key, kind, name);
    skg_part_ending(ending);
    snprintf(temporary, sizeof temporary, "%s%s.%d%s", name, ending, atomic_fetch_add(&number, 1),
             SKG_TEMPORARY);
    const int file = openat(folder, temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    int good = 0;
    if (file >= 0) {
        good = write_whole(file, &head, sizeof head) && write_whole(file, data, (size_t)bytes);
        if (close(file) != 0) good = 0;
        if (good) good = renameat(folder, temporary, folder, name) == 0;
        if (!good) unlinkat(folder, temporary, 0);
    }
    if (good) skg_store_bound(folder);
    close(folder);
    return good;
}

void skg_store_remove(const char *path, const skg_digest *key, skg_kept kind) {
    char name[NAME_LENGTH_MAX];
    const int folder = open_folder(path, 0);
    if (folder < 0) return;
    name_of(key, kind, name);
    unlinkat(folder, name, 0);
    close(folder);
}
