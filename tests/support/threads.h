/* The threads of this process, as /proc/self/task shows them. */
#ifndef SKG_TESTS_THREADS_H
#define SKG_TESTS_THREADS_H

#include <dirent.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS_MAX = 256 };

typedef struct {
    long id;
    uint64_t blocked; /* signal n is bit n - 1 */
    char cpus[256];   /* as the kernel writes them, such as "0-3,8" */
} thread_state;

/* Returns how many there are, or 0 where there is no /proc. */
static inline int threads_list(thread_state states[THREADS_MAX]) {
    DIR *tasks = opendir("/proc/self/task");
    int count = 0;
    for (struct dirent *one; tasks && count < THREADS_MAX && (one = readdir(tasks));) {
        thread_state *t = &states[count];
        char path[300], line[512];
        *t = (thread_state){.id = strtol(one->d_name, NULL, 10)};
        snprintf(path, sizeof path, "/proc/self/task/%s/status", one->d_name);
        FILE *file = t->id > 0 ? fopen(path, "r") : NULL;
        while (file && fgets(line, sizeof line, file)) {
            sscanf(line, "SigBlk: %" SCNx64, &t->blocked);
            sscanf(line, "Cpus_allowed_list: %255s", t->cpus);
        }
        if (file) fclose(file), count++;
    }
    if (tasks) closedir(tasks);
    return count;
}

#endif
