#define _DEFAULT_SOURCE /* malloc_trim */
#include "soak.h"

#include <dirent.h>
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

soak_health soak_health_now(void) {
    malloc_trim(0);
    const struct mallinfo2 heap = mallinfo2();
    return (soak_health){.resident_kib = resident_kib(),
                         .heap_kib = (long)((heap.uordblks + heap.hblkhd) / 1024),
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
