/* Draws the image of leaky meshes with each kind of repair (none, the neighbours' mean, rays traced again), and
 * below each image its difference from the image of the closed meshes. Prints the errors of the three.
 *
 *   skiagraph thorax --simple -o thorax && bench_repair --scene thorax/thorax.json --png docs/repair.png */
#include "common/holes.h"
#include "common/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { KINDS = 3, EVERY = 30, SIDE = 256, GAP = 8, FIRST_ROW = 160, FIRST_COLUMN = 52 };
enum { COLUMNS = KINDS * SIDE + (KINDS - 1) * GAP, ROWS = 2 * SIDE + GAP };

static const char *const leaky_parts[] = {"liver", "heart", "lung left", "lung right", "diaphragm"};
static const char *const names[KINDS] = {
    [SKG_REPAIR_NONE] = "none", [SKG_REPAIR_NEIGHBOURS] = "neighbours", [SKG_REPAIR_EXACT] = "exact"};
static const double darkest = 2.5, densest = 7; /* -ln(I/I0), black and white of the images */
static const double largest = 0.5;              /* of the differences, black and white */

static int is_leaky(const char *label) {
    for (size_t k = 0; k < sizeof leaky_parts / sizeof *leaky_parts; k++)
        if (!strcmp(label, leaky_parts[k])) return 1;
    return 0;
}

static skg_scene *leaky_scene(skg_context *context, const skg_scene *closed) {
    skg_scene *scene = NULL;
    int64_t parts = 0;
    bench_try(skg_scene_create(context, &scene), "scene");
    bench_try(skg_scene_part_count(closed, &parts), "scene");
    for (int64_t i = 0; i < parts; i++) {
        skg_part part;
        skg_part_init(&part);
        bench_try(skg_scene_part_get(closed, i, &part), "part");
        const int leaky = is_leaky(part.label);
        if (leaky) part.mesh = bench_mesh_with_holes(context, part.mesh, EVERY, part.label);
        bench_try(skg_scene_part_add(scene, &part, NULL), part.label);
        if (leaky) skg_mesh_release(&part.mesh);
    }
    return scene;
}

/* [rows][columns] of -ln(I/I0). */
static double *make_image(skg_context *context, const bench_scene *bench, skg_scene *scene, int32_t repair,
                          skg_plan_report *report) {
    skg_plan_options options = bench->options;
    skg_plan *plan = NULL;
    skg_output output;
    options.precision = SKG_PRECISION_DOUBLE;
    options.repair = repair;
    options.quantity = SKG_QUANTITY_ATTENUATION;
    options.overlaps = 0;
    bench_try(skg_plan_create(context, scene, &bench->view, bench->beam, &options, &plan), "plan");
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64;
    double *image = bench_alloc((size_t)(bench->view.columns * bench->view.rows), sizeof *image);
    output.data = image;
    bench_try(skg_plan_image(plan, &output), "image");
    skg_plan_report_init(report);
    bench_try(skg_plan_report_get(plan, report), "report");
    skg_plan_release(&plan);
    return image;
}

/* Rounded to eight bits, which suffice for a screen and halve the size of the file. */
static float shade(double value) {
    return (float)(round(255 * fmin(fmax(value, 0), 1)) / 255);
}

static void draw(const bench_scene *bench, const double *image, const double *truth, int kind,
                 float *drawing) {
    for (int64_t r = 0; r < SIDE; r++)
        for (int64_t c = 0; c < SIDE; c++) {
            const int64_t from = (FIRST_ROW + r) * bench->view.columns + FIRST_COLUMN + c;
            float *to = drawing + r * COLUMNS + kind * (SIDE + GAP) + c;
            to[0] = shade((image[from] - darkest) / (densest - darkest));
            to[(SIDE + GAP) * COLUMNS] = shade(0.5 + (image[from] - truth[from]) / (2 * largest));
        }
}

static void print_errors(const bench_scene *bench, const char *name, const double *image, const double *truth,
                         const skg_plan_report *report) {
    const int64_t pixels = bench->view.columns * bench->view.rows;
    double worst = 0, squares = 0;
    int64_t wrong = 0;
    for (int64_t i = 0; i < pixels; i++) {
        const double error = fabs(image[i] - truth[i]);
        worst = fmax(worst, error);
        squares += error * error;
        wrong += error > 0.01;
    }
    printf("| %-10s | %6lld | %6lld | %6lld | %8.2g | %8.2g |\n", name, (long long)report->bad_pixels,
           (long long)report->repaired_pixels, (long long)wrong, worst, sqrt(squares / (double)pixels));
}

static void write_drawing(const float *drawing, const char *png) {
    skg_picture picture;
    skg_picture_init(&picture);
    picture.type = SKG_TYPE_FLOAT32;
    picture.columns = COLUMNS;
    picture.rows = ROWS;
    picture.channels = 1;
    picture.data = drawing;
    picture.quantity = SKG_QUANTITY_ATTENUATION;
    picture.low = 0;
    picture.high = 1;
    bench_try(skg_picture_save(&picture, png), png);
}

int main(int count, char **words) {
    static const char usage[] = "usage: bench_repair --scene thorax/thorax.json --png FILE [--device CONFIG]";
    bench_arguments arguments = {count, words, 1};
    const char *file = NULL, *png = NULL, *device = NULL;
    bench_scene bench;
    skg_plan_report report;
    while (arguments.next < count)
        if (!bench_option(&arguments, "--scene", &file) && !bench_option(&arguments, "--png", &png) &&
            !bench_option(&arguments, "--device", &device))
            bench_usage(&arguments, usage);
    if (!file || !png) bench_die("%s", usage);
    skg_context *context = bench_context(device);
    skg_context_log_set(context, NULL, NULL); /* the meshes are leaky on purpose */
    scene_open(context, file, 0, &bench);
    if (bench.view.columns < FIRST_COLUMN + SIDE || bench.view.rows < FIRST_ROW + SIDE)
        bench_die("%s: the detector is too small for the drawing", file);
    skg_scene *scene = leaky_scene(context, bench.scene);
    float *drawing = bench_alloc((size_t)COLUMNS * ROWS, sizeof *drawing);
    for (int64_t i = 0; i < (int64_t)COLUMNS * ROWS; i++) drawing[i] = 1;
    double *truth = make_image(context, &bench, bench.scene, SKG_REPAIR_NONE, &report);
    printf(
        "Every %dth triangle of five organs is left out; errors of -ln(I/I0) against the closed meshes.\n\n"
        "| repair     | bad    | repaired | > 0.01 | largest  | rms      |\n|---|---|---|---|---|---|\n",
        EVERY);
    for (int kind = 0; kind < KINDS; kind++) {
        double *image = make_image(context, &bench, scene, kind, &report);
        print_errors(&bench, names[kind], image, truth, &report);
        draw(&bench, image, truth, kind, drawing);
        free(image);
    }
    write_drawing(drawing, png);
    free(truth);
    free(drawing);
    skg_scene_release(&scene);
    scene_close(&bench);
    skg_context_release(&context);
    return EXIT_SUCCESS;
}
