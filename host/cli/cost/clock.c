/* The clocks of runs. */
#include "cost/clock.h"

#include "common/progress.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

/* Milliseconds; negative: there is no such clock. */
static double read_ms(clockid_t clock) {
    struct timespec now = {0};
    if (clock_gettime(clock, &now) != 0) return -1;
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

/* The clock of a thread of this process by its number, as Linux's clock_getcpuclockid makes it for processes: the complement of the
 * number over three bits, of which 4 says thread and 2 scheduled time (include/linux/posix-timers_types.h). */
static clockid_t clock_of(int thread) {
    return (clockid_t)(~(unsigned)thread << 3 | 6U);
}

/* Does nothing where the threads of a process are not listed. */
static void read_others(cost_instant *now) {
    DIR *tasks = opendir("/proc/self/task");
    const struct dirent *entry;
    now->count = 0;
    while (tasks && now->count < COST_THREADS_MAX && (entry = readdir(tasks))) {
        const int id = atoi(entry->d_name);
        const double ms = id > 0 && id != (int)getpid() ? read_ms(clock_of(id)) : -1;
        if (ms < 0) continue;
        now->ids[now->count] = id;
        now->others[now->count++] = ms;
    }
    if (tasks) closedir(tasks);
}

void cost_begin(cost_instant *begun) {
    read_others(begun);
    begun->own = read_ms(CLOCK_THREAD_CPUTIME_ID);
    begun->wall = cli_now_ms();
}

void cost_end(cost_instant *ended) {
    ended->wall = cli_now_ms();
    ended->own = read_ms(CLOCK_THREAD_CPUTIME_ID);
    read_others(ended);
}

void cost_choose_clock(cost_study *study) {
    cost_instant now;
    cost_begin(&now);
    study->has_processor_clock = study->session.device.cpu == 1 && now.count > 0;
}

const char *cost_clock_name(const cost_study *study) {
    return study->has_processor_clock ? "cpu" : "wall";
}

/* Processor time that a thread had at the beginning; 0: it is new. */
static double before(const cost_instant *begun, int id) {
    for (int i = 0; i < begun->count; i++)
        if (begun->ids[i] == id) return begun->others[i];
    return 0;
}

double cost_price_ms(const cost_study *study, const cost_instant *begun, const cost_instant *ended) {
    const double wall = ended->wall - begun->wall;
    double busiest = 0;
    for (int i = 0; i < ended->count; i++)
        busiest = fmax(busiest, ended->others[i] - before(begun, ended->ids[i]));
    return study->has_processor_clock ? fmin(ended->own - begun->own + busiest, wall) : wall;
}
