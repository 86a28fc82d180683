/* Shared code of the benchmarks: clock, samples, options, errors. */
#include "bench.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

double bench_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

void bench_sleep(double ms) {
    const struct timespec pause = {(time_t)(ms / 1e3), (long)(ms * 1e6) % 1000000000};
    nanosleep(&pause, NULL);
}

void bench_die(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    exit(1);
}

void bench_try(skg_status status, const char *what) {
    if (SKG_FAILED(status)) bench_die("%s: %s: %s", what, skg_status_name(status), skg_last_error());
}

static void warn(int32_t level, const char *sentence, void *user) {
    static char last[512];
    (void)user;
    if (level != SKG_LOG_WARNING || !strncmp(last, sentence, sizeof last - 1)) return;
    snprintf(last, sizeof last, "%s", sentence);
    fprintf(stderr, "warning: %s\n", sentence);
}

skg_context *bench_context(const char *config) {
    skg_context *context = NULL;
    bench_try(skg_context_create(config, &context), "context");
    bench_try(skg_context_log_set(context, warn, NULL), "context");
    return context;
}

void *bench_alloc(size_t count, size_t size) {
    const size_t line = 64, bytes = (count * size + line - 1) / line * line;
    void *memory = aligned_alloc(line, bytes ? bytes : line);
    if (!memory) bench_die("memory is exhausted: %zu elements of %zu bytes", count, size);
    return memset(memory, 0, bytes);
}

void bench_add(bench_times *times, double ms) {
    if (times->count < BENCH_SAMPLES) times->ms[times->count++] = ms;
}

double bench_min(const bench_times *times) {
    double least = times->ms[0];
    for (int i = 1; i < times->count; i++)
        if (times->ms[i] < least) least = times->ms[i];
    return least;
}

static int ascending(const void *a, const void *b) {
    const double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

double bench_median(const bench_times *times) {
    double sorted[BENCH_SAMPLES];
    memcpy(sorted, times->ms, (size_t)times->count * sizeof *sorted);
    qsort(sorted, (size_t)times->count, sizeof *sorted, ascending);
    return (sorted[(times->count - 1) / 2] + sorted[times->count / 2]) / 2;
}

void bench_turn(bench_frame frame, void *contender, int frames, bench_times *times) {
    bench_sleep(10);
    frame(contender);
    for (int i = 0; i < frames; i++) {
        const double start = bench_now();
        frame(contender);
        bench_add(times, bench_now() - start);
    }
}

void bench_interleave(int contenders, const bench_frame *frames, void *const *what, int turns, int per_turn,
                      bench_times *times) {
    for (int turn = 0; turn < turns; turn++)
        for (int i = 0; i < contenders; i++) bench_turn(frames[i], what[i], per_turn, &times[i]);
}

int bench_flag(bench_arguments *arguments, const char *name) {
    if (strcmp(arguments->words[arguments->next], name) != 0) return 0;
    arguments->next++;
    return 1;
}

int bench_option(bench_arguments *arguments, const char *name, const char **value) {
    if (!bench_flag(arguments, name)) return 0;
    if (arguments->next == arguments->count) bench_die("%s needs a value", name);
    *value = arguments->words[arguments->next++];
    return 1;
}

void bench_usage(const bench_arguments *arguments, const char *usage) {
    bench_die("%s is unknown; usage: %s %s", arguments->words[arguments->next], arguments->words[0], usage);
}

int bench_numbers(const char *text, long low, long high, int most, long *numbers) {
    int count = 0;
    for (const char *at = text; count < most;) {
        char *end = NULL;
        errno = 0;
        const long number = strtol(at, &end, 10);
        if (end == at || errno || number < low || number > high)
            bench_die("\"%s\" is not a list of whole numbers from %ld to %ld, separated by commas", text, low,
                      high);
        numbers[count++] = number;
        if (!*end) return count;
        if (*end != ',') bench_die("\"%s\": \"%s\" should be a comma or the end", text, end);
        at = end + 1;
    }
    bench_die("\"%s\" has more than %d numbers", text, most);
}

FILE *bench_open(const char *path) {
    FILE *file = fopen(path, "w");
    if (!file) bench_die("%s: %s", path, strerror(errno));
    return file;
}
