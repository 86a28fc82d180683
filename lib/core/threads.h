/* Threads: work beside the caller's, work in shares, OpenMP. Private. */
#ifndef SKG_THREADS_H
#define SKG_THREADS_H

#include "core/core.h"

#include <pthread.h>

/* --- Work that one thread does beside the caller's. */

/* All zero: nothing is under way. It must not move while something is. */
typedef struct {
    void (*work)(void *user);
    void *user;
    pthread_t thread;
    int32_t begun, has_thread;
} skg_async;

/* Begins work(user) in a thread of its own, which has default arithmetic and the C locale, and blocks the signals that are
 * sent to the process. Nothing else may use what it uses until skg_async_end. If there is no thread to be had, or only one CPU,
 * skg_async_end does the work. It must not log. */
void skg_async_begin(skg_async *async, void (*work)(void *user), void *user);

/* Waits until the work is done. Nothing happens if none was begun. */
void skg_async_end(skg_async *async);

/* --- Work that several threads share. *
 * The threads live as long as the call: none is left that spins beside the threads of a driver, or that a fork would lose. */

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

/* --- OpenMP and fork. */

/* At the start of every public call whose loops OpenMP shares among threads. Its threads do not survive a fork, and GCC's
 * OpenMP would wait for them forever: SKG_ERR_FORK in a child of a process in which the library has used OpenMP with more
 * than one thread. With one thread (OMP_NUM_THREADS=1) it succeeds always. */
skg_status skg_openmp_enter(void);

#endif
