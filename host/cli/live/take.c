/* Saves what a page shows: scene, picture, values. */
#include "live/ask.h"

#include "live/frame.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The share of the pixels that a .png shows as black, and that it shows as white: those of `image`. */
static const double OUTSIDE = 0.005;

static int fail(char *sentence) {
    snprintf(sentence, LIVE_SENTENCE, "%s", skg_last_error());
    return 0;
}

/* Puts the name and the bytes of a file into one message. */
static int encode(const skg_picture *picture, const char *format, unsigned char **bytes, size_t *size,
                  char *sentence) {
    char name[32];
    int64_t whole = 0;
    const uint32_t length = (uint32_t)snprintf(name, sizeof name, "image.%s", format);
    const size_t head = 8 + length;
    if (skg_picture_encode(picture, name, NULL, 0, &whole) != SKG_OK) return fail(sentence);
    *size = head + (size_t)whole;
    *bytes = malloc(*size);
    if (!*bytes) {
        snprintf(sentence, LIVE_SENTENCE, "%s: out of host memory", name);
        return 0;
    }
    memcpy(*bytes, "SKLB", 4);
    memcpy(*bytes + 4, &length, 4);
    memcpy(*bytes + 8, name, length);
    return skg_picture_encode(picture, name, *bytes + head, whole, &whole) == SKG_OK || fail(sentence);
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
