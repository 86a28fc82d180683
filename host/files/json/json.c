/* Reading JSON with errors that name the place: file, line where the text has it, and path ("Samples[3].Material"). */
#include "json/json.h"

#include "core/maths.h"
#include "core/text.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Writes the path of a node, "Samples[3].Material"; returns its length. */
static size_t write_path(const skg_json_node *node, char *text, size_t size) {
    if (!node->up) return 0;
    size_t used = write_path(node->up, text, size);
    int more = node->key ? snprintf(text + used, size - used, "%s%s", used ? "." : "", node->key)
                         : snprintf(text + used, size - used, "[%" PRId64 "]", node->index);
    used += more > 0 ? (size_t)more : 0;
    return used < size ? used : size - 1;
}

void skg_json_place(const skg_json_node *node, char *place, size_t size) {
    place[0] = '\0';
    size_t used = write_path(node, place, size);
    int64_t line = skg_json_line(node), column = skg_json_column(node);
    if (column > 0)
        snprintf(place + used, size - used, " (line 1, column %" PRId64 ")", column);
    else if (line > 0)
        snprintf(place + used, size - used, " (line %" PRId64 ")", line);
}

enum { LONGEST_SENTENCE = 4096, LONGEST_PATH = 1024 };

static skg_status fail(const skg_json_node *node, skg_status status, const char *sentence) {
    char path[LONGEST_PATH] = "";
    write_path(node, path, sizeof path);
    if (status == SKG_ERR_ARGUMENT) status = SKG_ERR_FORMAT;
    int64_t line = skg_json_line(node), column = skg_json_column(node);
    if (column > 0)
        return skg_fail(status, "%s: line 1, column %" PRId64 ": %s: %s", node->file->path, column, path,
                        sentence);
    if (line > 0)
        return skg_fail(status, "%s: line %" PRId64 ": %s: %s", node->file->path, line, path, sentence);
    return skg_fail(status, "%s: %s%s%s", node->file->path, path, *path ? ": " : "", sentence);
}

static skg_status remark(const skg_json_node *node, const char *sentence) {
    char place[LONGEST_PATH], whole[LONGEST_SENTENCE + LONGEST_PATH];
    json_t *remarks = node->file->remarks;
    skg_json_place(node, place, sizeof place);
    snprintf(whole, sizeof whole, "%s: %s", place, sentence);
    for (size_t i = 0; i < json_array_size(remarks); i++)
        if (strcmp(json_string_value(json_array_get(remarks, i)), whole) == 0) return SKG_OK;
    if (json_array_append_new(remarks, json_string(whole)) == 0) return SKG_OK;
    return skg_fail(SKG_ERR_MEMORY, "%s: no memory for a warning", node->file->path);
}

skg_status skg_json_fail(const skg_json_node *node, skg_status status, const char *format, ...) {
    char sentence[LONGEST_SENTENCE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    return fail(node, status, sentence);
}

skg_status skg_json_remark(const skg_json_node *node, const char *format, ...) {
    char sentence[LONGEST_SENTENCE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    return remark(node, sentence);
}

skg_status skg_json_fault(const skg_json_node *node, skg_status status, const char *format, ...) {
    char sentence[LONGEST_SENTENCE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    if (node->file->lenient) return remark(node, sentence);
    char whole[LONGEST_SENTENCE + 64];
    snprintf(whole, sizeof whole, "%s; read leniently (--lenient), this is a warning", sentence);
    return fail(node, status, whole);
}

skg_status skg_json_at(const skg_json_node *node, skg_status status) {
    return status == SKG_OK ? SKG_OK : skg_json_fail(node, status, "%s", skg_last_error());
}

static const char *kind_of(const json_t *value) {
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        return "an object";
    case JSON_ARRAY:
        return "an array";
    case JSON_STRING:
        return "a string";
    case JSON_INTEGER:
    case JSON_REAL:
        return "a number";
    case JSON_TRUE:
        return "true";
    case JSON_FALSE:
        return "false";
    default:
        return "null";
    }
}

static skg_status wrong_kind(const skg_json_node *node, const char *wanted) {
    if (!node->value) return skg_json_fail(node, SKG_ERR_FORMAT, "is missing; give %s", wanted);
    return skg_json_fail(node, SKG_ERR_FORMAT, "is %s; give %s", kind_of(node->value), wanted);
}

static const char *next_of_key(const char *at) {
    while (*at == ' ' || *at == '-' || *at == '_') at++;
    return at;
}

int skg_json_same_key(const char *a, const char *b) {
    a = next_of_key(a), b = next_of_key(b);
    while (*a && *b && tolower((unsigned char)*a) == tolower((unsigned char)*b))
        a = next_of_key(a + 1), b = next_of_key(b + 1);
    return *a == '\0' && *b == '\0';
}

/* Keys that people and exporters write into any object for themselves and for displays. */
static const skg_json_key asides[] = {
    {"Comment", NULL, SKG_KEY_IGNORED, "any", NULL},     {"Comments", NULL, SKG_KEY_IGNORED, "any", NULL},
    {"Colour", NULL, SKG_KEY_IGNORED, "any", NULL},      {"Color", NULL, SKG_KEY_IGNORED, "any", NULL},
    {"Description", NULL, SKG_KEY_IGNORED, "any", NULL},
};
const skg_json_table skg_json_asides = {"Asides", asides, sizeof asides / sizeof *asides};

static const skg_json_key *find_in(const skg_json_table *table, const char *name) {
    for (int64_t i = 0; i < table->count; i++)
        if (skg_json_same_key(table->keys[i].name, name)) return &table->keys[i];
    return NULL;
}

static const skg_json_key *find_key(const skg_json_object *object, const char *name) {
    const skg_json_key *key = find_in(object->table, name);
    return key ? key : find_in(&skg_json_asides, name);
}

static const char *canonical(const skg_json_key *key) {
    return key->kind == SKG_KEY_READ && key->as ? key->as : key->name;
}

static skg_status unknown_key(const skg_json_object *object, const skg_json_node *member) {
    const char *names[64];
    int64_t count = object->table->count < 64 ? object->table->count : 64;
    for (int64_t i = 0; i < count; i++) names[i] = object->table->keys[i].name;
    const char *near = skg_nearest_name(member->key, names, count);
    return skg_json_fault(member, SKG_ERR_FORMAT, "unknown key%s%s", near ? "; did you mean " : "",
                          near ? near : "");
}

skg_status skg_json_read_object(const skg_json_node *node, const skg_json_table *table,
                                skg_json_object *object) {
    if (!json_is_object(node->value)) return wrong_kind(node, "an object { ... }");
    *object = (skg_json_object){.node = node, .table = table};
    const char *name = NULL;
    json_t *value = NULL;
    json_object_foreach(node->value, name, value) {
        skg_json_node member = {.file = node->file, .up = node, .key = name, .value = value};
        const skg_json_key *key = find_key(object, name);
        if (!key) SKG_TRY(unknown_key(object, &member));
        if (!key) continue;
        if (key->kind != SKG_KEY_READ) continue;
        const char *other = NULL;
        json_t *ignored = NULL;
        json_object_foreach(node->value, other, ignored) {
            const skg_json_key *another = find_key(object, other);
            if (other != name && another && another->kind == SKG_KEY_READ &&
                strcmp(canonical(another), canonical(key)) == 0)
                return skg_json_fail(&member, SKG_ERR_FORMAT,
                                     "is given twice (%s and %s are the same key); keep one", name, other);
        }
    }
    return SKG_OK;
}

skg_json_node skg_json_member(const skg_json_object *object, const char *name) {
    skg_json_node member = {.file = object->node->file, .up = object->node, .key = name};
    const char *given = NULL;
    json_t *value = NULL;
    json_object_foreach(object->node->value, given, value) {
        const skg_json_key *key = find_key(object, given);
        if (!key || strcmp(canonical(key), name) != 0) continue;
        member.key = given;
        member.value = value;
    }
    return member;
}

skg_status skg_json_need(const skg_json_object *object, const char *name, const char *example,
                         skg_json_node *member) {
    *member = skg_json_member(object, name);
    if (member->value) return SKG_OK;
    return skg_json_fail(object->node, SKG_ERR_FORMAT, "%s is missing; give \"%s\": %s", name, name, example);
}

skg_json_node skg_json_element(const skg_json_node *array, int64_t index) {
    return (skg_json_node){.file = array->file,
                           .up = array,
                           .index = index,
                           .value = json_array_get(array->value, (size_t)index)};
}

skg_status skg_json_array(const skg_json_node *node, const char *example, int64_t *count) {
    if (!json_is_array(node->value)) return wrong_kind(node, example);
    *count = (int64_t)json_array_size(node->value);
    return SKG_OK;
}

skg_status skg_json_number(const skg_json_node *node, double *number) {
    if (!json_is_number(node->value)) return wrong_kind(node, "a number");
    *number = json_number_value(node->value);
    return SKG_OK;
}

skg_status skg_json_integer(const skg_json_node *node, int64_t lowest, int64_t highest, int64_t *integer) {
    double number = 0;
    SKG_TRY(skg_json_number(node, &number));
    if (number != floor(number))
        return skg_json_fail(node, SKG_ERR_FORMAT, "is %g; give a whole number", number);
    if (number < (double)lowest || number > (double)highest)
        return skg_json_fail(node, SKG_ERR_FORMAT, "is %g; give %" PRId64 " to %" PRId64, number, lowest,
                             highest);
    *integer = (int64_t)number;
    return SKG_OK;
}

skg_status skg_json_flag(const skg_json_node *node, int32_t *flag) {
    if (json_is_boolean(node->value)) {
        *flag = json_is_true(node->value);
        return SKG_OK;
    }
    if (!json_is_integer(node->value)) return wrong_kind(node, "true or false");
    int64_t integer = 0;
    SKG_TRY(skg_json_integer(node, 0, 1, &integer));
    *flag = (int32_t)integer;
    return SKG_OK;
}

skg_status skg_json_text(const skg_json_node *node, const char **text) {
    if (!json_is_string(node->value)) return wrong_kind(node, "a string");
    *text = json_string_value(node->value);
    return SKG_OK;
}

skg_status skg_json_choice(const skg_json_node *node, const char *what, const char *const *names,
                           int64_t count, int64_t *choice) {
    const char *text = NULL;
    SKG_TRY(skg_json_text(node, &text));
    for (*choice = 0; *choice < count; ++*choice)
        if (skg_json_same_key(text, names[*choice])) return SKG_OK;
    char known[512] = "";
    for (int64_t i = 0; i < count; i++)
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", i ? ", " : "", names[i]);
    const char *near = skg_nearest_name(text, names, count);
    return skg_json_fail(node, SKG_ERR_FORMAT, "\"%s\" is no %s%s%s; known: %s", text, what,
                         near ? "; did you mean " : "", near ? near : "", known);
}

/* The first `count` elements as numbers. */
static skg_status read_numbers(const skg_json_node *node, int64_t count, double *numbers) {
    for (int64_t i = 0; i < count; i++) {
        skg_json_node element = skg_json_element(node, i);
        SKG_TRY(skg_json_number(&element, &numbers[i]));
    }
    return SKG_OK;
}

skg_status skg_json_numbers(const skg_json_node *node, const char *example, int64_t count, double *numbers) {
    int64_t given = 0;
    SKG_TRY(skg_json_array(node, example, &given));
    if (given != count)
        return skg_json_fail(node, SKG_ERR_FORMAT, "has %" PRId64 " elements instead of %" PRId64 "; give %s",
                             given, count, example);
    return read_numbers(node, count, numbers);
}

skg_status skg_json_unit_of_length(const skg_json_node *node, double *mm) {
    const char *name = NULL;
    SKG_TRY(skg_json_text(node, &name));
    skg_status status = skg_unit_of_length(name, mm);
    return skg_json_at(node, status);
}

skg_status skg_json_lengths(const skg_json_node *node, const char *example, int64_t count, double *mm) {
    int64_t given = 0;
    SKG_TRY(skg_json_array(node, example, &given));
    if (given == count) return skg_json_fail(node, SKG_ERR_FORMAT, "has no unit; give %s", example);
    if (given != count + 1)
        return skg_json_fail(node, SKG_ERR_FORMAT, "has %" PRId64 " elements instead of %" PRId64 "; give %s",
                             given, count + 1, example);
    double unit = 1;
    SKG_TRY(read_numbers(node, count, mm));
    skg_json_node last = skg_json_element(node, count);
    SKG_TRY(skg_json_unit_of_length(&last, &unit));
    for (int64_t i = 0; i < count; i++) mm[i] *= unit;
    return SKG_OK;
}

skg_status skg_json_direction(const skg_json_node *node, double *direction) {
    SKG_TRY(skg_json_numbers(node, "[x, y, z]", 3, direction));
    double length = skg_length(direction);
    if (!(length > 0) || !isfinite(length))
        return skg_json_fail(node, SKG_ERR_FORMAT, "is (%g, %g, %g), which is no direction", direction[0],
                             direction[1], direction[2]);
    skg_scale_vector(1 / length, direction, direction);
    return SKG_OK;
}
