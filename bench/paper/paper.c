/* The study of Vidal and Villard 2016 (section 4), made again. */
#include "affinity/affinity.h"
#include "paper/images.h"
#include "paper/numbers.h"
#include "paper/speed.h"

static const char usage[] =
    "[--quick] [--series N] [--iterations N] [--seconds N] [--size N] [--triangles N,...] [--body N] "
    "[--scene FILE.json [--into PREFIX] [--reference PREFIX]] [--device CONFIG] [--affinity] [--csv FILE]";

static void read_settings(int count, char **words, paper_study *out, const char **device, const char **csv) {
    static const char standard[] = "10500,21000,42000,84000";
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    int pinned = 0;
    *out = (paper_study){
        .series = 15, .iterations = 500, .seconds = 60, .size = 512, .body = 41710, .pieces = 17};
    out->sizes = bench_numbers(standard, 10000, 20000000, PAPER_SIZES_MAX, out->triangles);
    while (arguments.next < count) {
        if (bench_flag(&arguments, "--quick"))
            out->series = 5, out->iterations = 10, out->seconds = 1, out->sizes = 3, out->pieces = 4;
        else if (bench_option(&arguments, "--series", &value))
            bench_numbers(value, 3, BENCH_SAMPLES, 1, &out->series);
        else if (bench_option(&arguments, "--iterations", &value))
            bench_numbers(value, 1, 1000000, 1, &out->iterations);
        else if (bench_option(&arguments, "--seconds", &value))
            bench_numbers(value, 1, 86400, 1, &out->seconds);
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 16, 8192, 1, &out->size);
        else if (bench_option(&arguments, "--triangles", &value))
            out->sizes = bench_numbers(value, 10000, 20000000, PAPER_SIZES_MAX, out->triangles);
        else if (bench_option(&arguments, "--body", &value))
            bench_numbers(value, 10000, 20000000, 1, &out->body);
        else if (bench_flag(&arguments, "--affinity"))
            pinned = 1;
        else if (!bench_option(&arguments, "--scene", &out->scene) &&
                 !bench_option(&arguments, "--into", &out->into) &&
                 !bench_option(&arguments, "--reference", &out->reference) &&
                 !bench_option(&arguments, "--device", device) && !bench_option(&arguments, "--csv", csv))
            bench_usage(&arguments, usage);
    }
    if (pinned) host_pin_threads();
}

int main(int count, char **words) {
    const char *device = NULL, *csv = NULL;
    paper_study study;
    read_settings(count, words, &study, &device, &csv);
    study.context = bench_context(device);
    /* A frame with leaky meshes would warn of each of them. */
    bench_try(skg_context_log_set(study.context, NULL, NULL), "context");
    study.csv = csv ? bench_open(csv) : NULL;
    if (study.csv) fprintf(study.csv, "part,what,triangles,series,value,unit\n");
    const int missed = paper_numbers(&study);
    if (study.scene) paper_images(&study);
    paper_speed(&study);
    if (study.csv && fclose(study.csv) != 0) bench_die("%s could not be written", csv);
    skg_context_release(&study.context);
    return missed;
}
