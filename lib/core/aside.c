#include "core/aside.h"
#include "core/parallel.h"
#include "core/plain.h"

static void *run(void *given) {
    SKG_PLAIN;
    const skg_aside *aside = given;
    aside->work(aside->user);
    return NULL;
}

void skg_aside_begin(skg_aside *aside, void (*work)(void *user), void *user) {
    *aside = (skg_aside){.work = work, .user = user, .begun = 1};
    aside->has_thread = skg_thread_limit() > 1 && skg_thread_start(&aside->thread, run, aside) == 0;
}

void skg_aside_end(skg_aside *aside) {
    if (aside->has_thread)
        pthread_join(aside->thread, NULL);
    else if (aside->begun)
        run(aside);
    *aside = (skg_aside){0};
}
