/* Time, and the line that shows how far a long computation is. */
#include "common/progress.h"

#include "common/say.h"

#include <errno.h>
#include <inttypes.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

/* How long the command is silent at first; a later step shows its line at once. */
static const double SILENT_MS = 1000;
enum { RENEWED_NS = 250000000, SECOND_NS = 1000000000 };

/* The computation; all of it is guarded by `lock`. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t ended = PTHREAD_COND_INITIALIZER;
static struct {
    const char *what;
    int64_t done, total;
    double start_ms;
    double end_ms; /* when it is expected to end; 0: no forecast */
    int is_running;
    int is_followed; /* 1: done and total are those of `shared` */
} task;

static skg_progress *shared; /* stays until the process ends */

static double begun_ms; /* the first computation; 0: none yet */

static pthread_t shower;
static int has_shower; /* 1: the thread was started */

double cli_now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static void show(void) {
    char line[160];
    const double now = cli_now_ms(), ms = now - task.start_ms, seconds = 1e-3 * ms;
    if (task.end_ms > 0) {
        const double left = task.end_ms > now ? 1e-3 * (task.end_ms - now) : 0;
        int used = snprintf(line, sizeof line, "%s", task.what);
        if (task.total > 0)
            used += snprintf(line + used, sizeof line - (size_t)used, ": %" PRId64 " of %" PRId64, task.done,
                             task.total);
        snprintf(line + used, sizeof line - (size_t)used, ", %.0f s left", left);
        cli_show_line(line);
        return;
    }
    if (now - begun_ms < SILENT_MS) return;
    if (task.is_followed) (void)skg_progress_get(shared, &task.done, &task.total);
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
    task.what = what, task.total = total, task.done = 0, task.end_ms = 0, task.is_followed = 0;
    task.start_ms = cli_now_ms(), task.is_running = 1;
    if (begun_ms == 0) begun_ms = task.start_ms;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    has_shower = pthread_create(&shower, NULL, run, NULL) == 0; /* without it there is no line */
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

skg_progress *cli_progress(void) {
    if (!shared) (void)skg_progress_create(NULL, NULL, &shared);
    return shared;
}

void cli_progress_follow(const char *what) {
    cli_progress_begin(what, 0);
    pthread_mutex_lock(&lock);
    task.is_followed = cli_progress() != NULL;
    pthread_mutex_unlock(&lock);
}

void cli_progress_step(int64_t done) {
    pthread_mutex_lock(&lock);
    task.done = done;
    pthread_mutex_unlock(&lock);
}

void cli_progress_forecast(const char *what, int64_t done, int64_t total, double left_ms) {
    if (!has_shower) cli_progress_begin(what, total);
    if (!has_shower) return; /* no terminal */
    pthread_mutex_lock(&lock);
    task.what = what, task.done = done, task.total = total;
    task.end_ms = cli_now_ms() + left_ms;
    show();
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
