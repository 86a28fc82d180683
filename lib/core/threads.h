/* Threads: turns on a context and work between them, work beside the caller's, work in shares, OpenMP. Private. */
#ifndef SKG_THREADS_H
#define SKG_THREADS_H

#include "core/core.h"

#include <pthread.h>

/* --- Turns on a context.
 *
 * Every public call on a context takes its turn and gives it back (skg_call_begin). Between the calls a thread of the library may
 * take it, to go on with a job that nobody asks about. In a child after fork a turn is free, always. NULL likewise. */
typedef struct skg_turn skg_turn;

skg_status skg_turn_create(skg_turn **turn);
skg_turn *skg_turn_retain(skg_turn *turn);
void skg_turn_release(skg_turn **turn);

/* Waits until nobody else has the turn, and takes it; a thread may take it again while it has it. stop: NULL, or what skg_turn_stop
 * sets: then the turn is not taken, and 0 is returned. */
int skg_turn_take(skg_turn *turn, const int32_t *stop);
void skg_turn_give(skg_turn *turn);

/* Sets *stop for a thread that waits, or will wait, for its turn. */
void skg_turn_stop(skg_turn *turn, int32_t *stop);

/* 0: this process is a child by fork of the one that made the turn. */
int skg_turn_is_here(const skg_turn *turn);

/* --- Blocks of one size, for objects that other threads may still name when they are gone.
 *
 * A pool lives until its last owner and every block is back; whoever takes a block retains it. What a block held is still there when
 * it is taken again: 0 the first time. */
typedef struct skg_pool skg_pool;

skg_status skg_pool_create(skg_pool **pool);
skg_pool *skg_pool_retain(skg_pool *pool);
void skg_pool_release(skg_pool **pool);
skg_status skg_pool_take(skg_pool *pool, size_t size, const char *what, void *pointer_address);
void skg_pool_give(skg_pool *pool, void *bytes);

/* --- Work beside the calls. */

/* Work of a thread that takes turns with the calls of the program. */
typedef struct {
    /* Does what can be done now. Returns what to wait for; NULL: nothing is left to do. */
    void *(*turn)(void *user);
    /* Waits for it outside of the turn, and gives it up. 0: it failed, and the work ends. */
    int (*wait)(void *event);
} skg_aside_work;

typedef struct skg_aside skg_aside;

/* Starts such a thread, which logs to the mailbox of a context (skg_log_from_aside). *aside stays NULL if there is none to be had. */
void skg_aside_begin(skg_turn *turn, skg_aside_work work, void *user, skg_aside **aside);

/* Ends the thread: waits for what it waits for. The caller has the turn. The exit of the process ends all. */
void skg_aside_end(skg_aside **aside);

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
