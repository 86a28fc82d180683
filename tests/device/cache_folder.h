/* A folder of its own for SKG_CACHE_DIR. */
#ifndef SKG_TESTS_CACHE_FOLDER_H
#define SKG_TESTS_CACHE_FOLDER_H

#include <check.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char cache_folder[64];

static inline void make_cache_folder(void) {
    snprintf(cache_folder, sizeof cache_folder, "/tmp/skg-cache-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(cache_folder));
    ck_assert_int_eq(setenv("SKG_CACHE_DIR", cache_folder, 1), 0);
}

/* Number of files whose names end so. The name of the last one is written to path. */
static inline int count_kept(const char *ending, char path[512]) {
    int count = 0;
    DIR *entries = opendir(cache_folder);
    if (!entries) return 0;
    for (struct dirent *entry = readdir(entries); entry; entry = readdir(entries)) {
        const size_t length = strlen(entry->d_name), end = strlen(ending);
        if (entry->d_name[0] == '.' || length < end || strcmp(entry->d_name + length - end, ending) != 0)
            continue;
        count++;
        if (path) snprintf(path, 512, "%s/%s", cache_folder, entry->d_name);
    }
    closedir(entries);
    return count;
}

static inline void remove_cache_folder(void) {
    char path[512];
    while (count_kept("", path) > 0)
        if (unlink(path) != 0) abort();
    rmdir(cache_folder);
}

#endif
