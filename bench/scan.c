/* A scan against the same images in batches, and its file against the disk. */
#define _GNU_SOURCE /* O_DIRECT */
#include "common/bench.h"
#include "common/scenes.h"

#include "affinity/affinity.h"

#include <skiagraph/scanning.h>

#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char usage[] =
    "[--quick] [--projections N] [--size N] [--repeats N] [--tolerance-ppm N] [--into FOLDER]\n"
    "    [--scene FILE.json | FOLDER | sphere:N] [--device CONFIG] [--affinity] [--csv FILE]";

enum { BATCH = 32 };

typedef struct {
    long projections, size, repeats, ppm;
    int affinity;
    const char *scene, *device, *csv, *into;
} settings;

typedef struct {
    skg_plan *plan;
    skg_scan *scan;
    int64_t projections, pixels;
    skg_view views[BATCH];
    skg_frame frames[BATCH];
    float *images; /* [BATCH][pixels] */
    const char *folder;
    char path[512]; /* of the latest file */
    int files;      /* that are there */
} subject;

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.projections = 720, .size = 512, .repeats = 5, .ppm = 100, .into = "/tmp"};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick"))
            out->projections = 96, out->repeats = 2;
        else if (bench_flag(&arguments, "--affinity"))
            out->affinity = 1;
        else if (bench_option(&arguments, "--projections", &value))
            bench_numbers(value, 2, 100000, 1, &out->projections);
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 16, 8192, 1, &out->size);
        else if (bench_option(&arguments, "--repeats", &value))
            bench_numbers(value, 1, BENCH_SAMPLES, 1, &out->repeats);
        else if (bench_option(&arguments, "--tolerance-ppm", &value))
            bench_numbers(value, 0, 100000, 1, &out->ppm);
        else if (!bench_option(&arguments, "--scene", &out->scene) &&
                 !bench_option(&arguments, "--device", &out->device) &&
                 !bench_option(&arguments, "--into", &out->into) &&
                 !bench_option(&arguments, "--csv", &out->csv))
            bench_usage(&arguments, usage);
    }
}

/* Makes the projections without a run: batches of frames, one after another. */
static void image_loop(void *contender) {
    subject *self = contender;
    for (int64_t k = 0; k < self->projections; k += BATCH) {
        const int64_t left = self->projections - k, count = left < BATCH ? left : BATCH;
        skg_output output;
        skg_job *job = NULL;
        skg_output_init(&output);
        output.data = self->images;
        for (int64_t f = 0; f < count; f++) {
            skg_view_init(&self->views[f]);
            bench_try(skg_scan_view_get(self->scan, k + f, &self->views[f]), "view");
            skg_frame_init(&self->frames[f]);
            self->frames[f].view = &self->views[f];
            self->frames[f].index = k + f;
        }
        bench_try(skg_plan_submit(self->plan, count, self->frames, 1, &output, &job), "batch");
        bench_try(skg_job_wait(&job), "batch");
    }
}

static skg_status drop(const skg_scan_batch *batch, void *user) {
    (void)batch;
    (void)user;
    return SKG_OK;
}

static void scan_alone(void *contender) {
    subject *self = contender;
    bench_try(skg_scan_run_each(self->plan, self->scan, NULL, drop, NULL), "run");
}

static skg_status keep(const skg_scan_batch *batch, void *user) {
    return skg_scan_file_write(user, batch->count, batch->indices, batch->images, batch->phases);
}

/* Each file is a new one. The frees of blocks belong to nobody's time (remove_files). */
static const char *next_path(subject *self) {
    snprintf(self->path, sizeof self->path, "%s/bench-scan-%d.mha", self->folder, self->files++);
    return self->path;
}

static void remove_files(void *contender) {
    subject *self = contender;
    while (self->files > 0) {
        self->files--;
        snprintf(self->path, sizeof self->path, "%s/bench-scan-%d.mha", self->folder, self->files);
        unlink(self->path);
    }
    sync();
}

static void scan_to_file(void *contender) {
    subject *self = contender;
    skg_scan_file_options options;
    skg_scan_run_options run;
    skg_scan_file *file = NULL;
    char hash[65];
    memset(hash, 'a', 64);
    hash[64] = '\0';
    skg_scan_file_options_init(&options);
    skg_scan_run_options_init(&run);
    options.scan = self->scan;
    options.hash = hash;
    options.samples = 1;
    bench_try(skg_scan_file_open(next_path(self), &options, &file), "file");
    run.file = file;
    bench_try(skg_scan_run_each(self->plan, self->scan, &run, keep, file), "run");
    bench_try(skg_scan_file_finish(file), "file");
    skg_scan_file_release(&file);
}

/* A file of the same size, laid out alike, in pieces of a batch: the disk's own sequential rate. */
static void disk(subject *self, int flags) {
    const int64_t projection = self->pixels * (int64_t)sizeof(float), bytes = self->projections * projection;
    const int descriptor = open(next_path(self), O_WRONLY | O_CREAT | O_TRUNC | flags, 0600);
    if (descriptor < 0 || posix_fallocate(descriptor, 0, bytes) != 0)
        bench_die("%s cannot be written", self->path);
    for (int64_t at = 0; at < bytes; at += BATCH * projection) {
        const int64_t left = bytes - at, piece = left < BATCH * projection ? left : BATCH * projection;
        if (pwrite(descriptor, self->images, (size_t)piece, at) != (ssize_t)piece)
            bench_die("%s: the disk is full", self->path);
    }
    if (fdatasync(descriptor) != 0) bench_die("%s: no sync", self->path);
    close(descriptor);
}

static void disk_cached(void *contender) {
    disk(contender, 0);
}

static void disk_direct(void *contender) {
    disk(contender, O_DIRECT);
}

static void open_subject(skg_context *context, bench_scene *scene, const settings *set, subject *out) {
    skg_view around[8];
    double *poses = bench_alloc((size_t)set->projections, 12 * sizeof *poses);
    for (int v = 0; v < 8; v++) scene_turn(scene, 45 * v, &around[v]);
    for (long k = 0; k < set->projections; k++) {
        skg_view view;
        scene_turn(scene, 360.0 * (double)k / (double)set->projections, &view);
        const double *from[] = {view.source, view.centre, view.column_step, view.row_step};
        for (int v = 0; v < 4; v++) memcpy(poses + 12 * k + 3 * v, from[v], 3 * sizeof *poses);
    }
    scene->options.tolerance = 1e-6 * (double)set->ppm;
    scene->options.views = around;
    scene->options.view_count = 8;
    bench_try(skg_plan_create(context, scene->scene, &scene->view, scene->beam, &scene->options, &out->plan),
              "plan");
    bench_try(skg_scan_create_table(&scene->view, NULL, set->projections, poses, &out->scan), "scan");
    free(poses);
    out->projections = set->projections;
    out->pixels = scene->view.rows * scene->view.columns;
    void *images = NULL;
    if (posix_memalign(&images, 4096, (size_t)(BATCH * out->pixels) * sizeof *out->images) != 0)
        bench_die("out of memory");
    memset(images, 0, (size_t)(BATCH * out->pixels) * sizeof *out->images);
    out->images = images;
    out->folder = set->into;
}

/* In the order in which they run; after each writer its files are removed. */
enum { IMAGES, SCAN, TO_FILE, REMOVAL_1, CACHED, REMOVAL_2, DIRECT, REMOVAL_3, CONTENDERS };

static void print(const settings *set, const bench_times *times) {
    static const char *const names[CONTENDERS] = {[IMAGES] = "images in batches of 32",
                                                  [SCAN] = "scan",
                                                  [TO_FILE] = "scan to a file",
                                                  [CACHED] = "the disk, through the page cache",
                                                  [DIRECT] = "the disk, past it"};
    double rates[CONTENDERS];
    for (int c = 0; c < CONTENDERS; c++) rates[c] = 1e3 * (double)set->projections / bench_min(&times[c]);
    const double slower = fmin(rates[SCAN], fmax(rates[CACHED], rates[DIRECT]));
    const double ratios[CONTENDERS] = {
        [IMAGES] = 1, [SCAN] = rates[SCAN] / rates[IMAGES], [TO_FILE] = rates[TO_FILE] / slower};
    printf(
        "Projections per second, from the least time of %ld turns; targets: scan at least 0.95 of the images, to a "
        "file at least 0.9 of the slower of scan and the faster of both ways to the disk.\n\n"
        "| contender | per second | ratio |\n|---|---:|---:|\n",
        set->repeats);
    for (int c = 0; c < CONTENDERS; c++)
        if (ratios[c] > 0)
            printf("| %s | %.4g | %.3f |\n", names[c], rates[c], ratios[c]);
        else if (names[c])
            printf("| %s | %.4g | |\n", names[c], rates[c]);
    if (!set->csv) return;
    FILE *csv = bench_open(set->csv);
    fprintf(csv,
            "projections,size,images_per_s,scan_per_s,file_per_s,disk_cached_per_s,disk_direct_per_s\n"
            "%ld,%ld,%.5g,%.5g,%.5g,%.5g,%.5g\n",
            set->projections, set->size, rates[IMAGES], rates[SCAN], rates[TO_FILE], rates[CACHED],
            rates[DIRECT]);
    if (fclose(csv) != 0) bench_die("%s could not be written", set->csv);
}

int main(int count, char **words) {
    static const bench_frame frames[CONTENDERS] = {
        [IMAGES] = image_loop,      [SCAN] = scan_alone,       [TO_FILE] = scan_to_file,
        [REMOVAL_1] = remove_files, [CACHED] = disk_cached,    [REMOVAL_2] = remove_files,
        [DIRECT] = disk_direct,     [REMOVAL_3] = remove_files};
    settings set;
    bench_scene scene;
    subject all = {0};
    bench_times times[CONTENDERS] = {0};
    read_settings(count, words, &set);
    if (set.affinity) host_pin_threads();
    skg_context *context = bench_context(set.device);
    scene_open(context, set.scene, set.size, &scene);
    open_subject(context, &scene, &set, &all);
    void *const who[CONTENDERS] = {&all, &all, &all, &all, &all, &all, &all, &all};
    bench_interleave(CONTENDERS, frames, who, (int)set.repeats, 1, times);
    print(&set, times);
    skg_scan_release(&all.scan);
    skg_plan_release(&all.plan);
    free(all.images);
    scene_close(&scene);
    skg_context_release(&context);
    return 0;
}
