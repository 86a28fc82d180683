/* Many views of one scene, in one batch against one by one. */
#include "common/bench.h"
#include "common/scenes.h"

#include "affinity/affinity.h"

#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "[--quick] [--scene FILE.json | FOLDER | sphere:N] [--sizes N,N] [--views N] [--repeats N]\n"
    "    [--device CONFIG] [--affinity] [--csv FILE]";

enum { SIZES = 8, VIEWS_MAX = 4096 };

typedef struct {
    long sizes[SIZES], views, repeats;
    int size_count, affinity;
    const char *scene, *device, *csv;
} settings;

typedef struct {
    skg_plan *plan;
    int64_t views, pixels;
    skg_view *turned;  /* [views] */
    skg_frame *frames; /* [views] */
    skg_output output;
} series;

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.sizes = {512, 1024}, .size_count = 2, .views = 64, .repeats = 7};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick")) {
            out->size_count = 1;
            out->repeats = 3;
        } else if (bench_flag(&arguments, "--affinity")) {
            out->affinity = 1;
        } else if (bench_option(&arguments, "--sizes", &value)) {
            out->size_count = bench_numbers(value, 16, 8192, SIZES, out->sizes);
        } else if (bench_option(&arguments, "--views", &value)) {
            bench_numbers(value, 1, VIEWS_MAX, 1, &out->views);
        } else if (bench_option(&arguments, "--repeats", &value)) {
            bench_numbers(value, 1, BENCH_SAMPLES, 1, &out->repeats);
        } else if (!bench_option(&arguments, "--scene", &out->scene) &&
                   !bench_option(&arguments, "--device", &out->device) &&
                   !bench_option(&arguments, "--csv", &out->csv)) {
            bench_usage(&arguments, usage);
        }
    }
}

static void batch(void *contender) {
    series *self = contender;
    skg_job *job = NULL;
    bench_try(skg_plan_submit(self->plan, self->views, self->frames, 1, &self->output, &job), "batch");
    bench_try(skg_job_wait(&job), "batch");
}

static void one_by_one(void *contender) {
    series *self = contender;
    for (int64_t k = 0; k < self->views; k++) {
        skg_job *job = NULL;
        skg_output output = self->output;
        output.data = (float *)self->output.data + k * self->pixels;
        bench_try(skg_plan_submit(self->plan, 1, &self->frames[k], 1, &output, &job), "frame");
        bench_try(skg_job_wait(&job), "frame");
    }
}

static void open_series(skg_context *context, bench_scene *scene, long views, series *out) {
    bench_try(skg_plan_create(context, scene->scene, &scene->view, scene->beam, &scene->options, &out->plan),
              "plan");
    int64_t channels = 0;
    bench_try(skg_plan_channel_count(out->plan, &channels), "plan");
    out->views = views;
    out->pixels = channels * scene->view.rows * scene->view.columns;
    out->turned = bench_alloc((size_t)views, sizeof *out->turned);
    out->frames = bench_alloc((size_t)views, sizeof *out->frames);
    for (long k = 0; k < views; k++) {
        scene_turn(scene, 360.0 * (double)k / (double)views, &out->turned[k]);
        skg_frame_init(&out->frames[k]);
        out->frames[k].view = &out->turned[k];
    }
    skg_output_init(&out->output);
    out->output.data = bench_alloc((size_t)(views * out->pixels), sizeof(float));
}

static void close_series(series *self) {
    skg_plan_release(&self->plan);
    free(self->turned);
    free(self->frames);
    free(self->output.data);
}

/* Ends the program unless a batch gives the same bits as single frames. */
static void check(series *self) {
    const size_t bytes = (size_t)(self->views * self->pixels) * sizeof(float);
    one_by_one(self);
    void *single = bench_alloc(bytes, 1);
    memcpy(single, self->output.data, bytes);
    memset(self->output.data, 0, bytes);
    batch(self);
    if (memcmp(single, self->output.data, bytes) != 0)
        bench_die("batched views differ from single ones; nothing was timed");
    free(single);
}

static void measure(const settings *set, skg_context *context, long size, FILE *csv) {
    static const bench_frame frames[2] = {one_by_one, batch};
    bench_scene scene;
    series all = {0};
    bench_times times[2] = {0};
    scene_open(context, set->scene, size, &scene);
    open_series(context, &scene, set->views, &all);
    check(&all);
    void *const who[2] = {&all, &all};
    bench_interleave(2, frames, who, (int)set->repeats, 1, times);
    const double single = bench_min(&times[0]), together = bench_min(&times[1]);
    printf("| %lld x %lld | %ld | %.4g / %.4g | %.4g / %.4g | %.3f |\n", (long long)scene.view.columns,
           (long long)scene.view.rows, set->views, single, bench_median(&times[0]), together,
           bench_median(&times[1]), together / single);
    if (csv)
        fprintf(csv, "%lld,%lld,%ld,%.5g,%.5g,%.5g,%.5g,%.3f\n", (long long)scene.view.columns,
                (long long)scene.view.rows, set->views, single, bench_median(&times[0]), together,
                bench_median(&times[1]), together / single);
    close_series(&all);
    scene_close(&scene);
}

int main(int count, char **words) {
    settings set;
    read_settings(count, words, &set);
    if (set.affinity) host_pin_threads();
    skg_context *context = bench_context(set.device);
    FILE *csv = set.csv ? bench_open(set.csv) : NULL;
    if (csv)
        fprintf(csv,
                "columns,rows,views,single_min_ms,single_median_ms,batch_min_ms,batch_median_ms,ratio\n");
    printf(
        "Times in ms for all views, minimum / median; target: ratio of minima at most 0.95 at 64 views.\n\n"
        "| detector | views | one by one | in one batch | batch / single |\n|---|---:|---:|---:|---:|\n");
    for (int k = 0; k < set.size_count; k++) measure(&set, context, set.sizes[k], csv);
    if (csv && fclose(csv) != 0) bench_die("%s could not be written", set.csv);
    skg_context_release(&context);
    return 0;
}
