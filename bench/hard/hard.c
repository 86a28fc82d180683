/* Adversarial pixels in bulk: no ray whose signed hits fail to cancel, and no length out of its bar. Not timed. */
#include "hard/bodies.h"
#include "hard/judge.h"
#include "hard/several.h"

#include "common/bench.h"

#include <inttypes.h>
#include <stdlib.h>

static const char usage[] =
    "[--pixels N] [--size N] [--first N] [--kind N] [--faces N | --drawn N] [--device CONFIG] [--csv FILE]";

typedef struct {
    long pixels, size;
    long first;        /* picture; another run can go on where one ended */
    long kind;         /* -1: all */
    long faces, drawn; /* scenes instead of pictures */
    const char *device, *csv;
} settings;

typedef struct {
    skg_context *context;
    skg_material *material;
    skg_spectrum *beam;
} tools;

typedef struct {
    int64_t pictures, unbalanced[2]; /* in single, in double precision */
    hard_verdict verdict;
} tally;

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.pixels = 10000000, .size = 1024, .kind = -1};
    while (arguments.next < arguments.count) {
        if (bench_option(&arguments, "--pixels", &value))
            bench_numbers(value, 1, 100000000000, 1, &out->pixels);
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 64, 8192, 1, &out->size);
        else if (bench_option(&arguments, "--first", &value))
            bench_numbers(value, 0, 1000000000, 1, &out->first);
        else if (bench_option(&arguments, "--kind", &value))
            bench_numbers(value, 0, HARD_PLATES, 1, &out->kind);
        else if (bench_option(&arguments, "--faces", &value))
            bench_numbers(value, 1, 1000000000, 1, &out->faces);
        else if (bench_option(&arguments, "--drawn", &value))
            bench_numbers(value, 1, 1000000000, 1, &out->drawn);
        else if (!bench_option(&arguments, "--device", &out->device) &&
                 !bench_option(&arguments, "--csv", &out->csv))
            bench_usage(&arguments, usage);
    }
}

static skg_plan *plan_of(const tools *t, const solid *s, const skg_view *view, int32_t precision,
                         int32_t strategy) {
    skg_mesh *mesh = NULL;
    skg_scene *scene = NULL;
    skg_plan *plan = NULL;
    skg_part part;
    skg_plan_options options;
    skg_part_init(&part);
    skg_plan_options_init(&options);
    options.precision = precision;
    options.strategy = strategy;
    options.overlaps = 0;
    bench_try(skg_mesh_create(t->context, "body",
                              &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                 .vertices = s->vertices,
                                                 .positions = s->positions,
                                                 .triangles = s->triangles,
                                                 .corners = s->corners,
                                                 .unit_mm = 1},
                              &mesh),
              "mesh");
    bench_try(skg_scene_create(t->context, &scene), "scene");
    part.mesh = mesh;
    part.material = t->material;
    part.label = "body";
    bench_try(skg_scene_part_add(scene, &part, NULL), "part");
    bench_try(skg_plan_create(t->context, scene, view, t->beam, &options, &plan), "plan");
    skg_mesh_release(&mesh);
    skg_scene_release(&scene);
    return plan;
}

static void lengths_of(const tools *t, const solid *s, const skg_view *view, int32_t precision,
                       int32_t strategy, void *lengths) {
    skg_plan *plan = plan_of(t, s, view, precision, strategy);
    skg_output output;
    skg_frame frame;
    skg_job *job = NULL;
    skg_output_init(&output);
    skg_frame_init(&frame);
    output.type = precision == SKG_PRECISION_DOUBLE ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
    output.data = lengths;
    output.kind = SKG_OUTPUT_LENGTHS;
    output.lengths = SKG_LENGTHS_SURFACE;
    bench_try(skg_plan_submit(plan, 1, &frame, 1, &output, &job), "lengths");
    bench_try(skg_job_wait(&job), "lengths");
    skg_plan_release(&plan);
}

/* Hits are counted in open meshes only, so the body gets a triangle that is too small to be met. */
static int64_t unbalanced(const tools *t, const solid *s, const skg_view *view, int32_t precision,
                          void *image) {
    static double speck[9] = {0.113, 0.117, 1, 0.1130001, 0.117, 1, 0.113, 0.1170001, 1};
    static int32_t corners[3] = {0, 1, 2};
    const solid extra = {3, 1, speck, corners};
    skg_plan_report report;
    skg_output output;
    solid open = solid_copy(s);
    solid_add(&open, &extra);
    skg_plan *plan = plan_of(t, &open, view, precision, SKG_STRATEGY_AUTO);
    skg_output_init(&output);
    output.type = precision == SKG_PRECISION_DOUBLE ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
    output.data = image;
    bench_try(skg_plan_image(plan, &output), "image");
    skg_plan_report_init(&report);
    bench_try(skg_plan_report_get(plan, &report), "report");
    if (report.leaky_parts != 1) bench_die("the speck did not open the body");
    skg_plan_release(&plan);
    solid_free(&open);
    return report.bad_pixels;
}

static void take(const tools *t, const settings *set, uint64_t number, float *single, double *twice,
                 tally *total) {
    static const int32_t strategies[] = {SKG_STRATEGY_COPIES, SKG_STRATEGY_TILES, SKG_STRATEGY_ATOMICS};
    const int plates = set->kind == HARD_PLATES, kind = plates ? HARD_PLATES : (int)(number % HARD_TURNS);
    if (set->kind >= 0 && kind != set->kind) return;
    skg_view view = hard_view(set->size, plates ? number : number / HARD_TURNS);
    solid s = hard_body(kind, &view, number);
    if (plates) hard_view_fit(&s, &view);
    solid_round(&s); /* what the library stores is what the caster sees */
    const int foil = plates && hard_thickness(number) < 0.01; /* mm */
    tally *its = &total[foil ? HARD_FOILS : kind];
    its->pictures++;
    its->unbalanced[0] += unbalanced(t, &s, &view, SKG_PRECISION_SINGLE, single);
    its->unbalanced[1] += unbalanced(t, &s, &view, SKG_PRECISION_DOUBLE, twice);
    lengths_of(t, &s, &view, SKG_PRECISION_SINGLE, strategies[number % 3], single);
    lengths_of(t, &s, &view, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO, twice);
    char name[64];
    snprintf(name, sizeof name, "picture %" PRIu64 " (%s)", number, hard_names[kind]);
    const double share = foil ? 5e-6 : 2e-6;
    hard_judge(&s, &view, share, single, twice, name, &its->verdict);
    solid_free(&s);
}

/* Returns whether a pixel is unbalanced or out of bar. */
static int print(const tally *total, FILE *csv) {
    int bad = 0;
    printf(
        "| bodies | pictures | pixels | met | unbalanced, single / double | judged | thin | folded | out of bar | rough | worst | lowest |\n"
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    if (csv)
        fprintf(
            csv,
            "bodies,pictures,pixels,met,unbalanced_single,unbalanced_double,judged,thin,folded,out,rough,worst,lowest\n");
    for (int k = 0; k < HARD_KINDS; k++) {
        const tally *its = &total[k];
        const hard_verdict *v = &its->verdict;
        printf("| %s | %" PRId64 " | %" PRId64 " | %" PRId64 " | %" PRId64 " / %" PRId64 " | %" PRId64
               " | %" PRId64 " | %" PRId64 " | %" PRId64 " | %" PRId64 " | %.2g | %.2g |\n",
               hard_names[k], its->pictures, v->pixels, v->met, its->unbalanced[0], its->unbalanced[1],
               v->judged, v->thin, v->folded, v->out, v->rough, v->worst, v->lowest);
        if (csv)
            fprintf(csv,
                    "%s,%" PRId64 ",%" PRId64 ",%" PRId64 ",%" PRId64 ",%" PRId64 ",%" PRId64 ",%" PRId64
                    ",%" PRId64 ",%" PRId64 ",%" PRId64 ",%.3g,%.3g\n",
                    hard_names[k], its->pictures, v->pixels, v->met, its->unbalanced[0], its->unbalanced[1],
                    v->judged, v->thin, v->folded, v->out, v->rough, v->worst, v->lowest);
        bad |= its->unbalanced[0] > 0 || its->unbalanced[1] > 0 || v->out > 0;
        if (k >= HARD_PLATES) bad |= 1000 * v->rough > v->met;
    }
    return bad;
}

int main(int count, char **words) {
    settings set;
    tools t = {0};
    tally total[HARD_KINDS] = {0};
    skg_device_info info;
    read_settings(count, words, &set);
    t.context = bench_context(set.device);
    /* Warnings of these bodies are of no interest: parts of them are inside out. */
    bench_try(skg_context_log_set(t.context, NULL, NULL), "log");
    skg_device_info_init(&info);
    bench_try(skg_context_device_get(t.context, &info), "device");
    if (!info.double_precision)
        bench_die("the device has no double precision, by which the pixels are chosen that need a judge");
    if (set.faces || set.drawn) {
        int64_t out = 0;
        if (set.faces) out += hard_faces(t.context, set.first, set.faces);
        if (set.drawn) out += hard_drawn(t.context, set.first, set.drawn);
        skg_context_release(&t.context);
        return out > 0;
    }
    bench_try(skg_material_create_mu("body", 0.1, &t.material), "material");
    bench_try(skg_spectrum_create_mono(100, 1, &t.beam), "beam");
    const int64_t per_picture = (int64_t)set.size * set.size;
    float *single = bench_alloc((size_t)per_picture, sizeof *single);
    double *twice = bench_alloc((size_t)per_picture, sizeof *twice);
    FILE *csv = set.csv ? bench_open(set.csv) : NULL;
    const int64_t end = set.first + (set.pixels + per_picture - 1) / per_picture;
    for (int64_t number = set.first; number < end; number++)
        take(&t, &set, (uint64_t)number, single, twice, total);
    printf("Pictures %ld to %" PRId64 ", %ld x %ld pixels\n\n", set.first, end - 1, set.size, set.size);
    const int bad = print(total, csv);
    free(single);
    free(twice);
    skg_spectrum_release(&t.beam);
    skg_material_release(&t.material);
    skg_context_release(&t.context);
    if (csv && fclose(csv) != 0) bench_die("%s could not be written", set.csv);
    return bad;
}
