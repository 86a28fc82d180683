/* Sets of CPUs that threads may run on. Private. */
#ifndef SKG_CPUS_H
#define SKG_CPUS_H

#include <stdint.h>

enum { SKG_CPUS_MOST = 8192 };

/* One bit for each CPU, in the layout of cpu_set_t. */
typedef struct {
    unsigned long words[SKG_CPUS_MOST / (8 * sizeof(unsigned long))];
} skg_cpus;

/* The CPUs of the calling thread. Empty if the system does not report them. */
void skg_cpus_get(skg_cpus *cpus);

/* Binds the calling thread to these CPUs. An empty set changes nothing. */
void skg_cpus_set(const skg_cpus *cpus);

int32_t skg_cpus_count(const skg_cpus *cpus);

/* The CPUs that a driver's threads may use if a thread with the CPUs `thread` starts them: the union of OpenMP's places
 * if OpenMP binds threads and `thread` lies inside the union, because then OpenMP has narrowed it; otherwise `thread`.
 *
 * Some OpenMP runtimes bind a thread when it asks for the places. Call this in a thread whose binding does not matter. */
void skg_cpus_allowed(const skg_cpus *thread, skg_cpus *allowed);

#endif
