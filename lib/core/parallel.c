/* Divides items among threads that end with the call. */
#define _GNU_SOURCE /* sched_getaffinity, CPU_COUNT */
#include "core/text.h"
#include "core/threads.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>

enum { THREADS_MAX = 16 };

typedef struct {
    int64_t count;
    skg_item_work work;
    void *user;
    atomic_llong next;
    pthread_mutex_t lock; /* of what follows */
    int64_t failed;       /* the first item that failed; count: none */
    skg_status status;
    char message[1024];
} crew;

static void note_failure(crew *c, int64_t item, skg_status status) {
    atomic_store(&c->next, c->count); /* those before it were begun, and will end */
    pthread_mutex_lock(&c->lock);
    if (item < c->failed) {
        c->failed = item;
        c->status = status;
        snprintf(c->message, sizeof c->message, "%s", skg_last_error());
    }
    pthread_mutex_unlock(&c->lock);
}

static void do_items(crew *c) {
    for (;;) {
        const int64_t item = atomic_fetch_add(&c->next, 1);
        if (item >= c->count) return;
        const skg_status status = c->work(c->user, item);
        if (status != SKG_OK) note_failure(c, item, status);
    }
}

static void *do_thread(void *given) {
    SKG_PLAIN;
    do_items(given);
    return NULL;
}

int32_t skg_thread_limit(void) {
    cpu_set_t cpus;
    return sched_getaffinity(0, sizeof cpus, &cpus) == 0 ? (int32_t)CPU_COUNT(&cpus) : 1;
}

int skg_thread_start(pthread_t *thread, void *(*work)(void *given), void *given) {
    static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS, SIGABRT};
    sigset_t outside, before;
    sigfillset(&outside);
    for (size_t n = 0; n < sizeof faults / sizeof *faults; n++) sigdelset(&outside, faults[n]);
    pthread_sigmask(SIG_BLOCK, &outside, &before);
    const int error = pthread_create(thread, NULL, work, given);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return error;
}

/* Starts helpers, at most as many as there are further items and CPUs. Short work may be done before all of them have begun. */
static int start(crew *c, pthread_t *threads) {
    const int64_t most = c->count < THREADS_MAX ? c->count : THREADS_MAX, cpus = skg_thread_limit();
    int started = 0;
    while (started + 1 < most && started + 1 < cpus && atomic_load(&c->next) < c->count &&
           skg_thread_start(&threads[started], do_thread, c) == 0)
        started++;
    return started;
}

skg_status skg_parallel(int64_t count, skg_item_work work, void *user) {
    SKG_PLAIN;
    pthread_t threads[THREADS_MAX];
    crew c = {.count = count, .work = work, .user = user, .lock = PTHREAD_MUTEX_INITIALIZER, .failed = count};
    const int started = start(&c, threads);
    do_items(&c);
    for (int t = 0; t < started; t++) pthread_join(threads[t], NULL);
    pthread_mutex_destroy(&c.lock);
    return c.failed < count ? skg_fail(c.status, "%s", c.message) : SKG_OK;
}
