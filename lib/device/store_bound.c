/* Keeps the user's folder below its size: what was not used for longest goes. */
#include "core/core.h"
#include "device/cache.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { MIB_MAX = 256, HOUR = 3600, LONGEST_NAME = 128, DIGITS = 64 };

typedef struct {
    char name[LONGEST_NAME];
    int64_t bytes;
    time_t used;
} kept_file;

void skg_store_used(int file) {
    struct stat status;
    if (fstat(file, &status) == 0 && time(NULL) - status.st_mtime > HOUR) futimens(file, NULL);
}

static int ends_with(const char *name, const char *ending) {
    const size_t length = strlen(name), end = strlen(ending);
    return length >= end && strcmp(name + length - end, ending) == 0;
}

/* Whether skg_store_write gave this name. */
static int is_kept(const char *name) {
    return strlen(name) < LONGEST_NAME && strspn(name, "0123456789abcdef") == DIGITS && name[DIGITS] == '.';
}

static int by_use(const void *a, const void *b) {
    const kept_file *left = a, *right = b;
    return left->used < right->used ? -1 : left->used > right->used;
}

/* Lists the cached files. Unfinished files older than an hour are removed. */
static int64_t list_files(int folder, DIR *entries, kept_file **files) {
    int64_t count = 0, capacity = 0;
    const time_t now = time(NULL);
    for (struct dirent *entry = readdir(entries); entry; entry = readdir(entries)) {
        struct stat status;
        if (!is_kept(entry->d_name) || fstatat(folder, entry->d_name, &status, AT_SYMLINK_NOFOLLOW) != 0 ||
            !S_ISREG(status.st_mode))
            continue;
        if (ends_with(entry->d_name, SKG_TEMPORARY)) {
            if (now - status.st_mtime > HOUR) unlinkat(folder, entry->d_name, 0);
            continue;
        }
        if (count == capacity) {
            capacity = 2 * capacity + 64;
            if (skg_realloc(capacity, sizeof **files, "cached kernels", files) != SKG_OK) break;
        }
        snprintf((*files)[count].name, LONGEST_NAME, "%s", entry->d_name);
        (*files)[count].bytes = (int64_t)status.st_size;
        (*files)[count++].used = status.st_mtime;
    }
    return count;
}

void skg_store_bound(int folder) {
    kept_file *files = NULL;
    int64_t total = 0;
    const int again = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (again < 0) return;
    DIR *entries = fdopendir(again);
    if (!entries) {
        close(again);
        return;
    }
    const int64_t count = list_files(folder, entries, &files);
    for (int64_t i = 0; i < count; i++) total += files[i].bytes;
    const int64_t most = (int64_t)MIB_MAX << 20;
    if (total > most) qsort(files, (size_t)count, sizeof *files, by_use);
    for (int64_t i = 0; i < count && total > most; i++)
        if (unlinkat(folder, files[i].name, 0) == 0) total -= files[i].bytes;
    skg_free(&files);
    closedir(entries);
}
