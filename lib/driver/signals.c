/* Keeps the caller's signal handlers where a driver would replace them. */
#define _GNU_SOURCE /* NSIG */
#include "driver/driver.h"

#include <pthread.h>
#include <signal.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int users; /* threads between keep and restore */
static struct sigaction kept[NSIG];
static int has[NSIG]; /* 1: the system reports the disposition of this signal */

void skg_signals_keep(void) {
    pthread_mutex_lock(&lock);
    for (int n = 1; users == 0 && n < NSIG; n++) has[n] = sigaction(n, NULL, &kept[n]) == 0;
    users++;
    pthread_mutex_unlock(&lock);
}

static int same(const struct sigaction *a, const struct sigaction *b) {
    const int information = a->sa_flags & SA_SIGINFO;
    if (a->sa_flags != b->sa_flags) return 0;
    return information ? a->sa_sigaction == b->sa_sigaction : a->sa_handler == b->sa_handler;
}

void skg_signals_restore(void) {
    struct sigaction now;
    pthread_mutex_lock(&lock);
    for (int n = 1; n < NSIG; n++)
        if (has[n] && sigaction(n, NULL, &now) == 0 && !same(&now, &kept[n])) sigaction(n, &kept[n], NULL);
    users--;
    pthread_mutex_unlock(&lock);
}
