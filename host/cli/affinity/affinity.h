/* The number of PoCL's threads, and the cores on which they run. A program (the command, a benchmark) may decide this
 * through the environment; the library never changes the environment. */
#ifndef SKG_HOST_AFFINITY_H
#define SKG_HOST_AFFINITY_H

/* Sets POCL_AFFINITY=1, which pins PoCL's threads from core 0 on, where that is safe: the user has not set it, the process
 * may run on all online cores, OpenMP binds no threads, and no variable of MPI or of a batch system is set. If the process
 * may run on some of the cores only, sets POCL_MAX_PTHREAD_COUNT to their number unless the user has set it.
 *
 * Call it before the first OpenCL call. Returns what was done about pinning and why, in static storage. */
const char *host_pin_threads(void);

#endif
