#include "common/progress.h"

#include "common/say.h"

#include <errno.h>
#include <inttypes.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

static const double SILENT_MS = 2000;
enum { RENEWED_NS = 250000000, SECOND_NS = 1000000000 };

/* The computation; all of it is guarded by `lock`. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t ended = PTHREAD_COND_INITIALIZER;
static struct {
    const char *what;
    int64_t done, total;
    double start_ms;
    int is_running;
} task;

static pthread_t shower;
static int has_shower; /* 1: the thread was started */

double cli_now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static void show(void) {
    char line[160];
    const double ms = cli_now_ms() - task.start_ms, seconds = 1e-3 * ms;
    if (ms < SILENT_MS) return;
    if (task.total > 0 && task.done > 0) {
        const double rate = (double)task.done / seconds;
        snprintf(line, sizeof line, "%s: %" PRId64 " of %" PRId64 ", %.3g per second, %.0f s left", task.what,
                 task.done, task.total, rate, (double)(task.total - task.done) / rate);
    } else {
        snprintf(line, sizeof line, "%s, %.0f s", task.what, seconds);
    }
    cli_show_line(line);
}

static void *run(void *unused) {
    (void)unused;
    pthread_mutex_lock(&lock);
    while (task.is_running) {
        struct timespec until;
        clock_gettime(CLOCK_REALTIME, &until);
        until.tv_nsec += RENEWED_NS;
        if (until.tv_nsec >= SECOND_NS) until.tv_nsec -= SECOND_NS, until.tv_sec++;
        if (pthread_cond_timedwait(&ended, &lock, &until) == ETIMEDOUT && task.is_running) show();
    }
    pthread_mutex_unlock(&lock);
    return NULL;
}

void cli_progress_begin(const char *what, int64_t total) {
    sigset_t all, before; /* signals belong to the thread that writes */
    cli_progress_end();
    if (cli_is_quiet() || !isatty(STDERR_FILENO)) return;
    task.what = what, task.total = total, task.done = 0, task.start_ms = cli_now_ms(), task.is_running = 1;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    has_shower = pthread_create(&shower, NULL, run, NULL) == 0; /* without it there is no line */
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

void cli_progress_step(int64_t done) {
    pthread_mutex_lock(&lock);
    task.done = done;
    pthread_mutex_unlock(&lock);
}

void cli_progress_end(void) {
    if (!has_shower) return;
    pthread_mutex_lock(&lock);
    task.is_running = 0;
    pthread_cond_signal(&ended);
    pthread_mutex_unlock(&lock);
    pthread_join(shower, NULL);
    has_shower = 0;
    cli_show_line(NULL);
}
