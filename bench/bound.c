/* Measures the cost of OpenMP binding the calling thread to one core, as clusters have it: processes with OMP_PROC_BIND=true and =false
 * alternately, each a new one, because OpenMP binds when a program starts. */
#include "common/bench.h"
#include "common/scenes.h"

#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "[--quick] [--scene FILE.json | FOLDER | sphere:N] [--size N] [--frames N] [--repeats N]\n"
    "    [--device CONFIG] [--csv FILE]";

typedef struct {
    long size, frames, repeats;
    int worker;
    const char *scene, *device, *csv;
} settings;

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.size = 512, .frames = 100, .repeats = 9};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick"))
            out->frames = 30, out->repeats = 3;
        else if (bench_flag(&arguments, "--worker"))
            out->worker = 1;
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 16, 8192, 1, &out->size);
        else if (bench_option(&arguments, "--frames", &value))
            bench_numbers(value, 1, BENCH_SAMPLES, 1, &out->frames);
        else if (bench_option(&arguments, "--repeats", &value))
            bench_numbers(value, 1, BENCH_SAMPLES, 1, &out->repeats);
        else if (!bench_option(&arguments, "--scene", &out->scene) &&
                 !bench_option(&arguments, "--device", &out->device) &&
                 !bench_option(&arguments, "--csv", &out->csv))
            bench_usage(&arguments, usage);
    }
}

/* Prints the least time of an image. */
static void work(const settings *set) {
    bench_scene scene;
    skg_plan *plan = NULL;
    skg_output output;
    bench_times times = {0};
    skg_context *context = bench_context(set->device);
    scene_open(context, set->scene, set->size, &scene);
    bench_try(skg_plan_create(context, scene.scene, &scene.view, scene.beam, &scene.options, &plan), "plan");
    skg_output_init(&output);
    output.data = bench_alloc((size_t)(scene.view.rows * scene.view.columns), sizeof(float));
    bench_try(skg_plan_image(plan, &output), "image");
    for (long k = 0; k < set->frames; k++) {
        const double start = bench_now();
        bench_try(skg_plan_image(plan, &output), "image");
        bench_add(&times, bench_now() - start);
    }
    printf("%.17g\n", bench_min(&times));
    free(output.data);
    skg_plan_release(&plan);
    scene_close(&scene);
    skg_context_release(&context);
}

/* The words of this process again, for a worker in that environment. */
static double measure(const char *binding, int count, char **words) {
    char line[4096];
    double ms = 0;
    int used = snprintf(line, sizeof line, "OMP_PROC_BIND=%s", binding);
    for (int n = 0; n < count && used < (int)sizeof line; n++)
        used += snprintf(line + used, sizeof line - (size_t)used, " '%s'", words[n]);
    if (used + 10 >= (int)sizeof line) bench_die("the options are too long");
    strcat(line, " --worker");
    FILE *worker = popen(line, "r");
    if (!worker || fscanf(worker, "%lf", &ms) != 1 || pclose(worker) != 0)
        bench_die("a process failed: %s", line);
    return ms;
}

int main(int count, char **words) {
    settings set;
    static bench_times bound, unbound;
    read_settings(count, words, &set);
    if (set.worker) {
        work(&set);
        return 0;
    }
    for (long k = 0; k < set.repeats; k++) {
        bench_add(&bound, measure("true", count, words));
        bench_add(&unbound, measure("false", count, words));
    }
    const double ratio = bench_min(&bound) / bench_min(&unbound);
    printf(
        "Least time of %ld images in each of %ld processes, ms, minimum / median. Target: a ratio of minima within 5 %% of "
        "1.\n\n| OMP_PROC_BIND | ms |\n|---|---:|\n| true | %.4g / %.4g |\n| false | %.4g / %.4g |\n| ratio | %.3f |\n",
        set.frames, set.repeats, bench_min(&bound), bench_median(&bound), bench_min(&unbound),
        bench_median(&unbound), ratio);
    FILE *csv = set.csv ? bench_open(set.csv) : NULL;
    if (csv)
        fprintf(csv, "binding,min_ms,median_ms\ntrue,%.5g,%.5g\nfalse,%.5g,%.5g\n", bench_min(&bound),
                bench_median(&bound), bench_min(&unbound), bench_median(&unbound));
    if (csv && fclose(csv) != 0) bench_die("%s could not be written", set.csv);
    return 0;
}
