/* The CPUs that a thread may run on. */
#define _GNU_SOURCE /* sched_getaffinity, CPU_COUNT_S */
#include "driver/driver.h"

#include <omp.h>
#include <sched.h>
#include <string.h>

void skg_cpus_get(skg_cpus *cpus) {
    memset(cpus, 0, sizeof *cpus);
    if (sched_getaffinity(0, sizeof *cpus, (cpu_set_t *)(void *)cpus->words) != 0)
        memset(cpus, 0, sizeof *cpus);
}

void skg_cpus_set(const skg_cpus *cpus) {
    if (skg_cpus_count(cpus) > 0) sched_setaffinity(0, sizeof *cpus, (const cpu_set_t *)(const void *)cpus);
}

int32_t skg_cpus_count(const skg_cpus *cpus) {
    return (int32_t)CPU_COUNT_S(sizeof *cpus, (const cpu_set_t *)(const void *)cpus->words);
}

/* The union of OpenMP's places; empty if OpenMP does not bind threads. */
static void find_places(skg_cpus *all) {
    memset(all, 0, sizeof *all);
    if (omp_get_proc_bind() == omp_proc_bind_false) return;
    for (int place = 0; place < omp_get_num_places(); place++) {
        int cpus[SKG_CPUS_MAX];
        const int count = omp_get_place_num_procs(place);
        if (count > SKG_CPUS_MAX) continue;
        omp_get_place_proc_ids(place, cpus);
        for (int n = 0; n < count; n++)
            if (cpus[n] >= 0) CPU_SET_S((size_t)cpus[n], sizeof *all, (cpu_set_t *)(void *)all->words);
    }
}

void skg_cpus_allowed(const skg_cpus *thread, skg_cpus *allowed) {
    skg_cpus places;
    find_places(&places);
    int inside = skg_cpus_count(&places) > 0;
    for (size_t n = 0; n < sizeof places.words / sizeof *places.words; n++)
        if (thread->words[n] & ~places.words[n]) inside = 0;
    *allowed = inside ? places : *thread;
}
