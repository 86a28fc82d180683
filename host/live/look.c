/* Reads how a page looks at the scene. */
#include "live/inside.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_MAX = 4096, PIXELS_MAX = 1 << 23 };

/* The keys whose values are numbers. */
static const struct {
    const char *key;
    size_t at; /* in skg_live_eye */
    int count;
    double low, high;
} rows[] = {{"size", 0, 2, 1, SIDE_MAX},
            {"target", offsetof(skg_live_eye, target), 3, -1e9, 1e9},
            {"distance", offsetof(skg_live_eye, distance), 1, 1e-9, 1e9},
            {"from", offsetof(skg_live_eye, from), 3, -1e9, 1e9},
            {"up", offsetof(skg_live_eye, up), 3, -1e9, 1e9},
            {"grey", offsetof(skg_live_eye, grey), 2, -1e30, 1e30},
            {"cut", offsetof(skg_live_eye, cut), 4, -1e9, 1e9},
            {"background", offsetof(skg_live_eye, background), 3, 0, 255}};
enum { ROWS = sizeof rows / sizeof *rows, NEEDED = 5 };

static skg_status refuse(const char *key) {
    return skg_fail(SKG_ERR_ARGUMENT, "\"look\": \"%.40s\" is missing, unknown or out of range", key);
}

int skg_live_part_read(const char *key, int64_t *part) {
    if (!*key || strlen(key) > 9 || key[strspn(key, "0123456789")]) return 0;
    *part = strtoll(key, NULL, 10);
    return 1;
}

static int is_list(const json_t *value, int count, double low, double high, double *numbers) {
    if (count == 1) {
        *numbers = json_number_value(value);
        return json_is_number(value) && *numbers >= low && *numbers <= high;
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
    int64_t part;
    if (!json_is_object(value)) return 0;
    json_object_foreach(value, key, colour) {
        if (!skg_live_part_read(key, &part) || !is_list(colour, 4, 0, 255, numbers)) return 0;
    }
    return 1;
}

static int is_number(const json_t *value, int64_t *number) {
    *number = json_integer_value(value);
    return json_is_integer(value) && *number >= 0 && *number <= UINT32_MAX;
}

/* Whether the value is one of the key. */
static int read_key(const char *key, json_t *value, skg_live_message *message) {
    skg_live_eye *eye = &message->eye;
    double size[2];
    if (strcmp(key, "number") == 0) return is_number(value, &message->asked.number);
    if (strcmp(key, "parallel") == 0) {
        eye->is_parallel = json_is_true(value);
        return json_is_boolean(value);
    }
    if (strcmp(key, "parts") == 0) {
        eye->colours = json_incref(value);
        return is_colours(value);
    }
    for (int i = 0; i < ROWS; i++) {
        if (strcmp(key, rows[i].key) != 0) continue;
        double *to = i == 0 ? size : (double *)(void *)((char *)eye + rows[i].at);
        if (!is_list(value, rows[i].count, rows[i].low, rows[i].high, to)) return 0;
        if (i == 0) eye->columns = (int64_t)size[0], eye->rows = (int64_t)size[1];
        if (strcmp(key, "cut") == 0) eye->has_cut = 1;
        return eye->columns * eye->rows <= PIXELS_MAX;
    }
    return 0;
}

skg_status skg_live_look_read(const json_t *object, skg_live_message *message) {
    static const double background[] = {244, 245, 247};
    const char *key;
    json_t *value;
    memcpy(message->eye.background, background, sizeof background);
    for (int i = 0; i < NEEDED; i++)
        if (!json_object_get(object, rows[i].key)) return refuse(rows[i].key);
    /* the loop of jansson takes no const object */
    json_object_foreach((json_t *)(uintptr_t)object, key, value) {
        if (!read_key(key, value, message)) return refuse(key);
    }
    return SKG_OK;
}
