/* Watches calls of drivers that may hang, and says so. */
#include "driver/driver.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <time.h>

enum { PATIENCE_MS = 1000 };

typedef struct {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    int done;
    void (*work)(void *data);
    void *data;
} watched;

static void *do_work(void *address) {
    watched *w = address;
    w->work(w->data);
    pthread_mutex_lock(&w->lock);
    w->done = 1;
    pthread_cond_signal(&w->changed);
    pthread_mutex_unlock(&w->lock);
    return NULL;
}

static int64_t now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now); /* the clock of pthread_cond_timedwait */
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

/* Starts the thread. A signal that the program has asked for goes to the program's own threads. */
static int start(watched *w, pthread_t *thread) {
    sigset_t all, before;
    sigfillset(&all);
    if (pthread_sigmask(SIG_SETMASK, &all, &before) != 0) return 0;
    const int started = pthread_create(thread, NULL, do_work, w) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return started;
}

static void wait_for(watched *w, skg_watch *watch, const skg_context *context, const char *device) {
    const int64_t end = now_ms() + PATIENCE_MS - watch->ms;
    const struct timespec moment = {end / 1000, end % 1000 * 1000000};
    pthread_mutex_lock(&w->lock);
    int code = 0;
    while (!w->done && !watch->logged && code != ETIMEDOUT)
        code = pthread_cond_timedwait(&w->changed, &w->lock, &moment);
    if (!w->done && !watch->logged) {
        watch->logged = 1;
        pthread_mutex_unlock(&w->lock); /* a log may take its time */
        skg_log(context, SKG_LOG_PROGRESS, "compiling kernels for %s, once for this device", device);
        pthread_mutex_lock(&w->lock);
    }
    while (!w->done) pthread_cond_wait(&w->changed, &w->lock);
    pthread_mutex_unlock(&w->lock);
}

void skg_watch_call(skg_watch *watch, const skg_context *context, const char *device,
                    void (*work)(void *data), void *data) {
    watched w = {PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER, 0, work, data};
    pthread_t thread;
    const int64_t begin = now_ms();
    if (start(&w, &thread)) {
        wait_for(&w, watch, context, device);
        pthread_join(thread, NULL);
    } else {
        work(data);
    }
    watch->ms += now_ms() - begin;
    pthread_cond_destroy(&w.changed);
    pthread_mutex_destroy(&w.lock);
}
