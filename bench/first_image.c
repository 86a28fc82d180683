/* Time from the start of a process to its first image, and the largest memory that it used. Every sample is a
 * new process, as a user experiences it. */
#include "common/bench.h"
#include "common/scenes.h"

#include "affinity/affinity.h"

#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static const char usage[] = "[--quick] [--scene FILE.json | FOLDER | sphere:N] [--size N] [--repeats N]\n"
                            "    [--device CONFIG] [--affinity] [--csv FILE]";

typedef struct {
    long size, repeats;
    int affinity;
    const char *scene, *device, *csv;
} settings;

enum { CONTEXT, LOADING, PLANNING, FIRST, SECOND, ALL, STAGES };
static const char *const stages[STAGES] = {
    "context", "loading", "planning", "first image", "second image", "loading, planning and first image"};

typedef struct {
    double ms[STAGES];
    int64_t parts, triangles;
} sample;

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.size = 512, .repeats = 7};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick"))
            out->repeats = 2;
        else if (bench_flag(&arguments, "--affinity"))
            out->affinity = 1;
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 16, 8192, 1, &out->size);
        else if (bench_option(&arguments, "--repeats", &value))
            bench_numbers(value, 1, BENCH_SAMPLES, 1, &out->repeats);
        else if (!bench_option(&arguments, "--scene", &out->scene) &&
                 !bench_option(&arguments, "--device", &out->device) &&
                 !bench_option(&arguments, "--csv", &out->csv))
            bench_usage(&arguments, usage);
    }
}

static void run_stages(const settings *set, sample *out) {
    bench_scene scene;
    skg_plan *plan = NULL;
    skg_plan_report report;
    skg_output output;
    double moment[STAGES];
    int64_t channels = 0;
    moment[CONTEXT] = bench_now();
    skg_context *context = bench_context(set->device);
    moment[LOADING] = bench_now();
    scene_open(context, set->scene, set->size, &scene);
    moment[PLANNING] = bench_now();
    bench_try(skg_plan_create(context, scene.scene, &scene.view, scene.beam, &scene.options, &plan), "plan");
    bench_try(skg_plan_channel_count(plan, &channels), "plan");
    skg_output_init(&output);
    output.data = bench_alloc((size_t)(channels * scene.view.rows * scene.view.columns), sizeof(float));
    moment[FIRST] = bench_now();
    bench_try(skg_plan_image(plan, &output), "image");
    moment[SECOND] = bench_now();
    bench_try(skg_plan_image(plan, &output), "image");
    moment[ALL] = bench_now();
    for (int k = 0; k < ALL; k++) out->ms[k] = moment[k + 1] - moment[k];
    out->ms[ALL] = moment[SECOND] - moment[CONTEXT];
    skg_plan_report_init(&report);
    bench_try(skg_plan_report_get(plan, &report), "report");
    out->parts = report.parts;
    out->triangles = report.triangles;
}

/* Takes a sample in a new process. Returns the largest memory of any process so far, MiB. */
static double run_process(const settings *set, sample *out) {
    int ends[2], status = 0;
    struct rusage children;
    if (pipe(ends) != 0) bench_die("a pipe cannot be made");
    const pid_t child = fork();
    if (child < 0) bench_die("a process cannot be made");
    if (child == 0) {
        run_stages(set, out);
        _exit(write(ends[1], out, sizeof *out) == (ssize_t)sizeof *out ? 0 : 1);
    }
    close(ends[1]);
    const ssize_t got = read(ends[0], out, sizeof *out);
    close(ends[0]);
    waitpid(child, &status, 0);
    if (got != (ssize_t)sizeof *out || status != 0) bench_die("a process failed");
    getrusage(RUSAGE_CHILDREN, &children);
    return (double)children.ru_maxrss / 1024;
}

int main(int count, char **words) {
    settings set;
    sample once = {0};
    static bench_times times[STAGES];
    double cold[STAGES], memory = 0;
    read_settings(count, words, &set);
    if (set.affinity) host_pin_threads();
    run_process(&set, &once); /* may compile the kernels */
    memcpy(cold, once.ms, sizeof cold);
    for (long k = 0; k < set.repeats; k++) {
        memory = run_process(&set, &once);
        for (int stage = 0; stage < STAGES; stage++) bench_add(&times[stage], once.ms[stage]);
    }
    printf(
        "%lld parts, %lld triangles; %ld processes after a first one, which compiled the kernels that were not cached. Largest "
        "memory: %.0f MiB. Times in ms.\nTarget: a thorax of 61 organs below 2000 in total; 4 million triangles below "
        "1024 MiB.\n\n| stage | first process | minimum | median |\n|---|---:|---:|---:|\n",
        (long long)once.parts, (long long)once.triangles, set.repeats, memory);
    FILE *csv = set.csv ? bench_open(set.csv) : NULL;
    if (csv) fprintf(csv, "stage,first_process_ms,min_ms,median_ms\n");
    for (int k = 0; k < STAGES; k++) {
        printf("| %s | %.4g | %.4g | %.4g |\n", stages[k], cold[k], bench_min(&times[k]),
               bench_median(&times[k]));
        if (csv)
            fprintf(csv, "\"%s\",%.5g,%.5g,%.5g\n", stages[k], cold[k], bench_min(&times[k]),
                    bench_median(&times[k]));
    }
    if (csv)
        fprintf(csv, "# parts %lld, triangles %lld, most memory %.0f MiB\n", (long long)once.parts,
                (long long)once.triangles, memory);
    if (csv && fclose(csv) != 0) bench_die("%s could not be written", set.csv);
    return 0;
}
