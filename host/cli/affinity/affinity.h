/* Whether PoCL's threads are pinned, which a process of its own (command, benchmark) may decide and the
 * library never does. */
#ifndef SKG_HOST_AFFINITY_H
#define SKG_HOST_AFFINITY_H

/* Sets POCL_AFFINITY=1 where that is safe: the user has not set it, the process may run on all online cores,
 * and no variable of MPI or of a batch system is there. Call before the first OpenCL call. Says what was done
 * and why, in static storage. */
const char *host_pin_threads(void);

#endif
