/* A function that runs in a thread of its own until it is waited for. */
#include "core/text.h"
#include "core/threads.h"

static void *run(void *given) {
    SKG_PLAIN;
    const skg_async *async = given;
    async->work(async->user);
    return NULL;
}

void skg_async_begin(skg_async *async, void (*work)(void *user), void *user) {
    SKG_ASSERT(!async->begun);
    *async = (skg_async){.work = work, .user = user, .begun = 1};
    async->has_thread = skg_thread_limit() > 1 && skg_thread_start(&async->thread, run, async) == 0;
}

void skg_async_end(skg_async *async) {
    if (async->has_thread)
        pthread_join(async->thread, NULL);
    else if (async->begun)
        run(async);
    *async = (skg_async){0};
}
