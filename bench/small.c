/* Small images, as registration and scripts make them: what a frame of a batch takes, and what a call for one image. */
#include "common/bench.h"
#include "common/scenes.h"

#include "affinity/affinity.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char usage[] =
    "[--quick] [--scene FILE.json | FOLDER | sphere:N] [--size N] [--frames N,N] [--repeats N]\n"
    "    [--device CONFIG] [--affinity] [--csv FILE]";

enum { COUNTS = 8, FRAMES_MAX = 4096 };

typedef struct {
    long size, counts[COUNTS], repeats;
    int count_count, affinity;
    const char *scene, *device, *csv;
} settings;

/* Frames in each of which all parts have poses of their own. */
typedef struct {
    skg_plan *plan;
    int64_t count, pixels, parts;
    int64_t *numbers;  /* [parts] */
    double *poses;     /* [count][parts][16] */
    skg_frame *frames; /* [count] */
    skg_output output;
    double host_us; /* the calling thread's time of a frame, the least so far */
} series;

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.size = 128, .counts = {1, 8, 100, 500}, .count_count = 4, .repeats = 15};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick")) {
            out->repeats = 5;
        } else if (bench_flag(&arguments, "--affinity")) {
            out->affinity = 1;
        } else if (bench_option(&arguments, "--size", &value)) {
            bench_numbers(value, 16, 8192, 1, &out->size);
        } else if (bench_option(&arguments, "--frames", &value)) {
            out->count_count = bench_numbers(value, 1, FRAMES_MAX, COUNTS, out->counts);
        } else if (bench_option(&arguments, "--repeats", &value)) {
            bench_numbers(value, 1, BENCH_SAMPLES, 1, &out->repeats);
        } else if (!bench_option(&arguments, "--scene", &out->scene) &&
                   !bench_option(&arguments, "--device", &out->device) &&
                   !bench_option(&arguments, "--csv", &out->csv)) {
            bench_usage(&arguments, usage);
        }
    }
}

/* Time that the calling thread has run, us. */
static double thread_us(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

static void note_host(series *self, double begun) {
    const double us = (thread_us() - begun) / (double)self->count;
    if (self->host_us == 0 || us < self->host_us) self->host_us = us;
}

static void batch(void *contender) {
    series *self = contender;
    skg_job *job = NULL;
    const double begun = thread_us();
    bench_try(skg_plan_submit(self->plan, self->count, self->frames, 1, &self->output, &job), "batch");
    bench_try(skg_job_wait(&job), "batch");
    note_host(self, begun);
}

static void one_by_one(void *contender) {
    series *self = contender;
    const double begun = thread_us();
    for (int64_t k = 0; k < self->count; k++) {
        skg_job *job = NULL;
        skg_output output = self->output;
        output.data = (float *)self->output.data + k * self->pixels;
        bench_try(skg_plan_submit(self->plan, 1, &self->frames[k], 1, &output, &job), "frame");
        bench_try(skg_job_wait(&job), "frame");
    }
    note_host(self, begun);
}

/* Parts that stand a little elsewhere in each frame. */
static void move(const bench_scene *scene, series *out) {
    for (int64_t p = 0; p < out->parts; p++) {
        skg_part part;
        skg_part_init(&part);
        bench_try(skg_scene_part_get(scene->scene, p, &part), "part");
        out->numbers[p] = p;
        for (int64_t k = 0; k < out->count; k++) {
            double *pose = out->poses + 16 * (k * out->parts + p);
            memcpy(pose, part.pose, sizeof part.pose);
            pose[3] += 0.037 * (double)(k % 97);
            pose[7] -= 0.013 * (double)((k * 7 + p) % 89);
        }
    }
}

static void open_series(skg_context *context, bench_scene *scene, long count, series *out) {
    *out = (series){.count = count};
    bench_try(skg_plan_create(context, scene->scene, &scene->view, scene->beam, &scene->options, &out->plan),
              "plan");
    bench_try(skg_scene_part_count(scene->scene, &out->parts), "parts");
    int64_t channels = 0;
    bench_try(skg_plan_channel_count(out->plan, &channels), "plan");
    out->pixels = channels * scene->view.rows * scene->view.columns;
    out->numbers = bench_alloc((size_t)out->parts, sizeof *out->numbers);
    out->poses = bench_alloc((size_t)(count * out->parts), 16 * sizeof *out->poses);
    out->frames = bench_alloc((size_t)count, sizeof *out->frames);
    move(scene, out);
    for (long k = 0; k < count; k++) {
        skg_frame *frame = &out->frames[k];
        skg_frame_init(frame);
        frame->pose_count = out->parts, frame->pose_parts = out->numbers;
        frame->poses = out->poses + 16 * k * out->parts;
    }
    skg_output_init(&out->output);
    out->output.data = bench_alloc((size_t)(count * out->pixels), sizeof(float));
}

static void close_series(series *self) {
    skg_plan_release(&self->plan);
    free(self->numbers);
    free(self->poses);
    free(self->frames);
    free(self->output.data);
}

/* Ends the program unless a batch gives the same bits as single frames. */
static void check(series *self) {
    const size_t bytes = (size_t)(self->count * self->pixels) * sizeof(float);
    one_by_one(self);
    void *single = bench_alloc(bytes, 1);
    memcpy(single, self->output.data, bytes);
    memset(self->output.data, 0, bytes);
    batch(self);
    if (memcmp(single, self->output.data, bytes) != 0)
        bench_die("frames of a batch differ from single ones; nothing was timed");
    free(single);
}

static void measure(const settings *set, skg_context *context, bench_scene *scene, long count, FILE *csv) {
    static const bench_frame frames[2] = {one_by_one, batch};
    series all[2];
    bench_times times[2] = {0};
    for (int k = 0; k < 2; k++) open_series(context, scene, count, &all[k]);
    check(&all[1]);
    void *const who[2] = {&all[0], &all[1]};
    all[1].host_us = 0;
    bench_interleave(2, frames, who, (int)set->repeats, 1, times);
    const double single = 1e3 * bench_min(&times[0]) / (double)count,
                 together = 1e3 * bench_min(&times[1]) / (double)count;
    printf("| %ld | %.4g | %.4g | %.4g | %.4g | %.3f |\n", count, single, all[0].host_us, together,
           all[1].host_us, together / single);
    if (csv)
        fprintf(csv, "%ld,%.5g,%.5g,%.5g,%.5g,%.3f\n", count, single, all[0].host_us, together,
                all[1].host_us, together / single);
    for (int k = 0; k < 2; k++) close_series(&all[k]);
}

int main(int count, char **words) {
    settings set;
    read_settings(count, words, &set);
    if (set.affinity) host_pin_threads();
    skg_context *context = bench_context(set.device);
    bench_scene scene;
    scene_open(context, set.scene, set.size, &scene);
    FILE *csv = set.csv ? bench_open(set.csv) : NULL;
    if (csv) fprintf(csv, "frames,call_us,call_host_us,batch_us,batch_host_us,ratio\n");
    int64_t parts = 0;
    bench_try(skg_scene_part_count(scene.scene, &parts), "parts");
    printf(
        "%lld x %lld pixels, %lld parts, each with a pose of its own in each frame. Least times in us for a frame: all of it, "
        "and of the calling thread.\n\n"
        "| frames | calls | calling thread | one batch | calling thread | batch / calls |\n|---:|---:|---:|---:|---:|---:|\n",
        (long long)scene.view.columns, (long long)scene.view.rows, (long long)parts);
    for (int k = 0; k < set.count_count; k++) measure(&set, context, &scene, set.counts[k], csv);
    if (csv && fclose(csv) != 0) bench_die("%s could not be written", set.csv);
    scene_close(&scene);
    skg_context_release(&context);
    return 0;
}
