/* Scattered photons: beside images of a Monte Carlo program, and how long they take. */
#include "affinity/affinity.h"
#include "scatter/calibrate.h"
#include "scatter/compare.h"
#include "scatter/rooms.h"
#include "scatter/speed.h"

#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "[--quick] [--reference FOLDER/] [--cube FILE.json] [--compare | --seeds N | --rooms | --truth HISTORIES] [--room NAME] [--device CONFIG] [--affinity] "
    "[--csv FILE]";

typedef struct {
    int quick, affinity, compare, rooms;                 /* compare, rooms: no times */
    const char *reference, *cube, *device, *csv, *seeds; /* seeds: nothing but the calibration of the error */
    const char *truth, *room;                            /* truth: nothing but photons of our own in rooms */
} settings;

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    *out = (settings){0};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick"))
            out->quick = 1;
        else if (bench_flag(&arguments, "--affinity"))
            out->affinity = 1;
        else if (bench_flag(&arguments, "--compare"))
            out->compare = 1;
        else if (bench_flag(&arguments, "--rooms"))
            out->rooms = 1;
        else if (!bench_option(&arguments, "--reference", &out->reference) &&
                 !bench_option(&arguments, "--cube", &out->cube) &&
                 !bench_option(&arguments, "--device", &out->device) &&
                 !bench_option(&arguments, "--seeds", &out->seeds) &&
                 !bench_option(&arguments, "--truth", &out->truth) &&
                 !bench_option(&arguments, "--room", &out->room) &&
                 !bench_option(&arguments, "--csv", &out->csv))
            bench_usage(&arguments, usage);
    }
}

static int compare(skg_context *context, const settings *set, FILE *csv) {
    char prefix[4096];
    int missed = compare_water(context, set->reference, set->quick ? 1 << 18 : 1 << 20, csv);
    snprintf(prefix, sizeof prefix, "%sa_", set->reference);
    if (set->cube) missed += compare_cube(context, prefix, set->cube, set->quick ? 0.005 : 0.002, csv);
    return missed;
}

/* Targets: s to each tolerance; 0: none. */
static void measure(skg_context *context, const settings *set, FILE *csv) {
    static const double tolerances[] = {0.05, 0.02, 0.01}, cube[] = {0, 0, 0.8}, water[] = {0, 4, 0},
                        thorax[] = {2, 10};
    const int64_t truth = set->quick ? 1 << 17 : 1 << 19;
    speed_head();
    if (set->cube) {
        subject s = subject_cube(context, set->cube, 0);
        speed_rows(&s, 3, tolerances, cube, truth, csv);
        subject_close(&s);
    }
    for (int air = 0; air < 2; air++) {
        subject s = subject_water(context, air ? "w1" : "w0", air ? 300 : 100.00001, 1);
        speed_rows(&s, 3, tolerances, water, truth, csv);
        subject_close(&s);
    }
    subject s = subject_thorax(context, 512);
    speed_rows(&s, 2, tolerances, thorax, truth, csv);
    subject_close(&s);
    speed_merit(context, set->quick ? 1 << 16 : 1 << 18, csv);
}

static void calibrate(skg_context *context, const settings *set, FILE *csv) {
    static const double tolerances[] = {0.05, 0.02};
    const int seeds = atoi(set->seeds);
    subject subjects[4];
    int scenes = 0;
    if (set->cube) subjects[scenes++] = subject_cube(context, set->cube, 0);
    subjects[scenes++] = subject_water(context, "w0", 100.00001, 1);
    subjects[scenes++] = subject_water(context, "w1", 300, 1);
    subjects[scenes++] = subject_thorax(context, 64);
    calibrate_head(seeds);
    for (int s = 0; s < scenes; s++) {
        calibrate_rows(&subjects[s], seeds, 2, tolerances, csv);
        subject_close(&subjects[s]);
    }
}

int main(int count, char **words) {
    settings set;
    read_settings(count, words, &set);
    if (set.affinity) host_pin_threads();
    if (set.truth) {
        rooms_make_truth(set.room, (int64_t)atof(set.truth));
        return 0;
    }
    FILE *csv = set.csv ? bench_open(set.csv) : NULL;
    if (csv) fprintf(csv, "scene,what,value,error_percent,worst,count,bar\n");
    skg_context *context = bench_context(set.device);
    const int missed = set.reference ? compare(context, &set, csv) : 0;
    if (set.rooms)
        rooms_compare(context, set.room, csv);
    else if (set.seeds)
        calibrate(context, &set, csv);
    else if (!set.compare)
        measure(context, &set, csv);
    skg_context_release(&context);
    if (csv && fclose(csv) != 0) bench_die("%s could not be written", set.csv);
    return missed > 0;
}
