/* Work that several threads share. Private.
 *
 * The threads live as long as the call: none is left that spins beside the threads of a driver, or that a fork would lose. */
#ifndef SKG_PARALLEL_H
#define SKG_PARALLEL_H

#include "core/core.h"

#include <pthread.h>

/* Does one item. It may be called by several threads at a time, in default arithmetic and the C locale. It must not log. */
typedef skg_status (*skg_item_work)(void *user, int64_t item);

/* Does items 0 <= item < count, which are begun in ascending order, by as many threads as there are CPUs for this one. If
 * items fail, returns the status and sets the message of the first of them; later ones may be left out then. */
skg_status skg_parallel(int64_t count, skg_item_work work, void *user);

/* The number of CPUs that the calling thread may use. */
int32_t skg_thread_limit(void);

/* pthread_create of a thread that blocks the signals that are sent to the process: they go to the program's own threads.
 * Signals of faults are not blocked, since a fault would then end the process without the handler that the program may have. */
int skg_thread_start(pthread_t *thread, void *(*work)(void *given), void *given);

#endif
