/* A thread of the library that takes turns with the calls of the program, until its work is done or not wanted any more. */
#include "core/log.h"
#include "core/text.h"
#include "core/threads.h"

#include <stdlib.h>
#include <unistd.h>

struct skg_aside {
    skg_aside_work work;
    void *user;
    skg_turn *turn; /* retained */
    pthread_t thread;
    int32_t stop;   /* skg_turn_stop */
    int32_t joined; /* 1: the thread has ended; guarded by the lock */
    skg_aside *next;
};

/* All of the process, for its exit: drivers do not survive a thread that gives them work then. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static skg_aside *all;
static pid_t process; /* that has them: a child after fork has none, and the lock may be held for ever */

static void *run(void *given) {
    SKG_PLAIN;
    const skg_aside *aside = given;
    void *event = NULL;
    skg_log_from_aside();
    do {
        if (!skg_turn_take(aside->turn, &aside->stop)) break;
        event = aside->work.turn(aside->user);
        skg_turn_give(aside->turn);
    } while (event && aside->work.wait(event));
    return NULL;
}

/* With the lock. */
static void stop(skg_aside *aside) {
    if (aside->joined) return;
    skg_turn_stop(aside->turn, &aside->stop);
    pthread_join(aside->thread, NULL);
    aside->joined = 1;
}

static void stop_all(void) {
    if (process != getpid()) return;
    pthread_mutex_lock(&lock);
    for (skg_aside *aside = all; aside; aside = aside->next) stop(aside);
    pthread_mutex_unlock(&lock);
}

static void stop_at_exit(void) {
    process = getpid();
    (void)atexit(stop_all);
}

void skg_aside_begin(skg_turn *turn, skg_aside_work work, void *user, skg_aside **aside) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    skg_aside *made = NULL;
    *aside = NULL;
    pthread_once(&once, stop_at_exit); /* after that of a driver in use, and so called before */
    if (skg_alloc(1, sizeof *made, "thread", &made) != SKG_OK) return;
    *made = (skg_aside){.work = work, .user = user, .turn = skg_turn_retain(turn)};
    pthread_mutex_lock(&lock);
    if (skg_thread_start(&made->thread, run, made) == 0) {
        made->next = all;
        all = *aside = made;
    }
    pthread_mutex_unlock(&lock);
    if (*aside) return;
    skg_turn_release(&made->turn);
    skg_free(&made);
}

void skg_aside_end(skg_aside **aside) {
    skg_aside *last = *aside;
    if (!last) return;
    *aside = NULL;
    if (skg_turn_is_here(last->turn)) {
        pthread_mutex_lock(&lock);
        stop(last);
        skg_aside **link = &all;
        while (*link != last) link = &(*link)->next;
        *link = last->next;
        pthread_mutex_unlock(&lock);
    }
    skg_turn_release(&last->turn);
    skg_free(&last);
}
