/* The verb `distance`: how far two surfaces are apart. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/progress.h"
#include "common/say.h"
#include "common/values.h"
#include "map/map.h"

#include <skiagraph/breathing.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct {
    const cli_arguments *arguments;
    skg_mesh *mesh[2];  /* A and B */
    skg_distance to[2]; /* from A to B and back */
    double *map[2];     /* per vertex */
    skg_distance_options options;
} work;

static int read_options(work *w) {
    const cli_arguments *arguments = w->arguments;
    const char *picture = cli_value(arguments, "-o");
    const char *map = cli_value(arguments, "--map");
    skg_distance_options_init(&w->options);
    w->options.progress = cli_progress();
    int exit_status = cli_choice(arguments, "--sampling", &w->options.sampling);
    if (exit_status == CLI_DONE)
        exit_status = cli_number(arguments, "--spacing", 1e-6, 1e6, &w->options.spacing_mm);
    if (exit_status != CLI_DONE) return exit_status;
    if (picture && !cli_has_extension(picture, ".png"))
        return cli_error(CLI_USAGE, "-o %s: the picture is written as .png", picture);
    if (map && !cli_has_extension(map, ".ply"))
        return cli_error(CLI_USAGE, "--map %s: a map is written as .ply", map);
    return map ? cli_check_overwrite(arguments, map) : CLI_DONE;
}

static int load(work *w) {
    double unit_mm = 1;
    int exit_status = cli_mesh_unit(w->arguments, &unit_mm);
    skg_status status = SKG_OK;
    for (int m = 0; m < 2 && exit_status == CLI_DONE && status == SKG_OK; m++)
        status = skg_mesh_load(NULL, w->arguments->operands[m], unit_mm, &w->mesh[m]);
    return status == SKG_OK ? exit_status : cli_fail(status);
}

static int measure(work *w) {
    skg_status status = SKG_OK;
    for (int m = 0; m < 2 && status == SKG_OK; m++) {
        skg_distance_init(&w->to[m]);
        status = skg_distance_measure(w->mesh[m], w->mesh[1 - m], &w->options, &w->to[m]);
    }
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* The distances of the vertices of A or B from the other surface. */
static int find_map(work *w, int m) {
    int64_t vertices = 0, triangles = 0;
    skg_status status = skg_mesh_count(w->mesh[m], &vertices, &triangles);
    double *positions = malloc((size_t)(3 * vertices) * sizeof *positions);
    w->map[m] = malloc((size_t)vertices * sizeof *w->map[m]);
    if (!positions || !w->map[m]) {
        free(positions);
        return cli_error(CLI_DEVICE, "out of host memory for the map");
    }
    if (status == SKG_OK) status = skg_mesh_positions_get(w->mesh[m], positions, 0);
    if (status == SKG_OK) status = skg_distance_of_points(w->mesh[1 - m], vertices, positions, w->map[m]);
    free(positions);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int write_picture(const work *w, const char *path, double high) {
    char titles[2][512];
    cli_map maps[2];
    unsigned char *png = NULL;
    size_t size = 0;
    for (int m = 0; m < 2; m++) {
        snprintf(titles[m], sizeof titles[m], "%s to %s: mean %.3g mm, maximum %.3g mm",
                 w->arguments->operands[m], w->arguments->operands[1 - m], w->to[m].mean_mm, w->to[m].max_mm);
        maps[m] = (cli_map){titles[m], w->mesh[m], w->map[m]};
    }
    int exit_status = cli_map_png(maps, 2, high, &png, &size);
    if (exit_status == CLI_DONE) exit_status = cli_write_file(path, png, size);
    free(png);
    return exit_status;
}

static int write_maps(work *w) {
    const char *picture = cli_value(w->arguments, "-o");
    const char *map = cli_value(w->arguments, "--map");
    double high = cli_map_end(fmax(w->to[0].max_mm, picture ? w->to[1].max_mm : 0));
    int exit_status = cli_number(w->arguments, "--high", 1e-9, 1e9, &high);
    for (int m = 0; m < (picture ? 2 : map ? 1 : 0) && exit_status == CLI_DONE; m++)
        exit_status = find_map(w, m);
    if (map && exit_status == CLI_DONE) {
        const skg_status status = skg_distance_map_save(w->mesh[0], w->map[0], high, map);
        if (status != SKG_OK) exit_status = cli_fail(status);
    }
    return picture && exit_status == CLI_DONE ? write_picture(w, picture, high) : exit_status;
}

static json_t *distance_json(const skg_distance *d) {
    json_t *object = json_object();
    json_object_set_new(object, "mean_mm", cli_json_number(d->mean_mm));
    json_object_set_new(object, "rms_mm", cli_json_number(d->rms_mm));
    json_object_set_new(object, "p95_mm", cli_json_number(d->p95_mm));
    json_object_set_new(object, "max_mm", cli_json_number(d->max_mm));
    json_object_set_new(object, "max_position_mm", cli_json_numbers(d->max_position_mm, 3));
    json_object_set_new(object, "samples", json_integer(d->samples));
    json_object_set_new(object, "spacing_mm", cli_json_number(d->spacing_mm));
    return object;
}

static int print(const work *w) {
    const double hausdorff = fmax(w->to[0].max_mm, w->to[1].max_mm);
    const int at_vertices = w->options.sampling == SKG_DISTANCE_VERTICES;
    if (cli_given(w->arguments, "--json")) {
        json_t *object = distance_json(&w->to[0]);
        json_object_set_new(object, "back", distance_json(&w->to[1]));
        json_object_set_new(object, "hausdorff_mm", cli_json_number(hausdorff));
        json_object_set_new(object, "sampling", json_string(at_vertices ? "vertices" : "surface"));
        return cli_json_print(object);
    }
    if (cli_is_quiet()) return CLI_DONE;
    printf("%-28s %10s %10s %10s %10s %10s\n", "distance in mm", "mean", "rms", "p95", "maximum", "samples");
    for (int m = 0; m < 2; m++)
        printf("%-28s %10.4g %10.4g %10.4g %10.4g %10" PRId64 "\n", m == 0 ? "A to B" : "B to A",
               w->to[m].mean_mm, w->to[m].rms_mm, w->to[m].p95_mm, w->to[m].max_mm, w->to[m].samples);
    printf("Hausdorff distance %.4g mm; ", hausdorff);
    if (at_vertices)
        printf("sampled at the vertices, all with the same weight\n");
    else
        printf("sampled over the surface, at most %.3g mm apart\n",
               fmax(w->to[0].spacing_mm, w->to[1].spacing_mm));
    const char *outputs[] = {cli_value(w->arguments, "--map"), cli_value(w->arguments, "-o")};
    for (int i = 0; i < 2; i++)
        if (outputs[i]) cli_print("wrote %s\n", outputs[i]);
    return CLI_DONE;
}

int cli_distance(const cli_arguments *arguments) {
    work w = {.arguments = arguments};
    int exit_status = read_options(&w);
    cli_progress_follow("measuring distances");
    if (exit_status == CLI_DONE) exit_status = load(&w);
    if (exit_status == CLI_DONE) exit_status = measure(&w);
    if (exit_status == CLI_DONE) exit_status = write_maps(&w);
    cli_progress_end();
    if (exit_status == CLI_DONE) exit_status = print(&w);
    for (int m = 0; m < 2; m++) {
        skg_mesh_release(&w.mesh[m]);
        free(w.map[m]);
    }
    return exit_status;
}
