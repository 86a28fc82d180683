/* The page that shows what a fit found. */
#include "fit/work.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/say.h"
#include "map/map.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Skiagraph: fit</title>\n<style>"
    "body{font:15px sans-serif;margin:2em auto;max-width:1000px;color:#222}table{border-collapse:collapse;margin:1em 0}"
    "td,th{padding:.3em .8em;border-bottom:1px solid #ccc;text-align:right}td:first-child,th:first-child{text-align:left}"
    "img{max-width:100%}.open{color:#b03a00}</style></head><body>\n<h1>Fit of a body to surfaces</h1>\n";

static int put_picture(FILE *page, const unsigned char *png, size_t size, const char *what) {
    char *uri = cli_base64("data:image/png;base64,", png, size);
    if (!uri) return cli_error(CLI_DEVICE, "out of host memory for the page");
    fprintf(page, "<p><img alt=\"%s\" src=\"%s\"></p>\n", what, uri);
    free(uri);
    return CLI_DONE;
}

static void put_parameters(FILE *page, const fit_work *work) {
    int64_t count = 0;
    fputs("<h2>Parameters</h2>\n<table><tr><th>parameter<th>unit<th>start<th>range<th>value<th>sigma</tr>\n",
          page);
    if (skg_fit_parameter_count(work->fit, &count) != SKG_OK) return;
    for (int64_t p = 0; p < count; p++) {
        skg_fit_parameter one;
        skg_fit_parameter_init(&one);
        if (skg_fit_parameter_get(work->fit, p, &one) != SKG_OK || !one.chosen) continue;
        fprintf(page, "<tr%s><td>%s<td>%s<td>%.4g<td>%.4g to %.4g<td>%.4g<td>%.2g%s</tr>\n",
                one.determined ? "" : " class=\"open\"", one.name, one.unit, one.start, one.low, one.high,
                one.value, one.sigma, one.determined ? "" : " (not determined)");
    }
    fputs(
        "</table>\n<p>sigma says how far a value may go, the others following, before the errors grow by what is left of "
        "them (at least 0.1 mm).</p>\n",
        page);
}

static void put_targets(FILE *page, const fit_work *work) {
    int64_t count = 0;
    fputs(
        "<h2>Distances in mm</h2>\n<table><tr><th>target<th>phase<th>motion<th>mean before<th>mean after<th>rms before"
        "<th>rms after<th>maximum before<th>maximum after</tr>\n",
        page);
    if (skg_fit_target_count(work->fit, &count) != SKG_OK) return;
    for (int64_t t = 0; t < count; t++) {
        skg_fit_target one;
        skg_fit_target_init(&one);
        if (skg_fit_target_get(work->fit, t, &one) != SKG_OK) continue;
        fputs("<tr><td>", page);
        cli_html_text(one.label, page);
        fprintf(page, "<td>%.3g<td>%.3g<td>%.3g<td>%.3g<td>%.3g<td>%.3g<td>%.3g<td>%.3g</tr>\n", one.phase,
                one.motion_mm, one.before_mean_mm, one.after_mean_mm, one.before_rms_mm, one.after_rms_mm,
                one.before_max_mm, one.after_max_mm);
    }
    fprintf(page, "</table>\n<p>%" PRId64 " evaluations in %.3g s.</p>\n", work->state.evaluations,
            work->seconds);
}

/* The distances of a part's vertices, as it is posed, from the target. The caller frees them. */
static skg_status find_map(const skg_mesh *mesh, const skg_mesh *target, double **distances) {
    int64_t vertices = 0, triangles = 0;
    skg_status status = skg_mesh_count(mesh, &vertices, &triangles);
    double *positions = malloc((size_t)(3 * vertices) * sizeof *positions);
    *distances = malloc((size_t)vertices * sizeof **distances);
    if (status == SKG_OK) status = positions && *distances ? SKG_OK : SKG_ERR_MEMORY;
    if (status == SKG_OK) status = skg_mesh_positions_get(mesh, positions, 0);
    if (status == SKG_OK) status = skg_distance_of_points(target, vertices, positions, *distances);
    free(positions);
    return status;
}

/* Maps of one target, before and after. motions, scenes: of the scene as it was and of the fitted one. */
static int put_maps(FILE *page, skg_motion *const motions[2], skg_scene *const scenes[2],
                    const skg_fit_target *target, const skg_mesh *mesh) {
    char titles[2][400];
    cli_map maps[2];
    double *distances[2] = {NULL, NULL};
    unsigned char *png = NULL;
    size_t size = 0;
    skg_status status = SKG_OK;
    for (int m = 0; m < 2 && status == SKG_OK; m++) {
        skg_part part;
        skg_part_init(&part);
        status = skg_motion_pose_at_phase(motions[m], target->phase);
        if (status == SKG_OK) status = skg_scene_part_get(scenes[m], target->part, &part);
        if (status == SKG_OK) status = find_map(part.mesh, mesh, &distances[m]);
        snprintf(titles[m], sizeof titles[m], "%s at phase %.3g, %s: mean %.3g mm", target->label,
                 target->phase, m == 0 ? "before" : "after",
                 m == 0 ? target->before_mean_mm : target->after_mean_mm);
        maps[m] = (cli_map){titles[m], part.mesh, distances[m]};
    }
    int exit_status = status == SKG_OK ? CLI_DONE : cli_fail(status);
    if (exit_status == CLI_DONE)
        exit_status = cli_map_png(maps, 2, cli_map_end(target->before_max_mm), &png, &size);
    if (exit_status == CLI_DONE) exit_status = put_picture(page, png, size, "maps of distances");
    for (int m = 0; m < 2; m++) free(distances[m]);
    free(png);
    return exit_status;
}

/* Loads the fitted scene anew, so that the page shows what other verbs will find in it. */
static int put_all_maps(FILE *page, const fit_work *work) {
    skg_setup *fitted = NULL;
    skg_motion *motions[2] = {NULL, NULL};
    skg_scene *scenes[2] = {work->scene, NULL};
    int64_t count = 0;
    int exit_status = fit_load_scene(work->arguments, fit_output(work, ".json"), 0, &fitted);
    if (exit_status != CLI_DONE) return exit_status;
    skg_status status = skg_motion_create(NULL, work->setup, &motions[0]);
    if (status == SKG_OK) status = skg_motion_create(NULL, fitted, &motions[1]);
    if (status == SKG_OK) status = skg_setup_scene_get(fitted, &scenes[1]);
    if (status == SKG_OK) status = skg_fit_target_count(work->fit, &count);
    fputs("<h2>Maps</h2>\n", page);
    for (int64_t t = 0; t < count && status == SKG_OK && exit_status == CLI_DONE; t++) {
        skg_fit_target target;
        skg_mesh *mesh = NULL;
        skg_fit_target_init(&target);
        status = skg_fit_target_get(work->fit, t, &target);
        if (status == SKG_OK) status = skg_fit_target_mesh_get(work->fit, t, &mesh);
        if (status == SKG_OK) exit_status = put_maps(page, motions, scenes, &target, mesh);
    }
    for (int m = 0; m < 2; m++) skg_motion_release(&motions[m]);
    skg_setup_release(&fitted);
    return status == SKG_OK ? exit_status : cli_fail(status);
}

int fit_write_page(const fit_work *work, const char *path) {
    char *text = NULL;
    unsigned char *png = NULL;
    size_t size = 0, png_size = 0;
    FILE *page = open_memstream(&text, &size);
    if (!page) return cli_error(CLI_DEVICE, "out of host memory for the page");
    fputs(head, page);
    put_targets(page, work);
    int exit_status = fit_bars_png(work, &png, &png_size);
    if (exit_status == CLI_DONE) exit_status = put_picture(page, png, png_size, "errors before and after");
    put_parameters(page, work);
    if (exit_status == CLI_DONE) exit_status = put_all_maps(page, work);
    fputs("<p>Made by skiagraph.</p></body></html>\n", page);
    if (fclose(page) != 0 && exit_status == CLI_DONE)
        exit_status = cli_error(CLI_DEVICE, "out of host memory for the page");
    if (exit_status == CLI_DONE) exit_status = cli_write_file(path, text, size);
    free(png);
    free(text);
    return exit_status;
}
