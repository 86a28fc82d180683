/* Saves what a page shows: scene, picture, values. */
#include "live/ask.h"

#include "live/frame.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The share of the pixels that a .png shows as black, and that it shows as white: those of `image`. */
static const double OUTSIDE = 0.005;

static int fail(char *sentence) {
    snprintf(sentence, LIVE_SENTENCE, "%s", skg_last_error());
    return 0;
}

/* Puts name and bytes of a file into one message. */
static int wrap(const char *name, FILE *file, unsigned char **bytes, size_t *size) {
    const uint32_t length = (uint32_t)strlen(name);
    if (fseek(file, 0, SEEK_END) != 0) return 0;
    const long whole = ftell(file);
    if (whole < 0 || fseek(file, 0, SEEK_SET) != 0) return 0;
    *size = 8 + length + (size_t)whole;
    *bytes = malloc(*size);
    if (!*bytes) return 0;
    memcpy(*bytes, "SKLB", 4);
    memcpy(*bytes + 4, &length, 4);
    memcpy(*bytes + 8, name, length);
    return fread(*bytes + 8 + length, 1, (size_t)whole, file) == (size_t)whole;
}

/* Writes the picture into a folder of its own and reads it back, because only files have these formats. */
static int encode(const skg_picture *picture, const char *format, unsigned char **bytes, size_t *size,
                  char *sentence) {
    char folder[] = "/tmp/skiagraph-live-XXXXXX", path[64], name[32];
    if (!mkdtemp(folder)) {
        snprintf(sentence, LIVE_SENTENCE, "/tmp: no folder can be made for the file");
        return 0;
    }
    snprintf(name, sizeof name, "image.%s", format);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    int is_made = skg_picture_save(picture, path) == SKG_OK;
    if (!is_made) fail(sentence);
    FILE *file = is_made ? fopen(path, "rb") : NULL;
    if (is_made && !(file && wrap(name, file, bytes, size))) {
        snprintf(sentence, LIVE_SENTENCE, "%s: cannot be read back", path);
        is_made = 0;
    }
    if (file) fclose(file);
    unlink(path);
    rmdir(folder);
    return is_made;
}

int live_take(const live_base *base, const live_wish *wish, const char *format, unsigned char **bytes,
              size_t *size, char *sentence) {
    live_wish energy = *wish; /* what `image` shows unless it is asked for something else */
    live_scene scene;
    skg_output output;
    skg_picture picture;
    skg_view view;
    int dropped, is_outside;
    *bytes = NULL;
    energy.quantity = SKG_QUANTITY_ENERGY;
    int is_made = live_scene_make(base, &energy, &scene, sentence) &&
                  live_frame_pose(&scene, &energy, sentence) &&
                  live_scene_view(base, &scene, &energy, &view, sentence);
    skg_output_init(&output);
    output.data = scene.values;
    is_made = is_made && live_frame_render(&scene, &energy, scene.plan, &view, NULL, &output, 1, &dropped,
                                           &is_outside, sentence);
    skg_picture_init(&picture);
    picture.data = scene.values;
    picture.columns = view.columns, picture.rows = view.rows;
    picture.view = &view;
    picture.name = scene.channel.name, picture.unit = scene.channel.unit;
    picture.flat_field = scene.channel.flat_field;
    const char *names[SKG_CHANNELS_MAX];
    skg_channel channels[SKG_CHANNELS_MAX];
    for (int64_t c = 0; is_made && c < scene.channels; c++) {
        skg_channel_init(channels + c);
        if (skg_plan_channel_get(scene.plan, c, channels + c) != SKG_OK) is_made = fail(sentence);
        names[c] = channels[c].name;
    }
    picture.channels = is_made ? scene.channels : 1;
    picture.channel_names = names;
    if (is_made && skg_picture_window_get(&picture, OUTSIDE, OUTSIDE, &picture.low, &picture.high) != SKG_OK)
        is_made = fail(sentence);
    is_made = is_made && encode(&picture, format, bytes, size, sentence);
    live_scene_free(&scene);
    return is_made;
}
