/* Measures the cost of a volume of cells: an image of one energy, of a spectrum, and with a rod inside, against rays through the same cells
 * in plain C with OpenMP, whose error is printed beside the library's. */
#include "common/bench.h"
#include "volume/walk.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] = "[--quick] [--size N] [--cells N] [--repeats N] [--device CONFIG] [--csv FILE]";
enum { BINS = 80 };

typedef struct {
    long size, cells, repeats;
    const char *device, *csv;
} settings;

/* A body with lungs, spine and noise, HU. */
static int16_t *make_cells(long side) {
    int16_t *cells = bench_alloc((size_t)(side * side * side), sizeof *cells);
    uint32_t state = 1;
    for (long k = 0; k < side * side * side; k++) {
        const double x = 2 * ((double)(k % side) + 0.5) / (double)side - 1,
                     y = 2 * ((double)(k / side % side) + 0.5) / (double)side - 1,
                     z = 2 * ((double)(k / side / side) + 0.5) / (double)side - 1;
        const double lung = (fabs(x) - 0.4) * (fabs(x) - 0.4) * 10 + y * y * 4 + z * z;
        double hu = x * x * 1.3 + y * y * 2.4 > 1          ? -1000
                    : lung < 1                             ? -780
                    : x * x + (y - 0.4) * (y - 0.4) < 0.01 ? 500
                                                           : 40;
        state = state * 1664525u + 1013904223u;
        if (hu > -1000) hu += (double)(state >> 26) - 32;
        cells[k] = (int16_t)hu;
    }
    return cells;
}

typedef struct {
    skg_plan *plan;
    skg_output output;
    skg_scene *scene;
} frames;

static const double SIZE = 360;

static skg_view make_view(const settings *s) {
    skg_view view;
    skg_view_init(&view);
    view.columns = view.rows = s->size;
    view.source[0] = -700, view.source[1] = -640, view.source[2] = 90;
    view.centre[0] = 220, view.centre[1] = 200, view.centre[2] = -30;
    view.column_step[0] = -0.68 * 520 / (double)s->size, view.column_step[1] = 0.73 * 520 / (double)s->size;
    view.row_step[2] = 480.0 / (double)s->size;
    return view;
}

static frames make_frames(skg_context *context, const settings *s, const int16_t *cells, int64_t bins,
                          int rod) {
    frames f = {0};
    double kev[BINS], photons[BINS];
    const skg_view view = make_view(s);
    skg_volume_source source;
    skg_plan_options options;
    skg_spectrum *spectrum = NULL;
    skg_part part;
    skg_volume_source_init(&source);
    source.columns = source.rows = source.slices = s->cells;
    source.cells = cells;
    for (int k = 0; k < 3; k++)
        source.affine[5 * k] = SIZE / (double)s->cells,
                          source.affine[4 * k + 3] = 0.5 * SIZE * (1 / (double)s->cells - 1);
    bench_try(skg_scene_create(context, &f.scene), "scene");
    skg_part_init(&part);
    part.label = "patient";
    bench_try(skg_volume_create(&source, &part.volume), "volume");
    bench_try(skg_scene_part_add(f.scene, &part, NULL), "part");
    skg_volume_release(&part.volume);
    if (rod) {
        skg_part_init(&part);
        part.label = "rod", part.inside = 0;
        bench_try(skg_mesh_create_cylinder(6, 250, 64, &part.mesh), "rod");
        bench_try(skg_material_create_named("Ti", &part.material), "material");
        bench_try(skg_scene_part_add(f.scene, &part, NULL), "part");
        skg_mesh_release(&part.mesh);
        skg_material_release(&part.material);
    }
    for (int64_t k = 0; k < bins; k++) kev[k] = bins == 1 ? 60 : 20 + (double)k, photons[k] = 100;
    bench_try(skg_spectrum_create_bins(bins, kev, photons, &spectrum), "spectrum");
    skg_plan_options_init(&options);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    options.tolerance = bins > 1 ? 1e-3 : 0;
    bench_try(skg_plan_create(context, f.scene, &view, spectrum, &options, &f.plan), "plan");
    skg_spectrum_release(&spectrum);
    skg_output_init(&f.output);
    f.output.data = bench_alloc((size_t)(s->size * s->size), sizeof(float));
    return f;
}

static void run_frame(void *contender) {
    frames *f = contender;
    bench_try(skg_plan_image(f->plan, &f->output), "image");
}

/* The weights by value, from the least value on, 1/mm at 60 keV: those of the library's tissues. */
static float *make_weights(const int16_t *cells, long count, int *low) {
    int high = cells[0];
    *low = cells[0];
    for (long k = 0; k < count; k++)
        *low = cells[k] < *low ? cells[k] : *low, high = cells[k] > high ? cells[k] : high;
    float *weights = bench_alloc((size_t)(high - *low + 1), sizeof *weights);
    for (int hu = *low; hu <= high; hu++) {
        skg_material *tissue = NULL;
        double per_cm = 0;
        bench_try(skg_material_create_hounsfield(hu, &tissue), "tissue");
        bench_try(skg_material_attenuation_get(tissue, 60, &per_cm), "attenuation");
        weights[hu - *low] = (float)(0.1 * per_cm);
        skg_material_release(&tissue);
    }
    return weights;
}

/* The worst difference to sums in double, as a share of the greatest attenuation, over some pixels. */
static double worst_of(const walk_work *work, const float *image) {
    double worst = 0, most = 0;
    for (int64_t p = 0; p < work->view.rows * work->view.columns; p += 37) {
        const double exact = walk_exactly(work, p / work->view.columns, p % work->view.columns);
        worst = fmax(worst, fabs((double)image[p] - exact)), most = fmax(most, exact);
    }
    return worst / most;
}

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.size = 512, .cells = 256, .repeats = 20};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick"))
            out->repeats = 5;
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 32, 8192, 1, &out->size);
        else if (bench_option(&arguments, "--cells", &value))
            bench_numbers(value, 8, 1024, 1, &out->cells);
        else if (bench_option(&arguments, "--repeats", &value))
            bench_numbers(value, 5, BENCH_SAMPLES, 1, &out->repeats);
        else if (!bench_option(&arguments, "--device", &out->device) &&
                 !bench_option(&arguments, "--csv", &out->csv))
            bench_usage(&arguments, usage);
    }
}

int main(int count, char **words) {
    static const char *const names[] = {"library, one energy", "library, a spectrum of 80 energies",
                                        "library, spectrum, a rod inside", "plain C with OpenMP, one energy"};
    enum { CASES = 4 };
    settings s;
    read_settings(count, words, &s);
    skg_context *context = bench_context(s.device);
    FILE *csv = s.csv ? bench_open(s.csv) : NULL;
    int16_t *cells = make_cells(s.cells);
    walk_work walk = {.cells = cells, .side = (int)s.cells, .size = SIZE, .view = make_view(&s)};
    frames plans[3];
    bench_times times[CASES] = {{0}};
    bench_frame functions[CASES] = {run_frame, run_frame, run_frame, walk_frame};
    void *what[CASES];
    for (int k = 0; k < 3; k++) {
        plans[k] = make_frames(context, &s, cells, k ? BINS : 1, k == 2);
        what[k] = &plans[k];
    }
    float *weights = make_weights(cells, s.cells * s.cells * s.cells, &walk.low);
    walk.weights = weights;
    walk.image = bench_alloc((size_t)(s.size * s.size), sizeof *walk.image);
    what[3] = &walk;
    bench_interleave(CASES, functions, what, (int)s.repeats / 5, 5, times);
    printf("| %ld^3 cells, %ld x %ld pixels | min ms | median ms | worst error |\n|---|---|---|---|\n",
           s.cells, s.size, s.size);
    for (int k = 0; k < CASES; k++) {
        printf("| %s | %.1f | %.1f | ", names[k], bench_min(&times[k]), bench_median(&times[k]));
        if (k == 0 || k == 3)
            printf("%.2g |\n", worst_of(&walk, k ? walk.image : (const float *)plans[0].output.data));
        else
            printf("|\n");
        if (csv) fprintf(csv, "volume,%s,%g,%g\n", names[k], bench_min(&times[k]), bench_median(&times[k]));
    }
    printf("\nplain C over library, one energy: %.2f (target: 2)\n",
           bench_min(&times[3]) / bench_min(&times[0]));
    if (csv) fclose(csv);
    for (int k = 0; k < 3; k++) {
        skg_plan_release(&plans[k].plan);
        skg_scene_release(&plans[k].scene);
        free(plans[k].output.data);
    }
    free(walk.image);
    free(weights);
    free(cells);
    skg_context_release(&context);
    return 0;
}
