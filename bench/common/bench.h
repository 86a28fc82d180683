/* What all benchmarks share: a clock, samples, options, the end on an error. Times are in ms. */
#ifndef BENCH_H
#define BENCH_H

#include <skiagraph/skiagraph.h>

#include <stddef.h>
#include <stdio.h>

/* Time since some moment, ms. */
double bench_now(void);
void bench_sleep(double ms);

/* Ends the program with a sentence on standard error. */
_Noreturn void bench_die(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Ends the program with the library's own sentence where a call failed; answers such as SKG_RANGE pass. */
void bench_try(skg_status status, const char *what);

/* A context whose warnings go to standard error, the same one in a row once. config: as skg_context_create
 * takes it. */
skg_context *bench_context(const char *config);

/* `count` zeroed elements aligned to a cache line; ends the program when there is no memory. free() releases.
 */
void *bench_alloc(size_t count, size_t size);

/* Samples of one contender. */
enum { BENCH_SAMPLES = 1024 };
typedef struct {
    int count;
    double ms[BENCH_SAMPLES];
} bench_times;

void bench_add(bench_times *times, double ms);
double bench_least(const bench_times *times);
double bench_median(const bench_times *times);

/* Runs one frame of a contender. */
typedef void (*bench_frame)(void *contender);

/* One turn of a contender: a frame untimed, which wakes its threads and warms its cache, then `frames` timed
 * ones. The pause before lets the threads of the last contender go to sleep: OpenMP's spin for some ms after
 * their work. */
void bench_turn(bench_frame frame, void *contender, int frames, bench_times *times);

/* Turns of several contenders by turns, so that what disturbs the machine disturbs all: `turns` each. */
void bench_interleave(int contenders, const bench_frame *frames, void *const *what, int turns, int per_turn,
                      bench_times *times);

/* Options of the form --name VALUE and --name. */
typedef struct {
    int count;
    char **words;
    int next;
} bench_arguments;

/* The next word is --name: takes it (and its value). */
int bench_flag(bench_arguments *arguments, const char *name);
int bench_option(bench_arguments *arguments, const char *name, const char **value);
/* No option took the next word: ends the program with `usage`. */
_Noreturn void bench_usage(const bench_arguments *arguments, const char *usage);

/* Whole numbers parted by commas, each in [low, high]; returns how many. */
int bench_numbers(const char *text, long low, long high, int most, long *numbers);

/* A file to write, or the end of the program. */
FILE *bench_open(const char *path);

#endif
