/* Pins PoCL's threads to cores. A program (the command, a benchmark) may decide this; the library never does. */
#ifndef SKG_HOST_AFFINITY_H
#define SKG_HOST_AFFINITY_H

/* Sets POCL_AFFINITY=1 where that is safe: the user has not set it, the process may run on all online cores,
 * and no variable of MPI or of a batch system is set. Call it before the first OpenCL call. Returns what was
 * done and why, in static storage. */
const char *host_pin_threads(void);

#endif
