/* Reads what a page asks for: one JSON object a message. */
#include "live/inside.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SETTINGS_MAX = 1000, KEY_MAX = 400 };
static const double LARGEST = 1e9; /* mm, and number of a projection */

static skg_status read_number(json_t *value, skg_live_message *message) {
    message->asked.number = json_integer_value(value);
    return json_is_integer(value) && message->asked.number >= 0 && message->asked.number <= UINT32_MAX
               ? SKG_OK
               : skg_fail(SKG_ERR_ARGUMENT, "\"wish\" is no number of a wish");
}

/* "KEY=VALUE" */
static skg_status write_word(const char *key, json_t *value, char **word) {
    char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(17));
    const size_t size = strlen(key) + (text ? strlen(text) : 0) + 2;
    const skg_status status = skg_alloc((int64_t)size, 1, "setting", word);
    if (status == SKG_OK) snprintf(*word, size, "%s=%s", key, text ? text : "");
    free(text); /* of Jansson */
    return status;
}

static skg_status read_settings(json_t *value, skg_live_message *message) {
    const char *key;
    json_t *setting;
    if (!json_is_object(value))
        return skg_fail(SKG_ERR_ARGUMENT, "\"settings\" is no object {\"KEY\": VALUE}");
    if (json_object_size(value) > SETTINGS_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "\"settings\" has more than %d keys", SETTINGS_MAX);
    SKG_TRY(
        skg_alloc((int64_t)json_object_size(value) + 1, sizeof *message->words, "settings", &message->words));
    json_object_foreach(value, key, setting) {
        if (!*key || strlen(key) > KEY_MAX || strchr(key, '='))
            return skg_fail(SKG_ERR_ARGUMENT, "\"settings\": %.40s is no key of a scene file", key);
        SKG_TRY(write_word(key, setting, message->words + message->asked.setting_count));
        message->asked.setting_count++;
    }
    message->settings = json_incref(value);
    return SKG_OK;
}

static int is_pose(json_t *value, double *pose) {
    static const double last[] = {0, 0, 0, 1};
    if (!json_is_array(value) || json_array_size(value) != 16) return 0;
    for (size_t i = 0; i < 16; i++) {
        pose[i] = json_number_value(json_array_get(value, i));
        if (!json_is_number(json_array_get(value, i)) || !isfinite(pose[i]) || fabs(pose[i]) > LARGEST)
            return 0;
        if (i >= 12 && pose[i] != last[i - 12]) return 0;
    }
    return 1;
}

static skg_status read_poses(json_t *value, skg_live_message *message) {
    const char *key;
    json_t *pose;
    int64_t *const count = &message->asked.pose_count;
    if (!json_is_object(value))
        return skg_fail(SKG_ERR_ARGUMENT, "\"poses\" is no object {\"PART\": [16 numbers]}");
    const int64_t most = (int64_t)json_object_size(value) + 1;
    SKG_TRY(skg_alloc(most, sizeof *message->parts, "poses", &message->parts));
    SKG_TRY(skg_alloc(16 * most, sizeof *message->poses, "poses", &message->poses));
    json_object_foreach(value, key, pose) {
        if (!skg_live_part_read(key, message->parts + *count))
            return skg_fail(SKG_ERR_ARGUMENT, "\"poses\": \"%.40s\" is no number of a part", key);
        if (!is_pose(pose, message->poses + 16 * (*count)++))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "\"poses\": part %s needs 16 numbers, row by row, the last row 0, 0, 0, 1", key);
    }
    message->moves = json_incref(value);
    return SKG_OK;
}

static skg_status read_quantity(json_t *value, skg_live_message *message) {
    const char *name = NULL, *given = json_string_value(value);
    for (int32_t i = 0; given && skg_quantity_get(i, &name, NULL) == SKG_OK; i++)
        if (strcmp(given, name) == 0) {
            message->asked.quantity = i;
            return SKG_OK;
        }
    return skg_fail(SKG_ERR_ARGUMENT,
                    "\"quantity\" is not energy, fluence, photons, transmission or attenuation");
}

static skg_status read_phase(json_t *value, skg_live_message *message) {
    if (json_is_null(value)) return SKG_OK;
    if (!json_is_number(value)) return skg_fail(SKG_ERR_ARGUMENT, "\"phase\" is no number");
    message->asked.phase = json_number_value(value);
    return message->asked.phase >= 0 && message->asked.phase < 1
               ? SKG_OK
               : skg_fail(SKG_ERR_ARGUMENT, "\"phase\" is not from 0 to below 1");
}

static skg_status read_projection(json_t *value, skg_live_message *message) {
    const double number = json_number_value(value);
    if (json_is_null(value)) return SKG_OK;
    if (!json_is_number(value)) return skg_fail(SKG_ERR_ARGUMENT, "\"projection\" is no number");
    if (!(number >= 0 && number <= LARGEST && number == floor(number)))
        return skg_fail(SKG_ERR_ARGUMENT, "\"projection\" is no whole number from 0 on");
    message->asked.projection = (int64_t)number;
    return SKG_OK;
}

/* Edges of bands in keV, rising; an empty list: no bands. The plan says what else is wrong with them. */
static skg_status read_bands(json_t *value, skg_live_message *message) {
    const size_t count = json_array_size(value);
    double *edges = message->band_kev;
    if (!json_is_array(value) || count == 1 || count > SKG_CHANNELS_MAX + 1)
        return skg_fail(SKG_ERR_ARGUMENT, "\"bands\" is no list of 2 to %d edges in keV",
                        SKG_CHANNELS_MAX + 1);
    for (size_t i = 0; i < count; i++) {
        edges[i] = json_number_value(json_array_get(value, i));
        if (!json_is_number(json_array_get(value, i)) || !(edges[i] >= 0) ||
            (i > 0 && !(edges[i] > edges[i - 1])))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "\"bands\": edge %zu is not an energy in keV above the one before it", i + 1);
    }
    message->asked.bands = count > 0 ? (int64_t)count - 1 : 0;
    return SKG_OK;
}

static skg_status read_channel(json_t *value, skg_live_message *message) {
    message->asked.channel = json_integer_value(value);
    return json_is_integer(value) && message->asked.channel >= 0 && message->asked.channel < SKG_CHANNELS_MAX
               ? SKG_OK
               : skg_fail(SKG_ERR_ARGUMENT, "\"channel\" is no number of a band");
}

static skg_status read_flag(const char *key, const json_t *value, int32_t *flag) {
    *flag = json_is_true(value);
    return json_is_boolean(value) ? SKG_OK
                                  : skg_fail(SKG_ERR_ARGUMENT, "\"%s\" is neither true nor false", key);
}

static skg_status read_drag(json_t *value, skg_live_message *message) {
    return read_flag("drag", value, &message->asked.drag);
}

static skg_status read_play(json_t *value, skg_live_message *message) {
    return read_flag("play", value, &message->asked.play);
}

/* The keys of a wish. */
static const struct {
    const char *key;
    skg_status (*read)(json_t *value, skg_live_message *message);
} rows[] = {{"wish", read_number}, {"settings", read_settings},     {"poses", read_poses},
            {"phase", read_phase}, {"projection", read_projection}, {"quantity", read_quantity},
            {"bands", read_bands}, {"channel", read_channel},       {"play", read_play},
            {"drag", read_drag}};
enum { ROWS = sizeof rows / sizeof *rows };

/* The wish with all of its keys but the last row. */
static skg_status write_state(skg_live_message *message) {
    const skg_live_asked *asked = &message->asked;
    const char *quantity = NULL;
    json_t *object = json_object();
    SKG_TRY(skg_quantity_get(asked->quantity, &quantity, NULL));
    json_object_set_new(object, "wish", json_integer(asked->number));
    json_object_set(object, "settings", message->settings);
    json_object_set(object, "poses", message->moves);
    json_object_set_new(object, "phase", skg_live_number(asked->phase));
    json_object_set_new(object, "projection",
                        asked->projection < 0 ? json_null() : json_integer(asked->projection));
    json_object_set_new(object, "quantity", json_string(quantity));
    json_object_set_new(object, "bands",
                        skg_live_numbers(message->band_kev, asked->bands > 0 ? asked->bands + 1 : 0));
    json_object_set_new(object, "channel", json_integer(asked->channel));
    json_object_set_new(object, "play", json_boolean(asked->play));
    char *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17));
    const skg_status status =
        text ? skg_copy_text(text, &message->text) : skg_fail(SKG_ERR_MEMORY, "out of host memory");
    free(text); /* of Jansson */
    json_decref(object);
    return status;
}

static skg_status read_wish(json_t *object, skg_live_message *message) {
    const char *key;
    json_t *value;
    message->asked.quantity = SKG_QUANTITY_ATTENUATION;
    json_object_foreach(object, key, value) {
        int row = 0;
        while (row < ROWS && strcmp(key, rows[row].key) != 0) row++;
        if (row == ROWS) return skg_fail(SKG_ERR_ARGUMENT, "a wish has no key \"%.40s\"", key);
        SKG_TRY(rows[row].read(value, message));
    }
    if (!message->settings) message->settings = json_object();
    if (!message->moves) message->moves = json_object();
    message->asked.settings = (const char *const *)message->words;
    message->asked.parts = message->parts;
    message->asked.poses = message->poses;
    message->asked.band_kev = message->band_kev;
    return write_state(message);
}

static skg_status read_probe(json_t *value, skg_live_message *message) {
    for (size_t k = 0; k < 2; k++) {
        json_t *number = json_array_get(value, k);
        message->asked.at[k] = json_number_value(number);
        if (!json_is_number(number) || !(fabs(message->asked.at[k]) <= 1e6) || json_array_size(value) != 2)
            return skg_fail(SKG_ERR_ARGUMENT, "\"probe\" is not [column, row]");
    }
    return SKG_OK;
}

static skg_status read_ack(json_t *value, skg_live_message *message) {
    message->asked.number = json_integer_value(value);
    return json_is_integer(value) ? SKG_OK : skg_fail(SKG_ERR_ARGUMENT, "\"ack\" is no number of a frame");
}

static skg_status read_take(json_t *value, skg_live_message *message) {
    const char *take = json_string_value(value);
    if (!take || (strcmp(take, "png") != 0 && strcmp(take, "tif") != 0 && strcmp(take, "mha") != 0))
        return skg_fail(SKG_ERR_ARGUMENT, "\"take\" is not png, tif or mha");
    snprintf(message->asked.take, sizeof message->asked.take, "%s", take);
    return SKG_OK;
}

static skg_status read_measure(json_t *value, skg_live_message *message) {
    (void)value, (void)message;
    return SKG_OK;
}

static skg_status read_look(json_t *value, skg_live_message *message) {
    return skg_live_look_read(value, message);
}

static skg_status read_register(json_t *value, skg_live_message *message) {
    skg_live_asked *asked = &message->asked;
    asked->stop = json_is_null(value);
    asked->number = asked->stop ? -1 : json_integer_value(value);
    return asked->stop || (json_is_integer(value) && asked->number >= 0)
               ? SKG_OK
               : skg_fail(SKG_ERR_ARGUMENT, "\"register\" is neither the number of a part nor null");
}

static skg_status read_reconstruct(json_t *value, skg_live_message *message) {
    static const char *const names[] = {"spectrum", "noise", "scatter", "motion"};
    skg_live_asked *asked = &message->asked;
    int32_t *const ours[] = {&asked->spectrum, &asked->noise, &asked->scatter, &asked->motion};
    json_t *at = json_object_get(value, "at");
    asked->stop = json_is_null(value);
    if (asked->stop) return SKG_OK;
    if (!json_is_object(value))
        return skg_fail(SKG_ERR_ARGUMENT, "\"reconstruct\" is neither {SWITCH: BOOLEAN} nor null");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        json_t *is_on = json_object_get(value, names[i]);
        if (!json_is_boolean(is_on))
            return skg_fail(SKG_ERR_ARGUMENT, "\"reconstruct\": \"%s\" is neither true nor false", names[i]);
        *ours[i] = json_is_true(is_on);
    }
    const char *key;
    json_t *unused;
    json_object_foreach(value, key, unused) {
        int is_known = strcmp(key, "at") == 0;
        for (size_t i = 0; i < sizeof names / sizeof *names; i++) is_known |= strcmp(key, names[i]) == 0;
        if (!is_known)
            return skg_fail(
                SKG_ERR_ARGUMENT,
                "\"reconstruct\" has no key \"%.40s\", but spectrum, noise, scatter, motion and at", key);
    }
    asked->at_mm = json_number_value(at);
    return (!at || json_is_number(at)) && fabs(asked->at_mm) <= 1e6
               ? SKG_OK
               : skg_fail(SKG_ERR_ARGUMENT, "\"reconstruct\": \"at\" is no number of mm");
}

/* The kinds of messages, by their numbers. */
static const struct {
    const char *key;
    skg_status (*read)(json_t *value, skg_live_message *message);
} kinds[] = {[SKG_LIVE_ASKED_WISH] = {"wish", NULL},
             [SKG_LIVE_ASKED_ACK] = {"ack", read_ack},
             [SKG_LIVE_ASKED_PROBE] = {"probe", read_probe},
             [SKG_LIVE_ASKED_TAKE] = {"take", read_take},
             [SKG_LIVE_ASKED_MEASURE] = {"measure", read_measure},
             [SKG_LIVE_ASKED_LOOK] = {"look", read_look},
             [SKG_LIVE_ASKED_REGISTER] = {"register", read_register},
             [SKG_LIVE_ASKED_RECONSTRUCT] = {"reconstruct", read_reconstruct}};

skg_status skg_live_read(json_t *object, skg_live_message *message) {
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        json_t *value = json_object_get(object, kinds[i].key);
        if (!value) continue;
        message->asked.kind = (int32_t)i;
        return kinds[i].read ? kinds[i].read(value, message) : read_wish(object, message);
    }
    return skg_fail(SKG_ERR_ARGUMENT,
                    "a message has the key wish, ack, probe, take, measure, look, register or reconstruct");
}
