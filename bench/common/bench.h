/* Shared code of the benchmarks: clock, samples, options, errors. Times are in ms. */
#ifndef BENCH_H
#define BENCH_H

#include <skiagraph/skiagraph.h>

#include <stddef.h>
#include <stdio.h>

#define BENCH_PI 3.14159265358979323846

/* Time of a clock that never goes back, ms. */
double bench_now(void);
void bench_sleep(double ms);

/* Prints a sentence on standard error and ends the program with status 1. */
_Noreturn void bench_die(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Ends the program with the library's message if a call failed. Statuses such as SKG_RANGE are no failures. */
void bench_try(skg_status status, const char *what);

/* A context that prints warnings on standard error, without immediate repetitions. config: see
 * skg_context_create. */
skg_context *bench_context(const char *config);

/* `count` zeroed elements, aligned to a cache line, to be freed by free(). Ends the program if memory is
 * exhausted. */
void *bench_alloc(size_t count, size_t size);

/* The times of one contender. A contender is one of several programs or settings that are compared. */
enum { BENCH_SAMPLES = 1024 };
typedef struct {
    int count;
    double ms[BENCH_SAMPLES];
} bench_times;

void bench_add(bench_times *times, double ms);
double bench_min(const bench_times *times);
double bench_median(const bench_times *times);

/* Computes one frame of a contender. */
typedef void (*bench_frame)(void *contender);

/* One turn of a contender: a frame that is not timed, which wakes its threads and warms its caches, then
 * `frames` timed ones. The pause before it lets the threads of the previous contender go to sleep: OpenMP's
 * spin for some ms after their work. */
void bench_turn(bench_frame frame, void *contender, int frames, bench_times *times);

/* `turns` turns of each contender, alternately, so that other load disturbs all of them alike. */
void bench_interleave(int contenders, const bench_frame *frames, void *const *what, int turns, int per_turn,
                      bench_times *times);

/* Options of the form --name VALUE and --name. */
typedef struct {
    int count;
    char **words;
    int next;
} bench_arguments;

/* Whether the next word is --name; if so, takes it, and its value. */
int bench_flag(bench_arguments *arguments, const char *name);
int bench_option(bench_arguments *arguments, const char *name, const char **value);
/* Ends the program with the usage, because no option took the next word. */
_Noreturn void bench_usage(const bench_arguments *arguments, const char *usage);

/* Reads whole numbers in [low, high], separated by commas. Returns their number. */
int bench_numbers(const char *text, long low, long high, int most, long *numbers);

/* Opens a file to write, or ends the program. */
FILE *bench_open(const char *path);

#endif
