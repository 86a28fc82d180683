/* Settings that change a JSON value by its path. */
#include "json/json_file.h"

#include "json/json.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* The key of an object that is the same as a step of a path; the step itself where there is none. */
static const char *find_key(json_t *object, const char *step) {
    const char *key = NULL;
    json_t *value = NULL;
    json_object_foreach(object, key, value) if (skg_json_same_key(key, step)) return key;
    return step;
}

/* Whether a path continues with this label, which may contain dots. */
static int starts_with_label(const char *path, const char *label) {
    size_t length = strlen(label);
    return length > 0 && strncmp(path, label, length) == 0 && (path[length] == '.' || path[length] == '\0');
}

/* The element of an array with which a path continues: by the longest Label that fits, or by number. -1: none.
 * *length: number of characters of the path that name it. */
static int64_t find_element(json_t *array, const char *path, size_t *length) {
    int64_t count = (int64_t)json_array_size(array), found = -1;
    *length = 0;
    for (int64_t i = 0; i < count; i++) {
        json_t *element = json_array_get(array, (size_t)i);
        const char *label = json_is_object(element)
                                ? json_string_value(json_object_get(element, find_key(element, "Label")))
                                : NULL;
        if (label && starts_with_label(path, label) && strlen(label) > *length)
            found = i, *length = strlen(label);
    }
    if (found >= 0) return found;
    *length = strcspn(path, ".");
    char *end = NULL;
    long long number = strtoll(path, &end, 10);
    return end == path + *length && end > path && number >= 0 && number < count ? (int64_t)number : -1;
}

/* Turns a step such as "Samples[0]", as messages write places, into "Samples.0", where no key has this name. */
static void open_bracket(json_t *object, char *path) {
    const size_t length = strcspn(path, ".");
    char *bracket = memchr(path, '[', length),
         *end = bracket ? memchr(bracket, ']', length - (size_t)(bracket - path)) : NULL;
    char whole[256];
    if (!end || end == bracket + 1 || bracket == path || length >= sizeof whole) return;
    if (strspn(bracket + 1, "0123456789") != (size_t)(end - bracket - 1) || !strchr(".[", end[1])) return;
    memcpy(whole, path, length);
    whole[length] = '\0';
    if (json_object_get(object, find_key(object, whole))) return;
    *bracket = '.';
    memmove(end, end + 1, strlen(end));
}

static skg_status no_element(const char *setting, json_t *array, const char *step) {
    return skg_fail(SKG_ERR_ARGUMENT,
                    "--set %s: \"%s\" is neither the label of an element nor a number from 0 to %" PRId64,
                    setting, step, (int64_t)json_array_size(array) - 1);
}

static skg_status drop(const char *setting, json_t *object, const char *key) {
    return json_object_del(object, key) == 0
               ? SKG_OK
               : skg_fail(SKG_ERR_ARGUMENT, "--set %s: there is no key \"%s\" to delete", setting, key);
}

/* Puts a value at the end of a path, and makes objects that are missing on the way; null deletes a key. path is
 * overwritten. */
static skg_status put(const char *setting, json_t *at, char *path, json_t *value) {
    for (;;) {
        if (json_is_object(at)) open_bracket(at, path);
        size_t length = strcspn(path, ".");
        if (json_is_array(at)) {
            int64_t index = find_element(at, path, &length);
            if (index < 0) return no_element(setting, at, path);
            if (!path[length] && json_is_null(value)) /* the lines of later elements are found by number */
                return skg_fail(SKG_ERR_ARGUMENT, "--set %s: null deletes keys, not elements of an array",
                                setting);
            if (!path[length])
                return json_array_set(at, (size_t)index, value) == 0
                           ? SKG_OK
                           : skg_fail(SKG_ERR_MEMORY, "--set %s: no memory", setting);
            at = json_array_get(at, (size_t)index);
        } else if (json_is_object(at)) {
            int last = !path[length];
            path[length] = '\0';
            if (!*path) return skg_fail(SKG_ERR_ARGUMENT, "--set %s: a key is empty", setting);
            const char *key = find_key(at, path);
            if (json_is_null(value) && (last || !json_object_get(at, key))) return drop(setting, at, key);
            if (last || !json_object_get(at, key))
                if (json_object_set_new(at, key, last ? json_incref(value) : json_object()) != 0)
                    return skg_fail(SKG_ERR_MEMORY, "--set %s: no memory, or the key is not UTF-8", setting);
            if (last) return SKG_OK;
            at = json_object_get(at, key);
        } else {
            return skg_fail(
                SKG_ERR_ARGUMENT,
                "--set %s: the value before \"%s\" is neither an object nor an array; there is nothing inside it "
                "to set",
                setting, path);
        }
        path += length + 1;
    }
}

skg_status skg_json_set(skg_json_file *file, const char *setting) {
    const char *equals = setting ? strchr(setting, '=') : NULL;
    if (!equals || equals == setting)
        return skg_fail(SKG_ERR_ARGUMENT, "--set %s: give KEY=VALUE, as in Detector.Size=[100, 100, \"mm\"]",
                        setting ? setting : "");
    char *path = NULL;
    SKG_TRY(skg_copy_text(setting, &path));
    path[equals - setting] = '\0';
    json_t *value = json_loads(equals + 1, JSON_DECODE_ANY | JSON_REJECT_DUPLICATES, NULL);
    if (!value) value = json_string(equals + 1);
    skg_status status = SKG_OK;
    if (!value || json_array_append(file->set, value) != 0)
        status = skg_fail(SKG_ERR_ARGUMENT, "--set %s: the value is not UTF-8", setting);
    else
        status = put(setting, file->root, path, value);
    json_decref(value);
    skg_free(&path);
    return status;
}
