/* A scan against the same images in batches, and its file against the disk. */
#include "common/bench.h"
#include "common/scenes.h"

#include "affinity/affinity.h"

#include <fcntl.h>
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
    char path[512];
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

/* The same projections without a run: batches of frames, one after another. */
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
        bench_try(skg_plan_submit(self->plan, count, self->frames, &output, &job), "batch");
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

static void scan_to_file(void *contender) {
    subject *self = contender;
    skg_scan_file_options options;
    skg_scan_file *file = NULL;
    char hash[65];
    memset(hash, 'a', 64);
    hash[64] = '\0';
    unlink(self->path);
    skg_scan_file_options_init(&options);
    options.scan = self->scan;
    options.hash = hash;
    options.samples = 1;
    bench_try(skg_scan_file_open(self->path, &options, &file), "file");
    bench_try(skg_scan_run_each(self->plan, self->scan, NULL, keep, file), "run");
    bench_try(skg_scan_file_finish(file), "file");
    skg_scan_file_release(&file);
}

/* The same bytes in the same pieces, without computing them: the disk's own rate. */
static void disk(void *contender) {
    subject *self = contender;
    const size_t piece = (size_t)self->pixels * sizeof(float);
    const int descriptor = open(self->path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (descriptor < 0) bench_die("%s cannot be written", self->path);
    for (int64_t k = 0; k < self->projections; k++) {
        if (write(descriptor, self->images + (k % BATCH) * self->pixels, piece) != (ssize_t)piece)
            bench_die("%s: the disk is full", self->path);
        if (k % BATCH == BATCH - 1 && fdatasync(descriptor) != 0) bench_die("%s: no sync", self->path);
    }
    if (fsync(descriptor) != 0) bench_die("%s: no sync", self->path);
    close(descriptor);
    unlink(self->path);
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
    out->images = bench_alloc((size_t)(BATCH * out->pixels), sizeof *out->images);
    snprintf(out->path, sizeof out->path, "%s/bench-scan.mha", set->into);
}

static void print(const settings *set, const bench_times *times) {
    static const char *const names[] = {"images in batches of 32", "scan", "scan to a file", "the disk"};
    double rates[4];
    for (int c = 0; c < 4; c++) rates[c] = 1e3 * (double)set->projections / bench_least(&times[c]);
    const double slower = rates[1] < rates[3] ? rates[1] : rates[3];
    printf(
        "Projections per second, from the least time of %ld turns; targets: scan at least 0.95 of the images, to a "
        "file at least 0.9 of the slower of scan and disk.\n\n| contender | per second | ratio |\n|---|---:|---:|\n",
        set->repeats);
    const double ratios[4] = {1, rates[1] / rates[0], rates[2] / slower, 0};
    for (int c = 0; c < 4; c++)
        c == 3 ? printf("| %s | %.4g | |\n", names[c], rates[c])
               : printf("| %s | %.4g | %.3f |\n", names[c], rates[c], ratios[c]);
    if (!set->csv) return;
    FILE *csv = bench_open(set->csv);
    fprintf(csv,
            "projections,size,images_per_s,scan_per_s,file_per_s,disk_per_s\n%ld,%ld,%.5g,%.5g,%.5g,%.5g\n",
            set->projections, set->size, rates[0], rates[1], rates[2], rates[3]);
    if (fclose(csv) != 0) bench_die("%s could not be written", set->csv);
}

int main(int count, char **words) {
    static const bench_frame frames[4] = {image_loop, scan_alone, scan_to_file, disk};
    settings set;
    bench_scene scene;
    subject all = {0};
    bench_times times[4] = {0};
    read_settings(count, words, &set);
    if (set.affinity) host_pin_threads();
    skg_context *context = bench_context(set.device);
    scene_open(context, set.scene, set.size, &scene);
    open_subject(context, &scene, &set, &all);
    void *const who[4] = {&all, &all, &all, &all};
    bench_interleave(4, frames, who, (int)set.repeats, 1, times);
    print(&set, times);
    unlink(all.path);
    skg_scan_release(&all.scan);
    skg_plan_release(&all.plan);
    free(all.images);
    scene_close(&scene);
    skg_context_release(&context);
    return 0;
}
