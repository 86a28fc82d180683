/* The page that cost writes: its data put into the page of page/. */
#include "cost/output.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/made.h"
#include "common/say.h"
#include "map/surface_png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float MIN_SHOWN = 1e-12f; /* of the flat field */

extern const char cost_page[]; /* page.html, as built in */

/* Values as a picture of 256 levels from low to high, as a URI. */
static int levels_json(const cost_study *study, const float *values, double low, double high, json_t **uri) {
    const int64_t places = study->thumb_columns * study->thumb_rows;
    unsigned char *greys = calloc((size_t)places, 1), *png = NULL;
    size_t size = 0;
    if (!greys) return cli_error(CLI_DEVICE, "out of host memory");
    for (int64_t i = 0; i < places; i++) {
        const double level = round(255 * ((double)values[i] - low) / (high - low));
        greys[i] = (unsigned char)fmin(fmax(level, 0), 255); /* black where the value is not a number */
    }
    int exit_status = cli_png_of_greys((int)study->thumb_columns, (int)study->thumb_rows, greys, &png, &size);
    char *text = exit_status == CLI_DONE ? cli_base64("data:image/png;base64,", png, size) : NULL;
    if (text)
        *uri = json_string(text);
    else if (exit_status == CLI_DONE)
        exit_status = cli_error(CLI_DEVICE, "out of host memory");
    free(greys);
    free(png);
    free(text);
    return exit_status;
}

/* -ln(I/I0) of an image. low, high: set by the first picture and used for all. */
static int small_json(const cost_study *study, const float *small, double *low, double *high, json_t **uri) {
    const int64_t places = study->thumb_columns * study->thumb_rows;
    float *dense = calloc((size_t)places, sizeof *dense);
    skg_picture picture;
    if (!dense) return cli_error(CLI_DEVICE, "out of host memory");
    for (int64_t i = 0; i < places; i++) dense[i] = -logf(fmaxf(small[i], MIN_SHOWN));
    skg_picture_init(&picture);
    picture.columns = study->thumb_columns;
    picture.rows = study->thumb_rows;
    picture.data = dense;
    picture.quantity = SKG_QUANTITY_ATTENUATION;
    skg_status status = *high > *low ? SKG_OK : skg_picture_range_get(&picture, low, high);
    if (status == SKG_OK && !(*high > *low)) *high = *low + 1; /* all pixels are equal */
    int exit_status = status == SKG_OK ? levels_json(study, dense, *low, *high, uri) : cli_fail(status);
    free(dense);
    return exit_status;
}

/* The differences: middle grey is none, black and white are the largest finite one of either sign, *range.
 * Levels between are cube roots, so that eight bits also resolve small differences; the page can undo them. */
static int difference_json(const cost_study *study, const float *difference, json_t **uri, double *range) {
    const int64_t places = study->thumb_columns * study->thumb_rows;
    float largest = 0, *roots = calloc((size_t)places, sizeof *roots);
    if (!roots) return cli_error(CLI_DEVICE, "out of host memory");
    for (int64_t i = 0; i < places; i++)
        if (isfinite(difference[i])) largest = fmaxf(largest, fabsf(difference[i]));
    for (int64_t i = 0; i < places && largest > 0; i++) roots[i] = cbrtf(difference[i] / largest);
    *range = (double)largest;
    int exit_status = levels_json(study, roots, -1, 1, uri);
    free(roots);
    return exit_status;
}

static int add_difference(const cost_study *study, const float *difference, json_t *object) {
    json_t *uri = NULL;
    double range = 0;
    const int exit_status = difference_json(study, difference, &uri, &range);
    if (exit_status != CLI_DONE) return exit_status;
    json_object_set_new(object, "difference", uri);
    json_object_set_new(object, "range", cli_json_number(range));
    return CLI_DONE;
}

/* Pictures are kept of the scene as it is, of what is worth changing to, and of the settings that the sliders reach. */
static int add_shot_pictures(const cost_study *study, json_t *shots) {
    int exit_status = CLI_DONE;
    double low = 0, high = 0;
    for (int i = 0; exit_status == CLI_DONE && i < study->measured.shot_count; i++) {
        const cost_shot *shot = &study->measured.shots[i];
        json_t *object = json_array_get(shots, (size_t)i), *uri = NULL;
        if (!shot->small || !(shot->on_frontier || i == study->measured.here || i == study->judged.buy ||
                              i == study->judged.saving))
            continue;
        exit_status = small_json(study, shot->small, &low, &high, &uri);
        if (exit_status != CLI_DONE) break;
        json_object_set_new(object, "image", uri);
        exit_status = add_difference(study, shot->difference, object);
    }
    return exit_status;
}

/* Adds the difference pictures of each dial at today's value. */
static int add_source_pictures(const cost_study *study, json_t *sources) {
    int exit_status = CLI_DONE;
    for (int i = 0; exit_status == CLI_DONE && i < COST_SOURCES; i++) {
        const cost_source *source = &study->judged.sources[i];
        const float *difference = source->state == COST_FINE ? study->measured.points[source->own].difference
                                                             : study->measured.coarse[i].difference;
        if (!difference || !(source->error > 0)) continue;
        exit_status = add_difference(study, difference, json_array_get(sources, (size_t)i));
    }
    return exit_status;
}

/* The page with the data instead of its mark. */
static char *fill_page(json_t *object) {
    static const char mark[] = "\"STUDY\"";
    const char *place = strstr(cost_page, mark);
    char *data = cli_json_for_page(object), *text = NULL;
    size_t size = 0;
    FILE *stream = data && place ? open_memstream(&text, &size) : NULL;
    if (stream) {
        fwrite(cost_page, 1, (size_t)(place - cost_page), stream);
        fputs(data, stream);
        fputs(place + sizeof mark - 1, stream);
        if (fclose(stream) != 0) {
            free(text);
            text = NULL;
        }
    }
    free(data);
    return text;
}

int cost_write_page(const cost_study *study, const char *path) {
    json_t *object = cost_json(study);
    int exit_status = add_shot_pictures(study, json_object_get(object, "settings"));
    if (exit_status == CLI_DONE) exit_status = add_source_pictures(study, json_object_get(object, "sources"));
    char *text = exit_status == CLI_DONE ? fill_page(object) : NULL;
    if (exit_status == CLI_DONE && !text) exit_status = cli_error(CLI_DEVICE, "out of host memory");
    if (exit_status == CLI_DONE) cli_made(path);
    if (exit_status == CLI_DONE) exit_status = cli_write_file(path, text, strlen(text));
    free(text);
    json_decref(object);
    return exit_status;
}
