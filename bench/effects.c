/* Measures the cost of each effect by itself: a scene with it against the same scene without it, alternately. */
#include "common/bench.h"
#include "common/scenes.h"

#include "affinity/affinity.h"

#include <math.h>
#include <skiagraph/readout.h>

#include <stdlib.h>

static const char usage[] = "[--quick] [--size N] [--repeats N] [--device CONFIG] [--affinity] [--csv FILE]";

/* One difference from the base, in which no part has a parent, all meshes are closed, the precision is single
 * and the strategy is the plan's choice. */
typedef struct {
    const char *name, *what;
    scene_changes changes;
    int precision, strategy, quantity, type, profile;
    int counts; /* 1: the detector counts photons; 2: with pile-up and two thresholds */
    int lags;   /* 1: frames are a sequence of a detector with lag */
    int layer;  /* of 600 um CsI: 1: it keeps all energy; 2: what Compton scattering leaves it */
    void (*ask)(skg_plan_options *options); /* sets further options; may be NULL */
} effect;

static void ask_spot(skg_plan_options *options) {
    static skg_spot spot;
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_RECTANGLE;
    spot.extent[0] = spot.extent[1] = 1;
    spot.samples = 16;
    options->spot = &spot;
}

static void ask_off_focal(skg_plan_options *options) {
    static skg_spot spot;
    ask_spot(options);
    spot = *options->spot;
    spot.off_focal = 0.1, spot.off_focal_mm = 20;
    options->spot = &spot;
}

static void ask_blur(skg_plan_options *options) {
    static const double line[5] = {0.05, 0.2, 0.5, 0.2, 0.05};
    static skg_detector_blur blur;
    skg_detector_blur_init(&blur);
    blur.columns = blur.rows = 5;
    blur.along_row = blur.along_column = line;
    options->blur = &blur;
}

static void ask_supersampling(skg_plan_options *options) {
    options->supersampling = 2;
}
static void ask_falloff(skg_plan_options *options) {
    options->falloff = 1;
}
static void ask_noise(skg_plan_options *options) {
    options->noise = 1;
}
static void ask_electronic(skg_plan_options *options) {
    options->electronic_kev = 1;
}
static void ask_steps(skg_plan_options *options) {
    options->quantum_step_kev = 1;
}

/* A detector that counts, of the pixels of a view. */
static skg_counter *make_counter(const skg_view *view, int pile_up) {
    static const double thresholds[] = {20, 50};
    skg_counting counting;
    skg_counter *counter = NULL;
    skg_counting_init(&counting);
    bench_try(skg_material_create_named("CdTe", &counting.material), "CdTe");
    counting.thickness_mm = 1, counting.bias_v = 400;
    counting.count = 1, counting.threshold_kev = thresholds;
    if (pile_up) {
        counting.count = 2, counting.pile_up = SKG_PILE_UP_PARALYSABLE;
        counting.dead_time_ns = 100, counting.exposure_s = 1;
    }
    for (int k = 0; k < 3; k++) {
        counting.pixel_mm[0] = hypot(counting.pixel_mm[0], view->column_step[k]);
        counting.pixel_mm[1] = hypot(counting.pixel_mm[1], view->row_step[k]);
    }
    bench_try(skg_counter_create(&counting, &counter), "counter");
    skg_material_release(&counting.material);
    return counter;
}

static skg_response *make_layer(int transports) {
    skg_material *csi = NULL;
    skg_response *layer = NULL, *transporting = NULL;
    bench_try(skg_material_create_named("CsI", &csi), "CsI");
    bench_try(skg_response_create_scintillator(csi, 0.6, 0.8, &layer), "scintillator");
    skg_material_release(&csi);
    if (!transports) return layer;
    bench_try(skg_response_create_transporting(layer, &transporting), "scintillator");
    skg_response_release(&layer);
    return transporting;
}

static skg_lag *make_lag(long size) {
    static const double terms[] = {0.03, 1.5, 0.005, 40};
    skg_lag *lag = NULL;
    bench_try(skg_lag_create(size * size, 2, terms, &lag), "lag");
    return lag;
}

static const effect effects[] = {
    {"base", "61 closed parts without parents, one energy", {.flat = 1}, .ask = NULL},
    {"nesting", "60 parts displace their parent", {.flat = 0}, .ask = NULL},
    {"open part", "one of 61 parts has a hole", {.flat = 1, .leaky = 1}, .ask = NULL},
    {"source plane", "a small part encloses the source", {.flat = 1, .round_source = 1}, .ask = NULL},
    {"double", "precision double", {.flat = 1}, .precision = SKG_PRECISION_DOUBLE},
    {"attenuation", "-ln(I/I0) instead of energy", {.flat = 1}, .quantity = SKG_QUANTITY_ATTENUATION},
    {"float64 output", "images of doubles", {.flat = 1}, .type = SKG_TYPE_FLOAT64},
    {"profile", "stages are timed", {.flat = 1}, .profile = 1},
    {"copies", "strategy copies", {.flat = 1}, .strategy = SKG_STRATEGY_COPIES},
    {"tiles", "strategy tiles", {.flat = 1}, .strategy = SKG_STRATEGY_TILES},
    {"atomics", "strategy atomics", {.flat = 1}, .strategy = SKG_STRATEGY_ATOMICS},
    {"extended source", "16 samples of a rectangle", {.flat = 1}, .ask = ask_spot},
    {"off-focal radiation",
     "the same, a tenth of the photons from 20 mm around it",
     {.flat = 1},
     .ask = ask_off_focal},
    {"supersampling", "2 x 2 rays a pixel", {.flat = 1}, .ask = ask_supersampling},
    {"falloff", "inverse square and obliquity", {.flat = 1}, .ask = ask_falloff},
    {"quantum noise", "of the photons of a pixel", {.flat = 1}, .ask = ask_noise},
    {"blur", "two line spread functions of 5 samples", {.flat = 1}, .ask = ask_blur},
    {"electronic noise", "1 keV per pixel", {.flat = 1}, .ask = ask_electronic},
    {"quantisation", "steps of 1 keV", {.flat = 1}, .ask = ask_steps},
    {"photon counting",
     "1 mm of CdTe, one threshold, charge shared",
     {.flat = 1},
     .quantity = SKG_QUANTITY_PHOTONS,
     .counts = 1},
    {"pile-up",
     "the same with two thresholds, and pulses that overlap",
     {.flat = 1},
     .quantity = SKG_QUANTITY_PHOTONS,
     .counts = 2},
    {"scintillator", "600 um of CsI that keep all energy", {.flat = 1}, .layer = 1},
    {"deposition", "the same, less what Compton scattering takes out of it", {.flat = 1}, .layer = 2},
    {"lag", "two terms, of a sequence; by the host, behind each frame", {.flat = 1}, .lags = 1},
};
enum { EFFECTS = sizeof effects / sizeof *effects };

typedef struct {
    long size, repeats;
    int affinity;
    const char *device, *csv;
} settings;

typedef struct {
    skg_plan *plan; /* NULL: the device lacks what it needs */
    double plan_ms;
    skg_output output;
    skg_lag *lag; /* NULL: none */
} contender;

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.size = 512, .repeats = 30};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick"))
            out->repeats = 10;
        else if (bench_flag(&arguments, "--affinity"))
            out->affinity = 1;
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 16, 8192, 1, &out->size);
        else if (bench_option(&arguments, "--repeats", &value))
            bench_numbers(value, 5, BENCH_SAMPLES, 1, &out->repeats);
        else if (!bench_option(&arguments, "--device", &out->device) &&
                 !bench_option(&arguments, "--csv", &out->csv))
            bench_usage(&arguments, usage);
    }
}

static void frame(void *who) {
    contender *self = who;
    bench_try(skg_plan_image(self->plan, &self->output), "image");
    if (self->lag)
        bench_try(skg_lag_apply(self->lag, self->output.type, self->output.data, 1, self->output.data),
                  "lag");
}

static void make_plan(skg_context *context, const effect *kind, long size, contender *out) {
    bench_scene scene;
    scene_generate(context, &kind->changes, size, &scene);
    scene.options.overlaps = 0; /* without parents the organs overlap the envelope, on purpose */
    scene.options.precision = kind->precision;
    scene.options.strategy = kind->strategy;
    scene.options.quantity = kind->quantity;
    scene.options.profile = kind->profile;
    if (kind->ask) kind->ask(&scene.options);
    skg_counter *counter = kind->counts ? make_counter(&scene.view, kind->counts > 1) : NULL;
    scene.options.counter = counter;
    const double start = bench_now();
    skg_response *layer = kind->layer ? make_layer(kind->layer > 1) : NULL;
    if (layer) scene.options.response = layer;
    out->lag = kind->lags ? make_lag(size) : NULL;
    const skg_status status =
        skg_plan_create(context, scene.scene, &scene.view, scene.beam, &scene.options, &out->plan);
    out->plan_ms = bench_now() - start;
    skg_counter_release(&counter);
    skg_response_release(&layer);
    if (status == SKG_ERR_UNSUPPORTED)
        fprintf(stderr, "%s: left out: %s\n", kind->name, skg_last_error());
    else
        bench_try(status, kind->name);
    skg_output_init(&out->output);
    out->output.type = kind->type;
    out->output.data = bench_alloc((size_t)(size * size * (kind->counts > 1 ? 2 : 1)),
                                   kind->type == SKG_TYPE_FLOAT64 ? sizeof(double) : sizeof(float));
    scene_close(&scene);
}

static void measure(const settings *set, skg_context *context, contender *base, int index, FILE *csv) {
    const effect *kind = &effects[index];
    contender *self = bench_alloc(1, sizeof *self);
    make_plan(context, kind, set->size, self);
    if (self->plan) {
        const bench_frame frames[2] = {frame, frame};
        void *const who[2] = {base, self};
        bench_times times[2] = {0};
        bench_interleave(2, frames, who, (int)(set->repeats + 4) / 5, 5, times);
        const double without = bench_min(&times[0]), with = bench_min(&times[1]);
        printf("| %s | %s | %.4g | %.4g / %.4g | %.4g / %.4g | %+.3f | %.2f |\n", kind->name, kind->what,
               self->plan_ms, without, bench_median(&times[0]), with, bench_median(&times[1]), with - without,
               with / without);
        if (csv)
            fprintf(csv, "%s,%.5g,%.5g,%.5g,%.5g,%.5g,%.3f\n", kind->name, self->plan_ms, without,
                    bench_median(&times[0]), with, bench_median(&times[1]), with / without);
    }
    skg_plan_release(&self->plan);
    skg_lag_release(&self->lag);
    free(self->output.data);
    free(self);
}

int main(int count, char **words) {
    settings set;
    read_settings(count, words, &set);
    if (set.affinity) host_pin_threads();
    skg_context *context = bench_context(set.device);
    FILE *csv = set.csv ? bench_open(set.csv) : NULL;
    contender *base = bench_alloc(1, sizeof *base);
    make_plan(context, &effects[0], set.size, base);
    if (csv) fprintf(csv, "effect,plan_ms,base_min_ms,base_median_ms,with_min_ms,with_median_ms,ratio\n");
    printf(
        "Detector %ld x %ld. Times in ms: of a warm frame, minimum / median, and of planning once. Price and ratio are of "
        "minima.\nThe first row compares the base with itself: its difference is noise.\n\n"
        "| effect | what | planning | base | with | price | ratio |\n|---|---|---:|---:|---:|---:|---:|\n",
        set.size, set.size);
    for (int k = 0; k < EFFECTS; k++) measure(&set, context, base, k, csv);
    if (csv && fclose(csv) != 0) bench_die("%s could not be written", set.csv);
    skg_plan_release(&base->plan);
    free(base->output.data);
    free(base);
    skg_context_release(&context);
    return 0;
}
