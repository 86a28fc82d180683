/* Work that one thread does beside the caller's. Private. */
#ifndef SKG_ASYNC_H
#define SKG_ASYNC_H

#include "core/core.h"

#include <pthread.h>

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

#endif
