/* How a page looks at the scene: the eye, and what differs from `skiagraph view`. */
#include "live/look.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

enum { SIDE_MAX = 4096, PIXELS_MAX = 1 << 23 };

/* The keys whose values are numbers. */
static const struct {
    const char *key;
    size_t at; /* in live_look */
    int count;
    double low, high;
} rows[] = {{"size", 0, 2, 1, SIDE_MAX},
            {"target", offsetof(live_look, target), 3, -1e9, 1e9},
            {"distance", offsetof(live_look, distance), 1, 1e-9, 1e9},
            {"from", offsetof(live_look, from), 3, -1e9, 1e9},
            {"up", offsetof(live_look, up), 3, -1e9, 1e9},
            {"grey", offsetof(live_look, grey), 2, -1e30, 1e30},
            {"cut", offsetof(live_look, cut), 4, -1e9, 1e9},
            {"background", offsetof(live_look, background), 3, 0, 255}};
enum { ROWS = sizeof rows / sizeof *rows, NEEDED = 5 };

static int refuse(const char *key, char *sentence) {
    snprintf(sentence, LIVE_SENTENCE, "\"look\": \"%.40s\" is missing, unknown or out of range", key);
    return 0;
}

static int is_list(const json_t *value, int count, double low, double high, double *numbers) {
    if (json_is_number(value) && count == 1) {
        *numbers = json_number_value(value);
        return *numbers >= low && *numbers <= high;
    }
    if (!json_is_array(value) || json_array_size(value) != (size_t)count) return 0;
    for (int k = 0; k < count; k++) {
        const json_t *number = json_array_get(value, (size_t)k);
        numbers[k] = json_number_value(number);
        if (!json_is_number(number) || !(numbers[k] >= low && numbers[k] <= high)) return 0;
    }
    return 1;
}

/* {"PART": [red, green, blue, opacity]} */
static int is_colours(json_t *value) {
    const char *key;
    json_t *colour;
    double numbers[4];
    if (!json_is_object(value)) return 0;
    json_object_foreach(value, key, colour) {
        if (!*key || strlen(key) > 9 || key[strspn(key, "0123456789")]) return 0;
        if (!is_list(colour, 4, 0, 255, numbers)) return 0;
    }
    return 1;
}

static int read_key(const char *key, json_t *value, live_look *look, char *sentence) {
    double size[2];
    if (strcmp(key, "number") == 0) {
        look->number = json_integer_value(value);
        return json_is_integer(value) && look->number >= 0 && look->number <= UINT32_MAX
                   ? 1
                   : refuse(key, sentence);
    }
    if (strcmp(key, "parallel") == 0) {
        look->is_parallel = json_is_true(value);
        return json_is_boolean(value) ? 1 : refuse(key, sentence);
    }
    if (strcmp(key, "parts") == 0) {
        look->colours = value;
        return is_colours(value) ? 1 : refuse(key, sentence);
    }
    for (int i = 0; i < ROWS; i++) {
        if (strcmp(key, rows[i].key) != 0) continue;
        double *to = i == 0 ? size : (double *)(void *)((char *)look + rows[i].at);
        if (!is_list(value, rows[i].count, rows[i].low, rows[i].high, to)) break;
        if (i == 0) look->columns = (int64_t)size[0], look->rows = (int64_t)size[1];
        if (strcmp(key, "cut") == 0) look->has_cut = 1;
        return look->columns * look->rows <= PIXELS_MAX ? 1 : refuse(key, sentence);
    }
    return refuse(key, sentence);
}

int live_look_read(const json_t *object, live_look *look, char sentence[LIVE_SENTENCE]) {
    const char *key;
    json_t *value;
    *look = (live_look){.background = {244, 245, 247}, .grey = {0, 0}};
    for (int i = 0; i < NEEDED; i++)
        if (!json_object_get(object, rows[i].key)) return refuse(rows[i].key, sentence);
    /* the loop of jansson takes no const object */
    json_object_foreach((json_t *)(uintptr_t)object, key,
                        value) if (!read_key(key, value, look, sentence)) return 0;
    look->colours = json_incref(look->colours);
    return 1;
}

void live_look_free(live_look *look) {
    json_decref(look->colours);
    look->colours = NULL;
}
