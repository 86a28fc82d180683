/* Messages of pages: handles, and what differs between two wishes. */
#include "live/inside.h"

#include "core/text.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>
#include <strings.h>

/* Levels of arrays and objects in a message. The parser calls itself for each, and threads of a server have a small stack. */
enum { DEPTH_MAX = 40 };

/* Keys that frames can follow without another plan: they move source and detector. */
static const char *const moving[] = {"Source.Position",      "Detector.Position",   "Detector.UpVector",
                                     "Detector.RightVector", "Detector.ColumnStep", "Detector.RowStep"};

void skg_live_asked_init_sized(void *asked, int32_t size) {
    const skg_live_asked defaults = {.phase = (double)NAN, .projection = -1};
    skg_struct_init(asked, size, &defaults, sizeof defaults);
}

static int depth_of(const char *text, int64_t length) {
    int depth = 0, deepest = 0, is_text = 0;
    for (int64_t i = 0; i < length; i++) {
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

static skg_status parse(const char *text, int64_t length, json_t **object) {
    json_error_t error;
    if (depth_of(text, length) > DEPTH_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "a message is nested more than %d deep", DEPTH_MAX);
    *object = json_loadb(text, (size_t)length, JSON_REJECT_DUPLICATES, &error);
    if (!*object) return skg_fail(SKG_ERR_ARGUMENT, "a message is no JSON: %.150s", error.text);
    if (json_is_object(*object)) return SKG_OK;
    json_decref(*object);
    *object = NULL;
    return skg_fail(SKG_ERR_ARGUMENT, "a message is no JSON object");
}

/* Releases the object. */
static skg_status create(json_t *object, skg_live_message **message) {
    skg_live_message *made = NULL;
    skg_status status = skg_alloc(1, sizeof *made, "message", &made);
    if (status == SKG_OK) {
        skg_refs_init(&made->refs);
        skg_live_asked_init(&made->asked);
        status = skg_live_read(object, made);
    }
    json_decref(object);
    if (status != SKG_OK) skg_live_message_release(&made);
    *message = made;
    return status;
}

skg_status skg_live_message_create(const char *text, int64_t length, skg_live_message **message) {
    SKG_PLAIN;
    json_t *object = NULL;
    SKG_NEEDS(text);
    SKG_NEEDS(message);
    *message = NULL;
    SKG_TRY(parse(text, length, &object));
    return create(object, message);
}

static skg_status need_wish(const skg_live_message *wish) {
    if (wish && wish->asked.kind == SKG_LIVE_ASKED_WISH) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "live: the message is no wish");
}

json_t *skg_live_state(const skg_live_message *wish) {
    return json_loads(wish->text, 0, NULL);
}

skg_status skg_live_message_change(const skg_live_message *wish, const char *changes,
                                   skg_live_message **changed) {
    SKG_PLAIN;
    json_t *others = NULL;
    SKG_NEEDS(changes);
    SKG_NEEDS(changed);
    *changed = NULL;
    SKG_TRY(need_wish(wish));
    SKG_TRY(parse(changes, (int64_t)strlen(changes), &others));
    json_t *object = skg_live_state(wish);
    json_object_set_new(object, "drag", json_boolean(wish->asked.drag));
    json_object_update(object, others);
    json_decref(others);
    return create(object, changed);
}

skg_status skg_live_message_retain(skg_live_message *message) {
    SKG_NEEDS(message);
    skg_ref(&message->refs);
    return SKG_OK;
}

void skg_live_message_release(skg_live_message **message) {
    if (!message || !*message) return;
    skg_live_message *its = *message;
    *message = NULL;
    if (!skg_unref(&its->refs)) return;
    for (int64_t i = 0; its->words && i < its->asked.setting_count; i++) skg_free(its->words + i);
    skg_free(&its->words);
    skg_free(&its->parts);
    skg_free(&its->poses);
    skg_free(&its->text);
    json_decref(its->settings);
    json_decref(its->moves);
    json_decref(its->eye.colours);
    skg_free(&its);
}

skg_status skg_live_message_get(const skg_live_message *message, skg_live_asked *asked) {
    SKG_NEEDS(message);
    return skg_struct_write(&message->asked, sizeof message->asked, "skg_live_asked", asked);
}

skg_status skg_live_message_text_get(const skg_live_message *wish, const char **text) {
    SKG_NEEDS(text);
    *text = NULL;
    SKG_TRY(need_wish(wish));
    *text = wish->text;
    return SKG_OK;
}

static int is_moving(const char *key) {
    for (size_t i = 0; i < sizeof moving / sizeof *moving; i++)
        if (strcasecmp(key, moving[i]) == 0) return 1;
    return 0;
}

/* Marks what a has and b has not, or otherwise. */
static void compare(json_t *a, json_t *b, int32_t *moved, int32_t *other) {
    const char *key;
    json_t *value;
    json_object_foreach(a, key, value) {
        if (!json_equal(value, json_object_get(b, key))) *(is_moving(key) ? moved : other) = 1;
    }
}

skg_status skg_live_wish_compare(const skg_live_message *a, const skg_live_message *b, int32_t *moved,
                                 int32_t *other) {
    SKG_NEEDS(moved);
    SKG_NEEDS(other);
    SKG_TRY(need_wish(a));
    SKG_TRY(need_wish(b));
    *moved = 0;
    *other = a->asked.quantity != b->asked.quantity || a->asked.bands != b->asked.bands ||
             memcmp(a->band_kev, b->band_kev, sizeof a->band_kev) != 0;
    compare(a->settings, b->settings, moved, other);
    compare(b->settings, a->settings, moved, other);
    return SKG_OK;
}
