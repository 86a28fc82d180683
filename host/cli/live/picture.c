/* The 3D view as the server draws it, for pages whose browser draws slowly. */
#include "live/picture.h"

#include "common/progress.h"
#include "common/say.h"
#include "live/frame.h"
#include "view/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int fail(char *sentence) {
    snprintf(sentence, LIVE_SENTENCE, "%s", skg_last_error());
    return 0;
}

/* What the arrays of a look point to. */
typedef struct {
    uint8_t *colours, *image, background[3];
    double *poses;
} arrays;

int live_picture_box(live_scene *scene, char *sentence) {
    view_places places = {0};
    skg_look look;
    if (scene->has_box) return 1;
    skg_look_init(&look);
    scene->has_box = view_find_places(&scene->session, &look, &places) == CLI_DONE;
    memcpy(scene->box, places.low, sizeof places.low);
    memcpy(scene->box + 3, places.high, sizeof places.high);
    free(places.parts);
    return scene->has_box ? 1 : fail(sentence);
}

/* The colours of the library, and those of the look. */
static int fill_colours(const live_scene *scene, const live_look *asked, uint8_t *colours) {
    const char *key;
    json_t *colour;
    if (skg_look_colours_get(scene->session.scene, colours) != SKG_OK) return 0;
    json_object_foreach(asked->colours, key, colour) {
        const int64_t part = strtoll(key, NULL, 10);
        for (size_t k = 0; part < scene->parts && k < 4; k++)
            colours[4 * part + (int64_t)k] = (uint8_t)lround(json_number_value(json_array_get(colour, k)));
    }
    return 1;
}

/* The last frame in the greys of the page. */
static void fill_image(const live_scene *scene, const live_look *asked, uint8_t *image) {
    const double scale = asked->grey[1] != asked->grey[0] ? 255 / (asked->grey[1] - asked->grey[0]) : 0;
    const double flat = scene->shown_flat;
    const float *values = scene->values + scene->shown_channel * scene->shown.columns * scene->shown.rows;
    for (int64_t i = 0; i < scene->shown.columns * scene->shown.rows; i++) {
        const double value = (double)values[i], shown = flat > 0 ? -log(value / flat) : value;
        const double grey = (shown - asked->grey[0]) * scale;
        image[i] = (uint8_t)(grey > 0 ? grey < 255 ? grey + 0.5 : 255 : 0);
    }
}

static int fill(live_scene *scene, const live_wish *wish, const live_look *asked, skg_look *look, arrays *of,
                char *sentence) {
    const size_t parts = (size_t)scene->parts + 1;
    of->colours = malloc(4 * parts);
    of->poses = malloc(16 * parts * sizeof *of->poses);
    of->image = scene->is_shown ? malloc((size_t)(scene->shown.columns * scene->shown.rows)) : NULL;
    if (!of->colours || !of->poses || (scene->is_shown && !of->image)) {
        snprintf(sentence, LIVE_SENTENCE, "out of host memory for the 3D view");
        return 0;
    }
    if (!live_picture_box(scene, sentence)) return 0;
    if (!fill_colours(scene, asked, of->colours)) return fail(sentence);
    if (!live_frame_poses(scene, wish, of->poses, sentence)) return 0;
    if (of->image) fill_image(scene, asked, of->image);
    for (int k = 0; k < 3; k++) of->background[k] = (uint8_t)lround(asked->background[k]);
    skg_look_init(look);
    look->columns = asked->columns, look->rows = asked->rows;
    look->orthographic = asked->is_parallel;
    memcpy(look->from, asked->from, sizeof look->from);
    memcpy(look->up, asked->up, sizeof look->up);
    look->target = asked->target;
    look->distance = asked->distance;
    look->cut = asked->has_cut ? asked->cut : NULL;
    look->bounds = scene->box;
    look->colours = of->colours, look->poses = of->poses, look->background = of->background;
    look->image = of->image;
    look->collimation = scene->session.options.collimation;
    return 1;
}

int live_picture_make(live_scene *scene, const live_wish *wish, const live_look *asked, unsigned char **bytes,
                      size_t *size, char *sentence) {
    const double start = cli_now_ms();
    const skg_view *view = scene->is_shown ? &scene->shown : &scene->session.view;
    live_picture_header header = {.mark = {'S', 'K', 'L', 'P'}, .number = (uint32_t)asked->number};
    skg_look look;
    arrays of = {0};
    *size = sizeof header + (size_t)(4 * asked->columns * asked->rows);
    *bytes = malloc(*size);
    if (!*bytes) {
        snprintf(sentence, LIVE_SENTENCE, "out of host memory for the 3D view");
        return 0;
    }
    int is_made = fill(scene, wish, asked, &look, &of, sentence);
    if (is_made && skg_scene_picture(scene->session.context, scene->session.scene, view, &look,
                                     *bytes + sizeof header) != SKG_OK)
        is_made = fail(sentence);
    if (is_made) {
        header.columns = (uint16_t)asked->columns, header.rows = (uint16_t)asked->rows;
    } else {
        *size = sizeof header;
    }
    header.ms = (float)(cli_now_ms() - start);
    memcpy(*bytes, &header, sizeof header);
    free(of.colours);
    free(of.poses);
    free(of.image);
    return is_made;
}
