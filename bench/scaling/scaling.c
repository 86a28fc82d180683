/* How frames scale with workers: counts, prices of this device, and predictions beside measured times (docs/scaling.md). */
#include "common/thorax.h"
#include "scaling/prediction.h"

#include "affinity/affinity.h"
#include "plan/decisions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] = "[--quick] [--scene FILE.json | FOLDER | sphere:N] [--size N] [--repeats N]\n"
                            "    [--device CONFIG] [--affinity] [--csv FILE]";
enum { MIB = 1 << 20, CLEARED = 4 * MIB };
static const char *const strategies[] = {"auto", "copies", "tiles", "atomics"};

typedef struct {
    long size, repeats;
    int affinity;
    const char *scene, *device, *csv;
    FILE *out;
    skg_device_info info;
} settings;

/* Workers like those of this machine in a socket of today: two channels of DDR4-3200 (25.6 GB/s each) and 32 MiB of cache;
 * with 16 workers 64 MiB, as AMD Ryzen 9 5950X; with 64 workers eight channels and 256 MiB, as AMD EPYC 7763 (AMD's data
 * sheets of 2020 and 2021). */
static const scaling_machine machines[] = {{1, 51.2, 32.0 * MIB},  {2, 51.2, 32.0 * MIB},
                                           {4, 51.2, 32.0 * MIB},  {8, 51.2, 32.0 * MIB},
                                           {16, 51.2, 64.0 * MIB}, {64, 204.8, 256.0 * MIB}};

/* No figure was found for how many additions to memory a card does in a clock. One for each slice of the level 2 cache is
 * assumed: 80 of the A100 (5120 bytes in a clock, 64 each), 16 of the MI100 (2048 bytes, 128 each). */
static const scaling_card cards[] = {
    {"NVIDIA A100 40 GB", "NVIDIA A100 Tensor Core GPU Architecture, 2020", 6912, 1.41, 1555, 80},
    {"AMD Instinct MI100", "Introducing AMD CDNA Architecture, 2020", 7680, 1.502, 1228.8, 16},
};

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.size = 512, .repeats = 30};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick"))
            out->repeats = 5;
        else if (bench_flag(&arguments, "--affinity"))
            out->affinity = 1;
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 32, 8192, 1, &out->size);
        else if (bench_option(&arguments, "--repeats", &value))
            bench_numbers(value, 1, BENCH_SAMPLES, 1, &out->repeats);
        else if (!bench_option(&arguments, "--scene", &out->scene) &&
                 !bench_option(&arguments, "--device", &out->device) &&
                 !bench_option(&arguments, "--csv", &out->csv))
            bench_usage(&arguments, usage);
    }
}

static int stage_of(const char *name) {
    if (!strcmp(name, "project")) return SCALING_PROJECT;
    if (!strncmp(name, "tiles", 5)) return SCALING_SORT;
    if (!strcmp(name, "raster") || !strcmp(name, "large triangles")) return SCALING_RASTER;
    return !strcmp(name, "attenuate") ? SCALING_ATTENUATE : SCALING_STAGES;
}

/* The least time of each stage of a frame. */
static void measure(skg_context *context, const bench_scene *scene, int strategy, long repeats, double *ms,
                    skg_plan_report *report) {
    skg_plan_options options = scene->options;
    skg_plan *plan = NULL;
    skg_output output;
    int64_t channels = 0, stages = 0;
    options.strategy = strategy, options.profile = 1, options.overlaps = 0;
    bench_try(skg_plan_create(context, scene->scene, &scene->view, scene->beam, &options, &plan), "plan");
    bench_try(skg_plan_channel_count(plan, &channels), "channels");
    skg_output_init(&output);
    output.data = bench_alloc((size_t)(channels * scene->view.rows * scene->view.columns), sizeof(float));
    for (int s = 0; s < SCALING_STAGES; s++) ms[s] = HUGE_VAL;
    for (long k = 0; k <= repeats; k++) {
        double sums[SCALING_STAGES + 1] = {0};
        bench_try(skg_plan_image(plan, &output), "image");
        bench_try(skg_plan_stage_count(plan, &stages), "stages");
        for (int64_t i = 0; i < stages; i++) {
            skg_stage stage;
            skg_stage_init(&stage);
            bench_try(skg_plan_stage_get(plan, i, &stage), "stage");
            sums[stage_of(stage.name)] += stage.ns * 1e-6;
        }
        for (int s = 0; s < SCALING_STAGES; s++) ms[s] = fmin(ms[s], sums[s]);
    }
    skg_plan_report_init(report);
    bench_try(skg_plan_report_get(plan, report), "report");
    skg_plan_release(&plan);
    free(output.data);
}

/* Bytes that one thread clears in a ns. */
static double clear_rate(void) {
    volatile char *bytes = bench_alloc(CLEARED, 1);
    bench_times times = {0};
    for (int k = 0; k < 20; k++) {
        const double start = bench_now();
        memset((char *)bytes, k, CLEARED);
        bench_add(&times, bench_now() - start);
    }
    free((char *)bytes);
    return CLEARED / (bench_min(&times) * 1e6);
}

/* Solves a x + b y = c for two rows (a, b, c). A negative result is set to 0, and the other is fitted to the first row. */
static void solve(const double rows[2][3], double *x, double *y) {
    const double *p = rows[0], *q = rows[1], det = p[0] * q[1] - p[1] * q[0];
    *x = (p[2] * q[1] - p[1] * q[2]) / det;
    *y = (p[0] * q[2] - p[2] * q[0]) / det;
    if (*x < 0) *x = 0, *y = p[2] / p[1];
    if (*y < 0) *y = 0, *x = p[2] / p[0];
}

/* Fits the prices of a worker of this device, from a sphere of large triangles in one energy and one of small ones in ten. */
static scaling_prices fit(skg_context *context, const settings *s) {
    static const char *const spheres[2] = {"sphere:20000", "sphere:500000"};
    const double workers = s->info.compute_units;
    scaling_prices p = {.clear = clear_rate()};
    double raster[2][3], attenuate[2][3], ms[SCALING_STAGES];
    for (int k = 0; k < 2; k++) {
        bench_scene scene;
        skg_plan_report report;
        scene_open(context, spheres[k], 512 * (k + 1), &scene);
        if (k == 1) {
            skg_spectrum_release(&scene.beam);
            scene.beam = thorax_beam();
        }
        measure(context, &scene, SKG_STRATEGY_COPIES, s->repeats, ms, &report);
        scaling_counts c = scaling_count(&scene, &report);
        raster[k][0] = c.triangles, raster[k][1] = c.vectors;
        raster[k][2] = (ms[SCALING_RASTER] * 1e6 - c.sums * 4 / p.clear) * workers;
        attenuate[k][0] = scaling_exponentials(&c), attenuate[k][1] = c.sums * workers;
        attenuate[k][2] = ms[SCALING_ATTENUATE] * 1e6 * workers;
        p.vertex = ms[SCALING_PROJECT] * 1e6 * workers / c.vertices;
        measure(context, &scene, SKG_STRATEGY_TILES, s->repeats, ms, &report);
        p.sort = ms[SCALING_SORT] * 1e6 * workers / c.triangles;
        free(c.list);
        scene_close(&scene);
    }
    solve(raster, &p.triangle, &p.addition);
    solve(attenuate, &p.exponential, &p.accumulator);
    return p;
}

static void print_row(FILE *csv, const char *scene, const char *machine, const char *strategy, int chosen,
                      const scaling_frame *f, int predicted) {
    const double *ms = f->ms, all = ms[0] + ms[1] + ms[2] + ms[3];
    printf("| %s | %s%s | %.3f | %.3f | %.3f | %.3f | %.3f |", machine, strategy, chosen ? " (chosen)" : "",
           ms[0], ms[1], ms[2], ms[3], all);
    if (predicted)
        printf(" %.3g | %.1f | %.1f | %.1f |\n", f->set_ups, f->memory / MIB, f->traffic / MIB,
               f->traffic * 1e-6 / all);
    else
        printf("  |  |  |  |\n");
    if (csv)
        fprintf(csv, "%s,%s,%s,%s,%g,%g,%g,%g,%g,%g,%g,%g\n", scene, machine, strategy,
                predicted ? "predicted" : "measured", ms[0], ms[1], ms[2], ms[3], all, f->set_ups, f->memory,
                f->traffic);
}

static void predict_machines(const settings *s, const char *name, const scaling_counts *c,
                             const scaling_prices *p) {
    char machine[32];
    for (size_t m = 0; m < sizeof machines / sizeof *machines; m++) {
        const char *why = NULL;
        const skg_strategy_facts facts = {.workers = machines[m].workers,
                                          .image_bytes = (int64_t)(c->sums * 4),
                                          .triangles = (int64_t)c->triangles,
                                          .triangle_pixels = 4 * c->rectangles / c->triangles};
        snprintf(machine, sizeof machine, "%d workers", machines[m].workers);
        for (int k = SKG_STRATEGY_COPIES; k <= SKG_STRATEGY_TILES; k++) {
            const scaling_frame f = scaling_predict(c, p, k, &machines[m]);
            print_row(s->out, name, machine, strategies[k], skg_strategy_choose(&facts, &why) == k, &f, 1);
        }
    }
}

/* prices: NULL on a GPU, whose workers are not comparable */
static void show(skg_context *context, const settings *s, const char *name, bench_scene *scene,
                 const scaling_prices *prices) {
    skg_plan_report report, chosen;
    scaling_frame measured = {.set_ups = 0};
    measure(context, scene, SKG_STRATEGY_AUTO, 1, measured.ms, &chosen);
    scaling_counts c = scaling_count(scene, &chosen);
    printf(
        "## %s, %lld x %lld pixels\n\n| vertices | triangles | hits | additions | in vectors | accumulators | planes | energies |\n"
        "|---:|---:|---:|---:|---:|---:|---:|---:|\n| %.0f | %.0f | %.0f | %.0f | %.0f | %.0f | %.0f | %.0f |\n\n"
        "| machine | strategy | project ms | sort ms | raster ms | attenuate ms | together ms | set-ups | accumulators MiB | "
        "traffic MiB | GB/s |\n|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
        name, (long long)scene->view.columns, (long long)scene->view.rows, c.vertices, c.triangles, c.hits,
        c.adds, c.vectors, c.accumulators, c.planes, c.nodes);
    for (int k = SKG_STRATEGY_COPIES; k <= SKG_STRATEGY_ATOMICS; k++) {
        measure(context, scene, k, s->repeats, measured.ms, &report);
        print_row(s->out, name, "this device, measured", strategies[k], k == chosen.strategy, &measured, 0);
    }
    if (prices) predict_machines(s, name, &c, prices);
    for (size_t k = 0; k < sizeof cards / sizeof *cards; k++) {
        const scaling_frame f = scaling_predict_card(&c, &cards[k]);
        print_row(s->out, name, cards[k].name, strategies[SKG_STRATEGY_ATOMICS], 1, &f, 1);
    }
    printf("\n");
    free(c.list);
    scene_close(scene);
}

static void open_thorax(skg_context *context, long size, bench_scene *out) {
    bench_thorax thorax;
    memset(out, 0, sizeof *out);
    thorax_make(42000, THORAX_CLOSED, &thorax);
    skg_plan_options_init(&out->options);
    out->options.tolerance = 0;
    out->scene = thorax_scene(context, &thorax);
    out->beam = thorax_beam();
    thorax_view(size, &out->view);
    thorax_free(&thorax);
}

int main(int count, char **words) {
    settings s;
    scaling_prices prices;
    bench_scene scene;
    read_settings(count, words, &s);
    if (s.affinity) host_pin_threads();
    if (s.csv) s.out = bench_open(s.csv);
    if (s.out)
        fprintf(s.out, "scene,machine,strategy,what,project_ms,sort_ms,raster_ms,attenuate_ms,all_ms,set_ups,"
                       "accumulator_bytes,traffic_bytes\n");
    skg_context *context = bench_context(s.device);
    skg_device_info_init(&s.info);
    bench_try(skg_context_device_get(context, &s.info), "device");
    printf("Device: %s, %d compute units.\n", s.info.name, (int)s.info.compute_units);
    if (!s.info.gpu) {
        prices = fit(context, &s);
        printf(
            "One worker needs, in ns: %.2f for a vertex, %.2f to sort a triangle into bands, %.2f to set one up, %.3f for a "
            "vector addition, %.3f for an exponential, %.3f to read an accumulator; it clears %.1f GB/s.\n",
            prices.vertex, prices.sort, prices.triangle, prices.addition, prices.exponential,
            prices.accumulator, prices.clear);
    }
    for (size_t k = 0; k < sizeof cards / sizeof *cards; k++)
        printf("%s: %.0f lanes at %.3f GHz, %.0f GB/s (%s).\n", cards[k].name, cards[k].lanes, cards[k].ghz,
               cards[k].bandwidth, cards[k].source);
    printf("\n");
    if (s.scene) {
        scene_open(context, s.scene, s.size, &scene);
        show(context, &s, s.scene, &scene, s.info.gpu ? NULL : &prices);
    } else {
        open_thorax(context, s.size, &scene);
        show(context, &s, "thorax", &scene, s.info.gpu ? NULL : &prices);
        scene_open(context, "sphere:1000000", 2 * s.size, &scene);
        show(context, &s, "sphere", &scene, s.info.gpu ? NULL : &prices);
    }
    if (s.out && fclose(s.out) != 0) bench_die("%s could not be written", s.csv);
    skg_context_release(&context);
    return 0;
}
