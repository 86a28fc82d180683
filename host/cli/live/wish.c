/* What a page asks for: one JSON object a message. */
#include "live/wish.h"

#include "common/encode.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { SETTINGS_MAX = 1000, KEY_MAX = 400, DEPTH_MAX = 40 };
static const char *const quantities[] = {[SKG_QUANTITY_ENERGY] = "energy",
                                         [SKG_QUANTITY_FLUENCE] = "fluence",
                                         [SKG_QUANTITY_PHOTONS] = "photons",
                                         [SKG_QUANTITY_TRANSMISSION] = "transmission",
                                         [SKG_QUANTITY_ATTENUATION] = "attenuation"};
enum { QUANTITIES = sizeof quantities / sizeof *quantities };

static int refuse(char *sentence, const char *format, ...) __attribute__((format(printf, 2, 3)));

static int refuse(char *sentence, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, LIVE_SENTENCE, format, arguments);
    va_end(arguments);
    return 0;
}

void live_wish_init(live_wish *wish) {
    *wish = (live_wish){.settings = json_object(),
                        .poses = json_object(),
                        .phase = (double)NAN,
                        .projection = -1,
                        .quantity = SKG_QUANTITY_ATTENUATION};
}

void live_wish_free(live_wish *wish) {
    json_decref(wish->settings);
    json_decref(wish->poses);
    *wish = (live_wish){0};
}

live_wish live_wish_copy(const live_wish *wish) {
    live_wish copy = *wish;
    copy.settings = json_deep_copy(wish->settings);
    copy.poses = json_deep_copy(wish->poses);
    return copy;
}

json_t *live_wish_json(const live_wish *wish) {
    json_t *object = json_object();
    json_object_set_new(object, "wish", json_integer(wish->number));
    json_object_set_new(object, "settings", json_deep_copy(wish->settings));
    json_object_set_new(object, "poses", json_deep_copy(wish->poses));
    json_object_set_new(object, "phase", cli_json_number(wish->phase));
    json_object_set_new(object, "projection",
                        wish->projection < 0 ? json_null() : json_integer(wish->projection));
    json_object_set_new(object, "quantity", json_string(quantities[wish->quantity]));
    json_object_set_new(object, "bands",
                        cli_json_numbers(wish->band_kev, wish->bands > 0 ? (int)wish->bands + 1 : 0));
    json_object_set_new(object, "channel", json_integer(wish->channel));
    json_object_set_new(object, "play", json_boolean(wish->plays));
    return object;
}

static int read_settings(json_t *value, live_wish *wish, char *sentence) {
    const char *key;
    json_t *setting;
    if (!json_is_object(value)) return refuse(sentence, "\"settings\" is no object {\"KEY\": VALUE}");
    if (json_object_size(value) > SETTINGS_MAX)
        return refuse(sentence, "\"settings\" has more than %d keys", SETTINGS_MAX);
    json_object_foreach(value, key, setting) {
        if (!*key || strlen(key) > KEY_MAX || strchr(key, '='))
            return refuse(sentence, "\"settings\": %.40s is no key of a scene file", key);
    }
    json_decref(wish->settings);
    wish->settings = json_deep_copy(value);
    return 1;
}

static int is_pose(json_t *value) {
    static const double last[] = {0, 0, 0, 1};
    if (!json_is_array(value) || json_array_size(value) != 16) return 0;
    for (size_t i = 0; i < 16; i++) {
        const double number = json_number_value(json_array_get(value, i));
        if (!json_is_number(json_array_get(value, i)) || !isfinite(number) || fabs(number) > 1e9) return 0;
        if (i >= 12 && number != last[i - 12]) return 0;
    }
    return 1;
}

static int read_poses(json_t *value, live_wish *wish, char *sentence) {
    const char *key;
    json_t *pose;
    if (!json_is_object(value)) return refuse(sentence, "\"poses\" is no object {\"PART\": [16 numbers]}");
    json_object_foreach(value, key, pose) {
        if (!*key || strlen(key) > 9 || key[strspn(key, "0123456789")])
            return refuse(sentence, "\"poses\": \"%.40s\" is no number of a part", key);
        if (!is_pose(pose))
            return refuse(sentence,
                          "\"poses\": part %s needs 16 numbers, row by row, the last row 0, 0, 0, 1", key);
    }
    json_decref(wish->poses);
    wish->poses = json_deep_copy(value);
    return 1;
}

static int read_quantity(json_t *value, live_wish *wish, char *sentence) {
    for (int i = 0; json_is_string(value) && i < QUANTITIES; i++)
        if (strcmp(json_string_value(value), quantities[i]) == 0) {
            wish->quantity = i;
            return 1;
        }
    return refuse(sentence, "\"quantity\" is not energy, fluence, photons, transmission or attenuation");
}

static int read_numbers(const char *key, json_t *value, live_wish *wish, char *sentence) {
    if (json_is_null(value)) return 1;
    if (!json_is_number(value)) return refuse(sentence, "\"%s\" is no number", key);
    const double number = json_number_value(value);
    if (strcmp(key, "phase") == 0) {
        if (!(number >= 0 && number < 1)) return refuse(sentence, "\"phase\" is not from 0 to below 1");
        wish->phase = number;
    } else {
        if (!(number >= 0 && number <= 1e9 && number == floor(number)))
            return refuse(sentence, "\"projection\" is no whole number from 0 on");
        wish->projection = (int64_t)number;
    }
    return 1;
}

/* Edges of bands in keV, rising; an empty list: no bands. The plan says what else is wrong with them. */
static int read_bands(json_t *value, live_wish *wish, char *sentence) {
    const size_t count = json_array_size(value);
    if (!json_is_array(value) || count == 1 || count > SKG_CHANNELS_MAX + 1)
        return refuse(sentence, "\"bands\" is no list of 2 to %d edges in keV", SKG_CHANNELS_MAX + 1);
    for (size_t i = 0; i < count; i++) {
        wish->band_kev[i] = json_number_value(json_array_get(value, i));
        if (!json_is_number(json_array_get(value, i)) || !(wish->band_kev[i] >= 0) ||
            (i > 0 && !(wish->band_kev[i] > wish->band_kev[i - 1])))
            return refuse(sentence, "\"bands\": edge %zu is not an energy in keV above the one before it",
                          i + 1);
    }
    wish->bands = count > 0 ? (int64_t)count - 1 : 0;
    return 1;
}

/* One key of a wish. */
static int read_key(const char *key, json_t *value, live_wish *wish, char *sentence) {
    if (strcmp(key, "wish") == 0) {
        wish->number = json_integer_value(value);
        return json_is_integer(value) && wish->number >= 0 && wish->number <= UINT32_MAX
                   ? 1
                   : refuse(sentence, "\"wish\" is no number of a wish");
    }
    if (strcmp(key, "settings") == 0) return read_settings(value, wish, sentence);
    if (strcmp(key, "poses") == 0) return read_poses(value, wish, sentence);
    if (strcmp(key, "quantity") == 0) return read_quantity(value, wish, sentence);
    if (strcmp(key, "phase") == 0 || strcmp(key, "projection") == 0)
        return read_numbers(key, value, wish, sentence);
    if (strcmp(key, "bands") == 0) return read_bands(value, wish, sentence);
    if (strcmp(key, "channel") == 0) {
        wish->channel = json_integer_value(value);
        return json_is_integer(value) && wish->channel >= 0 && wish->channel < SKG_CHANNELS_MAX
                   ? 1
                   : refuse(sentence, "\"channel\" is no number of a band");
    }
    if (strcmp(key, "drag") == 0) {
        wish->dragging = json_is_true(value);
        return json_is_boolean(value) ? 1 : refuse(sentence, "\"drag\" is neither true nor false");
    }
    if (strcmp(key, "play") == 0) {
        wish->plays = json_is_true(value);
        return json_is_boolean(value) ? 1 : refuse(sentence, "\"play\" is neither true nor false");
    }
    return refuse(sentence, "a wish has no key \"%.40s\"", key);
}

static int read_wish(json_t *object, live_wish *wish, char *sentence) {
    const char *key;
    json_t *value;
    live_wish_init(wish);
    json_object_foreach(object, key, value) if (!read_key(key, value, wish, sentence)) {
        live_wish_free(wish);
        return 0;
    }
    return 1;
}

static int read_probe(json_t *value, live_message *message, char *sentence) {
    for (size_t k = 0; k < 2; k++) {
        json_t *number = json_array_get(value, k);
        message->probe[k] = json_number_value(number);
        if (!json_is_number(number) || !(fabs(message->probe[k]) <= 1e6) || json_array_size(value) != 2)
            return refuse(sentence, "\"probe\" is not [column, row]");
    }
    return 1;
}

static int read_switches(json_t *value, live_switches *switches, char *sentence) {
    static const char *const names[] = {"spectrum", "noise", "scatter", "motion"};
    int *const ours[] = {&switches->has_spectrum, &switches->has_noise, &switches->has_scatter,
                         &switches->has_motion};
    json_t *at = json_object_get(value, "at");
    switches->is_stop = json_is_null(value);
    if (switches->is_stop) return 1;
    if (!json_is_object(value))
        return refuse(sentence, "\"reconstruct\" is neither {SWITCH: BOOLEAN} nor null");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        json_t *is_on = json_object_get(value, names[i]);
        if (!json_is_boolean(is_on))
            return refuse(sentence, "\"reconstruct\": \"%s\" is neither true nor false", names[i]);
        *ours[i] = json_is_true(is_on);
    }
    switches->at_mm = json_number_value(at);
    return (!at || json_is_number(at)) && fabs(switches->at_mm) <= 1e6
               ? 1
               : refuse(sentence, "\"reconstruct\": \"at\" is no number of mm");
}

static int read_object(json_t *object, live_message *message, char *sentence) {
    static const char *const names[] = {"wish",    "ack",  "probe",    "take",
                                        "measure", "look", "register", "reconstruct"};
    json_t *value = NULL;
    for (message->kind = 0; message->kind < LIVE_KINDS; message->kind++)
        if ((value = json_object_get(object, names[message->kind]))) break;
    if (!value)
        return refuse(sentence,
                      "a message has the key wish, ack, probe, take, measure, look, register or reconstruct");
    if (message->kind == LIVE_WISH) return read_wish(object, &message->wish, sentence);
    if (message->kind == LIVE_PROBE) return read_probe(value, message, sentence);
    if (message->kind == LIVE_ACK) {
        message->ack = json_integer_value(value);
        return json_is_integer(value) ? 1 : refuse(sentence, "\"ack\" is no number of a frame");
    }
    if (message->kind == LIVE_MEASURE) return 1;
    if (message->kind == LIVE_LOOK) return live_look_read(value, &message->look, sentence);
    if (message->kind == LIVE_RECONSTRUCT) return read_switches(value, &message->switches, sentence);
    if (message->kind == LIVE_REGISTER) {
        message->part = json_is_null(value) ? -1 : json_integer_value(value);
        return json_is_null(value) || (json_is_integer(value) && message->part >= 0)
                   ? 1
                   : refuse(sentence, "\"register\" is neither the number of a part nor null");
    }
    const char *take = json_string_value(value);
    if (!take || (strcmp(take, "png") != 0 && strcmp(take, "tif") != 0 && strcmp(take, "mha") != 0))
        return refuse(sentence, "\"take\" is not png, tif or mha");
    snprintf(message->take, sizeof message->take, "%s", take);
    return 1;
}

/* How deep arrays and objects are nested. The parser calls itself for each, and threads of the server have a small stack. */
static int depth_of(const char *text, size_t length) {
    int depth = 0, deepest = 0, is_text = 0;
    for (size_t i = 0; i < length; i++) {
        if (is_text && text[i] == '\\')
            i++;
        else if (text[i] == '"')
            is_text = !is_text;
        else if (!is_text && (text[i] == '[' || text[i] == '{'))
            deepest = ++depth > deepest ? depth : deepest;
        else if (!is_text && (text[i] == ']' || text[i] == '}'))
            depth--;
    }
    return deepest;
}

int live_message_read(const char *text, size_t length, live_message *message, char sentence[LIVE_SENTENCE]) {
    json_error_t error;
    *message = (live_message){0};
    if (depth_of(text, length) > DEPTH_MAX)
        return refuse(sentence, "a message is nested more than %d deep", DEPTH_MAX);
    json_t *object = json_loadb(text, length, JSON_REJECT_DUPLICATES, &error);
    if (!object) return refuse(sentence, "a message is no JSON: %.150s", error.text);
    const int is_read = json_is_object(object) ? read_object(object, message, sentence)
                                               : refuse(sentence, "a message is no JSON object");
    json_decref(object);
    return is_read;
}
