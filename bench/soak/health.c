/* Reads the resources of a process: memory, files, folders, over a soak. */
#define _GNU_SOURCE /* malloc_trim, nftw */
#include "soak.h"

#include <dirent.h>
#include <ftw.h>
#include <malloc.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int count_entries(const char *path) {
    int count = 0;
    DIR *directory = opendir(path);
    if (!directory) bench_die("%s cannot be read", path);
    while (readdir(directory)) count++;
    closedir(directory);
    return count;
}

static long resident_kib(void) {
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%*d %ld", &pages) != 1) bench_die("/proc/self/statm cannot be read");
    fclose(file);
    return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

static int kernels;

static int count_kernel(const char *path, const struct stat *its, int type, struct FTW *at) {
    (void)its, (void)at;
    const char *end = strrchr(path, '.');
    kernels += type == FTW_F && end && strcmp(end, ".so") == 0;
    return 0;
}

/* The kernels that PoCL has compiled and cached. 0 with another driver. */
static int count_kernels(void) {
    enum { HANDLES = 16 };
    char path[SOAK_PATH];
    const char *own = getenv("POCL_CACHE_DIR"), *user = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    if (own)
        snprintf(path, sizeof path, "%s", own);
    else
        snprintf(path, sizeof path, "%s%s/pocl/kcache",
                 user   ? user
                 : home ? home
                        : "",
                 user ? "" : "/.cache");
    kernels = 0;
    nftw(path, count_kernel, HANDLES, FTW_PHYS); /* a folder that is missing holds none */
    return kernels;
}

soak_health soak_health_now(void) {
    malloc_trim(0);
    const struct mallinfo2 heap = mallinfo2();
    return (soak_health){.resident_kib = resident_kib(),
                         .heap_kib = (long)((heap.uordblks + heap.hblkhd) / 1024),
                         .kernels = count_kernels(),
                         .handles = count_entries("/proc/self/fd"),
                         .threads = count_entries("/proc/self/task")};
}

static int is_there(const struct dirent *entry) {
    return strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
}

void soak_folder_check(const soak *s, const char *kept, const char *what) {
    DIR *directory = opendir(s->folder);
    if (!directory) bench_die("%s cannot be read", s->folder);
    for (struct dirent *entry; (entry = readdir(directory));)
        if (is_there(entry) && !(kept && strcmp(entry->d_name, kept) == 0))
            bench_die("%s: %s/%s was left behind", what, s->folder, entry->d_name);
    closedir(directory);
}

/* Folders of scans hold files only. */
static void clear(const char *folder) {
    DIR *directory = opendir(folder);
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        char path[2 * SOAK_PATH];
        struct stat its;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (!is_there(entry) || lstat(path, &its) != 0) continue;
        if (S_ISDIR(its.st_mode)) clear(path);
        if (remove(path) != 0) bench_die("%s cannot be removed", path);
    }
    if (directory) closedir(directory);
}

void soak_folder_clear(const soak *s) {
    clear(s->folder);
}
