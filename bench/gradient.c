/* Measures the cost of a gradient: the thorax with a material for each organ, the image alone against image and gradient, alternately. Then
 * image and gradient against those of a volume, 200 x 200 pixels, by six numbers. */
#include "common/bench.h"
#include "common/thorax.h"
#include "gradient_volume.h"

#include "affinity/affinity.h"

#include <stdlib.h>

static const char usage[] =
    "[--quick] [--size N] [--triangles N] [--repeats N] [--tolerance 0|1] [--device CONFIG] [--affinity] [--csv FILE]";

enum { MATERIALS = 16 };
static const char *const materials[MATERIALS] = {"Tissue, Soft (ICRU-44)",
                                                 "Lung Tissue (ICRU-44)",
                                                 "Bone, Cortical (ICRU-44)",
                                                 "Liver (ICRU-46 adult)",
                                                 "Kidney (ICRU-46 adult)",
                                                 "Muscle, Skeletal (ICRU-44)",
                                                 "Pancreas (ICRU-46 adult)",
                                                 "Skin (ICRU-46 adult)",
                                                 "Spleen (ICRU-46 adult)",
                                                 "Breast Tissue (ICRU-44)",
                                                 "Water, Liquid",
                                                 "Stainless steel 304 (needle)",
                                                 "PEEK",
                                                 "ABS",
                                                 "Graphite",
                                                 "Eye Lens (ICRU-44)"};

typedef struct {
    long size, triangles, repeats, tolerance;
    int affinity;
    const char *device, *csv;
} settings;

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.size = 512, .triangles = 100000, .repeats = 30, .tolerance = 1};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick"))
            out->repeats = 10;
        else if (bench_flag(&arguments, "--affinity"))
            out->affinity = 1;
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 16, 8192, 1, &out->size);
        else if (bench_option(&arguments, "--triangles", &value))
            bench_numbers(value, 1000, 10000000, 1, &out->triangles);
        else if (bench_option(&arguments, "--repeats", &value))
            bench_numbers(value, 5, BENCH_SAMPLES, 1, &out->repeats);
        else if (bench_option(&arguments, "--tolerance", &value))
            bench_numbers(value, 0, 1, 1, &out->tolerance);
        else if (!bench_option(&arguments, "--device", &out->device) &&
                 !bench_option(&arguments, "--csv", &out->csv))
            bench_usage(&arguments, usage);
    }
}

/* One contender: an image, and what else of it. */
typedef struct {
    skg_plan *plan;
    skg_output output;
    skg_adjoint adjoint;
    skg_gradient gradient;
    int wants; /* 0: the image alone; 1, 2: its gradient; 3, 4: its derivatives along directions */
    int64_t direction_count;
    skg_direction *directions;
    skg_output derivatives;
} contender;

static void frame(void *who) {
    contender *self = who;
    bench_try(skg_plan_image(self->plan, &self->output), "image");
    if (self->wants >= 3)
        bench_try(skg_plan_derivatives(self->plan, NULL, self->direction_count, self->directions,
                                       &self->derivatives, NULL),
                  "derivatives");
    else if (self->wants)
        bench_try(skg_plan_gradient(self->plan, NULL, &self->adjoint, &self->gradient), "gradient");
}

/* Gives every part a material of its own, as far as there are any. */
static void set_materials(skg_scene *scene, int64_t parts) {
    for (int64_t p = 0; p < parts; p++) {
        skg_material *material = NULL;
        bench_try(skg_material_create_named(materials[p % MATERIALS], &material), "material");
        bench_try(skg_scene_part_material_set(scene, p, material), "material");
        skg_material_release(&material);
    }
}

static skg_plan *make_plan(skg_context *context, skg_scene *scene, const settings *set, long size) {
    skg_plan_options options;
    skg_view view;
    skg_spectrum *beam = thorax_beam();
    skg_plan *plan = NULL;
    thorax_view(size, &view);
    skg_plan_options_init(&options);
    options.overlaps = 0;
    options.tolerance = set->tolerance ? 1e-4 : 0;
    bench_try(skg_plan_create(context, scene, &view, beam, &options, &plan), "plan");
    skg_spectrum_release(&beam);
    return plan;
}

/* Memory for the vertices of all parts. */
static double **make_vertices(const bench_thorax *thorax) {
    double **vertices = bench_alloc((size_t)thorax->parts, sizeof *vertices);
    for (int64_t p = 0; p < thorax->parts; p++) {
        int64_t count = 0, triangles = 0;
        bench_try(skg_mesh_count(thorax->meshes[p], &count, &triangles), "mesh");
        vertices[p] = bench_alloc((size_t)(3 * count), sizeof **vertices);
    }
    return vertices;
}

enum { CONTENDERS = 5, WAYS = 6 };

/* Along the twists of the first part. twists: [WAYS][parts][6] */
static void set_directions(const bench_thorax *thorax, double *twists, skg_direction directions[WAYS]) {
    for (int d = 0; d < WAYS; d++) {
        skg_direction_init(&directions[d]);
        directions[d].poses = twists + d * 6 * thorax->parts;
        twists[d * 6 * thorax->parts + d] = 1;
    }
}

static void compare(const settings *set, const bench_thorax *thorax, skg_plan *plan, FILE *csv) {
    static const char *const names[CONTENDERS] = {"image", "image, poses, source, detector, densities",
                                                  "the same and all vertices", "image, along a twist",
                                                  "image, along six twists"};
    double *adjoint = bench_alloc((size_t)(set->size * set->size), sizeof *adjoint), view[9];
    double *derivatives = bench_alloc((size_t)(WAYS * set->size * set->size), sizeof *derivatives);
    double *twists = bench_alloc((size_t)(WAYS * 6 * thorax->parts), sizeof *twists);
    skg_direction directions[WAYS];
    double **vertices = make_vertices(thorax);
    double *densities = bench_alloc((size_t)thorax->parts, sizeof *densities);
    contender all[CONTENDERS] = {0};
    bench_times times[CONTENDERS] = {0};
    const bench_frame frames[CONTENDERS] = {frame, frame, frame, frame, frame};
    void *who[CONTENDERS];
    for (long p = 0; p < set->size * set->size; p++) adjoint[p] = 1e-6 * (double)(p % 7 - 3);
    set_directions(thorax, twists, directions);
    for (int k = 0; k < CONTENDERS; k++) {
        contender *c = &all[k];
        who[k] = c;
        c->plan = plan, c->wants = k;
        skg_output_init(&c->output);
        c->output.data = bench_alloc((size_t)(set->size * set->size), sizeof(float));
        skg_adjoint_init(&c->adjoint);
        c->adjoint.channels = 1, c->adjoint.rows = c->adjoint.columns = set->size, c->adjoint.data = adjoint;
        skg_gradient_init(&c->gradient);
        c->gradient.poses = bench_alloc((size_t)(6 * thorax->parts), sizeof(double));
        c->gradient.densities = densities;
        c->gradient.source = view, c->gradient.detector = view + 3;
        if (k == 2) c->gradient.vertices = vertices;
        c->direction_count = k == 4 ? WAYS : 1;
        c->directions = directions;
        skg_output_init(&c->derivatives);
        c->derivatives.type = SKG_TYPE_FLOAT64;
        c->derivatives.data = derivatives;
    }
    bench_interleave(CONTENDERS, frames, who, (int)(set->repeats + 4) / 5, 5, times);
    printf("| what | minimum, ms | median, ms | images |\n|---|---:|---:|---:|\n");
    if (csv) fprintf(csv, "what,min_ms,median_ms,images\n");
    for (int k = 0; k < CONTENDERS; k++) {
        const double least = bench_min(&times[k]), images = least / bench_min(&times[0]);
        printf("| %s | %.4g | %.4g | %.2f |\n", names[k], least, bench_median(&times[k]), images);
        if (csv) fprintf(csv, "\"%s\",%.5g,%.5g,%.3f\n", names[k], least, bench_median(&times[k]), images);
        free(all[k].output.data);
        free(all[k].gradient.poses);
    }
    const double further = (bench_min(&times[4]) - bench_min(&times[3])) / (WAYS - 1);
    printf("| each further twist | %.4g | | %.2f |\n", further, further / bench_min(&times[0]));
    if (csv) fprintf(csv, "each further twist,%.5g,,%.3f\n", further, further / bench_min(&times[0]));
    for (int64_t p = 0; p < thorax->parts; p++) free(vertices[p]);
    free(vertices);
    free(twists);
    free(densities);
    free(derivatives);
    free(adjoint);
}

enum { SMALL = 200 };

/* Image and gradient of all poses against those through a volume by one pose. */
static void compare_volume(const settings *set, const bench_thorax *thorax, skg_plan *plan, FILE *csv) {
    double *adjoint = bench_alloc((size_t)SMALL * SMALL, sizeof *adjoint);
    float *image = bench_alloc((size_t)SMALL * SMALL, sizeof *image);
    contender ours = {.plan = plan, .wants = 1};
    volume_work volume = {.size = 480, .adjoint = adjoint};
    bench_times times[2] = {0};
    const bench_frame frames[2] = {frame, volume_frame};
    void *const who[2] = {&ours, &volume};
    for (long p = 0; p < SMALL * SMALL; p++) adjoint[p] = 1e-6 * (double)(p % 7 - 3);
    volume.cells = bench_alloc((size_t)VOLUME_SIDE * VOLUME_SIDE * VOLUME_SIDE, sizeof *volume.cells);
    volume_fill(&volume);
    thorax_view(SMALL, &volume.view);
    skg_output_init(&ours.output);
    skg_adjoint_init(&ours.adjoint);
    skg_gradient_init(&ours.gradient);
    ours.output.data = image;
    ours.adjoint.channels = 1, ours.adjoint.rows = ours.adjoint.columns = SMALL, ours.adjoint.data = adjoint;
    ours.gradient.poses = bench_alloc((size_t)(6 * thorax->parts), sizeof(double));
    bench_interleave(2, frames, who, (int)(set->repeats + 4) / 5, 5, times);
    const double ratio = bench_min(&times[1]) / bench_min(&times[0]);
    printf(
        "\n%d x %d pixels: image and gradient of all poses %.4g ms; of one pose of a volume with %d points a ray %.4g ms, "
        "%.1f times.\n",
        SMALL, SMALL, bench_min(&times[0]), VOLUME_POINTS, bench_min(&times[1]), ratio);
    if (csv)
        fprintf(csv, "\"volume, 200 x 200\",%.5g,%.5g,%.3f\n", bench_min(&times[1]), bench_median(&times[1]),
                ratio);
    free(ours.gradient.poses);
    free(volume.cells);
    free(image);
    free(adjoint);
}

int main(int count, char **words) {
    settings set;
    bench_thorax thorax;
    read_settings(count, words, &set);
    if (set.affinity) host_pin_threads();
    skg_context *context = bench_context(set.device);
    FILE *csv = set.csv ? bench_open(set.csv) : NULL;
    thorax_make(set.triangles, THORAX_CLOSED, &thorax);
    skg_scene *scene = thorax_scene(context, &thorax);
    set_materials(scene, thorax.parts);
    skg_plan *plan = make_plan(context, scene, &set, set.size);
    printf("Thorax of %lld parts, %lld triangles; detector %ld x %ld; tolerance %s.\n\n",
           (long long)thorax.parts, (long long)thorax.triangles, set.size, set.size,
           set.tolerance ? "1e-4" : "0 (every energy)");
    compare(&set, &thorax, plan, csv);
    skg_plan *small = make_plan(context, scene, &set, SMALL);
    compare_volume(&set, &thorax, small, csv);
    skg_plan_release(&small);
    if (csv && fclose(csv) != 0) bench_die("%s could not be written", set.csv);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    thorax_free(&thorax);
    skg_context_release(&context);
    return 0;
}
