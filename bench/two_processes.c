/* Two processes at once against one of them alone, each with half of the cores and then each with all cores.
 * PoCL's threads are not pinned here, because the pinned threads of both processes would share the first
 * cores. */
#include "common/bench.h"
#include "common/scenes.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static const char usage[] =
    "[--quick] [--scene FILE.json | FOLDER | sphere:N] [--size N] [--frames N] [--repeats N]\n"
    "    [--device CONFIG (without threads=)] [--csv FILE]";

typedef struct {
    long size, frames, repeats;
    const char *scene, *device, *csv;
} settings;

typedef struct {
    pid_t process;
    int ask, answer; /* pipes */
} worker;

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.size = 512, .frames = 200, .repeats = 9, .device = ""};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick"))
            out->frames = 50, out->repeats = 3;
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 16, 8192, 1, &out->size);
        else if (bench_option(&arguments, "--frames", &value))
            bench_numbers(value, 1, 1000000, 1, &out->frames);
        else if (bench_option(&arguments, "--repeats", &value))
            bench_numbers(value, 1, BENCH_SAMPLES, 1, &out->repeats);
        else if (!bench_option(&arguments, "--scene", &out->scene) &&
                 !bench_option(&arguments, "--device", &out->device) &&
                 !bench_option(&arguments, "--csv", &out->csv))
            bench_usage(&arguments, usage);
    }
}

/* Makes a plan and a first image and reports it; then, for each byte that comes through the pipe, times
 * `frames` images. Ends when the pipe is closed. */
static _Noreturn void work(const settings *set, const char *config, int ask, int answer) {
    bench_scene scene;
    skg_plan *plan = NULL;
    skg_output output;
    char question = 0;
    double ms = 0;
    skg_context *context = bench_context(config);
    scene_open(context, set->scene, set->size, &scene);
    bench_try(skg_plan_create(context, scene.scene, &scene.view, scene.beam, &scene.options, &plan), "plan");
    skg_output_init(&output);
    output.data = bench_alloc((size_t)(scene.view.rows * scene.view.columns), sizeof(float));
    bench_try(skg_plan_image(plan, &output), "image");
    while (write(answer, &ms, sizeof ms) == (ssize_t)sizeof ms && read(ask, &question, 1) == 1) {
        const double start = bench_now();
        for (long k = 0; k < set->frames; k++) bench_try(skg_plan_image(plan, &output), "image");
        ms = (bench_now() - start) / (double)set->frames;
    }
    _exit(0);
}

/* other: the worker whose ends of pipes the new process must close; may be NULL. */
static worker start(const settings *set, const char *config, const worker *other) {
    int ask[2], answer[2];
    if (pipe(ask) != 0 || pipe(answer) != 0) bench_die("a pipe cannot be made");
    const pid_t process = fork();
    if (process < 0) bench_die("a process cannot be made");
    if (process == 0) {
        close(ask[1]), close(answer[0]);
        if (other) close(other->ask), close(other->answer);
        work(set, config, ask[0], answer[1]);
    }
    close(ask[0]), close(answer[1]);
    return (worker){process, ask[1], answer[0]};
}

static void ask(const worker *one) {
    if (write(one->ask, "?", 1) != 1) bench_die("a process has gone");
}

static double answer(const worker *one) {
    double ms = 0;
    if (read(one->answer, &ms, sizeof ms) != (ssize_t)sizeof ms) bench_die("a process has gone");
    return ms;
}

static void stop(worker *one) {
    close(one->ask), close(one->answer);
    waitpid(one->process, NULL, 0);
}

static void measure(const settings *set, const char *name, long threads, FILE *csv) {
    char config[256];
    worker two[2];
    bench_times alone = {0}, together = {0};
    snprintf(config, sizeof config, "%s threads=%ld", set->device, threads);
    two[0] = start(set, config, NULL);
    two[1] = start(set, config, &two[0]);
    answer(&two[0]), answer(&two[1]); /* ready */
    for (long k = 0; k < set->repeats; k++) {
        for (int who = 0; who < 2; who++) {
            ask(&two[who]);
            bench_add(&alone, answer(&two[who]));
        }
        ask(&two[0]), ask(&two[1]);
        bench_add(&together, answer(&two[0])), bench_add(&together, answer(&two[1]));
    }
    stop(&two[0]), stop(&two[1]);
    const double ratio = bench_median(&together) / bench_median(&alone);
    printf("| %s | %ld | %.4g / %.4g | %.4g / %.4g | %.2f |\n", name, threads, bench_min(&alone),
           bench_median(&alone), bench_min(&together), bench_median(&together), ratio);
    fflush(stdout);
    if (csv)
        fprintf(csv, "%s,%ld,%.5g,%.5g,%.5g,%.5g,%.3f\n", name, threads, bench_min(&alone),
                bench_median(&alone), bench_min(&together), bench_median(&together), ratio);
}

int main(int count, char **words) {
    settings set;
    read_settings(count, words, &set);
    signal(SIGPIPE, SIG_IGN);
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    FILE *csv = set.csv ? bench_open(set.csv) : NULL;
    if (csv) fprintf(csv, "share,threads,alone_min_ms,alone_median_ms,two_min_ms,two_median_ms,ratio\n");
    printf(
        "Times in ms a frame, over runs of %ld frames, minimum / median; ratio of medians. Target for half of the cores "
        "each: 1.3.\nWith all cores each, two fair shares of the machine would be 2.\n\n"
        "| each has | threads | one at a time | two at once | ratio |\n|---|---:|---:|---:|---:|\n",
        set.frames);
    fflush(stdout); /* before processes are made, which would print it again */
    measure(&set, "half of the cores", cores > 1 ? cores / 2 : 1, csv);
    if (cores > 1) measure(&set, "all cores", cores, csv);
    if (csv && fclose(csv) != 0) bench_die("%s could not be written", set.csv);
    return 0;
}
